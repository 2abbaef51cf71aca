// SPDX-License-Identifier: Apache-2.0
// Places at which a corner or part touches a surface of triangles, for impulses.
#pragma once

#include <vector>

#include <polhode/contact/contact_point.hpp>
#include <polhode/contact/gap.hpp>

namespace polhode::contact {

/// Cosine of the angle between the normals at the middle and the start of the step below which the
/// bodies would pass each other.
inline constexpr double kPasses = 0.5;

/// Whether a pair may be in contact at several places of a surface of triangles.
[[nodiscard]] inline bool is_over_surface(GapKind kind) {
  return kind == GapKind::point_surface || kind == GapKind::part_surface;
}

/// Placements of both bodies at an instant of a step, which they refer to.
struct BothPlaced {
  Placement<double> a, b;

  [[nodiscard]] static BothPlaced at_start(const BodyStep& a, const BodyStep& b) {
    return {{a.r_n, a.Lambda_n, 0}, {b.r_n, b.Lambda_n, 6}};
  }
  [[nodiscard]] static BothPlaced at_end(const BodyStep& a, const BodyStep& b) {
    return {{a.r_n1, a.Lambda_n1, 0}, {b.r_n1, b.Lambda_n1, 6}};
  }
};

/// The gap with the normal closest to n, if they belong to one contact; null: there is none.
[[nodiscard]] const Gap<double>* same_contact(const std::vector<Gap<double>>& gaps, const Vec3& n);

/// Corrects the gap of two edges, or of an edge and a rim, so that it is negative behind each
/// other.
/// @returns whether they cross at all.
bool correct_edges(const PointData& d, const BodyStep& a, const BodyStep& b, Gap<double>& g);

/// Displacement of a relative to b over the step at a place in the middle of it.
[[nodiscard]] inline Vec3 apart(const BodyStep& a, const BodyStep& b, const Vec3& place) {
  return a.u + a.theta.cross(place - a.r_n - 0.5 * a.u) - b.u -
         b.theta.cross(place - b.r_n - 0.5 * b.u);
}

}  // namespace polhode::contact
