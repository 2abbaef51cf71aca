// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include <Eigen/LU>

#include <polhode/core/error.hpp>
#include <polhode/solids/elements/registry.hpp>
#include <polhode/solids/loads/dead_load.hpp>
#include <polhode/solids/loads/solid_load.hpp>

namespace polhode::solids {

/// Force per undeformed volume [N/m³] on solid elements.
/// @param name          Path of the load in the user's model.
/// @param element       A kind of element_kinds(); its rule for the mass is used.
/// @param connectivity  Numbers of nodes, element after element.
/// @param X             Reference positions of all nodes [m].
/// @param factor        Multiplies the value, e.g. by a density, if the value is an acceleration.
/// @throws InputError if there are no elements.
[[nodiscard]] inline std::unique_ptr<ElementGroup> make_body_force(
    std::string name, const std::string& element, std::span<const int> connectivity,
    std::span<const Vec3> X, TimeVector force, double factor = 1.0) {
  const ElementKind& kind = element_kind(element);
  const CellShape& shape = kind.cell();
  const std::size_t n = static_cast<std::size_t>(shape.size());
  if (connectivity.empty() || connectivity.size() % n != 0)
    throw InputError(name, "there are no whole elements to load", "Give all nodes of each element");
  std::map<int, double> weights;
  for (const QuadraturePoint& q : kind.mass) {
    const Vec N = shape_functions(shape, q.xi);
    const Mat D = shape_gradients(shape, q.xi);
    for (std::size_t first = 0; first < connectivity.size(); first += n) {
      const std::span<const int> own = connectivity.subspan(first, n);
      const double volume = q.weight * reference_jacobian(D, own, X).determinant();
      for (std::size_t a = 0; a < n; ++a)
        weights[own[a]] += factor * volume * N[static_cast<Eigen::Index>(a)];
    }
  }
  NodeShares shares(X);
  for (const auto& [node, w] : weights) shares.add(node, w * Mat3::Identity());
  return std::make_unique<DeadLoad>("body force", std::move(name), shares.all(), std::move(force));
}

[[nodiscard]] inline SolidLoadKind body_force_kind() {
  return {.name = "body_force",
          .meaning = "a force on a deformable solid in proportion to its mass",
          .place = SolidLoadPlace::elements,
          .vector = TimeParameter{"acceleration", "m/s^2",
                                  "force per mass, world components, in addition to gravity"},
          .make = [](const SolidLoadDescription& d) {
            ElementGroups groups;
            for (const LoadedElements& block : d.elements)
              groups.push_back(
                  make_body_force(d.name, block.element, block.nodes, d.X, d.vector, d.density));
            return groups;
          }};
}

}  // namespace polhode::solids
