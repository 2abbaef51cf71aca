// SPDX-License-Identifier: Apache-2.0
// Sums of materials of an FEBio mixture that are materials of the same family.
#include <algorithm>
#include <array>
#include <cstdlib>

#include <polhode/core/format.hpp>
#include <polhode/io/importers/feb_law.hpp>

namespace polhode::io {

namespace {

/// Terms that an Ogden material has at most.
constexpr std::size_t kMostOgdenTerms = 6;

/// Number of a material; zero if it has none of this key.
double value_in(const SourceNode& law, std::string_view key) {
  const SourceNode* node = law.find(key);
  return node == nullptr ? 0.0 : std::strtod(node->text.c_str(), nullptr);
}

bool has_type(const SourceNode& law, std::string_view type) {
  return law.find("type")->text == type;
}

bool all_have(const std::vector<SourceNode>& laws, std::initializer_list<std::string_view> types) {
  return std::all_of(laws.begin(), laws.end(), [&](const SourceNode& law) {
    return std::any_of(types.begin(), types.end(),
                       [&](std::string_view type) { return has_type(law, type); });
  });
}

/// Both Lamé constants of a material with Young's modulus and Poisson's ratio.
std::array<double, 2> lame_of(const SourceNode& law) {
  const double E = value_in(law, "youngs_modulus"), v = value_in(law, "poisson_ratio");
  const double shear = E / (2.0 * (1.0 + v));
  return {2.0 * shear * v / (1.0 - 2.0 * v), shear};
}

}  // namespace

std::optional<SourceNode> sum_of_laws(const NodeBuilder& make,
                                      const std::vector<SourceNode>& laws) {
  SourceNode sum = make.map();
  const auto total = [&](std::string_view key) {
    double value = 0.0;
    for (const SourceNode& law : laws) value += value_in(law, key);
    return value;
  };
  const auto put = [&](const std::string& key, double value) {
    make.put(sum, key, make.number(value));
  };
  if (all_have(laws, {"neo_hookean"}) || all_have(laws, {"elastic"})) {
    make.put(sum, "type", *laws.front().find("type"));
    std::array<double, 2> both{};
    for (const SourceNode& law : laws)
      for (std::size_t k = 0; k < 2; ++k) both[k] += lame_of(law)[k];
    put("lame", both[0]);
    put("shear_modulus", both[1]);
    return sum;
  }
  if (all_have(laws, {"neo_hookean", "mooney_rivlin"})) {
    make.put(sum, "type", make.text("mooney_rivlin"));
    double c1 = total("c1"), lame = total("lame");
    for (const SourceNode& law : laws) {
      if (!has_type(law, "neo_hookean")) continue;
      lame += lame_of(law)[0];
      c1 += 0.5 * lame_of(law)[1];
    }
    put("c1", c1);
    put("c2", total("c2"));
    put("lame", lame);
    return sum;
  }
  if (all_have(laws, {"mooney_rivlin_uncoupled"})) {
    make.put(sum, "type", *laws.front().find("type"));
    put("c1", total("c1"));
    put("c2", total("c2"));
    return sum;
  }
  const bool coupled = all_have(laws, {"ogden"});
  if (!coupled && !all_have(laws, {"ogden_uncoupled", "mooney_rivlin_uncoupled"}))
    return std::nullopt;
  make.put(sum, "type", make.text(coupled ? "ogden" : "ogden_uncoupled"));
  std::vector<std::array<double, 2>> terms;
  for (const SourceNode& law : laws) {
    if (has_type(law, "mooney_rivlin_uncoupled")) {
      // The isochoric stretches have the product 1, so that I2 is the sum of their squares'
      // inverses.
      if (const double c = value_in(law, "c1"); c != 0.0) terms.push_back({4.0 * c, 2.0});
      if (const double c = value_in(law, "c2"); c != 0.0) terms.push_back({4.0 * c, -2.0});
      continue;
    }
    for (std::size_t k = 1; law.find(format("c{}", k)) != nullptr; ++k)
      terms.push_back({value_in(law, format("c{}", k)), value_in(law, format("m{}", k))});
  }
  if (terms.size() > kMostOgdenTerms) return std::nullopt;
  for (std::size_t k = 0; k < terms.size(); ++k) {
    put(format("c{}", k + 1), terms[k][0]);
    put(format("m{}", k + 1), terms[k][1]);
  }
  if (coupled) put("lame", total("lame"));
  return sum;
}

}  // namespace polhode::io
