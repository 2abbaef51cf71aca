// SPDX-License-Identifier: Apache-2.0
// A run judges its own balances and constraints, and says nothing where they hold.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <polhode/simulation/trust.hpp>

namespace polhode::trust_tests {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

RunSummary run(const std::string& text, const io::Overrides& overrides = {}) {
  Simulation s(io::read_model_text(text, "trust.yaml", overrides));
  const RunSummary r = s.run();
  EXPECT_EQ(r.end, RunEnd::finished) << r.message;
  return r;
}

// A stiff spring whose oscillation a coarse step with rho_inf = 0 damps away: numerical
// dissipation is of second order in the step.
constexpr const char* kStiff = R"(
format: 1
bodies: {a: {mass: 1, inertia: [1, 1, 1], position: [1.1, 0, 0]}}
joints: {guide: {type: prismatic, bodies: [ground, a], at: [0, 0, 0], axis: x}}
loads: {s: {type: spring_damper, bodies: [ground, a], at: [[0, 0, 0], [1.1, 0, 0]], stiffness: 1000, free_length: 1}}
analysis: {duration: 0.5 s, step: 20 ms, rho_inf: 0}
output: {hdf5: false}
)";

// @tests{trust}
TEST(Trust, IsLostToNumericalDissipationAndComesBackWithTheStep) {
  const RunSummary coarse = run(kStiff);
  EXPECT_FALSE(coarse.trusted());
  EXPECT_GT(coarse.energy_drift, 1e-3);
  EXPECT_THAT(coarse.distrust, Contains(AllOf(HasSubstr("the balance of energy does not close"),
                                              HasSubstr("rho_inf: 1, which does not dissipate"))));
  EXPECT_THAT(coarse.warnings, Contains(HasSubstr("not trusted: the balance of energy")));
  const RunSummary fine = run(kStiff, {"analysis.step=0.2 ms"});
  EXPECT_LT(fine.energy_drift, 1e-3);
  EXPECT_TRUE(fine.trusted()) << fine.distrust.front();
  for (const char* step : {"20 ms", "2 ms", "0.2 ms"}) {
    const std::string setting = std::string("analysis.step=") + step;
    const RunSummary exact = run(kStiff, {"analysis.rho_inf=1", setting});
    EXPECT_TRUE(exact.trusted()) << step << ": " << exact.distrust.front();
  }
}

TEST(Trust, AllowsAnExactMethodRoundOffAndOthersErrorsOfSecondOrder) {
  Model model = io::read_model_text(kStiff, "trust.yaml", {"analysis.rho_inf=1"});
  const double exact = allowed_drift(model);
  model.analysis.conserving = false;
  EXPECT_GT(allowed_drift(model), exact);
  model.analysis.conserving = true;
  model.analysis.rho_inf = 0.9;
  EXPECT_GT(allowed_drift(model), exact);
}

TEST(Trust, IsLostToABalanceThatIsNotANumber) {
  for (const char* step : {"20 ms", "2 ms", "0.2 ms"}) {
    const io::Overrides overrides = {"analysis.rho_inf=1", std::string("analysis.step=") + step};
    const Model model = io::read_model_text(kStiff, "trust.yaml", overrides);
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
      State state = Simulation(model).state();
      state.ledger.dissipated.add(bad);
      Simulation energy(model, state);
      EXPECT_THAT(energy.run().distrust, Contains(HasSubstr("the balance of energy"))) << step;
      state = Simulation(model).state();
      state.ledger.impulse[1].add(bad);
      Simulation momentum(model, state);
      EXPECT_THAT(momentum.run().distrust, Contains(HasSubstr("linear momentum"))) << step;
    }
  }
}

TEST(Trust, NamesEachBalanceAndConstraint) {
  const Simulation s(io::read_model_text(kStiff, "trust.yaml", {"analysis.rho_inf=1"}));
  Ledger ledger;
  ledger.energy_scale = ledger.p_scale = ledger.l_scale = 1.0;
  EXPECT_THAT(reasons_for_distrust(s.model(), s.system(), ledger), IsEmpty());
  const double allowed = allowed_drift(s.model());
  ledger.energy_drift = ledger.p_drift = ledger.l_drift = allowed;
  EXPECT_THAT(reasons_for_distrust(s.model(), s.system(), ledger), IsEmpty());
  ledger.p_drift = ledger.l_drift = 1.01 * allowed;
  ledger.constraint_max = 1e-3;
  EXPECT_THAT(reasons_for_distrust(s.model(), s.system(), ledger),
              testing::ElementsAre(HasSubstr("linear momentum"), HasSubstr("angular momentum"),
                                   HasSubstr("joints or drives do not hold")));
}

TEST(Trust, ImpactsThatWereNotSolvedAreNamed) {
  const Simulation s(io::read_model_text(kStiff, "trust.yaml", {"analysis.rho_inf=1"}));
  Ledger ledger;
  ledger.impacts = {.steps = 3, .largest = 0.02, .time = 0.125, .a = 0, .b = kGround};
  EXPECT_THAT(
      reasons_for_distrust(s.model(), s.system(), ledger),
      testing::ElementsAre("impacts do not meet their law in 3 steps: velocities differ from "
                           "it by up to 0.02 m/s, where 'a' meets the ground at t = 0.125 s. "
                           "Take shorter steps"));
}

TEST(Trust, UnsolvedImpactsOfSolidsAreNamedByTheirContact) {
  const Simulation s(io::read_model_text(R"(
format: 1
materials: {s: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}}
solids:
  u: {mesh: {block: {size: [1, 1, 1], cells: [1, 1, 1]}, position: [0, 0, 1.6]}, element: hex8, material: s, contact: {surface: zmin}}
  l: {mesh: {block: {size: [1, 1, 1], cells: [1, 1, 1]}, position: [0, 0, 0.5]}, element: hex8, material: s, bonded: {ground: zmin}, contact: {surface: zmax}}
contacts: {}
analysis: {duration: 1, step: 1}
)",
                                         "solids.yaml"));
  Ledger ledger;
  const int groups = s.system().nodes().group_count();
  int contact = 0;
  while (contact < groups && !s.system().nodes().group(contact).surface_impacts()) ++contact;
  ASSERT_LT(contact, groups);
  ledger.impacts = {.steps = 1, .largest = 0.02, .time = 0.125, .group = contact};
  EXPECT_THAT(reasons_for_distrust(s.model(), s.system(), ledger),
              testing::ElementsAre("impacts do not meet their law in 1 steps: velocities differ "
                                   "from it by up to 0.02 m/s, in the contact 'u on l' at "
                                   "t = 0.125 s. Take shorter steps"));
}

bool warns_of(const RunSummary& r, const std::string& part) {
  return std::any_of(r.warnings.begin(), r.warnings.end(),
                     [&](const std::string& w) { return w.find(part) != std::string::npos; });
}

// A weight that falls onto a stop: many iterations in the barrier's small band, but exact ones.
constexpr const char* kStop = R"(
format: 1
gravity: [0, 0, -9.81]
bodies: {a: {mass: 2, inertia: [1, 1, 1], position: [0, 0, 1]}}
joints: {g: {type: prismatic, bodies: [ground, a], at: [0, 0, 1], axis: z, limits: {lower: -0.5, restitution: 0.5}}}
analysis: {duration: 1 s, step: 5 ms}
output: {hdf5: false}
)";

TEST(Trust, ManyIterationsInTheImpactOfAStopAreNoFailure) {
  for (const char* step : {"20 ms", "5 ms", "0.05 ms"}) {
    const RunSummary r = run(kStop, {std::string("analysis.step=") + step});
    EXPECT_FALSE(warns_of(r, "only just converged")) << step;
    EXPECT_LT(r.energy_drift, 1e-10) << step;
  }
}

// A joint at any angle, whose gap of rounding is closed by velocities of rounding; and the same
// joint in slow motion, whose balance is judged all the same.
TEST(Trust, ABodyAtRestInAJointIsTrusted) {
  for (const double angle : {0.3, 1.0, 200.0 * 3.14159265358979 / 180.0, 4.0, 5.5})
    for (const char* step : {"10 ms", "1 ms", "0.01 ms"})
      for (const double speed : {0.0, 1e-4}) {
        const RunSummary r = run(
            "format: 1\nbodies: {a: {mass: 1, inertia: [0.02, 0.03, 0.02], orientation: {axis: z, "
            "angle: " +
                std::to_string(angle) + " rad}}}\n" +
                "joints: {A: {type: revolute, bodies: [ground, a], at_body: [[0, 0, 0], [-0.5, 0, "
                "0]], axis_body: [z, z], x_axis_body: [x, x], start_rate: " +
                std::to_string(speed) + "}}\nanalysis: {duration: 10 ms, step: 1 ms}\n",
            {std::string("analysis.step=") + step});
        EXPECT_TRUE(r.trusted()) << angle << ' ' << step << ' ' << speed << r.distrust.front();
        EXPECT_LT(r.energy_drift, 1e-6);
      }
}

// A bar on a hub that turns steadily: the hub's centre is at rest, its rim and the bar are not.
constexpr const char* kHub = R"(
format: 1
variables: {spin: 2}
bodies: {hub: {mass: 1000, inertia: [1e6, 1e6, 1e6], angular_velocity: [0, 0, spin]}}
materials: {m: {type: elastic, youngs_modulus: 1e7, poisson_ratio: 0, density: 1000, viscosity: {relaxation_time: 0.1}}}
solids: {bar: {mesh: {block: {size: [1, 0.1, 0.1], cells: [4, 1, 1]}, position: [0.7, 0, 0]}, material: m, bonded: {hub: xmin}}}
joints: {axle: {type: revolute, bodies: [ground, hub], at: [0, 0, 0], axis: z}}
analysis: {duration: 50 ms, step: 5 ms}
output: {hdf5: false}
)";

// A door that hangs at rest far from the origin, where rounding of positions is largest.
constexpr const char* kDoor = R"(
format: 1
gravity: [0, 0, -9.81]
bodies: {door: {mass: 20, inertia: [1, 1, 1], position: [300, 0, 0]}}
joints:
  low: {type: revolute, bodies: [ground, door], at: [299.5, 0, -0.5], axis: z}
  high: {type: revolute, bodies: [ground, door], at: [299.5, 0, 0.5], axis: z}
analysis: {duration: 50 ms, step: 5 ms}
output: {hdf5: false}
)";

// Round-off over round-off is no violation. @tests{velocity-noise}
TEST(Trust, VelocitiesOfBodiesAtRestViolateNothing) {
  for (const char* model : {kHub, kDoor})
    for (const char* step : {"50 ms", "5 ms", "0.05 ms"}) {
      const RunSummary r = run(model, {std::string("analysis.step=") + step});
      EXPECT_FALSE(warns_of(r, "velocities violate")) << step << ": " << r.warnings.front();
      EXPECT_TRUE(r.trusted()) << step;
    }
}

// A rotor that a motor turns by 1 rad a step, off its centre: positions are exact, (cos, sin) of
// the angle.
constexpr const char* kRotor = R"(
format: 1
variables: {load: 0}
bodies:
  rotor: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [0.5, 0, 0]}
joints: {axle: {type: revolute, bodies: [ground, rotor], at: [0, 0, 0], axis: z}}
loads: {motor: {type: rotary_motor, joint: axle, angle: "100*t"}}
analysis: {duration: 0.5 s, step: 10 ms}
output: {hdf5: false}
)";

// @tests{step-error-projected}
TEST(Trust, DrivenMotionIsExactAtAnyStep) {
  for (const char* step : {"10 ms", "1 ms", "0.1 ms"}) {
    Simulation s(io::read_model_text(kRotor, "rotor.yaml", {std::string("analysis.step=") + step}));
    const RunSummary r = s.run();
    ASSERT_EQ(r.end, RunEnd::finished) << r.message;
    const Vec3 at = s.body(0).r;
    EXPECT_NEAR(at[0], 0.5 * std::cos(50.0), 1e-12) << step;
    EXPECT_NEAR(at[1], 0.5 * std::sin(50.0), 1e-12) << step;
    EXPECT_FALSE(warns_of(r, "too long for the motion")) << step << ": " << r.warnings.front();
  }
}

// The same rotor without its motor spins as freely as a top: its phase is late by the step's third
// power, and the warning is right.
TEST(Trust, FreeMotionThatAStepDoesNotResolveIsReported) {
  const std::string text = kRotor;
  std::string free = text;
  free.erase(free.find("loads:"), free.find("analysis:") - free.find("loads:"));
  free.replace(free.find("position: [0.5, 0, 0]"), 21,
               "position: [0.5, 0, 0], velocity: [0, 50, 0], angular_velocity: [0, 0, 100]");
  EXPECT_TRUE(warns_of(run(free), "too long for the motion"));
  for (const char* step : {"analysis.step=1 ms", "analysis.step=0.1 ms"})
    EXPECT_FALSE(warns_of(run(free, {step}), "too long for the motion")) << step;
}

}  // namespace
}  // namespace polhode::trust_tests
