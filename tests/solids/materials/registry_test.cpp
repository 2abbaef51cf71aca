// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/solids/materials/registry.hpp>

namespace polhode::registry_tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;
using testing::ThrowsMessage;

auto make(solids::MaterialDescription d) {
  return [d] { (void)solids::make_material("materials.rubber", d); };
}
template <class... Part>
auto refused(Part... part) {
  return ThrowsMessage<InputError>(AllOf(StartsWith("materials.rubber"), HasSubstr(part)...));
}

TEST(MaterialRegistry, TakesYoungsModulusOrOtherPairs) {
  const auto a = solids::make_material(
      "m", {.kind = "elastic", .values = {{"youngs_modulus", 210e9}, {"poisson_ratio", 0.3}}});
  const auto b = solids::make_material(
      "m", {.kind = "st_venant_kirchhoff",
            .values = {{"bulk_modulus", 175e9}, {"shear_modulus", 210e9 / 2.6}}});
  EXPECT_NEAR(a->linear().lame, b->linear().lame, 1e-4);
  EXPECT_NEAR(a->linear().shear, b->linear().shear, 1e-4);
}

TEST(MaterialRegistry, RefusesImpossibleValues) {
  EXPECT_THAT(
      make({.kind = "elastic", .values = {{"youngs_modulus", -1.0}, {"poisson_ratio", 0.3}}}),
      refused("'youngs_modulus' is -1 Pa", "positive"));
  for (const double nu : {0.5, 0.7, -1.0})
    EXPECT_THAT(
        make({.kind = "neo_hookean", .values = {{"youngs_modulus", 1.0}, {"poisson_ratio", nu}}}),
        refused("'poisson_ratio'", "between -1 and 0.5"));
  EXPECT_THAT(make({.kind = "elastic", .values = {{"lame", -1.0}, {"shear_modulus", 1.0}}}),
              refused("bulk modulus"));
  EXPECT_THAT(make({.kind = "mooney_rivlin", .values = {{"c1", 1.0}, {"c2", 1.0}, {"lame", 1.0}}}),
              refused("collapse", "at least"));
  EXPECT_THAT(make({.kind = "mooney_rivlin_uncoupled",
                    .values = {{"c1", 1.0}, {"c2", -2.0}, {"bulk_modulus", 1.0}}}),
              refused("shear modulus 2 (c1 + c2) is -2 Pa"));
}

TEST(MaterialRegistry, NamesMissingUnknownAndSuperfluousValues) {
  EXPECT_THAT(make({.kind = "elastic", .values = {}}), refused("missing", "youngs_modulus"));
  EXPECT_THAT(make({.kind = "elastic", .values = {{"youngs_modulus", 1.0}}}),
              refused("alone", "poisson_ratio"));
  EXPECT_THAT(make({.kind = "elastic",
                    .values = {{"youngs_modulus", 1.0}, {"poisson_ratio", 0.3}, {"lame", 1.0}}}),
              refused("cannot be combined"));
  EXPECT_THAT(make({.kind = "elastic", .values = {{"young_modulus", 1.0}}}),
              refused("Did you mean 'youngs_modulus'?"));
  EXPECT_THAT(make({.kind = "neo_hokean", .values = {}}), refused("Did you mean 'neo_hookean'?"));
  EXPECT_THAT(make({.kind = "mooney_rivlin", .values = {{"bulk_modulus", 1.0}}}),
              refused("'c1' is missing"));
  EXPECT_THAT(make({.kind = "elastic",
                    .values = {{"youngs_modulus", 1.0}, {"poisson_ratio", 0.3}},
                    .fibres = {{.law = "exponentail", .values = {}}}}),
              refused("Did you mean 'exponential'?"));
}

TEST(MaterialRegistry, RefusesImpossibleTermsOfRelaxation) {
  const auto with = [](const std::vector<solids::Relaxation>& terms, double rest = 1.0) {
    return solids::MaterialDescription{.kind = "neo_hookean",
                                       .values = {{"youngs_modulus", 1e6}, {"poisson_ratio", 0.3}},
                                       .relaxation = terms,
                                       .long_term_ratio = rest};
  };
  const auto m = solids::make_material("m", with({{0.5, 1.0}, {2.0, 1e-3}}, 0.0));
  EXPECT_EQ(m->relaxation().size(), 2u);
  EXPECT_EQ(m->long_term_ratio(), 0.0);
  EXPECT_NO_THROW(
      solids::make_material("m", with(std::vector<solids::Relaxation>(12, {0.1, 1.0}))));
  EXPECT_THAT(make(with(std::vector<solids::Relaxation>(13, {0.1, 1.0}))),
              refused("13 terms, and at most 12"));
  EXPECT_THAT(make(with({{0.5, 1.0}, {0.5, 0.0}})), refused("relaxation.1", "'time' is 0"));
  EXPECT_THAT(make(with({{-0.5, 1.0}})), refused("'modulus_ratio' is -0.5"));
  EXPECT_THAT(make(with({{0.5, 1.0}}, -0.1)), refused("'long_term_ratio' is -0.1"));
  EXPECT_THAT(make(with({}, 0.5)), refused("without 'relaxation'"));
}

TEST(MaterialRegistry, TakesViscosityAsATimeOrAsModuli) {
  const solids::ParameterValues values = {{"youngs_modulus", 2.6}, {"poisson_ratio", 0.3}};
  const auto m =
      solids::make_material("m", {.kind = "neo_hookean", .values = values, .relaxation_time = 2.0});
  EXPECT_DOUBLE_EQ(m->viscous_moduli().shear, 2.0 * m->linear().shear);
  EXPECT_DOUBLE_EQ(m->viscous_moduli().lame, 2.0 * m->linear().lame);
  const auto u = solids::make_material("m", {.kind = "mooney_rivlin_uncoupled",
                                             .values = {{"c1", 1.0}, {"bulk_modulus", 1e4}},
                                             .relaxation_time = 0.1});
  EXPECT_NEAR(u->viscous_moduli().lame + 2.0 / 3.0 * u->viscous_moduli().shear, 0.0, 1e-16);
  EXPECT_THAT(make({.kind = "neo_hookean", .values = values, .relaxation_time = -1.0}),
              refused("relaxation_time"));
  EXPECT_THAT(make({.kind = "neo_hookean", .values = values, .viscous = {-1.0, 1.0}}),
              refused("create energy"));
  EXPECT_THAT(
      make(
          {.kind = "neo_hookean", .values = values, .relaxation_time = 1.0, .viscous = {1.0, 1.0}}),
      refused("one or the other"));
}

}  // namespace
}  // namespace polhode::registry_tests
