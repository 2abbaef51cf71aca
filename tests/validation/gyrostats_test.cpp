// SPDX-License-Identifier: Apache-2.0
// Rotors without an angle against closed forms of gyrostats: precession, spin-up, stability about
// the middle axis, a wheel as a body of its own, nutation modes, messages.
#include <cmath>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/math/quaternion.hpp>
#include <polhode/simulation/modal.hpp>
#include <support/convergence.hpp>
#include <support/run_text.hpp>

namespace polhode::gyrostat_tests {

using test::expect_fault, test::expect_order, test::finished, test::made;

constexpr double kPi = std::numbers::pi;
/// Rounding of balances over 20,000 steps.
constexpr double kRounding = 1e-12;
constexpr double kSteps[] = {0.05, 0.005, 0.0005};

/// A free body about its centre of mass with rotors.
std::string craft(const std::string& body, const std::string& rotors, double duration, double step,
                  const std::string& more = "") {
  return format(R"(
format: 1
bodies: {{craft: {{mass: 10, {}}}}}
loads: {{{}}}
analysis: {{duration: {}, step: {}{}}}
output: {{hdf5: false}}
)",
                body, rotors, duration, step, more);
}

void expect_balances(const RunSummary& r, const std::string& what) {
  EXPECT_LT(r.energy_drift, kRounding) << what;
  EXPECT_LT(r.angular_momentum_drift, kRounding) << what;
}

/// A symmetric body, inertia J_t across and J_a along z, with a wheel about z. Its axis turns about
/// the momentum L, which is constant, at |L|/J_t.
struct Symmetric {
  static constexpr double kAcross = 2.0, kAlong = 3.0, kWheel = 0.01, kTime = 10.0;
  Vec3 omega{0.3, 0.0, 0.5};
  double speed = 6000.0 * kPi / 30.0;

  [[nodiscard]] std::string text(double step, const std::string& more = "") const {
    return craft(format("inertia: [{0}, {0}, {1}], angular_velocity: [{2}, {3}, {4}]", kAcross,
                        kAlong, omega.x(), omega.y(), omega.z()),
                 format("wheel: {{type: rotor, body: craft, axis: z, inertia: {}, moment: 0, "
                        "start_speed: {:.17g}}}",
                        kWheel, speed),
                 kTime, step, more);
  }
  [[nodiscard]] Vec3 momentum() const {
    return {kAcross * omega.x(), kAcross * omega.y(),
            kAlong * omega.z() + kWheel * (speed + omega.z())};
  }
  /// Error of the axis at the end.
  [[nodiscard]] double error(Simulation& s) const {
    const Vec3 L = momentum();
    const Vec3 axis = quaternion_from_rotation_vector(kTime / kAcross * L) * Vec3(Vec3::UnitZ());
    return (s.body(0).q * Vec3(Vec3::UnitZ()) - axis).norm();
  }
};

// The wheel makes 100 turns a second, 5 of them in the longest step. @tests{rotor-moment}
TEST(Gyrostats, PrecessAtTheClosedFormRate) {
  const Symmetric model;
  for (const double h : kSteps) {
    Simulation s = made(model.text(h));
    expect_balances(finished(s), format("step {}", h));
    EXPECT_LT((s.balance().angular_momentum - model.momentum()).norm(), 1e-11) << h;
    // Phase error of a rotation by Cayley's transform, (θ/Δt)³ Δt²/12 T, of 3.4 rad/s.
    const double rate = model.momentum().norm() / Symmetric::kAcross;
    EXPECT_LT(model.error(s), std::pow(rate, 3) / 12.0 * h * h * Symmetric::kTime + 1e-9) << h;
    EXPECT_NEAR(s.load(0)[3], model.speed, 1e-9) << h;
  }
}

TEST(Gyrostats, PrecessWithTheOrderOfTheMethod) {
  const Symmetric model;
  for (const auto& [order, steps] :
       {std::pair(2, std::vector<int>{400, 800, 1600}), std::pair(4, std::vector<int>{100, 200}),
        std::pair(6, std::vector<int>{50, 100}), std::pair(8, std::vector<int>{40, 80})})
    expect_order(
        [&, k = order](int n) {
          Simulation s = made(model.text(Symmetric::kTime / n, format(", order: {}", k)));
          expect_balances(finished(s), format("order {}", k));
          return model.error(s);
        },
        steps, order, 0.35, format("order {}", order));
}

// Below ρ∞ = 1 energy is lost, at the same order.
TEST(Gyrostats, PrecessWithSecondOrderIfDamped) {
  const Symmetric model;
  for (const double rho : {0.8, 0.0})
    expect_order(
        [&](int n) {
          Simulation s = made(model.text(Symmetric::kTime / n, format(", rho_inf: {}", rho)));
          (void)finished(s);
          return model.error(s);
        },
        {800, 1600, 3200}, 2.0, 0.2, format("rho_inf {}", rho));
}

// Half a second of a step is 50 turns of the wheel.
TEST(Gyrostats, TurnTheirRotorsManyTimesInAStep) {
  Symmetric model;
  model.omega = Vec3(0.02, 0.0, 0.01);
  Simulation s = made(model.text(0.5, ", order: 8"));
  expect_balances(finished(s), "half a second");
  EXPECT_LT(model.error(s), 1e-4);
}

// M T = h, the body turns the other way at −h/J, the drive's work is h²/2 (1/I + 1/J): at every
// step, to rounding. With the speed given that results, the same. @tests{rotor-work}
TEST(Gyrostats, SpinUpAgainstTheClosedForm) {
  constexpr double kBody = 4.0, kRotor = 0.2, kMoment = 0.5, kTime = 6.0;
  const double h = kMoment * kTime, end = h / kRotor + h / kBody;
  const auto text = [&](const std::string& drive, double step) {
    return craft(
        format("inertia: [3, 5, {}], orientation: {{axis: [1, 1, 0], angle: 70 deg}}", kBody),
        "wheel: {type: rotor, body: craft, axis_body: z, inertia: 0.2, " + drive + "}", kTime,
        step);
  };
  for (const double step : kSteps)
    for (const bool given : {false, true}) {
      const std::string what = format("step {} {}", step, given ? "speed" : "moment");
      Simulation s =
          made(text(given ? format("speed: \"{:.17g}*t\"", end / kTime) : "moment: 0.5 N m", step));
      const RunSummary r = finished(s);
      expect_balances(r, what);
      const std::vector<double> wheel = s.load(0);
      EXPECT_NEAR(s.body(0).W.z(), -h / kBody, 1e-11) << what;
      EXPECT_NEAR(wheel[3], end, 1e-10) << what;           // speed
      EXPECT_NEAR(wheel[4], h, 1e-11) << what;             // momentum along the axis
      EXPECT_NEAR(wheel[8], kMoment, 1e-9) << what;        // of the drive
      EXPECT_NEAR(wheel[9], kMoment * end, 1e-7) << what;  // its power
      const double work = 0.5 * h * h * (1.0 / kRotor + 1.0 / kBody);
      EXPECT_NEAR(wheel[10], work, 1e-11 * work) << what;
      EXPECT_NEAR(s.balance().put_in, work, 1e-11 * work) << what;
      EXPECT_NEAR(s.balance().kinetic, work, 1e-11 * work) << what;
      EXPECT_LT(s.balance().angular_momentum.norm(), 1e-11) << what;
    }
}

/// Largest angle of the middle axis from its place at the start [rad].
double wander(double momentum, double step, double nudge = 1e-4) {
  Simulation s = made(craft(
      format("inertia: [1, 2, 2.5], angular_velocity: [{}, 1, 0]", nudge),
      format("wheel: {{type: rotor, body: craft, axis: y, inertia: 0.01, moment: 0, start_speed: "
             "{:.17g}}}",
             momentum / 0.01 - 1.0),
      40.0, step));
  double most = 0.0;
  while (s.state().t < 40.0 - 1e-9) {
    (void)s.step(40.0);
    const Vec3 y = s.body(0).q * Vec3(Vec3::UnitY());
    most = std::max(most, std::acos(std::min(1.0, y.y())));
  }
  expect_balances(s.summary(), format("momentum {}, step {}", momentum, step));
  return most;
}

// About its middle axis at W a body with a rotor on that axis is stable if h > (J_3 − J_2) W or
// h < −(J_2 − J_1) W (P. C. Hughes, Spacecraft Attitude Dynamics, 1986, on gyrostats): 0.5 and
// −1 here.
TEST(Gyrostats, AreStableAboutTheMiddleAxisBeyondTheKnownMomentum) {
  for (const double h : kSteps) {
    for (const double momentum : {0.8, 4.0, -1.3})
      EXPECT_LT(wander(momentum, h), 2e-3) << momentum << " " << h;
    for (const double momentum : {0.3, 0.0, -0.7})
      EXPECT_GT(wander(momentum, h), 0.3) << momentum << " " << h;
  }
}

// Small motions about the stable axis have the frequency of their linear equations,
// J_1 J_3 Ω² = (h + (J_2 − J_3) W)(h + (J_2 − J_1) W).
TEST(Gyrostats, OscillateAboutTheMiddleAxisAtTheirFrequency) {
  const double frequency = std::sqrt((4.0 - 0.5) * (4.0 + 1.0) / (1.0 * 2.5));
  const double T = 2.0 * kPi / frequency * 5.25;  // ω_x passes through zero
  for (const double h : kSteps) {
    const int n = static_cast<int>(std::ceil(T / h));
    Simulation s = made(craft("inertia: [1, 2, 2.5], angular_velocity: [1e-4, 1, 0]",
                              "wheel: {type: rotor, body: craft, axis: y, inertia: 0.01, moment: "
                              "0, start_speed: 399}",
                              T, T / n));
    expect_balances(finished(s), format("step {}", h));
    // A phase error of Ω³/12 Δt² T, Ω = 2.65 rad/s, and of the amplitude squared.
    EXPECT_LT(std::abs(s.body(0).W.x()) / 1e-4, 1.6 * h * h * T + 1e-6) << h;
  }
}

// Three wheels with moments over time in one body, and the same as bodies in hinges: the rotors'
// moments of inertia across their axes and their masses are in the body.
TEST(Gyrostats, MoveAsABodyWithWheelsInHinges) {
  const std::string moments[] = {"0.4*sin(3*t)", "0.3*t - 0.2", "t < 0.7 ? 0.5 : -0.2"};
  std::string rotors, bodies, joints, motors;
  for (int k = 0; k < 3; ++k) {
    const char* axis[] = {"x", "y", "z"};
    rotors += format(
        "r{}: {{type: rotor, body: craft, axis: {}, inertia: 0.3, moment: \"{}\", "
        "start_speed: {}}}, ",
        k, axis[k], moments[k], 2.0 - k);
    Vec3 across(0.2, 0.2, 0.2), spin(0.4, -0.3, 0.6);
    across[k] = 0.3;
    spin[k] += 2.0 - k;
    bodies += format("  w{}: {{mass: 1, inertia: [{}, {}, {}], angular_velocity: [{}, {}, {}]}}\n",
                     k, across.x(), across.y(), across.z(), spin.x(), spin.y(), spin.z());
    joints +=
        format("  h{0}: {{type: revolute, bodies: [craft, w{0}], at: [0, 0, 0], axis: {1}}}\n", k,
               axis[k]);
    motors +=
        format("  m{0}: {{type: rotary_motor, joint: h{0}, moment: \"{1}\"}}\n", k, moments[k]);
  }
  for (const double h : kSteps) {
    if (h < 1e-3) continue;
    const std::string analysis =
        format("analysis: {{duration: 2, step: {}, order: 6}}\noutput: {{hdf5: false}}\n", h);
    Simulation one = made(
        "format: 1\nbodies: {craft: {mass: 10, inertia: [1.4, 2.4, 3.4], angular_velocity: [0.4, "
        "-0.3, 0.6]}}\nloads: {" +
        rotors + "}\n" + analysis);
    Simulation four = made(
        "format: 1\nbodies:\n  craft: {mass: 7, inertia: [1, 2, 3], angular_velocity: [0.4, -0.3, "
        "0.6]}\n" +
        bodies + "joints:\n" + joints + "loads:\n" + motors + analysis);
    expect_balances(finished(one), format("step {}", h));
    EXPECT_LT(finished(four).energy_drift, 1e-10);
    // Order 6 with rates of 3 rad/s; the rates of the hinged bodies are projected ones.
    const double within = 1e-10 + 2e3 * std::pow(h, 6);
    EXPECT_LT(one.body(0).q.angularDistance(four.body(0).q), within) << h;
    EXPECT_LT((one.body(0).W - four.body(0).W).norm(), 10.0 * within) << h;
    EXPECT_NEAR(one.balance().kinetic, four.balance().kinetic, 10.0 * within) << h;
    EXPECT_LT((one.balance().angular_momentum - four.balance().angular_momentum).norm(), 1e-11);
    for (int k = 0; k < 3; ++k) {
      const std::vector<double> rotor = one.load(k), motor = four.load(k);
      EXPECT_NEAR(rotor[3], motor[4], 10.0 * within) << h;   // speed
      EXPECT_NEAR(rotor[10], motor[6], 10.0 * within) << h;  // work
    }
  }
}

// A body at rest with a running wheel nutates at h/J across.
TEST(Gyrostats, HaveTheirNutationAsAMode) {
  const ModalAnalysis analysis(
      io::read_model_text("format: 1\nbodies: {craft: {mass: 10, inertia: [2, 2, 3]}}\n"
                          "loads: {wheel: {type: rotor, body: craft, axis: z, inertia: 0.01, "
                          "moment: 0, start_speed: 600}}\n"
                          "analysis: {type: modes, about: start, count: 8}\n",
                          "model.yaml"));
  ASSERT_TRUE(analysis.converged()) << analysis.message();
  double highest = 0.0;
  for (const Mode& mode : analysis.report().modes)
    if (mode.kind == ModeKind::oscillation) highest = std::max(highest, mode.eigenvalue.imag());
  EXPECT_NEAR(highest, 6.0 / 2.0, 1e-9);
}

// A wheel that two controllers drive holds a direction: the body is at rest there, and the wheel
// has the momentum of the start.
TEST(Gyrostats, HoldAnAttitudeByAController) {
  for (const double h : {0.05, 0.005}) {
    Simulation s = made(format(R"(
format: 1
bodies: {{craft: {{mass: 10, inertia: [2, 2, 3], angular_velocity: [0, 0, 0.1]}}}}
controllers:
  angle: {{body: craft, rotation: vector, channel: thetaz, setpoint: 0.2 rad, proportional: 0.5, sample: 50 ms}}
  rate: {{body: craft, angular: true, channel: wz, setpoint: {{controller: angle}}, proportional: -6, sample: 50 ms}}
loads: {{wheel: {{type: rotor, body: craft, axis: z, inertia: 0.02, moment: {{controller: rate}}}}}}
analysis: {{duration: 40 s, step: {}}}
output: {{hdf5: false}}
)",
                               h));
    expect_balances(finished(s), format("step {}", h));
    EXPECT_NEAR(2.0 * std::asin(s.body(0).q.z()), 0.2, 1e-6) << h;
    EXPECT_NEAR(s.load(0)[4], 3.0 * 0.1 + 0.02 * 0.1, 1e-6) << h;
  }
}

// A mirrored part has the mirror image of the motion; momenta are axial vectors.
TEST(Gyrostats, AreMirroredWithTheirPart) {
  const std::string hub =
      "model: {format: 1, bodies: {hub: {mass: 3, inertia: [1, 2, 2.5], angular_velocity: [0.3, "
      "0.2, 0.6], orientation: {axis: [1, 2, 0.5], angle: 40 deg}}}, loads: {w: {type: rotor, "
      "body: hub, axis: [1, 2, 3], inertia: 0.2, moment: 0.3*t, start_speed: 50}, v: {type: rotor, "
      "body: hub, axis_body: [1, -2, 3], inertia: 0.1, speed: 20 + 3*t}}}";
  Simulation s =
      made("format: 1\nparts:\n  a: {" + hub + "}\n  b: {mirror: y, position: [0, 9, 0], " + hub +
           "}\nanalysis: {duration: 1, step: 5 ms}\noutput: {hdf5: false}\n");
  expect_balances(finished(s), "mirrored");
  const Vec3 axial(-1.0, 1.0, -1.0);
  EXPECT_LT((s.body(1).omega() - axial.cwiseProduct(s.body(0).omega())).norm(), 1e-12);
  for (const int k : {0, 1}) {
    const std::vector<double> one = s.load(k), other = s.load(2 + k);
    EXPECT_NEAR(one[3], other[3], 1e-10);
    EXPECT_LT((Vec3(other.data() + 5) - axial.cwiseProduct(Vec3(one.data() + 5))).norm(), 1e-11);
  }
}

TEST(Gyrostats, SayWhatIsMissing) {
  const auto text = [](const std::string& rotor) {
    return craft("inertia: [1, 2, 3]", "w: {type: rotor, body: craft, " + rotor + "}", 1.0, 0.1);
  };
  expect_fault(text("moment: 0"), "'inertia' is missing");
  expect_fault(text("inertia: 1"), "has no function of time. Give one of: speed, moment.");
  expect_fault(text("inertia: 1, speed: 2, start_speed: 3"), "Leave start_speed out");
  expect_fault(text("inertia: 1, speed: \"t < 0.5 ? 1 : 2\""), "jumps by 1 rad/s at t = 0.5 s");
  expect_fault(text("inertia: 1, moment: 0, axis: x, axis_body: y"), "cannot be combined");
  expect_fault(
      "format: 1\nbodies: {p: {mass: 1, point_mass: true}}\nloads: {w: {type: rotor, "
      "body: p, inertia: 1, moment: 0}}\n",
      "is a point mass");
}

}  // namespace polhode::gyrostat_tests
