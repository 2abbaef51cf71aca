// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

#include <polhode/contact_laws/normal_law.hpp>
#include <polhode/geometry/shape.hpp>
#include <polhode/geometry/triangle_tree.hpp>

namespace polhode::surface_contact {

/// Gap of a point [m], its gradient [-] and Hessian [1/m].
struct SurfaceGap {
  double value = 0.0;
  Vec3 normal = Vec3::UnitZ();
  Mat3 curvature = Mat3::Zero();
};

/// Parameters of a gap query.
struct GapQuery {
  const contact::NormalLaw& law;  ///< Combines the gaps of several features.
  double at_most = std::numeric_limits<double>::infinity();  ///< Upper limit of reported gaps [m].
  bool sided = false;   ///< Gaps within surfaces of triangles are negative, see RigidMesh.
  double radius = 0.0;  ///< Of a ball about the point: the gap of the ball is computed [m].
};

/// A rigid surface of triangles in contact with points of solids.
///
/// A point has a gap to each triangle, edge and corner. Their combined potential is the sum over
/// triangles, minus each edge shared by two of them, plus each inner corner: common parts of
/// neighbours count once. The reported gap has the potential of that sum, so a triangulated plane
/// has the gap of the plane. @eq{surface-feature-sum}
///
/// In order of their gaps the multiplicities of the features so far sum to the number of places at
/// which a growing ball touches the surface, minus its holes. Over a hole or a pit narrower than
/// the ball this would be zero: one place always counts, so the force is never less than that of
/// the nearest feature. @eq{surface-feature-holes}
///
/// Triangles have two sides: no step takes a point from one to the other, and no point starts
/// inside. Where points may get inside all the same, as in iterates of statics, the query sets
/// `sided`.
class RigidMesh {
 public:
  /// @param surface  A Solid::surface; one with a border is open above, towards +z.
  explicit RigidMesh(geometry::Shape surface);

  [[nodiscard]] SurfaceGap gap(const Vec3& y, const GapQuery& question) const;
  /// Smallest of the gaps to features.
  [[nodiscard]] double distance(const Vec3& y, double at_most, bool sided) const;
  /// Radius about the origin that contains the surface and what is behind it [m]; infinite with a
  /// border.
  [[nodiscard]] double extent() const;

 private:
  struct Feature {
    geometry::TriangleRegion::Kind kind;
    int index = 0;  ///< Of a triangle, edge or corner.
    int count = 0;  ///< Multiplicity.
  };
  using Features = std::vector<Feature>;

  [[nodiscard]] bool may_be_behind(const Vec3& y) const;
  [[nodiscard]] geometry::TriangleTree::Hit nearest(const Vec3& y, double at_most,
                                                    bool sided) const;
  [[nodiscard]] Feature feature(int triangle, const geometry::TriangleRegion& region) const;
  [[nodiscard]] bool behind(const Vec3& y, const geometry::TriangleTree::Hit& hit) const;
  /// @param round  Rounding of feature and point together [m].
  [[nodiscard]] SurfaceGap gap_of(const Feature& feature, const Vec3& y, double round) const;
  [[nodiscard]] Features features_near(const Vec3& point, double distance) const;
  [[nodiscard]] SurfaceGap sum(const Vec3& y, const SurfaceGap& nearest,
                               const GapQuery& question) const;

  geometry::Shape surface_;
  geometry::TriangleTree tree_;
  /// By corner: mean normal of its triangles, weighted by their angles.
  std::vector<Vec3> outward_;
  bool bordered_ = false;
};

}  // namespace polhode::surface_contact
