// SPDX-License-Identifier: Apache-2.0
// Contact between cables, and of a cable with itself.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/io/results/checkpoint.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <support/scratch.hpp>

namespace polhode::test::cable_pairs_tests {
namespace {

using std::numbers::pi;

constexpr double kRadius = 4e-3;
/// Tolerance at the ends of crossing pieces, which belong to both neighbours.
constexpr double kEnds = 1e-9;

/// Two tight cables between blocks in space, one across the other, thrown at each other.
/// @param angle  Between them [rad]; they cross at a part of both.
Model crossed(double step, double duration, double speed, double angle,
              const std::string& more = "restitution: 1") {
  const double c = std::cos(angle), s = std::sin(angle), h = 0.55, z = 0.02;
  return io::read_model_text(format(R"(
format: 1
bodies:
  left: {{shape: {{box: [0.1, 0.1, 0.1]}}, density: 1000, position: [-0.55, 0.001, 0], contact: {{touches: false}}}}
  right: {{shape: {{box: [0.1, 0.1, 0.1]}}, density: 1000, position: [0.55, 0.001, 0], contact: {{touches: false}}}}
  near: {{shape: {{box: [0.1, 0.1, 0.1]}}, density: 1000, position: [{0:.17g}, {1:.17g}, {4:g}], velocity: [0, 0, {5:g}],
         contact: {{touches: false}}}}
  far: {{shape: {{box: [0.1, 0.1, 0.1]}}, density: 1000, position: [{2:.17g}, {3:.17g}, {4:g}], velocity: [0, 0, {5:g}],
         contact: {{touches: false}}}}
cables:
  lower: {{through: [[left], [right]], stiffness: 20 kN, mass_per_length: 0.05, elements: 20, contact: {{radius: 4 mm}}}}
  upper: {{through: [[near], [far]], stiffness: 20 kN, mass_per_length: 0.05, elements: 19, contact: {{radius: 4 mm}}}}
contacts: {{default: {{{6}}}}}
analysis: {{duration: {7:g}, step: {8:g}}}
output: {{probes: {{touch: {{contact: [lower, upper]}}}}}}
)",
                                    -h * c, -h * s, h * c, h * s, z, -speed, more, duration, step),
                             "crossed.yaml");
}

/// @param pieces  Of the cable.
std::vector<Vec3> line(const Simulation& s, const std::string& cable, int pieces) {
  std::vector<Vec3> x;
  for (int k = 0; k <= pieces; ++k)
    x.push_back(s.body(s.model().body_index(cable + "." + std::to_string(k))).r);
  return x;
}

/// Smallest height of one line above the other where both cross as seen from above.
double height_where_they_cross(const std::vector<Vec3>& upper, const std::vector<Vec3>& lower,
                               int& crossings) {
  double least = 1.0;
  crossings = 0;
  for (std::size_t i = 0; i + 1 < upper.size(); ++i)
    for (std::size_t j = 0; j + 1 < lower.size(); ++j) {
      const Vec3 e = upper[i + 1] - upper[i], f = lower[j + 1] - lower[j], w = lower[j] - upper[i];
      const double across = e.x() * f.y() - e.y() * f.x();
      if (across == 0.0) continue;
      const double a = (w.x() * f.y() - w.y() * f.x()) / across,
                   b = (w.x() * e.y() - w.y() * e.x()) / across;
      if (std::min(a, b) < -kEnds || std::max(a, b) > 1.0 + kEnds) continue;
      least = std::min(least, (upper[i] + a * e - lower[j] - b * f).z());
      ++crossings;
    }
  return least;
}

TEST(CablePairs, CrossedCablesKeepEnergyAndMomenta) {
  for (const double angle : {0.5 * pi, 0.9, 0.05})
    for (const double step : {2e-4, 5e-5}) {
      Simulation s(crossed(step, 0.02, 3.0, angle));
      const RunSummary r = s.run();
      ASSERT_EQ(r.end, RunEnd::finished) << r.message;
      EXPECT_GT(s.contact(0).impulse, 0.03) << angle;
      EXPECT_LT(r.energy_drift, 1e-10) << angle << ", " << step;
      EXPECT_LT(r.linear_momentum_drift, 1e-12) << angle << ", " << step;
      EXPECT_LT(r.angular_momentum_drift, 1e-12) << angle << ", " << step;
      EXPECT_EQ(r.contacts->lost_in_impacts, 0.0);
      EXPECT_GT(r.contacts->least_gap, -4e-3 * kRadius) << angle;
    }
}

/// Speeds at which one cable moves by many times the other's thickness in a step.
TEST(CablePairs, FastCablesDoNotPassThroughEachOther) {
  for (const double angle : {0.5 * pi, 0.2, 0.02})
    for (const double speed : {30.0, 100.0}) {
      if (angle < 0.1 && speed > 50.0) continue;  // takes a quarter of a minute
      Simulation s(crossed(1e-3, 0.06 / speed, speed, angle));
      double least = 1.0;
      int crossings = 0;
      const RunSummary r = s.run({}, [&](Simulation& now) {
        const double height =
            height_where_they_cross(line(now, "upper", 19), line(now, "lower", 20), crossings);
        EXPECT_GE(crossings, 1) << angle << ", " << speed << " at " << now.time();
        least = std::min(least, height);
      });
      ASSERT_EQ(r.end, RunEnd::finished) << r.message;
      EXPECT_GT(least, 2.0 * kRadius - 4e-3 * kRadius) << angle << ", " << speed;
      EXPECT_LT(r.energy_drift, 1e-9);
    }
}

/// Changing coupling of bodies by a cable while other bodies are in contact: two balls collide,
/// then the second one hits the upper cable.
TEST(CablePairs, AllSolversAgree) {
  const auto model = [](const std::string& solver) {
    Model m = crossed(2e-4, 0.02, 3.0, 0.9);
    m.analysis.solver = solver;
    const Model balls = io::read_model_text(R"(
format: 1
bodies:
  one: {shape: {sphere: 30 mm}, density: 500, position: [0.05, 0.05, 0.22], velocity: [0, 0, -12]}
  two: {shape: {sphere: 30 mm}, density: 500, position: [0.05, 0.06, 0.1], velocity: [0, 0, -3]}
contacts: {}
analysis: {duration: 1, step: 0.1}
)",
                                            "balls.yaml");
    for (const BodySpec& ball : balls.bodies) m.bodies.push_back(ball);
    return m;
  };
  Simulation by_blocks(model("block_lu"));
  const RunSummary r = by_blocks.run();
  ASSERT_EQ(r.end, RunEnd::finished) << r.message;
  EXPECT_LT(r.energy_drift, 1e-10);
  EXPECT_LT(r.linear_momentum_drift, 1e-12);
  EXPECT_LT(r.angular_momentum_drift, 1e-12);
  const auto last = static_cast<int>(by_blocks.model().bodies.size()) - 1;
  EXPECT_LT(by_blocks.body(last).v.z(), -3.5) << "the balls have collided";
  for (const char* solver : {"klu", "sparse_lu"}) {
    Simulation s(model(solver));
    ASSERT_EQ(s.run().end, RunEnd::finished);
    for (int b = 0; b <= last; ++b)
      EXPECT_LT((s.body(b).r - by_blocks.body(b).r).norm(), 1e-8) << solver << ", body " << b;
  }
}

TEST(CablePairs, TouchByGroupsAndExclusions) {
  const auto pairs = [](const std::string& of_one, const std::string& of_two,
                        const std::string& contacts) {
    Simulation s(io::read_model_text(format(R"(
format: 1
cables:
  one: {{through: [[ground, [-1, 0, 0]], [ground, [1, 0, 0]]], stiffness: 10 kN, mass_per_length: 0.05, elements: 4, contact: {{radius: 4 mm{}}}}}
  two: {{through: [[ground, [0, -1, 0.1]], [ground, [0, 1, 0.1]]], stiffness: 10 kN, mass_per_length: 0.05, elements: 5, contact: {{radius: 4 mm{}}}}}
contacts: {{{}}}
analysis: {{duration: 0.05, step: 0.5 ms}}
)",
                                            of_one, of_two, contacts),
                                     "groups.yaml"));
    return s.contact_map().surfaces.size();
  };
  EXPECT_EQ(pairs("", "", ""), 1U);
  EXPECT_EQ(pairs(", self: true", "", ""), 2U);
  EXPECT_EQ(pairs(", self: true", "", "exclude: [[one, one]]"), 1U);
  EXPECT_EQ(pairs(", self: true", ", self: true", "exclude: [[one, two]]"), 2U);
  EXPECT_EQ(pairs(", groups: [thin], meets: [thin]", "", ""), 0U);
  EXPECT_EQ(pairs(", touches: false, self: true", "", ""), 0U);
}

/// A rope in a loop, whose legs cross 30 mm apart, one thrown at the other.
/// @param more  Keys of its contact.
Model loop(double speed, double step, double duration, const std::string& law,
           const std::string& more) {
  std::vector<Vec3> path;
  for (int k = -11; k < 11; ++k) path.emplace_back(0.2 / 11 * k, 0.1 / 11 * k, 0.0);
  for (int k = 0; k <= 15; ++k) {
    const double turn = pi * k / 15;
    path.emplace_back(0.2 + 0.1 * std::sin(turn), 0.1 * std::cos(turn), 0.002 * k);
  }
  for (int k = 10; k >= -11; --k) path.emplace_back(0.2 / 11 * k, -0.1 / 11 * k, 0.03);
  double length = 0.0;
  for (std::size_t k = 1; k < path.size(); ++k) length += (path[k] - path[k - 1]).norm();
  Model model = io::read_model_text(
      format(R"(
format: 1
bodies:
  a: {{mass: 5e-3, inertia: [1e-6, 1e-6, 1e-6], position: [{0:.17g}, {1:.17g}, {2:.17g}]}}
  b: {{mass: 5e-3, inertia: [1e-6, 1e-6, 1e-6], position: [{3:.17g}, {4:.17g}, {5:.17g}]}}
cables:
  rope: {{through: [[a], [b]], stiffness: 2 kN, mass_per_length: 0.05, elements: {6}, free_length: {7:.17g},
         contact: {{radius: 4 mm{8}}}}}
contacts: {{default: {{{9}}}}}
analysis: {{duration: {10:g}, step: {11:g}}}
)",
             path.front().x(), path.front().y(), path.front().z(), path.back().x(), path.back().y(),
             path.back().z(), path.size() - 1, length, more, law, duration, step),
      "loop.yaml");
  const int first = model.body_index("rope.0");
  for (std::size_t k = 0; k < path.size(); ++k) {
    BodySpec& body = model.bodies[static_cast<std::size_t>(first) + k];
    body.position = path[k];
    if (k > path.size() / 2) body.velocity = Vec3(0.0, 0.0, -speed);
  }
  model.bodies[1].velocity = Vec3(0.0, 0.0, -speed);
  return model;
}

double height_of_strands(const Simulation& s, int pieces, int& crossings) {
  const std::vector<Vec3> x = line(s, "rope", pieces);
  const std::vector<Vec3> lower(x.begin(), x.begin() + 22), upper(x.end() - 22, x.end());
  return height_where_they_cross(upper, lower, crossings);
}

TEST(CablePairs, StrandsOfOneRopeDoNotPassEachOther) {
  for (const double speed : {3.0, 30.0}) {
    const double step = 3e-4 / speed;
    Simulation s(loop(speed, step, 0.06 / speed, "restitution: 1", ", self: true"));
    double least = 1.0;
    int crossed = 0, crossings = 0;
    const RunSummary r = s.run({}, [&](Simulation& now) {
      least = std::min(least, height_of_strands(now, 59, crossings));
      crossed += crossings > 0 ? 1 : 0;
    });
    ASSERT_EQ(r.end, RunEnd::finished) << r.message;
    EXPECT_GT(crossed, 100);
    EXPECT_GT(least, 2.0 * kRadius - 13e-3 * kRadius) << speed;
    EXPECT_GT(s.contact(0).impulse, 1e-3);
    EXPECT_LT(r.energy_drift, 1e-10) << speed;
    EXPECT_LT(r.linear_momentum_drift, 1e-12) << speed;
    EXPECT_LT(r.angular_momentum_drift, 1e-12) << speed;
    EXPECT_EQ(s.contact(0).force.norm(), 0.0) << "forces on itself have no resultant";
  }
  Simulation without(loop(3.0, 1e-4, 0.02, "restitution: 1", ""));
  double least = 1.0;
  int crossings = 0;
  ASSERT_EQ(without
                .run({},
                     [&](Simulation& now) {
                       least = std::min(least, height_of_strands(now, 59, crossings));
                     })
                .end,
            RunEnd::finished);
  EXPECT_LT(least, -1e-3) << "without contact it passes through";
}

TEST(CablePairs, ContinueFromACheckpointInTheSameBits) {
  for (const bool self : {false, true}) {
    const Model model =
        self ? loop(3.0, 1e-4, 0.03, "friction: 0.3, restitution: 0.5", ", self: true")
             : crossed(2e-4, 0.03, 3.0, 0.05, "friction: 0.3, restitution: 0.5");
    const Scratch folder;
    const std::string file = folder / "checkpoint.pst";
    Simulation straight(model);
    int touched = 0;
    const RunSummary r = straight.run({}, [&](Simulation& now) {
      if (now.contact(0).points > 0 && ++touched == 3)
        io::write_checkpoint(file, model, now.system(), now.state());
    });
    ASSERT_EQ(r.end, RunEnd::finished) << r.message;
    ASSERT_GT(touched, 3);
    EXPECT_GT(r.contacts->lost_by_friction, 0.0);
    EXPECT_GT(r.contacts->lost_in_impacts, 0.0);
    EXPECT_LT(r.energy_drift, 1e-9) << "the loss is in the energy balance";
    Simulation continued(model, io::read_checkpoint(file, model, straight.system()));
    EXPECT_LT(continued.time(), straight.time());
    ASSERT_EQ(continued.run().end, RunEnd::finished);
    EXPECT_EQ(continued.state_hash(), straight.state_hash()) << self;
  }
}

/// Three ropes from one hook at small angles, which overlap there, and one that ends where it
/// began: pieces near the hook are excluded from contact, and overlaps elsewhere are reported.
TEST(CablePairs, LeaveOutPiecesNearACommonAttachment) {
  Simulation s(io::read_model_text(R"(
format: 1
gravity: [0, 0, -9.81]
bodies:
  hook: {fixed: true}
  one: {mass: 0.1, inertia: [1e-4, 1e-4, 1e-4], position: [0, 0, -0.5]}
  two: {mass: 0.1, inertia: [1e-4, 1e-4, 1e-4], position: [0.06, 0, -0.5]}
  three: {mass: 0.1, inertia: [1e-4, 1e-4, 1e-4], position: [0, 0.05, -0.5]}
cables:
  first: {through: [[hook], [one]], stiffness: 10 kN, mass_per_length: 0.05, elements: 20, contact: {radius: 4 mm, self: true}}
  second: {through: [[hook], [two]], stiffness: 10 kN, mass_per_length: 0.05, elements: 20, contact: {radius: 4 mm}}
  third: {through: [[hook], [three]], stiffness: 10 kN, mass_per_length: 0.05, elements: 20, contact: {radius: 4 mm}}
contacts: {default: {friction: 0.2}}
analysis: {duration: 0.05, step: 0.5 ms}
)",
                                   "hook.yaml"));
  const RunSummary r = s.run();
  ASSERT_EQ(r.end, RunEnd::finished) << r.message;
  EXPECT_LT(r.energy_drift, 1e-9);
  EXPECT_LT(std::abs(s.body(s.model().body_index("first.1")).r.x()), 1e-3)
      << "no contact force acts on it";
  try {
    Simulation crossing(io::read_model_text(R"(
format: 1
cables:
  first: {through: [[ground, [-1, 0, 0]], [ground, [1, 0, 0]]], stiffness: 10 kN, mass_per_length: 0.05, elements: 4, contact: {radius: 4 mm}}
  second: {through: [[ground, [0, -1, 5 mm]], [ground, [0, 1, 5 mm]]], stiffness: 10 kN, mass_per_length: 0.05, elements: 5, contact: {radius: 4 mm}}
contacts: {}
analysis: {duration: 0.05, step: 0.5 ms}
)",
                                            "cross.yaml"));
    FAIL() << "overlaps";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("first in second by 0.003 m"), std::string::npos)
        << e.what();
  }
}

}  // namespace
}  // namespace polhode::test::cable_pairs_tests
