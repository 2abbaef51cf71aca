// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/feb_mesh.hpp>
#include <polhode/solids/elements/quadrature.hpp>
#include <polhode/solids/mesh/shapes.hpp>

namespace polhode::io {

namespace {

/// Rounding of sums over elements.
constexpr double kRounding = 1e-13;

solids::Quadrature rule_of(const std::string& shape) {
  if (shape.starts_with("hex")) return solids::hexahedron_rule(4);
  if (shape == "tet4") return solids::tetrahedron_rule(2);
  if (shape.starts_with("tet")) return solids::tetrahedron_rule(7);
  if (shape == "wedge15") return solids::collapsed_wedge_rule();
  return solids::wedge_rule();
}

}  // namespace

std::optional<geometry::MassProperties> feb_mass(FebFile& file, const FebMesh& mesh,
                                                 const FebPart& part, double density) {
  if (part.shape.empty() || !part.is_solid()) {
    file.refuse(*part.at, format("{} elements of a rigid body are not read", part.type),
                "Mesh the part with hex8, hex20, hex27, tet4, tet10, tet15, penta6 or penta15.");
    return std::nullopt;
  }
  const solids::CellShape& shape = solids::cell_shape(part.shape);
  const solids::Quadrature rule = rule_of(part.shape);
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
