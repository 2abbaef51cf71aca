// SPDX-License-Identifier: Apache-2.0
// Complete models with forces given by code as functions of the motion.
#include <cmath>
#include <stdexcept>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <polhode/system/state_archive.hpp>
#include <support/convergence.hpp>

namespace polhode::test::load_functions_tests {
namespace {

constexpr double kMass = 2.0, kStiffness = 50.0, kDamping = 3.0, kStart = 0.8;

/// A free body that begins at x = 0.8 m, with a force on it.
Model free_body(const std::string& step, const std::string& load = "type: force, body: it") {
  return io::read_model_text(R"(
format: 1
bodies: {it: {mass: 2, inertia: [0.1, 0.2, 0.3], position: [0.8, 0, 0]}}
loads: {push: {)" + load + R"(, force: [0, 0, 0]}}
analysis: {duration: 1.5, step: )" +
                                 step + "}\noutput: {hdf5: false}\n",
                             "free_body.yaml", {});
}

PointFunction spring(double k, double c, bool with_derivative = false) {
  PointFunction f;
  f.value = [=](const PointReading& x) -> Vec3 { return -k * x.position - c * x.velocity; };
  f.reads_velocity = c != 0.0;
  if (with_derivative)
    f.derivative = [=](const PointReading&) {
      return PointDerivative{.position = -k * Mat3::Identity(), .velocity = -c * Mat3::Identity()};
    };
  return f;
}

double end_of(Model model) {
  Simulation s(std::move(model));
  const RunSummary summary = s.run();
  EXPECT_EQ(summary.end, RunEnd::finished) << summary.message;
  return s.body("it").r.x();
}

double damped_oscillator(double t) {
  const double d = kDamping / (2.0 * kMass), w = std::sqrt(kStiffness / kMass - d * d);
  return kStart * std::exp(-d * t) * (std::cos(w * t) + d / w * std::sin(w * t));
}

}  // namespace

TEST(LoadFunctions, SpringAndDamperFollowTheClosedFormAtOrderTwo) {
  for (const bool with_derivative : {false, true})
    expect_order(
        [&](int steps) {
          Model model = free_body(std::to_string(1.5 / steps));
          model.loads[0].of_motion = spring(kStiffness, kDamping, with_derivative);
          return std::abs(end_of(model) - damped_oscillator(1.5));
        },
        {30, 150, 1500, 15000}, 2.0, 0.05);
}

TEST(LoadFunctions, WithoutVelocityCanBeUsedAtOrderFour) {
  const double w = std::sqrt(kStiffness / kMass);
  expect_order(
      [&](int steps) {
        Model model = free_body(std::to_string(1.5 / steps));
        model.analysis.order = 4;
        model.loads[0].of_motion = spring(kStiffness, 0.0);
        return std::abs(end_of(model) - kStart * std::cos(1.5 * w));
      },
      {50, 100, 200}, 4.0, 0.15);
  Model damped = free_body("0.01");
  damped.analysis.order = 4;
  damped.loads[0].of_motion = spring(kStiffness, kDamping);
  EXPECT_EQ(Simulation(damped).summary().scheme, "order 4 by extrapolation");
  damped.analysis.method = "composition";
  EXPECT_THROW(Simulation{damped}, InputError);
}

TEST(LoadFunctions, LinearSpringKeepsItsEnergyAtAnyStep) {
  for (const char* step : {"0.1", "0.01", "0.001"}) {
    Model model = free_body(step);
    model.loads[0].of_motion = spring(kStiffness, 0.0);
    Simulation s(std::move(model));
    s.run();
    const double x = s.body("it").r.x(), start = 0.5 * kStiffness * kStart * kStart;
    EXPECT_NEAR(s.balance().kinetic + 0.5 * kStiffness * x * x, start, 1e-11 * start) << step;
    EXPECT_NEAR(s.balance().put_in, s.balance().kinetic, 1e-11 * start) << step;
  }
}

// A spring of the engine and the same one from code, in a joint and between two points.
TEST(LoadFunctions, AgreeWithSpringsOfTheEngine) {
  const std::string text = R"(
format: 1
gravity: [0, 0, -9.81]
bodies:
  arm: {mass: 2, inertia: [0.1, 0.2, 0.3], position: [0.5, 0, 0], angular_velocity: [0, 6, 0]}
  bob: {point_mass: true, mass: 1, position: [1.4, 0.1, 0.2]}
joints: {hinge: {type: revolute, bodies: [ground, arm], at: [0, 0, 0], axis: y}}
loads:
  twist: TWIST
  pull: PULL
analysis: {duration: 1, step: 2 ms}
output: {hdf5: false}
)";
  const auto with = [&](std::string twist, std::string pull) {
    std::string t = text;
    t.replace(t.find("TWIST"), 5, twist);
    t.replace(t.find("PULL"), 4, pull);
    return io::read_model_text(t, "two.yaml", {});
  };
  Simulation engine(
      with("{type: torsional_spring, joint: hinge, stiffness: 7, damping: 0.3}",
           "{type: spring_damper, bodies: [arm, bob], at: [[1, 0, 0], [1.4, 0.1, 0.2]], "
           "stiffness: 40, damping: 0.5, free_length: 0.4}"));
  Model model = with("{type: rotary_motor, joint: hinge, moment: 0}",
                     "{type: axial_force, bodies: [arm, bob], at: [[1, 0, 0], [1.4, 0.1, 0.2]], "
                     "pull: 0}");
  model.loads[0].of_motion = CoordinateFunction{
      [](const CoordinateReading& q) { return -7.0 * q.value - 0.3 * q.rate; }, {}, true};
  model.loads[1].of_motion = CoordinateFunction{
      [](const CoordinateReading& l) { return 40.0 * (l.value - 0.4) + 0.5 * l.rate; }, {}, true};
  Simulation code(std::move(model));
  EXPECT_EQ(engine.run().end, RunEnd::finished);
  const RunSummary summary = code.run();
  EXPECT_EQ(summary.end, RunEnd::finished);
  EXPECT_LT(summary.energy_drift, 1e-11);  // the work of the functions is in the energy balance
  EXPECT_GT(std::abs(engine.joint("hinge").coordinates[0]), 0.1);
  EXPECT_NEAR(engine.joint("hinge").coordinates[0], code.joint("hinge").coordinates[0], 1e-9);
  EXPECT_LT((engine.body("bob").r - code.body("bob").r).norm(), 1e-9);
  EXPECT_NEAR(engine.load("twist")[1], code.load("twist")[1], 1e-8);  // moment about y
  EXPECT_NEAR(engine.load("pull")[0], code.load("pull")[0], 1e-7);
}

TEST(LoadFunctions, ContinueBitForBitFromASavedState) {
  const auto model = [] {
    Model m = free_body("0.01");
    m.loads[0].of_motion = spring(kStiffness, kDamping);
    return m;
  };
  Simulation first(model());
  while (first.time() < 0.7) first.step(1.5);
  const std::string bytes = state_bytes(first.system(), first.state());
  Simulation second(model(), state_from_bytes(first.system(), bytes, "state"));
  while (first.time() < 1.5 - 1e-9) first.step(1.5);
  while (second.time() < 1.5 - 1e-9) second.step(1.5);
  EXPECT_EQ(first.state_hash(), second.state_hash());
}

TEST(LoadFunctions, ThatThrowLeaveTheSimulationUnchanged) {
  Model model = free_body("0.01");
  bool fail = false;
  PointFunction f = spring(kStiffness, 0.0);
  f.value = [&fail, value = f.value](const PointReading& x) -> Vec3 {
    if (fail) throw std::runtime_error("no force today");
    return value(x);
  };
  model.loads[0].of_motion = f;
  Simulation s(std::move(model));
  for (int i = 0; i < 5; ++i) s.step(1.5);
  const std::string before = s.state_hash();
  fail = true;
  EXPECT_THROW(s.step(1.5), std::runtime_error);
  EXPECT_EQ(s.state_hash(), before);
  fail = false;
  EXPECT_TRUE(s.step(1.5).accepted);
  EXPECT_NEAR(s.time(), 0.06, 1e-12);
}

TEST(LoadFunctions, HoldAWeightInStatics) {
  Model model = io::read_model_text(R"(
format: 1
gravity: [0, 0, -10]
bodies: {it: {mass: 2, inertia: [1, 1, 1]}}
joints: {rail: {type: prismatic, bodies: [ground, it], at: [0, 0, 0], axis: z}}
loads: {hold: {type: linear_motor, joint: rail, force: 0}}
analysis: {type: statics}
output: {hdf5: false}
)",
                                    "hold.yaml", {});
  model.loads[0].of_motion = CoordinateFunction{
      [](const CoordinateReading& z) { return -100.0 * z.value - 1e3 * std::pow(z.value, 3); },
      {},
      false};
  Simulation s(std::move(model));
  EXPECT_EQ(s.run().end, RunEnd::finished);
  const double z = s.body("it").r.z();
  EXPECT_NEAR(-100.0 * z - 1e3 * z * z * z, 20.0, 1e-8);
}

TEST(LoadFunctions, AreRefusedWhereTheyHaveNoMeaning) {
  const auto message = [](Model model) -> std::string {
    try {
      Simulation s(std::move(model));
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  const CoordinateFunction scalar{[](const CoordinateReading&) { return 0.0; }, {}, true};
  Model model = free_body("0.01");
  model.loads[0].of_motion = scalar;
  EXPECT_EQ(message(model),
            "loads.push.force: is a function of a coordinate. Give one of the motion of the point "
            "(PointFunction).");
  model.loads[0].of_motion = PointFunction{};
  EXPECT_EQ(message(model), "loads.push.force: is a function without a value. Set its value.");
  model = io::read_model_text(R"(
format: 1
bodies: {it: {mass: 2, inertia: [1, 1, 1]}}
joints: {hinge: {type: revolute, bodies: [ground, it], at: [0, 0, 0], axis: y}}
loads: {turn: {type: rotary_motor, joint: hinge, angle: 0}, brake: {type: drag, body: it, linear: 1}}
)",
                              "refused.yaml", {});
  model.loads[0].of_motion = scalar;
  EXPECT_EQ(
      message(model),
      "loads.turn.angle: is prescribed, so the moment cannot be given too. Give one of them.");
  model.loads[0].of_motion = {};
  model.loads[1].of_motion = spring(1.0, 0.0);
  EXPECT_EQ(message(model),
            "loads.brake: a 'drag' cannot be a function of the motion. Use a force, moment, "
            "axial_force, rotary_motor or linear_motor.");
}

// Output times are multiples of the interval also where a function jumps; values are those after
// it.
TEST(LoadFunctions, OutputAtAJumpHasTheValuesAfterIt) {
  for (const char* steps : {"tolerance: 1e-6", "tolerance: 1e-6, order: 2", "step: 10 ms"}) {
    Model model = io::read_model_text(format(R"yaml(
format: 1
bodies: {{it: {{mass: 2, inertia: [1, 1, 1]}}}}
loads: {{push: {{type: force, body: it, force: ["3*step(t, 0.5)", 0, 0]}}}}
analysis: {{duration: 1, {}}}
output: {{every: 0.1, hdf5: false, probes: {{it: {{body: it}}}}}}
)yaml",
                                             steps),
                                      "jump.yaml", {});
    Simulation simulation(std::move(model));
    int frames = 0;
    simulation.run([&](const Simulation& s) {
      const double t = 0.1 * frames++;
      EXPECT_NEAR(s.time(), t, 1e-15) << steps;
      EXPECT_NEAR(s.probe("it")[7], t < 0.45 ? 0.0 : 1.5, 1e-12) << steps << " " << t;
    });
    EXPECT_EQ(frames, 11) << steps;
  }
}

// Probes of the model's output by name.
TEST(LoadFunctions, ProbesAreReadByName) {
  Model model = io::read_model_text(R"(
format: 1
bodies: {it: {mass: 2, inertia: [1, 1, 1], position: [1, 0, 0], velocity: [0, 3, 0]}}
analysis: {duration: 1, step: 10 ms}
output: {hdf5: false, probes: {corner: {body: it, point: [0, 0, 0.5]}}}
)",
                                    "probe.yaml", {});
  Simulation s(std::move(model));
  s.run();
  const std::vector<std::string> columns = s.probe_columns("corner");
  const std::vector<double> row = s.probe("corner");
  ASSERT_EQ(columns.size(), row.size());
  EXPECT_EQ(columns.front(), "t [s]");
  EXPECT_EQ(columns[2], "y [m]");
  EXPECT_NEAR(row[0], 1.0, 1e-12);
  EXPECT_NEAR(row[2], 3.0, 1e-12);
  EXPECT_NEAR(row[3], 0.5, 1e-12);
  EXPECT_NEAR(row[5], 3.0, 1e-12);
  try {
    (void)s.probe("cormer");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_STREQ(e.what(),
                 "probes: unknown probe 'cormer'. Did you mean 'corner'? Use one of: corner.");
  }
}

}  // namespace polhode::test::load_functions_tests
