// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
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

/// Quadratic serendipity monomials of the prism: quadratic along the triangle and linear along the
/// axis, or the reverse.
Powers serendipity_prism() {
  return powers({2, 2, 2}, [](int a, int b, int c) { return a + b <= 2 && a + b + c <= 3; });
}

/// A polynomial: factors of its monomials.
using Polynomial = std::map<std::array<int, 3>, double>;

Polynomial product(const Polynomial& p, const Polynomial& q) {
  Polynomial sum;
  for (const auto& [a, x] : p)
    for (const auto& [b, y] : q) sum[{a[0] + b[0], a[1] + b[1], a[2] + b[2]}] += x * y;
  return sum;
}

/// Functions that span the shape functions: monomials, and the functions as sums of them.
struct Span {
  Powers powers;
  Mat functions;  ///< Column k: factors of the monomials in function k.

  Span(Powers monomials)  // NOLINT(google-explicit-constructor)
      : powers(std::move(monomials)),
        functions(Mat::Identity(static_cast<Eigen::Index>(powers.size()),
                                static_cast<Eigen::Index>(powers.size()))) {}
  explicit Span(const std::vector<Polynomial>& sums) {
    Polynomial all;
    for (const Polynomial& one : sums) all.insert(one.begin(), one.end());
    functions.setZero(static_cast<Eigen::Index>(all.size()),
                      static_cast<Eigen::Index>(sums.size()));
    Eigen::Index row = 0;
    for (const auto& [p, unused] : all) {
      powers.push_back(p);
      for (std::size_t k = 0; k < sums.size(); ++k)
        if (const auto found = sums[k].find(p); found != sums[k].end())
          functions(row, static_cast<Eigen::Index>(k)) = found->second;
      ++row;
    }
  }
};

/// Quadratic functions of a triangle or tetrahedron, and bubbles: the product of the barycentric
/// coordinates of each triangle, and of all four of the tetrahedron.
Span quadratic_with_bubbles(int dimension) {
  std::vector<Polynomial> functions;
  for (const auto& p : complete(dimension, 2)) functions.push_back({{p, 1.0}});
  std::vector<Polynomial> barycentric(1);
  barycentric[0][{0, 0, 0}] = 1.0;
  for (int k = 0; k < dimension; ++k) {
    std::array<int, 3> one{};
    one[static_cast<std::size_t>(k)] = 1;
    barycentric[0][one] = -1.0;
    barycentric.push_back({{one, 1.0}});
  }
  const std::size_t corners = barycentric.size();
  for (std::size_t i = 0; i < corners; ++i)
    for (std::size_t j = i + 1; j < corners; ++j)
      for (std::size_t k = j + 1; k < corners; ++k)
        functions.push_back(product(product(barycentric[i], barycentric[j]), barycentric[k]));
  if (corners == 4) functions.push_back(product(functions.back(), barycentric[0]));
  return Span(functions);
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

/// Place of a face in the order of VTK's nodes in their middles: the last face of a tetrahedron is
/// the first there.
int middle_place(const Family& family, std::size_t face) {
  const int count = static_cast<int>(family.faces.size()), place = static_cast<int>(face);
  return count == 4 ? (place + 1) % count : place;
}

/// @param full  Nodes in the middles of faces and of the cell too.
CellShape shape(std::string name, int vtk, const Family& family, int order, Span span,
                bool full = false) {
  CellShape s{.name = std::move(name),
              .dimension = family.dimension,
              .corners = static_cast<int>(family.corners.size()),
              .order = order,
              .vtk = vtk,
              .nodes = family.corners,
              .edges = family.edges,
              .faces = {},
              .powers = std::move(span.powers),
              .coefficients = {},
              .slopes = {}};
  if (order == 2)
    for (CellEdge& edge : s.edges) {
      edge.middle = s.size();
      s.nodes.push_back(0.5 * (s.nodes[edge.begin] + s.nodes[edge.end]));
    }
  const std::size_t edges_end = s.nodes.size();
  if (full) s.nodes.resize(edges_end + family.faces.size());
  for (std::size_t f = 0; f < family.faces.size(); ++f) {
    const std::vector<int>& corners = family.faces[f];
    CellFace face{.type = {}, .nodes = corners};
    for (std::size_t i = 0; order == 2 && i < corners.size(); ++i)
      for (const CellEdge& edge : s.edges) {
        const int a = corners[i], b = corners[(i + 1) % corners.size()];
        if ((edge.begin == a && edge.end == b) || (edge.begin == b && edge.end == a))
          face.nodes.push_back(edge.middle);
      }
    if (full) {
      face.nodes.push_back(static_cast<int>(edges_end) + middle_place(family, f));
      s.nodes[static_cast<std::size_t>(face.nodes.back())] = middle_of(s, corners);
    }
    face.type = face_type(corners.size(), face.nodes.size());
    s.faces.push_back(std::move(face));
  }
  if (full) s.nodes.push_back(middle_of(s, first_numbers(s.corners)));
  // N_a(ξ_b) = δ_ab: the coefficients are the inverse of the functions at the nodes. Their entries
  // are sums of 1, 1/2, 1/4, 1/8, which the rounding to 1/64 makes exact.
  Mat values(s.size(), static_cast<Eigen::Index>(s.powers.size()));
  for (int b = 0; b < s.size(); ++b)
    for (Eigen::Index m = 0; m < values.cols(); ++m)
      values(b, m) = monomial(s.powers[static_cast<std::size_t>(m)], s.nodes[b]);
  s.coefficients = (span.functions * (values * span.functions).inverse()).unaryExpr([](double c) {
    return std::round(64.0 * c) / 64.0;
  });
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
      shape("tri7", 34, triangle(), 2, quadratic_with_bubbles(2), true),
      shape("quad4", 9, quadrilateral(), 1, tensor(2, 1)),
      shape("quad8", 23, quadrilateral(), 2, serendipity(2)),
      shape("quad9", 28, quadrilateral(), 2, tensor(2, 2), true),
      shape("tet4", 10, tetrahedron(), 1, complete(3, 1)),
      shape("tet10", 24, tetrahedron(), 2, complete(3, 2)),
      shape("tet15", 71, tetrahedron(), 2, quadratic_with_bubbles(3), true),
      shape("wedge6", 13, wedge(), 1, prism()),
      shape("wedge15", 26, wedge(), 2, serendipity_prism()),
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
  Vec monomials(static_cast<Eigen::Index>(shape.powers.size()));
  for (Eigen::Index m = 0; m < monomials.size(); ++m)
    monomials[m] = monomial(shape.powers[static_cast<std::size_t>(m)], xi);
  return shape.coefficients.transpose() * monomials;
}

Mat shape_gradients(const CellShape& shape, const Vec3& xi) {
  Mat slopes(static_cast<Eigen::Index>(shape.powers.size()), 3);
  for (Eigen::Index m = 0; m < slopes.rows(); ++m) {
    const auto& p = shape.powers[static_cast<std::size_t>(m)];
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
