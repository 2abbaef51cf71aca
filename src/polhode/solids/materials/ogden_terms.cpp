// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/solids/materials/ogden_terms.hpp>

namespace polhode::solids {

std::vector<Parameter> OgdenTerms::parameters() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kMostExponent = 100.0;
  std::vector<Parameter> list;
  for (int k = 1; k <= kMost; ++k) {
    const bool first = k == 1;
    list.push_back({format("c{}", k), "Pa",
                    first ? std::optional<double>() : std::optional<double>(0.0), -kInfinity,
                    kInfinity, format("factor of term {}; half of the sum of all is μ", k)});
    list.push_back({format("m{}", k), "-",
                    first ? std::optional<double>() : std::optional<double>(2.0), -kMostExponent,
                    kMostExponent, format("exponent of the stretches in term {}, not zero", k)});
  }
  return list;
}

OgdenTerms OgdenTerms::from(const ParameterValues& values) {
  OgdenTerms terms;
  for (int k = 1; k <= kMost; ++k) {
    const double c = values.at(format("c{}", k)), m = values.at(format("m{}", k));
    if (c == 0.0) continue;
    if (m == 0.0)
      throw InputError("moduli", format("the exponent 'm{}' is zero", k),
                       "Give another exponent, or leave the term out");
    terms.weight[terms.count] = c / (m * m);
    terms.exponent[terms.count] = 0.5 * m;
    ++terms.count;
  }
  if (!(terms.shear() > 0.0))
    throw InputError("moduli",
                     format("the shear modulus (c1 + c2 + ...)/2 is {:g} Pa", terms.shear()),
                     "Give factors with a positive sum");
  return terms;
}

double OgdenTerms::shear() const {
  double sum = 0.0;
  for (int k = 0; k < count; ++k) sum += 2.0 * weight[k] * exponent[k] * exponent[k];
  return sum;
}

}  // namespace polhode::solids
