// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <polhode/compile/nonsmooth_contacts.hpp>
#include <polhode/contact/contact_set.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::nonsmooth_contacts_tests {
namespace {

Model model_of(const std::string& more) {
  return io::read_model_text("format: 1\ngravity: [0, 0, -10]\n" + more, "m.yaml");
}

const char* kBodies = R"(
bodies:
  floor: {fixed: true, shape: {plane: z}}
  a: {shape: {sphere: 0.2}, mass: 2, position: [0, 0, 0.1], velocity: [1, 0, 0]}
  b: {shape: {box: [0.2, 0.2, 0.2]}, mass: 1, position: [3, 0, 1]}
)";

TEST(NonsmoothContacts, TakeTheirOptionsFromTheFile) {
  const Model plain = model_of(std::string(kBodies) + R"(
contacts: {default: {law: nonsmooth}}
analysis: {duration: 1 s, step: 10 ms}
)");
  EXPECT_EQ(impulse_options(plain.contacts).sweeps, ImpulseOptions().sweeps);
  EXPECT_EQ(impulse_options(plain.contacts).tolerance, ImpulseOptions().tolerance);
  const Simulation run(model_of(std::string(kBodies) + R"(
contacts: {default: {law: nonsmooth}, sweeps: 7, sweep_tolerance: 1e-5}
analysis: {duration: 1 s, step: 10 ms}
)"));
  ASSERT_TRUE(run.contact_set()->impulses());
  EXPECT_EQ(run.contact_set()->impulses()->sweeps, 7);
  EXPECT_EQ(run.contact_set()->impulses()->tolerance, 1e-5);
}

TEST(NonsmoothContacts, ReportForcesLossesAndSweeps) {
  Simulation run(model_of(std::string(kBodies) + R"(
contacts:
  default: {law: nonsmooth, friction: 0.2, restitution: 0.5}
  pairs: {drop: {between: [b, floor], restitution: 0}}
analysis: {duration: 2 s, step: 5 ms}
)"));
  const RunSummary summary = run.run();
  ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
  const ContactReport rolls = run.contact(run.contact_pair(1, 0));
  EXPECT_NEAR(rolls.normal_force, 20.0, 1e-9);
  EXPECT_NEAR(rolls.force.z(), -20.0, 1e-9);  // on the floor, which the file names first
  EXPECT_NEAR(rolls.impulse, 40.0, 1e-7);
  EXPECT_EQ(rolls.points, 1);
  EXPECT_EQ(rolls.status, 1);
  // The ball keeps 5/7 of its speed; the box loses all of its kinetic energy, 9 J.
  EXPECT_NEAR(rolls.energy_lost, 0.5 * 2.0 * 2.0 / 7.0, 1e-9);
  const ContactReport stands = run.contact(run.contact_pair(2, 0));
  EXPECT_NEAR(stands.normal_force, 10.0, 1e-4);
  EXPECT_EQ(stands.points, 4);
  EXPECT_NEAR(stands.energy_lost, 9.0, 1e-3);
  EXPECT_NEAR(run.body(2).r.z(), 0.1, 1e-6);
  ASSERT_TRUE(summary.contacts && summary.contacts->sweeps);
  EXPECT_GE(summary.contacts->sweeps->first, 2.0);
  EXPECT_LT(summary.contacts->sweeps->first, 100.0);
  EXPECT_LT(summary.contacts->sweeps->second, 20);
  EXPECT_LT(std::abs(summary.contacts->numerical), 1e-6);
  EXPECT_LT(summary.linear_momentum_drift, 1e-12);
  EXPECT_LT(summary.angular_momentum_drift, 1e-12);
}

/// Smallest gap of a run, reported after a restart although it occurred before.
TEST(NonsmoothContacts, ReportTheSmallestGapAcrossARestart) {
  const auto model = [](const char* duration) {
    return model_of(std::string(kBodies) + R"(
contacts: {default: {restitution: 1}}
analysis: {step: 2 ms, duration: )" +
                    duration + "}\n");
  };
  Simulation whole(model("0.6 s")), first(model("0.5 s"));
  ASSERT_EQ(whole.run().end, RunEnd::finished);
  ASSERT_EQ(first.run().end, RunEnd::finished);
  const double least = whole.summary().contacts->least_gap;
  EXPECT_LT(least, 0.0);
  EXPECT_EQ(first.summary().contacts->least_gap, least);
  Simulation second(model("0.6 s"), first.state());
  ASSERT_EQ(second.run().end, RunEnd::finished);
  EXPECT_EQ(second.summary().contacts->least_gap, least);
}

TEST(NonsmoothContacts, WarnOfStepsThatDidNotConverge) {
  // More points than Newton's method continues with.
  std::string boxes = "\nbodies:\n  floor: {fixed: true, shape: {plane: z}}\n";
  for (int k = 0; k < 15; ++k)
    boxes += format("  b{}: {{shape: {{box: [0.2, 0.2, 0.2]}}, mass: 1, position: [{}, 0, 0.1]}}\n",
                    k, k);
  Simulation run(model_of(boxes + R"(
contacts: {default: {law: nonsmooth, rolling_friction: 1 mm}, sweeps: 1}
analysis: {duration: 20 ms, step: 5 ms}
)"));
  const RunSummary summary = run.run();
  ASSERT_EQ(summary.end, RunEnd::finished);
  ASSERT_EQ(summary.warnings.size(), 1u);
  EXPECT_NE(summary.warnings[0].find("Raise contacts.sweeps"), std::string::npos);
}

/// Forces, a spring with a damper between two bodies and one to the ground: without contact the
/// step equals that of the other engines.
TEST(NonsmoothContacts, MoveBodiesUnderLoadsAsOtherLawsDo) {
  const auto run = [](const char* law) {
    Simulation s(model_of(std::string(R"yaml(
bodies:
  a: {shape: {box: [0.2, 0.3, 0.4]}, mass: 2, position: [0, 0, 0.1], angular_velocity: [3, 1, -2]}
  b: {shape: {box: [0.2, 0.1, 0.2]}, mass: 1, position: [1, 0, 1]}
loads:
  between: {type: spring_damper, bodies: [a, b], at: [[0.1, 0, 0.1], [1, 0.05, 1]], stiffness: 200 N/m, damping: 2 N s/m}
  above: {type: spring_damper, bodies: [ground, b], at: [[1, 0, 3], [1, 0, 1.1]], stiffness: 100 N/m}
  pull: {type: force, body: a, force: [1, 2, "20 + 3*sin(5*t)"], at: [0.1, 0.1, 0.1]}
contacts: {default: {law: )yaml") +
                          law + R"yaml(}, exclude: [[a, b]]}
analysis: {duration: 1 s, step: 5 ms}
)yaml"));
    EXPECT_EQ(s.run().end, RunEnd::finished);
    return std::pair(s.body(0), s.body(1));
  };
  const auto impulses = run("nonsmooth"), forces = run("barrier");
  EXPECT_LT((impulses.first.r - forces.first.r).norm(), 1e-10);
  EXPECT_LT((impulses.second.r - forces.second.r).norm(), 1e-10);
  EXPECT_LT((impulses.first.W - forces.first.W).norm(), 1e-9);
  EXPECT_LT((impulses.second.v - forces.second.v).norm(), 1e-9);
}

}  // namespace
}  // namespace polhode::nonsmooth_contacts_tests
