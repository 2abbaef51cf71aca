// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <polhode/solids/mesh/mesh.hpp>

namespace polhode::solids {

/// A curved box of cells: an image of the unit cube, divided into cells along each coordinate.
struct Patch {
  /// Ends of the cells along each coordinate, from 0 to 1, ascending.
  std::array<std::vector<double>, 3> ends;
  std::function<Vec3(const Vec3&)> map;  ///< Unit cube → X [m], with a positive determinant.
};

/// A named part of the boundary: the faces of which all nodes satisfy a condition.
struct NamedSide {
  std::string name;
  std::function<bool(const Vec3&)> holds;
};

/// Ends of n cells between 0 and 1 whose lengths grow geometrically.
/// @param ratio  Length of the last cell over that of the first [-], positive.
[[nodiscard]] std::vector<double> graded(int n, double ratio);

/// Mesh of patches with matching cells. Nodes in the middles of edges, faces and cells are images
/// of the middles in the unit cube, so they lie on curved boundaries.
///
/// Tetrahedra: six per cell, by lines from its first node to the three opposite faces, so that
/// neighbours match for any orientation. Wedges: two per cell, with triangles normal to the third
/// coordinate; patches must agree on that coordinate.
///
/// @param type  hex8, hex20, hex27, tet4, tet10, tet15, wedge6 or wedge15.
/// @throws InputError if the cells would be inverted, or for another type.
[[nodiscard]] Mesh lattice_mesh(std::string_view name, const std::vector<Patch>& patches,
                                std::string_view type, const std::vector<NamedSide>& sides);

}  // namespace polhode::solids
