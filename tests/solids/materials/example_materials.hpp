// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <polhode/solids/materials/registry.hpp>

namespace polhode::test {

/// Some values that a kind accepts: its first alternative, moduli of a soft solid.
inline solids::ParameterValues example_values(const solids::MaterialKind& kind) {
  solids::ParameterValues values;
  for (const Parameter& p : kind.parameters) {
    bool chosen = true;
    for (std::size_t i = 0; i < kind.alternatives.size(); ++i)
      for (const std::string& name : kind.alternatives[i])
        if (name == p.name) chosen = i == 0;
    if (!chosen) continue;
    double value = p.unit == "Pa" ? (p.name == "bulk_modulus" ? 2e7 : 1e6) : 2.0;
    if (p.name == "poisson_ratio") value = 0.3;
    if (p.name == "c2") value = 4e5;
    if (p.name == "straight_stretch") value = 1.15;
    values[p.name] = std::clamp(value, p.least, p.most);
  }
  return values;
}

/// Every material of the registry, without fibres and with those of every law.
inline std::vector<solids::MaterialDescription> example_materials() {
  std::vector<solids::MaterialDescription> all;
  for (const solids::MaterialKind& kind : solids::material_kinds()) {
    all.push_back({.kind = kind.name, .values = example_values(kind)});
    for (const solids::MaterialKind& fibre : solids::fibre_kinds())
      all.push_back({.kind = kind.name,
                     .values = example_values(kind),
                     .fibre = fibre.name,
                     .fibre_values = example_values(fibre)});
  }
  return all;
}

inline std::string label(const solids::MaterialDescription& d) {
  return d.kind + (d.fibre.empty() ? "" : "_with_" + d.fibre);
}

}  // namespace polhode::test
