// SPDX-License-Identifier: Apache-2.0
// Normal and friction forces between cables, against closed forms.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::test::cable_pairs_at_rest_tests {
namespace {

constexpr double g = 9.81;

/// Two tight cables across each other, the ends of the upper one 30 mm below those of the lower
/// one: both are kinked at the contact, by angles that follow from the forces.
TEST(CablePairs, TightCablesBendEachOtherByTheForceBalance) {
  const double radius = 5e-3, below = 0.03, EA_1 = 2e4, EA_2 = 5e4, half_1 = 1.0, half_2 = 0.7;
  const double free_1 = 0.995, free_2 = 0.69, kGuess = 0.02;
  Model model = io::read_model_text(format(R"(
format: 1
cables:
  lower: {{through: [[ground, [-1, 0, 0]], [ground, [1, 0, 0]]], stiffness: {:g}, free_length: {:g},
          mass_per_length: 0.1, elements: 10, contact: {{radius: 5 mm}}}}
  upper: {{through: [[ground, [0, -0.7, -0.03]], [ground, [0, 0.7, -0.03]]], stiffness: {:g}, free_length: {:g},
          mass_per_length: 0.1, elements: 8, contact: {{radius: 5 mm}}}}
contacts: {{}}
analysis: {{type: statics}}
)",
                                           EA_1, 2.0 * free_1, EA_2, 2.0 * free_2),
                                    "kink.yaml");
  // The cables of the file are straight, one below the other; the kinked shape here is an initial
  // guess.
  const auto kink = [&](const std::string& cable, int pieces, double ends, double middle) {
    for (int k = 0; k <= pieces; ++k)
      model.bodies[static_cast<std::size_t>(model.body_index(cable + "." + std::to_string(k)))]
          .position.z() = middle + (ends - middle) * std::abs(2.0 * k / pieces - 1.0);
  };
  kink("lower", 10, 0.0, -kGuess);
  kink("upper", 8, -below, 2.0 * radius + 1e-4 - kGuess);
  Simulation s(model);
  const RunSummary r = s.run();
  ASSERT_EQ(r.end, RunEnd::finished) << r.message;
  // 2 T_1 sin(kink_1) = 2 T_2 sin(kink_2), and the distance of the inclined pieces is the sum of
  // the radii.
  const auto press = [](double EA, double half, double free, double depth) {
    const double length = std::hypot(half, depth);
    return 2.0 * EA * (length / free - 1.0) * depth / length;
  };
  double w_1 = 0.0, w_2 = 0.0, lean = 1.0;
  for (int again = 0; again < 20; ++again) {
    const double both = below + 2.0 * radius * lean;
    double low = 0.0, high = both;
    for (int k = 0; k < 80; ++k) {
      w_1 = 0.5 * (low + high);
      w_2 = both - w_1;
      (press(EA_1, half_1, free_1, w_1) < press(EA_2, half_2, free_2, w_2) ? low : high) = w_1;
    }
    lean = std::sqrt(1.0 + std::pow(w_1 / half_1, 2) + std::pow(w_2 / half_2, 2));
  }
  const double z_1 = s.body(s.model().body_index("lower.5")).r.z(),
               z_2 = s.body(s.model().body_index("upper.4")).r.z();
  const double band = 1e-3 * radius;
  EXPECT_NEAR(z_2 - z_1, 2.0 * radius * lean, band);
  EXPECT_NEAR(-z_1, w_1, band);
  EXPECT_NEAR(z_2 + below, w_2, band);
  const ContactReport c = s.contact(0);
  EXPECT_NEAR(c.force.z() / press(EA_1, half_1, free_1, w_1), -1.0, 1e-3)
      << "contact is beside the nodes";
  EXPECT_NEAR(c.normal_force / c.force.z(), -lean, 2e-5)
      << "on the lower cable, the first of the pair";
  EXPECT_EQ(c.points, 4) << "two pieces on each side of the nodes in contact";
}

/// A bar of two fixed bodies with a cable between them, across two cables that carry it like rails,
/// on a slope, which is given by the direction of gravity.
RunSummary sled(Simulation& s, double* v_1, double* t_1) {
  return s.run({}, [&](Simulation& now) {
    if (now.time() < 0.05 + 1e-9) *t_1 = now.time(), *v_1 = now.body(0).v.x();
  });
}

Model sled_model(double slope, double mu) {
  return io::read_model_text(format(R"(
format: 1
gravity: [{:.17g}, 0, {:.17g}]
bodies:
  back: {{mass: 0.5, inertia: [1e-3, 1e-3, 1e-3], position: [-0.5, 0, 8 mm]}}
  front: {{mass: 0.5, inertia: [1e-3, 1e-3, 1e-3], position: [0.5, 0, 8 mm]}}
joints:
  weld: {{type: fixed, bodies: [back, front], at: [0, 0, 0]}}
cables:
  bar: {{through: [[back], [front]], stiffness: 50 kN, contact: {{radius: 4 mm}}}}
  rail_1: {{through: [[ground, [-0.2, -0.1, 0]], [ground, [-0.2, 0.13, 0]]], stiffness: 1e9, free_length: 0.2299,
           mass_per_length: 1, elements: 2, contact: {{radius: 4 mm}}}}
  rail_2: {{through: [[ground, [0.2, -0.1, 0]], [ground, [0.2, 0.13, 0]]], stiffness: 1e9, free_length: 0.2299,
           mass_per_length: 1, elements: 2, contact: {{radius: 4 mm}}}}
contacts: {{default: {{friction: {:g}}}}}
analysis: {{step: 0.5 ms, duration: 0.25}}
)",
                                    g * std::sin(slope), -g * std::cos(slope), mu),
                             "sled.yaml");
}

TEST(CablePairs, ACableAcrossTwoOthersSlidesOnASlopeByCoulombsLaw) {
  const double mu = 0.3;
  for (const double slope : {std::atan(0.29), std::atan(0.31), 0.5}) {
    Simulation s(sled_model(slope, mu));
    double v_1 = 0.0, t_1 = 0.0;
    const RunSummary r = sled(s, &v_1, &t_1);
    ASSERT_EQ(r.end, RunEnd::finished) << r.message;
    const double a = (s.body(0).v.x() - v_1) / (s.time() - t_1);
    const double expected = std::max(0.0, g * (std::sin(slope) - mu * std::cos(slope)));
    EXPECT_NEAR(a, expected, 2e-3 * g) << slope;
    const double way = s.body(0).r.x() + 0.5;
    if (expected > 0.0)
      EXPECT_NEAR(r.contacts->lost_by_friction, mu * g * std::cos(slope) * way, 5e-3 * g * way);
    else
      EXPECT_LT(way, 1e-4) << "it sticks: the displacement until the bristle held it";
    EXPECT_LT(r.energy_drift, 1e-6);
  }
}

/// A similar bar lies lengthwise in the groove between two others that touch: of three equal round
/// bars the normals stand at 30 degrees, so both carry W/(2 cos 30°), and friction is μ W/cos 30°.
TEST(CablePairs, ACableAlongTwoOthersSlidesInTheirGrooveAsAWedge) {
  const double mu = 0.3, radius = 4e-3, wedge = mu / std::cos(std::numbers::pi / 6.0);
  for (const double slope : {std::atan(wedge) - 0.01, std::atan(wedge) + 0.01, 0.6}) {
    Simulation s(io::read_model_text(format(R"(
format: 1
gravity: [{0:.17g}, 0, {1:.17g}]
bodies:
  back: {{mass: 0.5, inertia: [1e-3, 1e-3, 1e-3], position: [-0.2, 0, {2:.17g}]}}
  front: {{mass: 0.5, inertia: [1e-3, 1e-3, 1e-3], position: [0.2, 0, {2:.17g}]}}
joints:
  weld: {{type: fixed, bodies: [back, front], at: [0, 0, 0]}}
cables:
  bar: {{through: [[back], [front]], stiffness: 50 kN, contact: {{radius: 4 mm}}}}
  rail_1: {{through: [[ground, [-0.7, {3:.17g}, 0]], [ground, [1.4, {3:.17g}, 0]]], stiffness: 1e9, free_length: 2.09,
           mass_per_length: 1, elements: 3, contact: {{radius: 4 mm}}}}
  rail_2: {{through: [[ground, [-0.7, -{3:.17g}, 0]], [ground, [1.4, -{3:.17g}, 0]]], stiffness: 1e9, free_length: 2.09,
           mass_per_length: 1, elements: 3, contact: {{radius: 4 mm}}}}
contacts: {{default: {{friction: {4:g}}}, exclude: [[rail_1, rail_2]]}}
analysis: {{step: 0.5 ms, duration: 0.25}}
)",
                                            g * std::sin(slope), -g * std::cos(slope),
                                            radius * std::sqrt(3.0) * 1.0, radius, mu),
                                     "groove.yaml"));
    double v_1 = 0.0, t_1 = 0.0;
    const RunSummary r = sled(s, &v_1, &t_1);
    ASSERT_EQ(r.end, RunEnd::finished) << r.message;
    const double a = (s.body(0).v.x() - v_1) / (s.time() - t_1);
    const double expected = std::max(0.0, g * (std::sin(slope) - wedge * std::cos(slope)));
    EXPECT_NEAR(a, expected, 5e-3 * g) << slope;
    double normal = 0.0;
    for (int k = 0; k < 2; ++k) normal += s.contact(k).impulse / s.time();
    EXPECT_NEAR(normal / (g * std::cos(slope) / std::cos(std::numbers::pi / 6.0)), 1.0, 1e-2);
    EXPECT_NEAR(s.body(0).r.z(), radius * std::sqrt(3.0), 8e-3 * radius);
    EXPECT_LT(r.energy_drift, 1e-5) << "the rounding of energies of such tight rails";
  }
}

}  // namespace
}  // namespace polhode::test::cable_pairs_at_rest_tests
