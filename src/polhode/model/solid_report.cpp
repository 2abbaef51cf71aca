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
  const auto at_node = [](const ElementSample& sample, std::size_t a) {
    return a < sample.cauchy_at_nodes.size() ? sample.cauchy_at_nodes[a] : sample.cauchy;
  };
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const ElementSample& sample = elements[e];
    std::size_t a = 0;
    for (const int node : mesh.element_nodes(static_cast<int>(e))) {
      const auto i = static_cast<std::size_t>(node);
      result.cauchy[i] += sample.volume * at_node(sample, a);
      result.strain_energy_density[i] +=
          sample.volume * (a < sample.energy_at_nodes.size() ? sample.energy_at_nodes[a]
                                                             : sample.strain_energy_density);
      volume[i] += sample.volume;
      ++a;
    }
  }
  for (std::size_t i = 0; i < volume.size(); ++i) {
    if (!(volume[i] > 0.0)) continue;
    result.cauchy[i] /= volume[i];
    result.strain_energy_density[i] /= volume[i];
    result.von_mises[i] = von_mises(result.cauchy[i]);
  }
  for (std::size_t e = 0; e < elements.size(); ++e) {
    double sum = 0.0;
    std::size_t a = 0;
    for (const int node : mesh.element_nodes(static_cast<int>(e))) {
      const Mat3& mean = result.cauchy[static_cast<std::size_t>(node)];
      const double off = von_mises(at_node(elements[e], a++) - mean);
      sum += off * off;
    }
    result.stress_error.push_back(a > 0 ? std::sqrt(sum / static_cast<double>(a)) : 0.0);
  }
  return result;
}

}  // namespace polhode
