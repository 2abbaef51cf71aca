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
    if (p.name == "c2" && p.unit == "Pa") value = 4e5;
    // Exponents of Ogden's terms, also negative and not whole.
    constexpr double kExponents[] = {2.0, -2.0, 4.5, -1.3, 1.0, 8.0};
    if (p.name.size() == 2 && p.name[0] == 'm')
      value = kExponents[static_cast<std::size_t>(p.name[1] - '1')];
    if (p.name == "straight_stretch") value = 1.15;
    if (p.name == "beta") value = 2.6;
    if (p.name == "dispersion") value = 0.0;
    values[p.name] = std::clamp(value, p.least, p.most);
  }
  return values;
}

/// Every material of the registry without fibres; one coupled and one uncoupled with fibres of
/// every law, and with several families.
inline std::vector<solids::MaterialDescription> example_materials() {
  std::vector<solids::MaterialDescription> all;
  for (const solids::MaterialKind& kind : solids::material_kinds())
    all.push_back({.kind = kind.name, .values = example_values(kind)});
  for (const char* name : {"neo_hookean", "mooney_rivlin_uncoupled"}) {
    const solids::ParameterValues values = example_values(solids::material_kind(name));
    for (const solids::MaterialKind& fibre : solids::fibre_kinds())
      all.push_back({.kind = name,
                     .values = values,
                     .fibres = {{.law = fibre.name, .values = example_values(fibre)}}});
    solids::ParameterValues straight = example_values(solids::fibre_kind("power_linear"));
    straight["dispersion"] = 0.1;
    all.push_back({.kind = name,
                   .values = values,
                   .fibres = {{.law = "exponential",
                               .values = {{"xi", 1e6}, {"alpha", 3.0}, {"dispersion", 0.2}}},
                              {.law = "power_linear", .values = straight}}});
  }
  return all;
}

/// Directions of its families of fibres.
inline std::vector<Vec3> example_directions(const solids::Material& material) {
  std::vector<Vec3> all = {Vec3(1.0, 0.4, -0.3), Vec3(0.2, 1.0, 0.5)};
  all.resize(material.fibres().size());
  return all;
}

inline std::string label(const solids::MaterialDescription& d) {
  if (d.fibres.empty()) return d.kind;
  return d.kind + (d.fibres.size() > 1 ? "_with_families" : "_with_" + d.fibres.front().law);
}

}  // namespace polhode::test
