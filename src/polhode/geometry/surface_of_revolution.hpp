// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/geometry/triangle_surface.hpp>

namespace polhode::geometry {

/// A corner of a profile that is rotated about z.
struct ProfilePoint {
  double r;  ///< Distance from the axis [m]; not negative.
  double z;  ///< [m]
};
using Profile = std::vector<ProfilePoint>;

/// A circular arc about (0, z_centre) between the quarter turns from and to (−1 is the south pole,
/// 0 the equator, 1 the north pole), about segments/4 chords a quarter.
[[nodiscard]] Profile arc_profile(double radius, double z_centre, int from, int to, int segments);

/// Surface swept by a profile that starts and ends on the axis; outward if the profile runs with
/// the solid on its left in the (r, z) plane, i.e. from the south pole to the north pole.
[[nodiscard]] TriangleSurface surface_of_revolution(const Profile& profile, int segments);

/// Surface swept by a closed profile that stays off the axis, counterclockwise in the (r, z) plane.
[[nodiscard]] TriangleSurface ring_of_revolution(const Profile& profile, int segments);

}  // namespace polhode::geometry
