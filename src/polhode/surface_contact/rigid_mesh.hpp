// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

#include <polhode/contact_laws/normal_law.hpp>
#include <polhode/geometry/shape.hpp>
#include <polhode/geometry/triangle_tree.hpp>

namespace polhode {

/// Gap of a point [m], its gradient [-] and Hessian [1/m].
struct SurfaceGap {
  double value = 0.0;
  Vec3 normal = Vec3::UnitZ();
  Mat3 curvature = Mat3::Zero();
};

/// What is asked about a gap.
struct GapQuery {
  const contact::NormalLaw& law;  ///< Which makes one gap of those of several features.
  double at_most = std::numeric_limits<double>::infinity();  ///< Larger gaps are told as this [m].
  bool sided = false;   ///< Gaps within surfaces of triangles are negative, see RigidMesh.
  double radius = 0.0;  ///< Of a ball about the point: the gap is that of the ball [m].
};

/// A rigid surface of triangles that points of solids meet.
///
/// A point has a gap to each triangle, edge and corner. What they do to it together is the sum of
/// their potentials, for each triangle, less each edge that two of them share, plus each corner
/// inside: what neighbours have in common counts once. The gap with the potential of that sum is
/// the one that is told, so a triangulated plane has the gap of the plane. @eq{surface-feature-sum}
///
/// In order of their gaps the features that count so far sum up to the number of places at which a
/// growing ball touches the surface, less its holes. Over a hole or a pit that is narrower than a
/// ball this would be none: one place counts always, so nothing is pushed by less than by what is
/// nearest. @eq{surface-feature-holes}
///
/// Triangles have two sides: no step takes a point from one to the other, and none starts within.
/// Where points may get there all the same, as iterates of statics, the question asks for `sided`.
class RigidMesh {
 public:
  /// @param surface  A Solid::surface; one with a border is free above, towards +z.
  explicit RigidMesh(contact::Shape surface);

  [[nodiscard]] SurfaceGap gap(const Vec3& y, const GapQuery& question) const;
  /// The least of the gaps to features.
  [[nodiscard]] double distance(const Vec3& y, double at_most, bool sided) const;
  /// No point of it, nor what is behind it, is farther from the origin [m]; infinite with a border.
  [[nodiscard]] double extent() const;

 private:
  struct Feature {
    contact::TriangleRegion::Kind kind;
    int index = 0;  ///< Of a triangle, edge or corner.
    int count = 0;  ///< How often it counts.
  };
  using Features = std::vector<Feature>;

  [[nodiscard]] bool may_be_behind(const Vec3& y) const;
  [[nodiscard]] contact::TriangleTree::Hit nearest(const Vec3& y, double at_most, bool sided) const;
  [[nodiscard]] Feature feature(int triangle, const contact::TriangleRegion& region) const;
  [[nodiscard]] bool behind(const Vec3& y, const contact::TriangleTree::Hit& hit) const;
  /// @param round  Of what is round about both, the feature and the point [m].
  [[nodiscard]] SurfaceGap gap_of(const Feature& feature, const Vec3& y, double round) const;
  [[nodiscard]] Features features_near(const Vec3& point, double distance) const;
  [[nodiscard]] SurfaceGap sum(const Vec3& y, const SurfaceGap& nearest,
                               const GapQuery& question) const;

  contact::Shape surface_;
  contact::TriangleTree tree_;
  std::vector<Vec3> outward_;  ///< By corner: of its triangles, weighted by their angles.
  bool bordered_ = false;
};

}  // namespace polhode
