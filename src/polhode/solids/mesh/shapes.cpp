// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/LU>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/solids/mesh/shapes.hpp>

namespace polhode::solids {
namespace {

using Corners = std::vector<std::vector<int>>;
using Powers = std::vector<std::array<int, 3>>;

/// Common data of the shapes of one family.
struct Family {
  int dimension;
  std::vector<Vec3> corners;
  std::vector<CellEdge> edges;  ///< In the order of VTK's nodes in their middles.
  Corners faces;                ///< Corners of each face, outward.
};

const std::vector<CellEdge> kHexEdges = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                                         {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};

Family point() { return {0, {Vec3::Zero()}, {}, {}}; }
Family line() { return {1, {{-1, 0, 0}, {1, 0, 0}}, {{0, 1}}, {}}; }
Family triangle() { return {2, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1}, {1, 2}, {2, 0}}, {}}; }
Family quadrilateral() {
  return {
      2, {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}, {}};
}
Family tetrahedron() {
  return {3,
          {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}},
          {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 2, 1}}};
}
Family wedge() {
  return {3,
          {{0, 0, -1}, {1, 0, -1}, {0, 1, -1}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}},
          {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}},
          {{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}};
}
Family hexahedron() {
  return {3,
          {{-1, -1, -1},
           {1, -1, -1},
           {1, 1, -1},
           {-1, 1, -1},
           {-1, -1, 1},
           {1, -1, 1},
           {1, 1, 1},
           {-1, 1, 1}},
          kHexEdges,
          {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}}};
}

/// Monomials ξ^a η^b ζ^c up to `each` in every variable for which keep(a, b, c) holds.
template <class Keep>
Powers powers(std::array<int, 3> each, const Keep& keep) {
  Powers found;
  for (int c = 0; c <= each[2]; ++c)
    for (int b = 0; b <= each[1]; ++b)
      for (int a = 0; a <= each[0]; ++a)
        if (keep(a, b, c)) found.push_back({a, b, c});
  return found;
}

Powers complete(int dimension, int degree) {
  return powers(
      {dimension > 0 ? degree : 0, dimension > 1 ? degree : 0, dimension > 2 ? degree : 0},
      [&](int a, int b, int c) { return a + b + c <= degree; });
}

Powers tensor(int dimension, int degree) {
  return powers(
      {dimension > 0 ? degree : 0, dimension > 1 ? degree : 0, dimension > 2 ? degree : 0},
      [](int, int, int) { return true; });
}

/// Quadratic serendipity monomials: squares of at most one variable.
Powers serendipity(int dimension) {
  return powers({2, dimension > 1 ? 2 : 0, dimension > 2 ? 2 : 0},
                [](int a, int b, int c) { return (a == 2) + (b == 2) + (c == 2) <= 1; });
}

Powers prism() {
  return powers({1, 1, 1}, [](int a, int b, int) { return a + b <= 1; });
}

double power(double x, int n) { return n == 0 ? 1.0 : n == 1 ? x : x * x; }
double power_slope(double x, int n) { return n == 0 ? 0.0 : n == 1 ? 1.0 : 2.0 * x; }

double monomial(const std::array<int, 3>& p, const Vec3& xi) {
  return power(xi[0], p[0]) * power(xi[1], p[1]) * power(xi[2], p[2]);
}

Vec3 middle_of(const CellShape& shape, const std::vector<int>& corners) {
  Vec3 sum = Vec3::Zero();
  for (int corner : corners) sum += shape.nodes[corner];
  return sum / static_cast<double>(corners.size());
}

double determinant(const Mat& slopes, const Vec3* X) {
  Mat3 J = Mat3::Zero();
  for (Eigen::Index a = 0; a < slopes.rows(); ++a) J += X[a] * slopes.row(a);
  return J.determinant();
}

std::vector<int> first_numbers(int n) {
  std::vector<int> all(n);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

std::string face_type(std::size_t corners, std::size_t nodes) {
  return (corners == 3 ? "tri" : "quad") + std::to_string(nodes);
}

/// @param full  Nodes in the middles of faces and of the cell too.
CellShape shape(std::string name, int vtk, const Family& family, int order, Powers monomials,
                bool full = false) {
  CellShape s{.name = std::move(name),
              .dimension = family.dimension,
              .corners = static_cast<int>(family.corners.size()),
              .order = order,
              .vtk = vtk,
              .nodes = family.corners,
              .edges = family.edges,
              .faces = {},
              .powers = std::move(monomials),
              .coefficients = {},
              .slopes = {}};
  if (order == 2)
    for (CellEdge& edge : s.edges) {
      edge.middle = s.size();
      s.nodes.push_back(0.5 * (s.nodes[edge.begin] + s.nodes[edge.end]));
    }
  for (const std::vector<int>& corners : family.faces) {
    CellFace face{.type = {}, .nodes = corners};
    for (std::size_t i = 0; order == 2 && i < corners.size(); ++i)
      for (const CellEdge& edge : s.edges) {
        const int a = corners[i], b = corners[(i + 1) % corners.size()];
        if ((edge.begin == a && edge.end == b) || (edge.begin == b && edge.end == a))
          face.nodes.push_back(edge.middle);
      }
    if (full) {
      face.nodes.push_back(s.size());
      s.nodes.push_back(middle_of(s, corners));
    }
    face.type = face_type(corners.size(), face.nodes.size());
    s.faces.push_back(std::move(face));
  }
  if (full) s.nodes.push_back(middle_of(s, first_numbers(s.corners)));
  // N_a(ξ_b) = δ_ab: the coefficients are the inverse of the monomials at the nodes. Their entries
  // are sums of 1, 1/2, 1/4, 1/8, which the rounding to 1/64 makes exact.
  Mat values(s.size(), s.size());
  for (int b = 0; b < s.size(); ++b)
    for (int m = 0; m < s.size(); ++m) values(b, m) = monomial(s.powers[m], s.nodes[b]);
  s.coefficients = values.inverse().unaryExpr([](double c) { return std::round(64.0 * c) / 64.0; });
  for (const Vec3& xi : s.nodes) s.slopes.push_back(shape_gradients(s, xi));
  s.slopes.push_back(shape_gradients(s, middle_of(s, first_numbers(s.corners))));
  return s;
}

std::vector<CellShape> make_shapes() {
  return {
      shape("point", 1, point(), 1, complete(0, 0)),
      shape("line2", 3, line(), 1, complete(1, 1)),
      shape("line3", 21, line(), 2, complete(1, 2)),
      shape("tri3", 5, triangle(), 1, complete(2, 1)),
      shape("tri6", 22, triangle(), 2, complete(2, 2)),
      shape("quad4", 9, quadrilateral(), 1, tensor(2, 1)),
      shape("quad8", 23, quadrilateral(), 2, serendipity(2)),
      shape("quad9", 28, quadrilateral(), 2, tensor(2, 2), true),
      shape("tet4", 10, tetrahedron(), 1, complete(3, 1)),
      shape("tet10", 24, tetrahedron(), 2, complete(3, 2)),
      shape("wedge6", 13, wedge(), 1, prism()),
      shape("hex8", 12, hexahedron(), 1, tensor(3, 1)),
      shape("hex20", 25, hexahedron(), 2, serendipity(3)),
      shape("hex27", 29, hexahedron(), 2, tensor(3, 2), true),
  };
}

}  // namespace

const std::vector<CellShape>& cell_shapes() {
  static const std::vector<CellShape> shapes = make_shapes();
  return shapes;
}

const CellShape* find_cell_shape(std::string_view name) {
  for (const CellShape& shape : cell_shapes())
    if (shape.name == name) return &shape;
  return nullptr;
}

const CellShape& cell_shape(std::string_view name) {
  if (const CellShape* shape = find_cell_shape(name)) return *shape;
  std::vector<std::string> names;
  for (const CellShape& shape : cell_shapes()) names.push_back(shape.name);
  throw InputError("element type", format("there is no type '{}'", name),
                   did_you_mean(name, names) + "Types: " + name_list(names));
}

Vec shape_functions(const CellShape& shape, const Vec3& xi) {
  Vec monomials(shape.size());
  for (int m = 0; m < shape.size(); ++m) monomials[m] = monomial(shape.powers[m], xi);
  return shape.coefficients.transpose() * monomials;
}

Mat shape_gradients(const CellShape& shape, const Vec3& xi) {
  Mat slopes(shape.size(), 3);
  for (int m = 0; m < shape.size(); ++m) {
    const auto& p = shape.powers[m];
    const Vec3 x{power(xi[0], p[0]), power(xi[1], p[1]), power(xi[2], p[2])};
    slopes.row(m) << power_slope(xi[0], p[0]) * x[1] * x[2], power_slope(xi[1], p[1]) * x[0] * x[2],
        power_slope(xi[2], p[2]) * x[0] * x[1];
  }
  return shape.coefficients.transpose() * slopes;
}

double jacobian(const CellShape& shape, const Vec3* X, const Vec3& xi) {
  return determinant(shape_gradients(shape, xi), X);
}

double least_jacobian(const CellShape& shape, const Vec3* X) {
  double least = std::numeric_limits<double>::infinity();
  for (const Mat& slopes : shape.slopes) {
    const double J = determinant(slopes, X);
    if (!(J >= least)) least = J;  // NaN counts as the smallest
  }
  return least;
}

}  // namespace polhode::solids
