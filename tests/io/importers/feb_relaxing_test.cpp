// SPDX-License-Identifier: Apache-2.0
// Viscoelastic materials of FEBio's files: their terms, and stresses by the recursion of FEBio's
// user manual, written here for one component.
#include <array>
#include <cmath>

#include <gmock/gmock.h>

#include <polhode/simulation/simulation_details.hpp>

#include <io/importers/feb_fixture.hpp>

namespace polhode::feb_tests {
namespace {

using testing::HasSubstr;

class FebRelaxing : public FebFixture {
 protected:
  /// A unit cube whose face x = 1 is moved within one second and then held; the others slide.
  static std::string cube(const std::string& type, const std::string& inside) {
    const auto face = [](const std::string& name, const std::string& nodes) {
      return tag("NodeSet", nodes, "name='" + name + "'");
    };
    const auto held = [](const std::string& set, const std::string& along) {
      return tag("bc", tag(along + "_dof", "1"),
                 "type='zero displacement' node_set='" + set + "' name='" + set + "_0'");
    };
    return feb(
        control("STATIC", 30, 0.1) +
        tag("Material", tag("material", inside, "id='1' name='m' type='" + type + "'")) +
        tag("Mesh", block(1, "part", Vec3::Zero(), Vec3::Ones()) + face("low", "1,4,5,8") +
                        face("high", "2,3,6,7") + face("all", "1:8")) +
        tag("MeshDomains", domain("part", "m")) +
        tag("Boundary", held("low", "x") +
                            tag("bc", tag("y_dof", "1") + tag("z_dof", "1"),
                                "type='zero displacement' node_set='all' name='sides'") +
                            tag("bc", tag("dof", "x") + tag("value", "0.3", "lc='1'"),
                                "type='prescribed displacement' node_set='high' name='pull'")) +
        tag("LoadData", curve(1, "0,0;1,1;3,1")));
  }
};

const std::string kElasticPart =
    "<elastic type='neo-Hookean'><density>5</density><E>1e4</E><v>0.3</v></elastic>";
const std::string kPronyTerms = "<t1>0.25</t1><g1>0.8</g1><g2>0</g2><t3>4</t3><g3>0.5</g3>";

// Along the stretch λ, sides held: S = μ (1 − λ⁻²) + Λ ln λ λ⁻² of FEBio's neo-Hookean material.
TEST_F(FebRelaxing, HasTheStressesOfItsRecursion) {
  for (const double rest : {1.0, 0.4}) {
    const std::string inside =
        "<density>1</density><g0>" + format("{}", rest) + "</g0>" + kPronyTerms;
    Simulation s(read(cube("viscoelastic", inside + kElasticPart)));
    const double mu = 1e4 / 2.6, lame = 1e4 * 0.3 / (1.3 * 0.4);
    const auto elastic = [&](double l) {
      return mu * (1.0 - 1.0 / (l * l)) + lame * std::log(l) / (l * l);
    };
    std::array<double, 2> H{};
    const std::array<double, 2> g{0.8, 0.5}, tau{0.25, 4.0};
    double before = 0.0, t = 0.0;
    int checked = 0;
    const RunSummary run = s.run({}, [&](Simulation& now) {
      if (now.time() == 0.0) return;
      const double dt = now.time() - t, l = 1.0 + 0.3 * std::min(now.time(), 1.0);
      EXPECT_NEAR(dt, 0.1, 1e-12);
      t = now.time();
      const double here = elastic(l);
      double S = rest * here;
      for (std::size_t k = 0; k < 2; ++k) {
        const double decay = std::exp(-dt / tau[k]);
        H[k] = decay * H[k] + (here - before) * (1.0 - decay) / (dt / tau[k]);
        S += g[k] * H[k];
      }
      before = here;
      const int pull = static_cast<int>(now.model().solids[0].prescribed.size()) - 1;
      EXPECT_NEAR(now.interface_reaction(0, pull).force.x() / (l * S), 1.0, 1e-9) << t;
      ++checked;
    });
    EXPECT_EQ(run.end, RunEnd::finished) << run.message;
    EXPECT_EQ(checked, 30);
  }
}

TEST_F(FebRelaxing, BecomesAMaterialWithTheseTerms) {
  const Model coupled =
      read(cube("viscoelastic", "<density>900</density>" + kPronyTerms + kElasticPart));
  ASSERT_EQ(coupled.materials.size(), 1u);
  const MaterialSpec& m = coupled.materials[0];
  EXPECT_EQ(m.type, "neo_hookean");
  EXPECT_EQ(m.density, 900.0);
  EXPECT_EQ(m.long_term_ratio, 1.0);
  ASSERT_EQ(m.relaxation.size(), 2u);
  EXPECT_EQ(m.relaxation[0].modulus_ratio, 0.8);
  EXPECT_EQ(m.relaxation[0].time, 0.25);
  EXPECT_EQ(m.relaxation[1].modulus_ratio, 0.5);
  EXPECT_EQ(m.relaxation[1].time, 4.0);
  // Bulk moduli of both add up; fibres have the axes of both.
  const Model uncoupled = read(cube(
      "uncoupled viscoelastic",
      "<k>20</k><g0>0.5</g0><g1>0.3</g1><mat_axis type='vector'><a>0,1,0</a><d>0,0,1</d></mat_axis>"
      "<elastic type='trans iso Mooney-Rivlin'><c1>1</c1><c2>0</c2><c3>1</c3><c4>40</c4><c5>2</c5>"
      "<lam_max>1.1</lam_max><k>60</k><fiber type='vector'>1,0,0</fiber></elastic>"));
  const MaterialSpec& u = uncoupled.materials[0];
  EXPECT_EQ(u.type, "mooney_rivlin_uncoupled");
  EXPECT_EQ(u.parameters.at("bulk_modulus"), 80.0);
  EXPECT_EQ(u.long_term_ratio, 0.5);
  ASSERT_EQ(u.relaxation.size(), 1u);
  EXPECT_EQ(u.relaxation[0].time, 1.0);  // FEBio's standard
  EXPECT_EQ(u.density, 1.0);
  EXPECT_LT((u.fibres[0].direction - Vec3::UnitY()).norm(), 1e-15);
  EXPECT_EQ(uncoupled.solids[0].element, "hex8_q1p0");
  // The density of a mixture within is that of the outer material.
  const Model mixture = read(cube(
      "viscoelastic", "<density>7</density>" + kPronyTerms +
                          "<elastic type='solid mixture'><solid type='neo-Hookean'><density>900"
                          "</density><E>1</E><v>0.3</v></solid><solid type='fiber-exp-pow'>"
                          "<ksi>1</ksi><alpha>0</alpha><beta>3</beta></solid></elastic>"));
  EXPECT_EQ(mixture.materials[0].density, 7.0);
  EXPECT_EQ(mixture.materials[0].fibres.size(), 1u);
}

TEST_F(FebRelaxing, WhatCannotBeReadIsNamed) {
  const auto said = [&](const std::string& type, const std::string& inside) {
    return fault(cube(type, inside));
  };
  const std::string rubber = "<elastic type='Mooney-Rivlin'><c1>1</c1><k>9</k></elastic>";
  EXPECT_THAT(said("viscoelastic", kPronyTerms), HasSubstr("the material has no <elastic>"));
  EXPECT_THAT(said("viscoelastic", kElasticPart), HasSubstr("the material has no terms"));
  EXPECT_THAT(said("viscoelastic", kPronyTerms + rubber),
              HasSubstr("its pressure would relax, too"));
  EXPECT_THAT(said("uncoupled viscoelastic", kPronyTerms + kElasticPart),
              HasSubstr("elastic part of an uncoupled viscoelastic material is not uncoupled"));
  EXPECT_THAT(
      said("uncoupled viscoelastic",
           kPronyTerms + "<elastic type='Holzapfel-Gasser-Ogden'><c>1</c><k>9</k></elastic>"),
      HasSubstr("in an uncoupled viscoelastic material is not read"));
  EXPECT_THAT(said("viscoelastic", kPronyTerms + "<elastic type='viscoelastic'>" + kPronyTerms +
                                       kElasticPart + "</elastic>"),
              HasSubstr("a viscoelastic material within another one is not read"));
  EXPECT_THAT(said("viscoelastic", kPronyTerms + "<elastic type='wood'/>"),
              HasSubstr("of type 'wood' is not read"));
}

}  // namespace
}  // namespace polhode::feb_tests
