// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <polhode/assembly/barrier_points.hpp>
#include <polhode/assembly/element_group.hpp>
#include <polhode/contact/normal_law.hpp>
#include <polhode/fe/contact/rigid_surface.hpp>
#include <polhode/fe/loads/solid_loads.hpp>

namespace polhode {

/// Where the rigid surface stands.
///
/// On a body it is carried by four nodes bonded to it: the origin of the
/// surface's coordinates, and its distance `size` along each of the axes.
/// Positions of nodes alone then tell everything.
struct SurfacePlace {
  Vec3 origin = Vec3::Zero();                ///< On the ground: world [m].
  Mat3 axes = Mat3::Identity();              ///< Columns, world.
  std::array<int, 4> nodes{-1, -1, -1, -1};  ///< On a body: their numbers.
  double size = 1.0;                         ///< [m]

  [[nodiscard]] bool moves() const { return nodes[0] >= 0; }
};

/// How the surface of a solid and a rigid surface act on each other, per
/// reference area.
struct SurfaceLaw {
  contact::NormalLaw normal;  ///< Stiffness in Pa/m.
  double end_share = 0.0;     ///< Part of the pressure that is that of the step's
                              ///< end: takes energy.
  double mu = 0.0;            ///< Coefficient of friction [-].
  double bristle = 0.0;       ///< Stiffness of the friction bristle [Pa/m].
};

/// What the contact does at an instant or over the last step.
struct SurfaceReport {
  Vec3 force = Vec3::Zero();       ///< On the solid [N], world.
  Vec3 friction = Vec3::Zero();    ///< Its tangential part [N].
  double area = 0.0;               ///< Of points in contact [m²], reference.
  double least_gap = 0.0;          ///< [m]
  double largest_pressure = 0.0;   ///< [Pa]
  int sticking = 0, slipping = 0;  ///< Points in contact.
};

/// Faces of a solid against a rigid surface: the potential ∫ β(g) dA over the
/// reference area.
///
/// The points are the nodes, with their share of the area, of faces with
/// straight edges, and Gauss points of curved ones. The forces of a point are
/// functions of its coordinates y in the surface's axes, and y of squared
/// distances between nodes: central forces, so that energy and both momenta are
/// kept exactly at ρ∞ = 1. @eq{surface-squared-distances}
class SurfaceContact final : public ElementGroup, public BarrierPoints {
 public:
  /// @param X  Reference positions by the system's node numbers.
  SurfaceContact(std::string name, const LoadedFaces& faces, const std::vector<Vec3>& X,
                 const RigidSurface& surface, const SurfacePlace& place, const SurfaceLaw& law);

  std::string kind() const override { return "surface contact"; }
  const std::string& name() const override { return name_; }
  int size() const override { return static_cast<int>(points_.size()); }
  int nodes_per_element() const override { return n_ + frame_; }
  std::span<const int> nodes(int element) const override {
    const auto width = static_cast<std::size_t>(n_ + frame_);
    return std::span(nodes_).subspan(static_cast<std::size_t>(element) * width, width);
  }
  bool dissipates() const override { return law_.mu > 0.0 || law_.end_share > 0.0; }
  bool conservative() const override { return !dissipates(); }
  bool external() const override { return frame_ == 0; }
  std::size_t history_size() const override { return kMemory * points_.size(); }
  void clearances(const NodeStep& step, std::vector<double>& list) const override;

  ElementReport evaluate(const NodeStep& step, const double* history, double* scratch,
                         const Mat3& turn, const ElementSink& sink) const override;
  void commit(const NodeStep& step, double* history, const double* scratch) const override;
  Work work(const NodeStep& step, const double* history, const double* scratch) const override;

  /// @param instant  Of node_instant().
  [[nodiscard]] SurfaceReport report(const NodeStep& instant, const double* history) const;

 private:
  static constexpr int kMostNodes = 9;
  static constexpr std::size_t kMemory = 4;  ///< Bristle in the surface's axes; whether it slips.

  struct Point {
    double area = 0.0;  ///< [m²]
    double N[kMostNodes]{};
  };
  /// The point in the surface's coordinates over the step.
  struct Place {
    Vec3 at_n, at_n1;
  };
  /// What acts at a point, conjugate to y, per unit of area.
  struct Action;
  template <class T>
  struct Terms;

  [[nodiscard]] Vec3 position(const double* x, int point) const;
  [[nodiscard]] Vec3 local(const double* x, int point) const;
  [[nodiscard]] Action act(const NodeStep& step, const Place& place, const double* memory,
                           bool tangent) const;
  void add_nodal_points(const LoadedFaces& faces, const std::vector<Vec3>& X);
  void add_gauss_points(const LoadedFaces& faces, const std::vector<Vec3>& X);

  std::string name_;
  RigidSurface surface_;
  SurfacePlace place_;
  SurfaceLaw law_;
  int n_ = 1, frame_ = 0;  ///< Nodes of the face, of the frame.
  std::vector<int> nodes_;
  std::vector<Point> points_;
};

}  // namespace polhode
