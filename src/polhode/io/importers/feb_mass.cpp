// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/feb_mesh.hpp>
#include <polhode/solids/elements/quadrature.hpp>
#include <polhode/solids/mesh/shapes.hpp>

namespace polhode::io {

namespace {

/// Distance of a node from the middle of its edge, over the length of the edge, up to which the
/// edge is straight.
constexpr double kStraight = 1e-6;

/// Rounding of sums over elements.
constexpr double kRounding = 1e-13;

/// Edges of tet15 and penta15 in the order of their nodes after the corners.
using Edge = std::array<int, 2>;
const std::vector<Edge>& edges_of(bool tetrahedron) {
  static const std::vector<Edge> tet{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  static const std::vector<Edge> penta{{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5},
                                       {5, 3}, {0, 3}, {1, 4}, {2, 5}};
  return tetrahedron ? tet : penta;
}

solids::Quadrature rule_of(const std::string& shape) {
  if (shape.starts_with("hex")) return solids::hexahedron_rule(4);
  if (shape == "tet4") return solids::tetrahedron_rule(2);
  if (shape == "tet10") return solids::tetrahedron_rule(7);
  return solids::wedge_rule();
}

/// Shape that has the same volume; "" if there is none.
std::string shape_of_volume(const FebMesh& mesh, const FebPart& part) {
  if (!part.shape.empty()) return part.shape;
  const bool tetrahedron = part.type == "tet15";
  if (!tetrahedron && part.type != "penta15") return "";
  const std::size_t corners = tetrahedron ? 4 : 6, size = static_cast<std::size_t>(part.size);
  for (std::size_t e = 0; e < part.nodes.size(); e += size)
    for (std::size_t k = 0; k < edges_of(tetrahedron).size(); ++k) {
      const auto node = [&](std::size_t n) {
        return mesh.nodes[static_cast<std::size_t>(part.nodes[e + n])];
      };
      const Edge& edge = edges_of(tetrahedron)[k];
      const Vec3 a = node(static_cast<std::size_t>(edge[0]));
      const Vec3 b = node(static_cast<std::size_t>(edge[1]));
      if ((node(corners + k) - 0.5 * (a + b)).norm() > kStraight * (b - a).norm()) return "";
    }
  return tetrahedron ? "tet4" : "wedge6";
}

}  // namespace

std::optional<geometry::MassProperties> feb_mass(FebFile& file, const FebMesh& mesh,
                                                 const FebPart& part, double density) {
  const std::string shape_name = shape_of_volume(mesh, part);
  if (shape_name.empty()) {
    file.refuse(*part.at,
                format("{} elements {} are not read", part.type,
                       part.type == "tet15" || part.type == "penta15" ? "with curved edges"
                                                                      : "of a rigid body"),
                "Mesh the part with hex8, hex20, hex27, tet4, tet10 or penta6.");
    return std::nullopt;
  }
  const solids::CellShape& shape = solids::cell_shape(shape_name);
  const solids::Quadrature rule = rule_of(shape_name);
  std::vector<Vec> values;
  for (const solids::QuadraturePoint& q : rule) values.push_back(shape_functions(shape, q.xi));
  // Moments about the first node lose few digits where the mesh is far from the origin.
  const Vec3 about =
      part.nodes.empty() ? Vec3::Zero() : mesh.nodes[static_cast<std::size_t>(part.nodes.front())];
  double volume = 0.0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  std::vector<Vec3> x(static_cast<std::size_t>(shape.size()));
  const auto size = static_cast<std::size_t>(part.size);
  for (std::size_t e = 0; e * size < part.nodes.size(); ++e) {
    for (std::size_t k = 0; k < x.size(); ++k)
      x[k] = mesh.nodes[static_cast<std::size_t>(part.nodes[e * size + k])] - about;
    for (std::size_t q = 0; q < rule.size(); ++q) {
      const double J = solids::jacobian(shape, x.data(), rule[q].xi);
      if (!(J > 0.0)) {
        file.xml.fault(*part.at, format("the element {} is inverted or has no volume", part.ids[e]),
                       "Order its nodes as FEBio does.");
        return std::nullopt;
      }
      Vec3 point = Vec3::Zero();
      for (std::size_t k = 0; k < x.size(); ++k)
        point += values[q][static_cast<Eigen::Index>(k)] * x[k];
      const double part_volume = rule[q].weight * J;
      volume += part_volume;
      first += part_volume * point;
      second += part_volume * (point * point.transpose());
    }
  }
  geometry::MassProperties result;
  if (!(density * volume > 0.0)) return result;
  const Vec3 com = first / volume;
  const Mat3 central = density * (second - volume * (com * com.transpose()));
  result.mass = density * volume;
  result.com = about + com;
  result.inertia = central.trace() * Mat3::Identity() - central;
  result.inertia = Mat3(0.5 * (result.inertia + result.inertia.transpose()));
  // Rounding of what is zero by symmetry.
  const double radius = std::sqrt(result.inertia.trace() / result.mass);
  for (int i = 0; i < 3; ++i) {
    if (std::abs(result.com[i]) < kRounding * radius) result.com[i] = 0.0;
    for (int j = 0; j < 3; ++j)
      if (std::abs(result.inertia(i, j)) < kRounding * result.inertia.trace())
        result.inertia(i, j) = 0.0;
  }
  return result;
}

}  // namespace polhode::io
