// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include <polhode/surface_contact/line_stretch.hpp>
#include <polhode/surface_contact/point_memory.hpp>
#include <polhode/surface_contact/rigid_surface.hpp>
#include <polhode/surface_contact/surface_points.hpp>
#include <polhode/surface_contact/surface_totals.hpp>
#include <polhode/system/barrier_constraint.hpp>
#include <polhode/system/element_group.hpp>
#include <polhode/system/surface_impacts.hpp>

namespace polhode::surface_contact {

/// Placement of the rigid surface.
///
/// On a body it is carried by four nodes bonded to it: the origin of the surface's coordinates, and
/// points at the distance `size` along each of the axes. The placement then follows from node
/// positions alone.
struct SurfacePlace {
  Vec3 origin = Vec3::Zero();                ///< On the ground: world [m].
  Mat3 axes = Mat3::Identity();              ///< Columns, world.
  std::array<int, 4> nodes{-1, -1, -1, -1};  ///< On a body: their numbers.
  double size = 1.0;                         ///< [m]

  [[nodiscard]] bool moves() const { return nodes[0] >= 0; }
};

/// Faces of a solid, or a cable, against a rigid surface: the potential ∫ β(g) dA over the
/// reference area.
///
/// The forces of a point are functions of its coordinates y in the surface's axes, and y of squared
/// distances between nodes: central forces, so that energy and both momenta are conserved exactly
/// at ρ∞ = 1. @eq{surface-squared-distances}
///
/// The history holds, for each point, bristle, slip and forces of the last step, and then sums over
/// the run: all that reports contain is part of the state.
class SurfaceContact final : public ElementGroup,
                             public BarrierConstraint,
                             public SurfaceContactInterface,
                             public SurfaceImpacts {
 public:
  /// @param X  Positions at the start by the system's node numbers, including the nodes that carry
  /// a moving surface.
  SurfaceContact(std::string name, SurfacePoints points, const std::vector<Vec3>& X,
                 const RigidSurface& surface, const SurfacePlace& place, const SurfaceLaw& law);

  std::string kind() const override { return of_cable() ? kCableContact : "surface contact"; }
  const std::string& name() const override { return name_; }
  int size() const override { return static_cast<int>(points_.points.size()); }
  int nodes_per_element() const override { return n_ + frame_; }
  std::span<const int> nodes(int element) const override {
    const auto width = static_cast<std::size_t>(nodes_per_element());
    return std::span(nodes_).subspan(static_cast<std::size_t>(element) * width, width);
  }
  bool dissipates() const override { return law_.mu > 0.0 || law_.end_share > 0.0; }
  bool conservative() const override { return !dissipates(); }
  const BarrierConstraint* barrier_constraint() const override { return this; }
  const SurfaceImpacts* surface_impacts() const override { return this; }
  bool external() const override { return frame_ == 0; }
  std::size_t history_size() const override { return totals() + SurfaceTotals::kCount; }
  void initialize(double* history) const override;
  void clearances(const NodeStep& step, const double* history,
                  std::vector<double>& list) const override;
  double free_part(const NodeStep& from, const NodeStep& to, const double* history) const override;

  ElementReport evaluate(const NodeStep& step, const double* history, double* scratch,
                         const Mat3& turn, const ElementSink& sink) const override;
  void commit(const NodeStep& step, double* history, const double* scratch) const override;
  Work work(const NodeStep& step, const double* history, const double* scratch) const override;

  const SurfaceLaw& law() const override { return law_; }
  std::size_t places() const override { return points_.points.size(); }
  [[nodiscard]] bool of_cable() const { return points_.radius > 0.0; }
  /// Gaps of the points [m]. @param X  See the constructor.
  [[nodiscard]] std::vector<double> gaps(const std::vector<Vec3>& X) const;
  void begin_at(const NodeStep& instant, double* history) const override;
  [[nodiscard]] SurfaceReport report(const double* history) const override;
  [[nodiscard]] std::vector<SurfacePointReport> point_reports(const NodeStep& instant,
                                                              const double* history) const override;
  void add_to_nodes(const NodeStep& instant, const double* history,
                    std::vector<NodeContact>& nodes) const override;
  [[nodiscard]] std::optional<SurfaceOverlap> overlap(const NodeStep& instant) const override;

  void impacts(const NodeStep& step, const double* history,
               std::vector<SurfaceImpact>& list) const override;
  double turn(const SurfaceImpact& impact, double held, double* history) const override;
  void settled(const SurfaceImpact& impact, const ResolvedImpact& settled, double dt,
               double* history) const override;

 private:
  /// The point in the surface's coordinates over the step.
  struct LocalMotion {
    Vec3 at_n, at_n1;
  };
  /// Force of a point over a step, conjugate to y, per unit of area.
  struct Action {
    Vec3 h = Vec3::Zero();
    Mat3 D = Mat3::Zero();         ///< Derivative by y_{n+1}.
    Vec3 friction = Vec3::Zero();  ///< Part of h.
    Vec3 slid = Vec3::Zero();      ///< Tangential displacement.
    Vec3 bristle = Vec3::Zero();   ///< At t_{n+1}.
    double lambda = 0.0;           ///< Conjugate to the gap.
    double pressure = 0.0;         ///< Of the normal force.
    double gap_n = 0.0, gap_n1 = 0.0;
    Vec3 normal = Vec3::Zero();  ///< Gradient of the gap at t_{n+1}.
    PointPhase phase;            ///< In the step.
    bool acts = false, slips = false;
  };
  /// Energy per unit of area: stored at the end, dissipated over the step.
  struct Energies {
    double stored = 0.0, by_friction = 0.0, by_pressure = 0.0;
  };
  template <class T>
  struct Terms;

  /// Gap between the round section about a point and the surface.
  [[nodiscard]] RigidSurface::Gap gap(const Vec3& y, const GapQuery& question) const;
  [[nodiscard]] double distance(const Vec3& y,
                                double at_most = std::numeric_limits<double>::infinity(),
                                bool sided = false) const;
  [[nodiscard]] double radius() const { return points_.radius; }
  /// Whether the point is far from the surface: a quick test, as most of a cable is far from most
  /// shapes.
  [[nodiscard]] bool is_far(const Vec3& y, double at_most) const {
    return of_cable() && y.norm() - extent_ - radius() > at_most;
  }
  [[nodiscard]] Vec3 position(const double* x, int point) const;
  /// Point of the round section about a point that is nearest to the surface.
  [[nodiscard]] Vec3 foot(const double* x, int point) const;
  [[nodiscard]] Vec3 local(const double* x, int point) const;
  [[nodiscard]] Mat3 axes(const double* x) const;
  [[nodiscard]] LocalMotion place(const NodeStep& step, int point) const {
    return {local(step.x_n, point), local(step.x_n1, point)};
  }
  /// Whether points may get within surfaces, as iterates of statics do, see GapQuery.
  [[nodiscard]] bool sided(const NodeStep& step) const {
    return !step.context.conserving || law_.normal.is_spring();
  }
  [[nodiscard]] static std::size_t place_of(int point) {
    return PointMemory::kCount * static_cast<std::size_t>(point);
  }
  [[nodiscard]] static PointMemory memory_of(const double* history, int point) {
    return read_record<PointMemory>(history + place_of(point));
  }
  /// Where the totals begin, behind the points.
  [[nodiscard]] std::size_t totals() const { return place_of(size()); }
  /// Law at an instant.
  [[nodiscard]] SurfaceLaw law_of(const PointMemory& memory) const {
    return beginning_later(law_, memory.phase.lowered);
  }
  /// Velocity in the surface's coordinates.
  [[nodiscard]] Vec3 local_rate(const double* x, const double* v, int point) const;
  void write_start(const std::vector<double>& gaps, double* history) const;
  [[nodiscard]] Action act(const NodeStep& step, int point, const PointMemory& memory,
                           bool tangent) const;
  [[nodiscard]] bool goes_through(const Vec3& from, const Vec3& to) const;
  [[nodiscard]] double free_of_stretch(const NodeStep& from, const NodeStep& to) const;
  [[nodiscard]] Energies energies(const NodeStep& step, const Action& a,
                                  const PointMemory& memory) const;

  std::string name_;
  RigidSurface surface_;
  SurfacePlace place_;
  SurfaceLaw law_;
  int n_ = 1, frame_ = 0;  ///< Nodes of the face, of the frame.
  SurfacePoints points_;
  double extent_ = 0.0;                ///< Of the surface about its origin [m].
  std::vector<int> nodes_;             ///< Of each point: of its face, then of the frame.
  std::vector<double> gaps_at_start_;  ///< Of each point, at the start [m].
};

}  // namespace polhode::surface_contact
