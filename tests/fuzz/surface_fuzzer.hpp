// SPDX-License-Identifier: Apache-2.0
// Feeds arbitrary bytes to one reader of triangle surfaces, and its surfaces to the shapes of
// contact. The only accepted outcomes are valid shapes and an InputError.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include <polhode/core/error.hpp>
#include <polhode/geometry/read_surface.hpp>
#include <polhode/geometry/shape.hpp>

namespace polhode::fuzz {

inline void require(bool holds) {
  if (!holds) std::abort();
}

inline void check_shape(const geometry::Shape& shape) {
  const int corners = static_cast<int>(shape.corners.size());
  const auto exists = [&](int corner) { return corner >= 0 && corner < corners; };
  for (const Vec3& x : shape.corners) require(x.allFinite());
  for (const auto& triangle : shape.triangles)
    for (const int corner : triangle) require(exists(corner));
  for (const geometry::Shape::Edge& edge : shape.edges) require(exists(edge.i) && exists(edge.j));
  require(shape.rounding > 0.0 && shape.size > 0.0);
}

template <class Use>
void tolerate(const std::string& where, Use&& use) {
  try {
    use();
  } catch (const InputError& error) {
    require(error.where().starts_with(where) && !error.what_is_wrong().empty() &&
            !error.hint().empty());
  }
}

inline int read(const std::string& name, const std::uint8_t* data, std::size_t size) {
  tolerate(name, [&] {
    const geometry::TriangleSurface surface =
        geometry::parse_surface(name, std::string_view(reinterpret_cast<const char*>(data), size));
    const int points = static_cast<int>(surface.points.size());
    for (const auto& triangle : surface.triangles)
      for (const int corner : triangle) require(corner >= 0 && corner < points);
    (void)geometry::edge_report(surface);
    tolerate(name, [&] { check_shape(geometry::mesh(name, surface)); });
    tolerate(name, [&] { check_shape(geometry::hull(name, surface.points)); });
  });
  return 0;
}

}  // namespace polhode::fuzz
