// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/loads/registry.hpp>

#include "contact/scene.hpp"
#include "contact/shapes_for_tests.hpp"

namespace polhode::contact_conservation_tests {
namespace {

using namespace test;

/// Two bodies connected by a spring that collide repeatedly. Without friction and with e = 1 energy
/// and both momenta are conserved, apart from the rounding of gaps where an impact is stopped
/// within a step: the fewer steps it has, the deeper it ends in the barrier. A ball against a mesh
/// needs shorter steps, since its distance is that of its centre.
struct Tie {
  int first, second;
  double step;  ///< [s]
};
constexpr int kSteps = 10000;
class Tied : public testing::TestWithParam<Tie> {};

void tie(Scene& s, int a, int b) {
  LoadDescription spring;
  spring.name = "spring";
  spring.bodies = {a, b};
  spring.values = {{"stiffness", 4.0}, {"free_length", 0.1}};
  load_kind("spring_damper").add(s.system, spring);
}

/// Takes all steps. @returns the number of impacts; −1 if a step failed.
int count_hits(Scene& s) {
  int hits = 0;
  bool touched = false;
  for (int k = 0; k < kSteps; ++k) {
    if (!s.step()) {
      ADD_FAILURE() << s.last.text();
      return -1;
    }
    double force = 0.0;
    for (const auto& r : s.contacts->reports()) force += r.normal_force;
    if (force > 0.0 && !touched) ++hits;
    touched = force > 0.0;
  }
  return hits;
}

TEST_P(Tied, BodiesKeepEnergyAndMomentaOverThousandsOfSteps) {
  const auto all = every_shape();
  const NamedShape &first = all[GetParam().first], &second = all[GetParam().second];
  Random random(11);
  Scene s(Vec3::Zero());
  BodyMotion m = at({-0.7, 0.0, 0.0}, {0.1, 0.2, 0.0});
  m.W = {0.5, -0.3, 0.4};
  const int a = s.add("a", first.shape, 1.0, {0.05, 0.06, 0.08}, m);
  m = at({0.8, 0.05, -0.05}, {-0.05, -0.1, 0.1});
  m.W = {-0.2, 0.4, 0.6};
  const int b = s.add("b", second.shape, 1.5, {0.08, 0.09, 0.1}, m);
  tie(s, a, b);
  s.law(0.0, 1.0);
  s.begin(GetParam().step);
  const int hits = count_hits(s);
  const Ledger& l = s.state.ledger;
  EXPECT_GT(hits, 5);
  EXPECT_LT(s.drift(), 1e-10 * l.energy_scale);
  EXPECT_LT(l.p_drift, 1e-10 * l.p_scale);
  EXPECT_LT(l.l_drift, 1e-10 * l.l_scale);
}

INSTANTIATE_TEST_SUITE_P(Shapes, Tied,
                         testing::Values(Tie{0, 0, 5e-3}, Tie{2, 2, 2.5e-3}, Tie{6, 6, 2.5e-3},
                                         Tie{0, 7, 1e-3}, Tie{7, 7, 1e-3}, Tie{0, 10, 1e-3},
                                         Tie{2, 1, 2.5e-3}),
                         [](const auto& tied) {
                           const auto all = every_shape();
                           return all[tied.param.first].name + "_" + all[tied.param.second].name;
                         });

/// The same with a bar of deformable solid on each body, and one of them on a joint with a third.
struct Carrying {
  int first, second;
  bool joint;
  double step;  ///< [s]
};
class TiedWithSolids : public testing::TestWithParam<Carrying> {};

TEST_P(TiedWithSolids, BodiesKeepEnergyAndMomentaOverThousandsOfSteps) {
  const auto all = every_shape();
  const NamedShape &first = all[GetParam().first], &second = all[GetParam().second];
  Scene s(Vec3::Zero());
  BodyMotion m = at({-0.7, 0.0, 0.0}, {0.1, 0.2, 0.0});
  m.W = {0.5, -0.3, 0.4};
  const int a = s.add("a", first.shape, 1.0, {0.05, 0.06, 0.08}, m);
  m = at({0.8, 0.05, -0.05}, {-0.05, -0.1, 0.1});
  if (!GetParam().joint) m.W = {-0.2, 0.4, 0.6};
  const int b = s.add("b", second.shape, 1.5, {0.08, 0.09, 0.1}, m);
  s.add_bar(a, {.from = {-0.3, 0.0, 0.3}, .cells = {1, 1, 1}, .stiffness = 1e4});
  if (GetParam().joint) {
    const int c = s.add_box("c", {0.1, 0.1, 0.1}, 0.4, at({1.5, 0.05, -0.05}, m.v));
    s.add_joint("spherical", b, c, {1.4, 0.05, -0.05});
    s.add_bar(
        c,
        {.from = {0.05, 0.0, 0.0}, .size = {0.3, 0.1, 0.1}, .cells = {1, 1, 1}, .stiffness = 1e4});
  } else {
    s.add_bar(
        b,
        {.from = {0.3, 0.0, 0.0}, .size = {0.3, 0.1, 0.1}, .cells = {1, 1, 1}, .stiffness = 1e4});
  }
  tie(s, a, b);
  s.law(0.0, 1.0);
  s.begin(GetParam().step);
  const int hits = count_hits(s);
  const Ledger& l = s.state.ledger;
  RecordProperty("energy_drift", format("{:.2e}", s.drift() / l.energy_scale));
  RecordProperty("angular_momentum_drift", format("{:.2e}", l.l_drift / l.l_scale));
  EXPECT_GT(hits, 5);
  EXPECT_LT(s.drift(), 1e-10 * l.energy_scale);
  EXPECT_LT(l.p_drift, 1e-10 * l.p_scale);
  EXPECT_LT(l.l_drift, 1e-10 * l.l_scale);
}

INSTANTIATE_TEST_SUITE_P(Shapes, TiedWithSolids,
                         testing::Values(Carrying{0, 0, false, 2.5e-3},
                                         Carrying{2, 2, true, 2.5e-3},
                                         Carrying{6, 6, false, 2.5e-3}, Carrying{0, 7, true, 1e-3}),
                         [](const auto& tied) {
                           const auto all = every_shape();
                           return all[tied.param.first].name + "_" + all[tied.param.second].name +
                                  (tied.param.joint ? "_on_joints" : "");
                         });

}  // namespace
}  // namespace polhode::contact_conservation_tests
