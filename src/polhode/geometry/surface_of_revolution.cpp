// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <polhode/geometry/surface_of_revolution.hpp>

namespace polhode::geometry {
namespace {

/// Adds the circle of a profile point and returns its corners; a point on the axis is one corner.
std::vector<int> add_circle(TriangleSurface& surface, const ProfilePoint& p, int segments) {
  std::vector<int> corners(static_cast<std::size_t>(segments),
                           static_cast<int>(surface.points.size()));
  if (p.r == 0.0) {
    surface.points.emplace_back(0.0, 0.0, p.z);
    return corners;
  }
  for (int i = 0; i < segments; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / segments;
    corners[static_cast<std::size_t>(i)] += i;
    surface.points.emplace_back(p.r * std::cos(angle), p.r * std::sin(angle), p.z);
  }
  return corners;
}

/// Adds the band between two circles of corners, leaving out triangles that collapse on the axis.
void add_band(TriangleSurface& surface, const std::vector<int>& below,
              const std::vector<int>& above) {
  for (std::size_t i = 0; i < below.size(); ++i) {
    const std::size_t j = (i + 1) % below.size();
    if (below[i] != below[j]) surface.triangles.push_back({below[i], below[j], above[j]});
    if (above[i] != above[j]) surface.triangles.push_back({below[i], above[j], above[i]});
  }
}

}  // namespace

Profile arc_profile(double radius, double z_centre, int from, int to, int segments) {
  const int chords = std::max(2, (segments + 3) / 4) * (to - from);
  Profile profile;
  for (int i = 0; i <= chords; ++i) {
    const double latitude = 0.5 * std::numbers::pi * (from + (to - from) * double(i) / chords);
    const bool pole = (i == 0 && from == -1) || (i == chords && to == 1);
    profile.push_back(
        {pole ? 0.0 : radius * std::cos(latitude), z_centre + radius * std::sin(latitude)});
  }
  return profile;
}

TriangleSurface surface_of_revolution(const Profile& profile, int segments) {
  TriangleSurface surface;
  std::vector<int> below = add_circle(surface, profile.front(), segments);
  for (std::size_t i = 1; i < profile.size(); ++i) {
    std::vector<int> above = add_circle(surface, profile[i], segments);
    add_band(surface, below, above);
    below = std::move(above);
  }
  return surface;
}

TriangleSurface ring_of_revolution(const Profile& profile, int segments) {
  TriangleSurface surface;
  const std::vector<int> first = add_circle(surface, profile.front(), segments);
  std::vector<int> below = first;
  for (std::size_t i = 1; i < profile.size(); ++i) {
    std::vector<int> above = add_circle(surface, profile[i], segments);
    add_band(surface, below, above);
    below = std::move(above);
  }
  add_band(surface, below, first);
  return surface;
}

}  // namespace polhode::geometry
