// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <polhode/surface_contact/contact_neighbours.hpp>
#include <polhode/surface_contact/line_stretch.hpp>
#include <polhode/surface_contact/mesh_gap.hpp>
#include <polhode/surface_contact/patch_gap.hpp>
#include <polhode/surface_contact/point_memory.hpp>
#include <polhode/surface_contact/surface_totals.hpp>
#include <polhode/system/barrier_constraint.hpp>
#include <polhode/system/element_group.hpp>
#include <polhode/system/surface_impacts.hpp>

namespace polhode::surface_contact {

/// Contact of points of a solid's surface with another surface, or with its own: the potential
/// Σ A β(d − g_tol), with d the distance of a point to the nearest smooth patch of that surface.
///
/// d is never negative: surfaces are kept apart, by 2 g_tol where they exert no pressure. Forces
/// act along the lines to the nearest points, see PatchGap, so energy and both momenta are
/// conserved exactly at ρ∞ = 1, whichever patch is the nearest one. Each point has a list of
/// candidate triangles, see ContactNeighbours; a patch counts where one of its triangles does.
/// @eq{mesh-contact}
///
/// Points of a cable stay its radius away, and their distance to triangles is a MeshGap: the gap is
/// the distance minus the radius. @eq{cable-on-mesh}
class SolidContact final : public ElementGroup,
                           public BarrierConstraint,
                           public ChangingSparsity,
                           public SurfaceContactInterface,
                           public SurfaceImpacts {
 public:
  SolidContact(std::string name, std::vector<MeshPoint> points, MeshSurface surface,
               const SurfaceLaw& law, const SolidContactStart& start, RoundLine cable = {});

  std::string kind() const override { return of_cable() ? kCableContact : "contact of solids"; }
  const std::string& name() const override { return name_; }
  int size() const override { return 0; }  // its blocks are those of ChangingSparsity
  int nodes_per_element() const override { return 1; }
  std::span<const int> nodes(int /*element*/) const override { return {}; }
  bool has_tangent() const override { return false; }
  bool dissipates() const override { return law_.mu > 0.0 || law_.end_share > 0.0; }
  bool conservative() const override { return !dissipates(); }
  const BarrierConstraint* barrier_constraint() const override { return this; }
  const ChangingSparsity* changing_sparsity() const override { return this; }
  const SurfaceImpacts* surface_impacts() const override { return this; }
  std::size_t history_size() const override;
  void initialize(double* history) const override;

  const std::vector<int>& reach() const override { return nodes_.numbers(); }
  const NodeBlocks& blocks(const double* history) const override {
    return search(history).blocks.blocks;
  }
  void renew(const NodeStep& step, double* history) const override { nodes_.renew(step, history); }
  void clearances(const NodeStep& step, const double* history,
                  std::vector<double>& list) const override;
  double free_part(const NodeStep& from, const NodeStep& to, const double* history) const override;

  ElementReport evaluate(const NodeStep& step, const double* history, double* scratch,
                         const Mat3& turn, const ElementSink& sink) const override;
  void commit(const NodeStep& step, double* history, const double* scratch) const override;
  Work work(const NodeStep& step, const double* history, const double* scratch) const override;

  const SurfaceLaw& law() const override { return law_; }
  std::size_t places() const override { return points_.size(); }
  [[nodiscard]] bool of_cable() const { return cable_.radius > 0.0; }
  /// Gaps of the points at the start, negative behind the nearest triangle; NaN where nothing is
  /// near [m].
  [[nodiscard]] std::vector<double> gaps_at_start() const;
  [[nodiscard]] const std::vector<MeshPoint>& points() const { return points_; }
  [[nodiscard]] double radius() const { return cable_.radius; }  ///< About its points [m].
  /// Number of candidate pairs of a point and a triangle.
  [[nodiscard]] int candidates(const double* history) const;
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
  struct Field;
  struct Slide;

  /// Triangles by point at the positions of a search, and the blocks of the tangent.
  struct Search {
    std::vector<double> key;  ///< Part of the history that determines the result.
    std::vector<int> first, triangle;
    ContactNeighbours::Blocks blocks;
  };
  /// The nearest triangle or patch of a point.
  struct Nearest {
    int triangle = -1;
    NearestFour four;  ///< On the triangle.
    PatchFoot foot;    ///< On the patch, unless the point is one of a cable.
    double distance = 0.0;
  };
  /// An active point over a step.
  struct Action {
    MeshGap at_n, at_n1;                  ///< Of a cable.
    PatchFoot foot_n, foot_n1;            ///< Of a solid.
    contact::ForceAndSlope pressure;      ///< Conjugate to the distance.
    contact::ForceAndSlope normal_force;  ///< Resultant on the point.
    double gap_n = 0.0, gap_n1 = 0.0;     ///< [m]
    PointPhase phase;                     ///< In the step.
    bool acts = false;

    [[nodiscard]] bool has_friction(const SurfaceLaw& law) const {
      return acts && law.mu > 0.0 && !phase.in_impact();
    }
  };
  struct Energies {
    double stored = 0.0, by_friction = 0.0, by_pressure = 0.0;
  };

  [[nodiscard]] std::size_t place_of(int point) const {
    return nodes_.key_size() + PointMemory::kCount * static_cast<std::size_t>(point);
  }
  [[nodiscard]] PointMemory memory_of(const double* history, int point) const {
    return read_record<PointMemory>(history + place_of(point));
  }
  /// Where the totals begin, behind the points.
  [[nodiscard]] std::size_t totals() const { return place_of(static_cast<int>(points_.size())); }
  [[nodiscard]] const Search& search(const double* history) const;
  void find(Search& s) const;
  [[nodiscard]] bool may_meet(int point, int triangle) const;
  [[nodiscard]] bool may_meet_triangle(int point, int triangle) const;
  [[nodiscard]] std::span<const int> found(const Search& s, int point) const;
  void four_points(const Field& field, int point, int triangle, Vec3 (&x)[4]) const;
  [[nodiscard]] Nearest nearest(const Field& field, std::span<const int> triangles,
                                int point) const;
  [[nodiscard]] Nearest nearest_triangle(const Field& field, std::span<const int> triangles,
                                         int point) const;
  void vertices_of(const SurfacePatch& patch, const std::vector<Vec3>& vertices,
                   Vec3 (&x)[SurfacePatch::kSize]) const;
  [[nodiscard]] PatchVector vector_to(int point, const PatchFoot& foot) const {
    return {points_[static_cast<std::size_t>(point)],
            patches_[static_cast<std::size_t>(foot.patch)], foot, surface_.vertices};
  }
  void round_edges();
  [[nodiscard]] SurfaceLaw law_of(const PointMemory& memory) const {
    return with_band_lowered(law_, memory.phase.lowered);
  }
  [[nodiscard]] MeshGap gap(const Field& field, std::span<const int> triangles, int point,
                            const Nearest& nearest, const contact::NormalLaw& law) const;
  [[nodiscard]] double signed_distance(const Field& field, std::span<const int> triangles,
                                       int point, const Nearest& nearest) const;
  [[nodiscard]] Vec3 way_out(const Field& field, const Nearest& nearest, int point,
                             double signed_distance) const;
  /// A point and its nearby triangles on a straight displacement.
  struct Way;
  [[nodiscard]] FourMoves moves(const Field& x_n1, const Field& u, int point, int triangle) const;
  template <class Use>
  void with_gap(const NodeStep& step, const Field& x_n1, const Field& u, int point, const Action& a,
                Use&& use) const;
  /// Distance by which a point may come nearer.
  [[nodiscard]] double clearance(double distance) const {
    return distance - centre_ + law_.normal.tolerance;
  }
  [[nodiscard]] const MeshPoint& corner(int point, int triangle, int k) const;
  [[nodiscard]] Action act(const NodeStep& step, const Field& x_n, const Field& x_n1,
                           std::span<const int> triangles, int point,
                           const PointMemory& memory) const;
  /// Rate of the gap at t_n.
  [[nodiscard]] double rate_n(const NodeStep& step, const Field& x_n, const Nearest& nearest,
                              int point) const;
  void add_rates(const NodeStep& step, const Field& x, const Action& a, int point,
                 SurfaceImpact& impact) const;
  [[nodiscard]] Slide slide(const NodeStep& step, const Field& x_n1, const Field& u,
                            std::span<const int> triangles, int point, double pressure,
                            const PointMemory& memory, bool tangent) const;
  [[nodiscard]] Energies energies(const NodeStep& step, const Action& a, const Slide& slide,
                                  const PointMemory& memory) const;
  void write_start(double* history) const;
  [[nodiscard]] Vec3 normal(const Field& field, const MeshGap& gap, int point) const;
  [[nodiscard]] Vec3 foot(const Field& field, const MeshGap& gap, int point) const;

  std::string name_;
  std::vector<MeshPoint> points_;
  MeshSurface surface_;
  std::vector<SurfacePatch> patches_;  ///< Of a contact of solids.
  std::vector<int> patch_of_;          ///< By triangle.
  std::vector<double> width_;          ///< By point, of rounded edges.
  SurfaceLaw law_;
  bool self_ = false;
  RoundLine cable_;
  double centre_ = 0.0;  ///< Distance at which the gap is zero [m].
  ContactNeighbours nodes_;
  mutable Search search_;  ///< For the last history queried.
};

}  // namespace polhode::surface_contact
