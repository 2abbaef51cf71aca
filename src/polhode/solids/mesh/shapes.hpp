// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <polhode/core/types.hpp>

namespace polhode::solids {

/// One edge: its corners, and the node in its middle (−1 if it has none).
struct CellEdge {
  int begin;
  int end;
  int middle = -1;
};

/// One face of a solid. Seen from outside, the corners are counterclockwise; then follow the nodes
/// in the middles of the edges, then the one in the middle of the face, if the type has them.
struct CellFace {
  std::string type;        ///< A 2-D shape: tri3, tri6, tri7, quad4, quad8, quad9.
  std::vector<int> nodes;  ///< Local numbers.
};

/// A kind of cell: its nodes and their reference coordinates.
///
/// Nodes are in the order of VTK, corners first, with one exception: triangle 0 1 2 of wedges faces
/// triangle 3 4 5, as in Gmsh and Abaqus, so that the wedge's map has a positive determinant.
///
/// Reference coordinates: lines [−1, 1], quadrilaterals and hexahedra their powers; triangles and
/// tetrahedra between 0 and 1 along each axis, node 0 at the origin; wedges triangle × [−1, 1].
struct CellShape {
  std::string name;                        ///< hex8, hex20, tet4, tet15, wedge6, quad4, …
  int dimension;                           ///< 0 point, 1 line, 2 face, 3 solid.
  int corners;                             ///< Nodes 0 … corners − 1 are corners.
  int order;                               ///< 1 linear, 2 quadratic.
  int vtk;                                 ///< Number of this cell in VTK.
  std::vector<Vec3> nodes;                 ///< Reference coordinates of each node [-].
  std::vector<CellEdge> edges;             ///< Of lines: the line itself.
  std::vector<CellFace> faces;             ///< Of solids; outward. Empty for others.
  std::vector<std::array<int, 3>> powers;  ///< Monomials of the shape functions.
  Mat coefficients;                        ///< Column a: coefficients of N_a over the monomials.
  std::vector<Mat> slopes;  ///< shape_gradients() at each node, and finally in the middle.

  [[nodiscard]] int size() const { return static_cast<int>(nodes.size()); }
};

/// All kinds of cell.
[[nodiscard]] const std::vector<CellShape>& cell_shapes();

/// The shape of that name; null if there is none.
[[nodiscard]] const CellShape* find_cell_shape(std::string_view name);

/// Shape of that name. @throws InputError that lists the existing names.
[[nodiscard]] const CellShape& cell_shape(std::string_view name);

/// Shape functions at a reference point [-].
[[nodiscard]] Vec shape_functions(const CellShape& shape, const Vec3& xi);

/// Derivatives of the shape functions by the reference coordinates: one row per node, three columns
/// (those beyond the dimension are zero) [-].
[[nodiscard]] Mat shape_gradients(const CellShape& shape, const Vec3& xi);

/// Determinant of ∂X/∂ξ of a solid cell at a reference point [m³].
/// @param X  Nodes of the cell, shape.size() of them.
[[nodiscard]] double jacobian(const CellShape& shape, const Vec3* X, const Vec3& xi);

/// Smallest determinant over all nodes and the middle of a solid cell, for nodes X [m³]. Not
/// positive: the cell is inverted or collapsed somewhere.
[[nodiscard]] double least_jacobian(const CellShape& shape, const Vec3* X);

}  // namespace polhode::solids
