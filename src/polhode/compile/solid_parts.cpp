// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/compile/solid_parts.hpp>
#include <polhode/solids/elements/registry.hpp>

namespace polhode {

solids::MaterialDescription material_description(const MaterialSpec& material) {
  solids::MaterialDescription d{.kind = material.type, .values = material.parameters};
  for (const FibreSpec& fibre : material.fibres)
    d.fibres.push_back({.law = fibre.law, .values = fibre.parameters});
  d.relaxation_time = material.viscosity.relaxation_time;
  d.viscous = {material.viscosity.lame, material.viscosity.shear};
  for (const RelaxationSpec& term : material.relaxation)
    d.relaxation.push_back({term.modulus_ratio, term.time});
  d.long_term_ratio = material.long_term_ratio;
  return d;
}

std::vector<std::string> solid_element_names() {
  std::vector<std::string> names;
  for (const solids::ElementKind& kind : solids::element_kinds())
    for (const std::string& name : {kind.shape, kind.name})
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  return names;
}

std::string cell_of_element(std::string_view element) {
  for (const solids::ElementKind& kind : solids::element_kinds())
    if (kind.name == element || kind.shape == element) return kind.shape;
  return {};
}

}  // namespace polhode
