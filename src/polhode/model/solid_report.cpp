// SPDX-License-Identifier: Apache-2.0
#include <polhode/model/solid_report.hpp>

#include <cmath>

namespace polhode {

double von_mises(const Mat3& stress) {
  const Mat3 deviator = stress - stress.trace() / 3.0 * Mat3::Identity();
  return std::sqrt(1.5) * deviator.norm();
}

NodalAverages nodal_averages(const Mesh& mesh, const std::vector<ElementSample>& elements) {
  NodalAverages result;
  result.cauchy.assign(mesh.nodes.size(), Mat3::Zero());
  result.von_mises.assign(mesh.nodes.size(), 0.0);
  result.strain_energy_density.assign(mesh.nodes.size(), 0.0);
  std::vector<double> volume(mesh.nodes.size(), 0.0);
  for (std::size_t e = 0; e < elements.size(); ++e)
    for (const int node : mesh.element_nodes(static_cast<int>(e))) {
      const auto i = static_cast<std::size_t>(node);
      const ElementSample& sample = elements[e];
      result.cauchy[i] += sample.volume * sample.cauchy;
      result.strain_energy_density[i] += sample.volume * sample.strain_energy_density;
      volume[i] += sample.volume;
    }
  for (std::size_t i = 0; i < volume.size(); ++i) {
    if (!(volume[i] > 0.0)) continue;
    result.cauchy[i] /= volume[i];
    result.strain_energy_density[i] /= volume[i];
    result.von_mises[i] = von_mises(result.cauchy[i]);
  }
  return result;
}

}  // namespace polhode
