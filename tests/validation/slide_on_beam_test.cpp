// SPDX-License-Identifier: Apache-2.0
// A point that slides along a beam: closed forms of a bead on a rod and of a moving load, statics,
// conservation, order, and messages.
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/simulation/modal.hpp>
#include <support/run_text.hpp>

namespace polhode::test::slide_on_beam_tests {
namespace {

constexpr double kPi = std::numbers::pi;

/// Channels of slide_on_beam in a report.
enum Channel : std::size_t { kForce, kPosition = 3, kSpeed, kAlong, kEnergy };

/// The section of a rod that is stiff enough to be rigid.
std::string stiff(const std::string& rest) {
  return R"(
format: 1
sections:
  rod: {type: general, EA: 1e9, GA_y: 1e9, GA_z: 1e9, GJ: 1e9, EI_y: 1e9, EI_z: 1e9,
        mass_per_length: 1, inertia_per_length: [0.1, 0.1, 0.1]}
output: {hdf5: false}
)" + rest;
}

std::string analysis(double step, double duration, double rho_inf = 1.0) {
  return format("analysis: {{type: dynamics, duration: {:.17g}, step: {:.17g}, rho_inf: {}}}\n",
                duration, step, rho_inf);
}

/// A free, soft beam that tumbles, with a heavy bead that crosses its elements.
std::string tumbling(double step, double duration, const std::string& slide = "",
                     double relaxation_time = 0.0) {
  return format("variables: {{tau: {:.17g}}}\n", relaxation_time) + R"(
format: 1
sections:
  rod: {type: general, EA: 1e4, GA_y: 4e3, GA_z: 4e3, GJ: 160, EI_y: 200, EI_z: 150,
        mass_per_length: 0.5, inertia_per_length: [0.01, 0.005, 0.005],
        relaxation_time: tau}
beams:
  rod: {points: [[0, 0, 0], [6, 0, 0]], elements: 8, section: rod,
        angular_velocity: [0.4, -0.7, 1.1], velocity: [0.3, -1, -0.7]}
bodies:
  bead: {mass: 2, inertia: [0.02, 0.03, 0.025], position: [1.8, 0.1, 0.05],
         velocity: [3.2, 1, 0.8], angular_velocity: [1, -2, 0.5]}
loads:
  slide: {type: slide_on_beam, beam: rod, body: bead, at: [1.8, 0, 0])" +
         slide + "}\noutput: {hdf5: false}\n" + analysis(step, duration);
}

}  // namespace

// On a rod that turns at ω the bead moves as r = r_0 cosh(ωt). @tests{slide-along}
TEST(SlideOnBeam, FollowsABeadOnATurningRod) {
  const double omega = 2.0, t = 0.6, r = 2.0 * std::cosh(omega * t);
  double before = 0.0;
  for (const double h : {0.02, 0.01, 0.001}) {
    Simulation s = made(stiff(R"(
bodies:
  hub: {mass: 1, inertia: [1, 1, 1], angular_velocity: [0, 0, 2]}
  bead: {mass: 0.5, inertia: [0.01, 0.01, 0.01], position: [2, 0, 0], velocity: [0, 4, 0]}
joints:
  axle: {type: revolute, bodies: [ground, hub], at: [0, 0, 0], axis: z}
beams:
  rod: {points: [[0, 0, 0], [8, 0, 0]], elements: 4, section: rod, bonded: {hub: start}}
loads:
  drive: {type: rotary_motor, joint: axle, angle: 2*t}
  slide: {type: slide_on_beam, beam: rod, body: bead}
)") + analysis(h, t));
    const RunSummary run = finished(s);
    const double error = std::abs(s.body(1).r.norm() - r);
    EXPECT_LT(error, 3.0 * h * h + 2e-7) << h;  // the rod bends by some 1e-8 m
    if (h == 0.01) {
      EXPECT_NEAR(before / error, 4.0, 0.3);
    }
    before = error;
    const std::vector<double> at = s.load(1);
    EXPECT_NEAR(at[kPosition], r, 3.0 * h * h + 2e-7);
    const double rate = s.body(1).v.dot(s.body(1).r.normalized());
    EXPECT_NEAR(rate, 2.0 * omega * std::sinh(omega * t), 3.0 * h * h + 2e-7) << h;
    EXPECT_NEAR(at[kSpeed], rate, 3e-3);  // the rod vibrates along its axis
    EXPECT_LT(run.energy_drift, 1e-9) << h;
  }
}

// Down a straight incline: s = s_0 + ½ g sin α t², exactly at any step as a parabola, over borders
// of elements. The force across is m g cos α where numerical damping brings the rod to rest.
// @tests{slide-along}
TEST(SlideOnBeam, RunsDownAnIncline) {
  for (const auto& [rho_inf, h] :
       {std::pair(1.0, 0.1), {1.0, 0.01}, {1.0, 0.001}, {0.5, 0.1}, {0.5, 0.01}, {0.5, 0.001}}) {
    Simulation s = made(stiff(R"(
gravity: [3, 0, -4]
bodies:
  bead: {mass: 2, inertia: [1, 1, 1], position: [0.7, 0, 0]}
beams:
  rod: {points: [[0, 0, 0], [8, 0, 0]], elements: 5, section: rod, bonded: {ground: start}}
joints:
  far: {type: fixed, bodies: [ground, rod.end], at: [8, 0, 0]}
loads:
  slide: {type: slide_on_beam, beam: rod, body: bead}
)") + analysis(h, 2.0, rho_inf));
    const RunSummary run = finished(s);
    EXPECT_NEAR(s.body(0).r.x(), 0.7 + 1.5 * 4.0, 1e-6) << h;
    const std::vector<double> at = s.load(0);
    EXPECT_NEAR(at[kAlong], 0.0, 1e-6) << h;
    if (rho_inf == 1.0) {
      EXPECT_LT(run.energy_drift, 1e-12) << h;
    } else {
      EXPECT_NEAR(at[kForce + 2], 8.0, 1e-3) << h;
    }
  }
}

// Energy and both momenta of a free beam with a bead are conserved at any step, also where the bead
// crosses several elements in one. @tests{slide-rows} @tests{slide-along}
TEST(SlideOnBeam, ConservesEnergyAndMomenta) {
  for (const double h : {0.1, 0.02, 0.002, 0.0002}) {
    Simulation s = made(tumbling(h, 0.8));
    const RunSummary run = finished(s);
    EXPECT_LT(run.energy_drift, 2e-13) << h;
    EXPECT_LT(run.linear_momentum_drift, 5e-14) << h;
    EXPECT_LT(run.angular_momentum_drift, 5e-14) << h;
    EXPECT_NEAR(s.load(0)[kPosition], 3.717, 2e-3) << h;  // over three borders of elements
  }
}

// A spring along the beam stores what the bead loses; a damper's loss and a force's work are in the
// balance.
TEST(SlideOnBeam, BalancesSpringsDampersAndForcesAlongIt) {
  for (const double h : {0.05, 0.005}) {
    for (const char* along :
         {", stiffness: 5, free_position: 2.5", ", stiffness: 5, free_position: 2.5, damping: 0.7",
          ", stiffness: 3, free_position: 2, force: 2*sin(3*t)"}) {
      Simulation s = made(tumbling(h, 1.5, along));
      const RunSummary run = finished(s);
      EXPECT_LT(run.energy_drift, 1e-12) << along << h;
      EXPECT_LT(run.angular_momentum_drift, 5e-14) << along << h;
    }
  }
}

// Second order in the step. Viscosity damps vibrations that the steps do not resolve.
TEST(SlideOnBeam, ConvergesWithTheSecondOrder) {
  const auto end = [](double h) {
    Simulation s = made(tumbling(h, 0.8, "", 0.02));
    (void)finished(s);
    return s.body(0).r;
  };
  const Vec3 first = end(0.004), second = end(0.002), third = end(0.001);
  EXPECT_NEAR((first - second).norm() / (second - third).norm(), 4.0, 0.2);
}

// A simply supported beam under a weight at a: w = P a² b²/(3 E I L), less what the curve lacks
// within the element, P α³ β³/(3 E I h³) at α, β from its nodes. @tests{beam-curve}
TEST(SlideOnBeam, BendsABeamStatically) {
  const double L = 10.0, EI = 2e6, P = 10.0 * 9.81, h = L / 5.0;
  for (const double a : {2.0, 4.0, 5.0, 6.6}) {
    Simulation s = made(format(R"(
format: 1
gravity: [0, 0, -9.81]
sections:
  girder: {{type: general, EA: 1e9, GA_y: 1e13, GA_z: 1e13, GJ: 1e6, EI_y: 2e6, EI_z: 2e6,
            mass_per_length: 1e-6, inertia_per_length: [1e-6, 1e-6, 1e-6]}}
beams:
  bridge: {{points: [[0, 0, 0], [10, 0, 0]], elements: 5, section: girder}}
bodies:
  trolley: {{mass: 10, inertia: [1, 1, 1], position: [{0}, 0, 0]}}
joints:
  left: {{type: revolute, bodies: [ground, bridge.start], at: [0, 0, 0], axis: y}}
  right: {{type: generic, bodies: [ground, bridge.end], at: [10, 0, 0], free: [x, ry]}}
  guide: {{type: prismatic, bodies: [ground, trolley], at: [{0}, 0, 0], axis: z}}
loads:
  slide: {{type: slide_on_beam, beam: bridge, body: trolley}}
analysis: {{type: statics}}
output: {{hdf5: false}}
)",
                               a));
    (void)finished(s);
    const double b = L - a, alpha = std::fmod(a, h), beta = h - alpha;
    const double w =
        P * a * a * b * b / (3.0 * EI * L) - P * std::pow(alpha * beta, 3) / (3.0 * EI * h * h * h);
    EXPECT_NEAR(-s.body(0).r.z(), w, 1e-6 * w) << a;
    EXPECT_NEAR(s.load(0)[kForce + 2], P, 1e-6 * P) << a;
    EXPECT_NEAR(s.load(0)[kPosition], a, 1e-6) << a;
  }
}

// A force that moves over a simply supported beam of Euler and Bernoulli at a constant speed, by
// its modal series (Frýba, Vibration of Solids and Structures under Moving Loads, 1972, (1.31)).
// @tests{beam-curve} @tests{slide-rows}
TEST(SlideOnBeam, MovesALoadOverABeam) {
  const double L = 10.0, EI = 2e6, m = 20.0, P = 100.0;
  const double omega_1 = kPi * kPi / (L * L) * std::sqrt(EI / m), alpha = 0.3;
  const double v = alpha * omega_1 * L / kPi, T = 0.8 * L / v;
  double exact = 0.0;
  for (int n = 1; n < 400; ++n) {
    const double omega_n = n * n * omega_1, omega = n * kPi * v / L;
    exact += 2.0 * P / (m * L) / (omega_n * omega_n - omega * omega) * std::sin(0.5 * n * kPi) *
             (std::sin(omega * T) - omega / omega_n * std::sin(omega_n * T));
  }
  const double at_rest = P * L * L * L / (48.0 * EI);
  for (const double h : {T / 100.0, T / 400.0, T / 4000.0}) {
    Simulation s = made(format(R"(
format: 1
sections:
  girder: {{type: general, EA: 1e9, GA_y: 1e11, GA_z: 1e11, GJ: 1e6, EI_y: 2e6, EI_z: 2e6,
            mass_per_length: 20, inertia_per_length: [1e-4, 1e-4, 1e-4]}}
beams:
  bridge: {{points: [[0, 0, 0], [10, 0, 0]], elements: 16, section: girder}}
bodies:
  wheel: {{mass: 1e-3, point_mass: true, position: [0, 0, 0], velocity: [{0:.17g}, 0, 0]}}
joints:
  left: {{type: revolute, bodies: [ground, bridge.start], at: [0, 0, 0], axis: y}}
  right: {{type: generic, bodies: [ground, bridge.end], at: [10, 0, 0], free: [x, ry]}}
loads:
  weight: {{type: force, body: wheel, force: [0, 0, -100]}}
  slide: {{type: slide_on_beam, beam: bridge, body: wheel, position: "{0:.17g}*t"}}
output: {{hdf5: false}}
)",
                               v) +
                        analysis(h, T));
    const RunSummary run = finished(s);
    EXPECT_NEAR(-s.beam(0).position[8].z(), exact, 1e-2 * at_rest) << h;
    EXPECT_NEAR(s.load(1)[kPosition], 0.8 * L, 1e-9);
    EXPECT_LT(run.energy_drift, 1e-9) << h;
  }
}

// A slow trolley on a bent beam: the force stays the weight where it crosses nodes. A kink of 1
// mrad in its path would be an impulse of m v 1e-3, 25 N over a step. @tests{beam-curve}
TEST(SlideOnBeam, CrossesNodesWithoutNoise) {
  for (const double h : {0.02, 0.002}) {
    Simulation s = made(R"(
format: 1
gravity: [0, 0, -10]
sections:
  girder: {type: general, EA: 1e9, GA_y: 1e9, GA_z: 1e9, GJ: 1e6, EI_y: 2e6, EI_z: 2e6,
           mass_per_length: 20, inertia_per_length: [0.1, 0.1, 0.1], relaxation_time: 0.05}
beams:
  bridge: {points: [[0, 0, 0], [10, 0, 0]], elements: 10, section: girder}
bodies:
  trolley: {mass: 100, inertia: [1, 1, 1], position: [2.6, 0, 0], velocity: [0.5, 0, 0]}
joints:
  left: {type: revolute, bodies: [ground, bridge.start], at: [0, 0, 0], axis: y}
  right: {type: generic, bodies: [ground, bridge.end], at: [10, 0, 0], free: [x, ry]}
loads:
  slide: {type: slide_on_beam, beam: bridge, body: trolley, position: 2.6 + 0.5*t}
output: {hdf5: false, every: 0.02}
)" + analysis(h, 9.0, 0.5));
    double worst = 0.0;
    const auto look = [&](Simulation& now) {
      if (now.time() > 3.0)  // the beam has come to rest after the sudden load
        worst = std::max(worst, std::abs(now.load(0)[kForce + 2] - 1000.0));
    };
    EXPECT_EQ(s.run(look).end, RunEnd::finished);
    EXPECT_LT(worst, 1.0) << h;
    EXPECT_NEAR(s.load(0)[kPosition], 7.1, 1e-12);
  }
}

// A beam that runs through a fixed eye: the ground holds it, at any place along it.
TEST(SlideOnBeam, GuidesABeamThroughAnEye) {
  for (const double h : {0.05, 0.005}) {
    Simulation s = made(R"(
format: 1
sections:
  rod: {type: general, EA: 1e4, GA_y: 4e3, GA_z: 4e3, GJ: 160, EI_y: 200, EI_z: 150,
        mass_per_length: 0.5, inertia_per_length: [0.01, 0.005, 0.005]}
beams:
  rod: {points: [[-2, 0, 0], [6, 0, 0]], elements: 8, section: rod, velocity: [1.5, 0, 0]}
bodies:
  tip: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [6, 0, 0.5], velocity: [1.5, 0, 0]}
joints:
  grip: {type: fixed, bodies: [rod.end, tip], at: [6, 0, 0]}
loads:
  eye: {type: slide_on_beam, beam: rod, body: ground, at: [2.7, 0, 0]}
  push: {type: moment, body: tip, moment: [0, 0, 3]}
output: {hdf5: false}
)" + analysis(h, 1.0));
    const RunSummary run = finished(s);
    EXPECT_LT(run.energy_drift, 1e-11) << h;
    EXPECT_LT(s.load(0)[kPosition], 3.6);
    EXPECT_LT(run.angular_momentum_drift, 1e-11) << h;
  }
}

// What cannot be is told when the model is built.
TEST(SlideOnBeam, RefusesWhatItCannotHold) {
  const auto with = [](const std::string& load, const std::string& points = "[0, 0, 0], [8, 0, 0]",
                       const std::string& more = "") {
    return stiff(
               "bodies:\n  bead: {mass: 2, inertia: [1, 1, 1], position: [2, 0, 0]}\n"
               "beams:\n  rod: {points: [" +
               points +
               "], elements: 6, section: rod}\n"
               "loads:\n  slide: {type: slide_on_beam, " +
               load + "}\n" + more) +
           analysis(0.01, 1.0);
  };
  expect_fault(with("beam: pole, body: bead"), "there is no beam 'pole'. Name an entry of 'beams'");
  expect_fault(with("beam: rod, body: bead, at: [2, 0.3, 0]"),
               "loads.slide.at: is 0.3 m from beam 'rod', whose nearest point is [2, 0, 0] m. Put "
               "the point there at the start.");
  expect_fault(with("beam: rod, body: bead", "[0, 0, 0], [4, 0, 0], [4, 3, 0]"),
               "loads.slide.beam: 'rod' has a corner at its node 3, which no point can pass. Give "
               "the beam an arc, or a straight line.");
  expect_fault(with("beam: rod, body: rod.3"),
               "loads.slide.body: is a node of the beam itself. Name another body.");
  expect_fault(with("beam: rod, body: bead, position: 1 + t"),
               "loads.slide.position: begins at 1 m, but the point is at 2 m along the beam. Let "
               "it begin there, or move the body.");
  expect_fault(with("beam: rod, body: bead, force: 1, position: 2 + t"), "cannot be combined");
}

// Modes of a trolley on a spring along the beam: f = sqrt(k/m)/2π, free rotations about its point,
// and no others that the beam does not have.
TEST(SlideOnBeam, HasTheFrequencyOfItsSpringAlongTheBeam) {
  const ModalAnalysis modal(io::read_model_text(R"(
format: 1
sections:
  girder: {type: general, EA: 1e9, GA_y: 1e9, GA_z: 1e9, GJ: 1e6, EI_y: 2e6, EI_z: 2e6,
           mass_per_length: 20, inertia_per_length: [0.1, 0.1, 0.1]}
beams:
  bridge: {points: [[0, 0, 0], [10, 0, 0]], elements: 10, section: girder}
bodies:
  trolley: {mass: 100, inertia: [1, 1, 1], position: [2.6, 0, 0]}
joints:
  left: {type: revolute, bodies: [ground, bridge.start], at: [0, 0, 0], axis: y}
  right: {type: generic, bodies: [ground, bridge.end], at: [10, 0, 0], free: [x, ry]}
loads:
  slide: {type: slide_on_beam, beam: bridge, body: trolley, stiffness: 1e3, free_position: 2.6}
analysis: {type: modes, count: 5}
)",
                                                "modes.yaml"));
  ASSERT_TRUE(modal.converged()) << modal.message();
  const std::vector<Mode>& modes = modal.report().modes;
  ASSERT_EQ(modes.size(), 5u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_TRUE(modes[k].rigid) << k;
  EXPECT_NEAR(modes[3].frequency, std::sqrt(1e3 / 100.0) / (2.0 * kPi), 1e-5);
  EXPECT_GT(modes[4].frequency, 3.5);  // of bending
}

// Message of a point that leaves its beam.
TEST(SlideOnBeam, TellsThatThePointLeavesTheBeam) {
  Simulation s = made(stiff(R"(
bodies:
  bead: {mass: 2, inertia: [1, 1, 1], position: [7, 0, 0], velocity: [1, 0, 0]}
beams:
  rod: {points: [[0, 0, 0], [8, 0, 0]], elements: 5, section: rod, bonded: {ground: start}}
loads:
  slide: {type: slide_on_beam, beam: rod, body: bead}
)") + analysis(0.01, 2.0));
  const RunSummary run = s.run();
  EXPECT_NE(run.end, RunEnd::finished);
  EXPECT_NEAR(run.t, 1.0, 0.011);
  EXPECT_NE(run.message.find("slide_on_beam 'slide': the point leaves beam 'rod' at its end"),
            std::string::npos)
      << run.message;
}

}  // namespace polhode::test::slide_on_beam_tests
