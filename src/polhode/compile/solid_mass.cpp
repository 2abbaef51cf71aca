// SPDX-License-Identifier: Apache-2.0
#include <polhode/compile/solid_mass.hpp>

#include <span>
#include <vector>

#include <polhode/solids/solid_elements.hpp>

namespace polhode {

geometry::MassProperties solid_mass(const SolidMap& solid) {
  Mat3 second = Mat3::Zero();
  std::vector<double> M;
  for (const solids::SolidElements* group : solid.elements) {
    const auto n = static_cast<std::size_t>(group->nodes_per_element());
    M.resize(n * n);
    for (int e = 0; e < group->size(); ++e) {
      group->mass(e, M.data());
      const std::span<const int> nodes = group->nodes(e);
      const auto from_centre = [&](std::size_t k) -> Vec3 {
        return solid.plan.start[static_cast<std::size_t>(nodes[k] - solid.first_node)] -
               solid.centre;
      };
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j)
          second += M[i * n + j] * from_centre(i) * from_centre(j).transpose();
    }
  }
  geometry::MassProperties result;
  result.mass = solid.mass;
  result.com = solid.centre;
  const Mat3 inertia = second.trace() * Mat3::Identity() - second;
  result.inertia = 0.5 * (inertia + inertia.transpose());
  return result;
}

}  // namespace polhode
