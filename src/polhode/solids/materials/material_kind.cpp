// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/solids/materials/material_kind.hpp>

namespace polhode::solids {
namespace {

constexpr double kLeastPositive = std::numeric_limits<double>::min();
constexpr double kUnbounded = std::numeric_limits<double>::infinity();

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

std::string listed(const std::vector<std::vector<std::string>>& sets) {
  std::string text;
  for (const auto& set : sets) text += (text.empty() ? "" : "; or ") + joined(set);
  return text;
}

std::string range_text(const Parameter& p) {
  if (p.least == kLeastPositive) return "a positive number";
  if (p.least == 0.0 && p.most == kUnbounded) return "a number that is not negative";
  if (p.most == kUnbounded) return format("a number of at least {:g}", p.least);
  return format("a number between {:g} and {:g}", p.least, p.most);
}

void check_range(std::string_view where, const Parameter& p, double value) {
  if (std::isfinite(value) && value >= p.least && value <= p.most) return;
  throw InputError(where, format("'{}' is {:g} {}", p.name, value, p.unit == "-" ? "" : p.unit),
                   format("Give {}", range_text(p)));
}

bool has_all(const ParameterValues& given, const std::vector<std::string>& names) {
  return std::all_of(names.begin(), names.end(), [&](const auto& n) { return given.count(n) > 0; });
}

/// Checks that the given names out of alternatives form exactly one complete set.
void check_alternatives(std::string_view where, const MaterialKind& kind,
                        const ParameterValues& given) {
  if (kind.alternatives.empty()) return;
  std::vector<std::string> present;
  for (const Parameter& p : kind.parameters)
    for (const auto& set : kind.alternatives)
      if (given.count(p.name) > 0 && std::count(set.begin(), set.end(), p.name) > 0 &&
          std::count(present.begin(), present.end(), p.name) == 0)
        present.push_back(p.name);
  for (const auto& set : kind.alternatives)
    if (has_all(given, set) && present.size() == set.size()) return;
  const std::string what =
      present.empty()       ? "elastic moduli are missing"
      : present.size() == 1 ? format("'{}' alone does not determine the stiffness", present.front())
                            : format("{} cannot be combined", joined(present));
  throw InputError(where, what, format("Give {}", listed(kind.alternatives)));
}

}  // namespace

ParameterValues checked_values(std::string_view where, const MaterialKind& kind,
                               const ParameterValues& given) {
  std::vector<std::string> names;
  for (const Parameter& p : kind.parameters) names.push_back(p.name);
  for (const auto& [name, value] : given)
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw InputError(where, format("'{}' has no parameter '{}'", kind.name, name),
                       did_you_mean(name, names) + "It takes: " + name_list(names));
  check_alternatives(where, kind, given);
  ParameterValues values;
  for (const Parameter& p : kind.parameters) {
    if (const auto found = given.find(p.name); found != given.end()) {
      check_range(where, p, found->second);
      values.insert(*found);
      continue;
    }
    if (p.standard) {
      values[p.name] = *p.standard;
      continue;
    }
    const bool optional = std::any_of(
        kind.alternatives.begin(), kind.alternatives.end(),
        [&](const auto& set) { return std::count(set.begin(), set.end(), p.name) > 0; });
    if (!optional)
      throw InputError(where, format("'{}' is missing", p.name),
                       format("Give {}: {}", p.unit == "-" ? "it" : "it in " + p.unit, p.meaning));
  }
  return values;
}

std::vector<Parameter> isotropic_parameters() {
  return {
      {"youngs_modulus", "Pa", {}, kLeastPositive, kUnbounded, "E"},
      {"poisson_ratio",
       "-",
       {},
       std::nextafter(-1.0, 0.0),
       std::nextafter(0.5, 0.0),
       "between -1 and 0.5, both excluded"},
      {"lame", "Pa", {}, -kUnbounded, kUnbounded, "first Lamé constant λ"},
      {"shear_modulus", "Pa", {}, kLeastPositive, kUnbounded, "μ = E/(2(1 + ν))"},
      {"bulk_modulus", "Pa", {}, kLeastPositive, kUnbounded, "K = λ + 2μ/3"},
  };
}

std::vector<std::vector<std::string>> isotropic_alternatives() {
  return {{"youngs_modulus", "poisson_ratio"},
          {"lame", "shear_modulus"},
          {"bulk_modulus", "shear_modulus"}};
}

LinearModuli isotropic_moduli(const ParameterValues& values) {
  const auto get = [&](const char* name) { return values.at(name); };
  if (values.count("youngs_modulus") > 0) {
    const double E = get("youngs_modulus"), nu = get("poisson_ratio");
    return {E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), E / (2.0 * (1.0 + nu))};
  }
  const double shear = get("shear_modulus");
  const double lame =
      values.count("lame") > 0 ? get("lame") : get("bulk_modulus") - 2.0 / 3.0 * shear;
  if (!(lame + 2.0 / 3.0 * shear > 0.0))
    throw InputError("moduli",
                     format("'lame' {:g} Pa with 'shear_modulus' {:g} Pa makes a bulk modulus of "
                            "{:g} Pa, which is not positive",
                            lame, shear, lame + 2.0 / 3.0 * shear),
                     "Give a first Lamé constant above -2/3 of the shear modulus");
  return {lame, shear};
}

}  // namespace polhode::solids
