// SPDX-License-Identifier: Apache-2.0
// Friction and stops of joints against closed forms and event-based integration.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <support/model_builder.hpp>

namespace polhode::test::joint_friction_tests {
namespace {

constexpr double kG = 9.81;
const Vec3 kY = Vec3::UnitY();

/// A uniform rod of 1 kg and 1 m on a pin along y through its end, at an angle from hanging.
Model pendulum(double angle, double step) {
  ModelBuilder b;
  b.model.gravity = {0.0, 0.0, -kG};
  const Quat turned(Eigen::AngleAxisd(angle, kY));
  const int rod =
      b.body("rod", turned * Vec3(0.0, 0.0, -0.5), 1.0, Vec3(1.0 / 12.0, 1.0 / 12.0, 1e-3), turned);
  b.joint_along("pin", "revolute", kGround, rod, Vec3::Zero(), ModelBuilder::axes_about(kY));
  b.model.analysis.step = step;
  b.model.analysis.duration = 1.0;
  return b.model;
}

double angle_of(const Simulation& s) { return s.joint(0).coordinates[0]; }

double energy_of(const Simulation& s) { return s.balance().kinetic + s.balance().potential; }

/// Angles at which the rate changes its sign, from the angles before and after.
std::vector<double> turning_angles(Simulation& s, double start, double duration) {
  std::vector<double> list;
  double rate = 0.0;
  while (s.time() < duration && s.step(1e3).accepted) {
    const JointReport now = s.joint(0);
    if (rate * now.rates[0] < 0.0) list.push_back(start + now.coordinates[0]);
    rate = now.rates[0];
  }
  return list;
}

class PinFriction : public testing::TestWithParam<const char*> {};

// Reference: integration between the turning points, the couple from the pin's exact force.
// @tests{joint-friction-limit}
TEST_P(PinFriction, TurnsAndStopsThePendulumAtTheReferenceAngles) {
  Model m = pendulum(1.2, 2.5e-3);
  m.joints[0].friction = JointFrictionSpec{.mu = 0.3, .radius = 0.05, .stiffness = 1e4};
  m.analysis.solver = GetParam();
  Simulation s(m);
  const std::vector<double> turns = turning_angles(s, 1.2, 16.0);
  ASSERT_GE(turns.size(), 3U);
  EXPECT_NEAR(turns[0], -1.0956, 1e-3);
  EXPECT_NEAR(turns[1], 0.99926, 1e-3);
  EXPECT_NEAR(turns[2], -0.90952, 1e-3);
  const double held = 1.2 + angle_of(s);
  EXPECT_NEAR(std::abs(held), 0.0239, 1e-3);
  EXPECT_FALSE(s.joint(0).slips);
  while (s.time() < 18.0) ASSERT_TRUE(s.step(1e3).accepted);
  EXPECT_NEAR(1.2 + angle_of(s), held, 1e-7);
  EXPECT_LT(s.state().ledger.energy_drift, 1e-10);
}

/// The two pins of a universal joint: about either of them the pendulum swings as about that of a
/// revolute joint, while the other one sticks.
// @tests{joint-friction-limit}
TEST(UniversalFriction, ActsLikeAPinAboutEitherAxis) {
  for (const int pin : {0, 1}) {
    Model m = pendulum(1.2, 2.5e-3);
    m.joints.clear();
    ModelBuilder b;
    b.model = m;
    Mat3 R = Mat3::Identity();  // y of both sides is the pin
    if (pin == 0) R << 0, 0, 1, 1, 0, 0, 0, 1, 0;
    b.joint_along("cross", "universal", kGround, 0, Vec3::Zero(), R).friction =
        JointFrictionSpec{.mu = 0.3, .radius = 0.05, .stiffness = 1e4};
    Simulation s(b.model);
    std::vector<double> turns;
    double rate = 0.0;
    const auto k = static_cast<std::size_t>(pin);
    while (s.time() < 18.0) {
      ASSERT_TRUE(s.step(1e3).accepted);
      const JointReport now = s.joint(0);
      if (rate * now.rates[k] < 0.0) turns.push_back(1.2 + now.coordinates[k]);
      rate = now.rates[k];
      ASSERT_NEAR(now.coordinates[1 - k], 0.0, 1e-9) << "the other pin";
    }
    ASSERT_GE(turns.size(), 3U);
    EXPECT_NEAR(turns[0], -1.0956, 1e-3) << pin;
    EXPECT_NEAR(turns[1], 0.99926, 1e-3) << pin;
    EXPECT_NEAR(turns[2], -0.90952, 1e-3) << pin;
    EXPECT_NEAR(std::abs(1.2 + s.joint(0).coordinates[k]), 0.0239, 1e-3) << pin;
    EXPECT_FALSE(s.joint(0).slips);
    EXPECT_LT(s.state().ledger.energy_drift, 1e-10);
  }
}

/// A shaft that coasts about both pins at once, each with a constant friction moment: energy
/// decreases until both stick.
TEST(UniversalFriction, NeverRaisesTheEnergyAboutBothPins) {
  ModelBuilder b;
  const int rod = b.body("rod", {0.0, 0.0, -0.5}, 1.0, Vec3(0.1, 0.12, 0.02));
  b.turning(rod, {2.0, -1.5, 0.0});
  b.joint_along("cross", "universal", kGround, rod, Vec3::Zero(), Mat3::Identity()).friction =
      JointFrictionSpec{.mu = 0.2, .radius = 0.05, .length = 0.2, .constant = 0.1};
  b.model.gravity = {0.0, 0.0, -kG};
  b.model.analysis.step = 5e-3;
  b.model.analysis.duration = 1.0;
  Simulation s(b.model);
  double energy = energy_of(s);
  const double scale = s.balance().kinetic;
  while (s.time() < 12.0) {
    ASSERT_TRUE(s.step(1e3).accepted);
    ASSERT_LE(energy_of(s), energy + 1e-12 * scale);
    energy = energy_of(s);
  }
  EXPECT_LT(s.balance().kinetic, 1e-10 * scale);
  EXPECT_FALSE(s.joint(0).slips);
  EXPECT_LT(s.state().ledger.energy_drift, 1e-10 * scale);
}

INSTANTIATE_TEST_SUITE_P(Solvers, PinFriction,
                         testing::Values("tree", "block_lu", "klu", "sparse_lu"),
                         [](const auto& solver) { return std::string(solver.param); });

TEST(JointFriction, NeverRaisesTheEnergy) {
  Model m = pendulum(1.2, 5e-3);
  m.joints[0].friction = JointFrictionSpec{.mu = 0.3, .radius = 0.05};
  Simulation s(m);
  double energy = energy_of(s);
  const double scale = std::abs(energy);
  while (s.time() < 5.0) {
    ASSERT_TRUE(s.step(1e3).accepted);
    EXPECT_LE(energy_of(s), energy + 1e-12 * scale);
    energy = energy_of(s);
  }
}

TEST(JointLimits, ReflectThePendulumWithAllItsEnergy) {
  Model m = pendulum(1.2, 1e-2);
  m.joints[0].limits = JointLimitsSpec{.lower = -1.5, .restitution = 1.0, .band = 2e-3};
  Simulation s(m);
  const double start = energy_of(s);
  double least = 1.0;
  while (s.time() < 20.0) {
    ASSERT_TRUE(s.step(1e3).accepted);
    least = std::min(least, angle_of(s));
  }
  EXPECT_NEAR(energy_of(s), start, 1e-10 * 0.5 * kG);
  EXPECT_LT(least, -1.4989);
  EXPECT_GT(least, -1.501);  // the band's half
  EXPECT_LT(s.state().ledger.energy_drift, 1e-10 * 0.5 * kG);
}

// E(peak) = E(stop) + e² (E(start) − E(stop)).
// @tests{joint-stop-exit}
TEST(JointLimits, ReturnTheSpeedTimesTheRestitution) {
  for (const double e : {0.3, 0.5, 0.8})
    for (const double step : {5e-3, 2e-3}) {
      Model m = pendulum(0.6, step);
      m.joints[0].limits = JointLimitsSpec{.lower = -0.9, .restitution = e};
      Simulation s(m);
      const std::vector<double> turns = turning_angles(s, 0.6, 1.6);
      const auto height = [](double angle) { return 1.0 - std::cos(angle); };
      const double stop = 0.3;
      const double peak = std::acos(1.0 - (height(stop) + e * e * (height(0.6) - height(stop))));
      ASSERT_GE(turns.size(), 2U);
      EXPECT_NEAR(*std::max_element(turns.begin(), turns.end()), peak, 1e-3 * peak)
          << "e " << e << ", step " << step;
      EXPECT_LT(s.state().ledger.energy_drift, 1e-10);
    }
}

TEST(JointLimits, BringThePendulumToRestAtAStopWithoutRestitution) {
  Model m = pendulum(0.6, 5e-3);
  m.joints[0].limits = JointLimitsSpec{.lower = -0.3};  // 0.3 rad from hanging
  Simulation s(m);
  double energy = energy_of(s);
  const double scale = std::abs(energy);
  while (s.time() < 4.0) {
    ASSERT_TRUE(s.step(1e3).accepted);
    EXPECT_LE(energy_of(s), energy + 1e-12 * scale);
    energy = energy_of(s);
  }
  EXPECT_NEAR(angle_of(s), -0.3, 1e-3);
  EXPECT_NEAR(s.joint(0).rates[0], 0.0, 1e-6);
  // The stop holds the weight.
  EXPECT_NEAR(s.joint(0).stops[0], 0.5 * kG * std::sin(0.6 + angle_of(s)), 1e-6);
}

/// A block of 2 kg on a guide with a slope angle.
Model slider(double slope, double step) {
  ModelBuilder b;
  b.model.gravity = {0.0, 0.0, -kG};
  const int block = b.body("block", Vec3::Zero(), 2.0, Vec3(0.01, 0.02, 0.03));
  b.joint("guide", "prismatic", kGround, block, Vec3::Zero(),
          Vec3(std::cos(slope), 0.0, -std::sin(slope)));
  b.model.analysis.step = step;
  b.model.analysis.duration = 1.0;
  return b.model;
}

TEST(JointFriction, LetsASliderSlideByTheDifferenceOfTheForces) {
  const double slope = 0.5, mu = 0.3;
  Model m = slider(slope, 2e-3);
  m.joints[0].friction = JointFrictionSpec{.mu = mu};
  Simulation s(m);
  while (s.time() < 1.0 - 1e-9) ASSERT_TRUE(s.step(1e3).accepted);
  EXPECT_NEAR(angle_of(s), 0.5 * kG * (std::sin(slope) - mu * std::cos(slope)), 1e-4);
  EXPECT_TRUE(s.joint(0).slips);
  EXPECT_NEAR(s.joint(0).friction[0], -mu * 2.0 * kG * std::cos(slope), 1e-6);
}

TEST(JointFriction, HoldsASliderWithoutCreep) {
  const double mu = 0.5, slope = std::atan(0.9 * mu);
  Model m = slider(slope, 1e-2);
  m.joints[0].friction = JointFrictionSpec{.mu = mu};
  Simulation s(m);
  while (s.time() < 0.5) ASSERT_TRUE(s.step(1e3).accepted);
  const double held = angle_of(s);
  while (s.time() < 10.0) ASSERT_TRUE(s.step(1e3).accepted);
  EXPECT_NEAR(angle_of(s), held, 1e-9);
  EXPECT_LT(std::abs(held), 1e-5);
  EXPECT_FALSE(s.joint(0).slips);
  EXPECT_NEAR(s.joint(0).friction[0], -2.0 * kG * std::sin(slope), 1e-6);
}

TEST(JointLimits, BounceASliderOnItsStop) {
  const double e = 0.8;
  Model m = slider(0.5 * 3.14159265358979324, 5e-3);
  m.joints[0].limits = JointLimitsSpec{.upper = 1.0, .restitution = e, .band = 2e-4};
  Simulation s(m);
  std::vector<double> peaks;
  double rate = 0.0;
  while (s.time() < 3.0) {
    ASSERT_TRUE(s.step(1e3).accepted);
    const JointReport now = s.joint(0);
    if (rate < 0.0 && now.rates[0] > 0.0) peaks.push_back(1.0 - 1e-4 - now.coordinates[0]);
    rate = now.rates[0];
    ASSERT_LT(now.coordinates[0], 1.0 + 1e-4);
  }
  ASSERT_GE(peaks.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k)  // the peak lies within a step: g dt²/8
    EXPECT_NEAR(peaks[k], std::pow(e, 2.0 * (static_cast<double>(k) + 1.0)), 2e-4) << k;
}

// With I = m r² the direction of slip is constant: spin and slide stop together, after m √(v² +
// r²ω²)/F.
TEST(JointFriction, StopsASleeveAlongItsHelix) {
  ModelBuilder b;
  b.model.gravity.setZero();
  const double r = 0.1, F = 3.0;
  const int sleeve = b.body("sleeve", Vec3::Zero(), 2.0, Vec3(0.02, 0.02, 2.0 * r * r));
  b.joint("shaft", "cylindrical", kGround, sleeve, Vec3::Zero());
  b.at(sleeve).velocity = {0.0, 0.0, 0.6};
  b.at(sleeve).angular_velocity = {0.0, 0.0, 8.0};
  b.model.joints[0].friction = JointFrictionSpec{.radius = r, .constant = F};
  b.model.analysis.step = 2e-3;
  Simulation s(b.model);
  const double stop = 2.0 * 1.0 / F;
  while (s.time() < 0.5 * stop) ASSERT_TRUE(s.step(1e3).accepted);
  const double left = 1.0 - s.time() / stop;
  EXPECT_NEAR(s.joint(0).rates[0], 0.6 * left, 1e-3);
  EXPECT_NEAR(s.joint(0).rates[1], 8.0 * left, 1e-2);
  while (s.time() < 1.5 * stop) ASSERT_TRUE(s.step(1e3).accepted);
  EXPECT_NEAR(s.joint(0).coordinates[0], 0.5 * 0.6 * stop, 1e-3);
  EXPECT_NEAR(s.joint(0).coordinates[1], 0.5 * 8.0 * stop, 1e-2);
  EXPECT_NEAR(s.joint(0).rates[0], 0.0, 1e-6);
}

// A ball joint that spins about any axis slows down by M/I.
TEST(JointFriction, StopsABallThatSpins) {
  ModelBuilder b;
  b.model.gravity.setZero();
  const int ball = b.body("ball", Vec3::Zero(), 1.0, Vec3(0.1, 0.1, 0.1));
  b.joint("socket", "spherical", kGround, ball, Vec3::Zero());
  const Vec3 spin = 4.0 * Vec3(0.36, 0.48, 0.8);
  b.at(ball).angular_velocity = spin;
  b.model.joints[0].friction = JointFrictionSpec{.constant = 0.2};
  b.model.analysis.step = 2e-3;
  Simulation s(b.model);
  while (s.time() < 1.0 - 1e-9) ASSERT_TRUE(s.step(1e3).accepted);
  EXPECT_LT((s.system().motion(s.state(), ball).omega() - 0.5 * spin).norm(), 2e-3);
  while (s.time() < 2.2) ASSERT_TRUE(s.step(1e3).accepted);
  EXPECT_LT(s.system().motion(s.state(), ball).omega().norm(), 1e-5);
}

/// Two rods in the plane and out of it, with friction and stops in both hinges.
Model double_pendulum() {
  Model m = pendulum(1.2, 2e-3);
  BodySpec second = m.bodies[0];
  second.name = "second";
  const Vec3 end = 2.0 * second.position, axis = Vec3(0.3, 1.0, 0.2).normalized();
  second.position = end + Vec3(0.0, 0.0, -0.5);
  second.orientation = Quat::Identity();
  m.bodies.push_back(second);
  ModelBuilder b;
  b.model = m;
  b.joint("elbow", "revolute", 0, 1, end, axis);
  b.model.joints[0].friction = JointFrictionSpec{.mu = 0.2, .radius = 0.05, .length = 0.2};
  b.model.joints[1].friction =
      JointFrictionSpec{.mu = 0.3, .radius = 0.04, .face_radius = 0.05, .length = 0.3};
  b.model.joints[1].limits = JointLimitsSpec{.lower = -0.7, .upper = 0.8, .restitution = 0.5};
  return b.model;
}

TEST(JointFriction, IsTheSameWithEverySolver) {
  std::vector<double> expected;
  for (const char* solver : {"block_lu", "tree", "klu", "sparse_lu"}) {
    Model m = double_pendulum();
    m.analysis.solver = solver;
    Simulation s(m);
    while (s.time() < 1.0 - 1e-9) ASSERT_TRUE(s.step(1e3).accepted) << solver;
    const std::vector<double> now{s.joint(0).coordinates[0], s.joint(1).coordinates[0]};
    if (expected.empty()) expected = now;
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(now[i], expected[i], 1e-8) << solver;
    EXPECT_LT(s.state().ledger.energy_drift, 1e-10) << solver;
    EXPECT_LT(s.state().ledger.constraint_max, 1e-10) << solver;
  }
}

TEST(JointFriction, ContinuesAfterARestartBitForBit) {
  Simulation straight(double_pendulum());
  for (int k = 0; k < 150; ++k) ASSERT_TRUE(straight.step(1e3).accepted);
  Simulation again(double_pendulum(), straight.state());
  for (int k = 0; k < 150; ++k) {
    ASSERT_TRUE(straight.step(1e3).accepted);
    ASSERT_TRUE(again.step(1e3).accepted);
  }
  EXPECT_EQ(straight.state().history, again.state().history);
  EXPECT_EQ(straight.system().motion(straight.state(), 1).r,
            again.system().motion(again.state(), 1).r);
}

TEST(JointLimits, RefuseAStartOutside) {
  Model m = pendulum(0.6, 5e-3);
  m.joints[0].limits = JointLimitsSpec{.lower = 0.1};
  try {
    const Simulation s(m);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(e.where(), "joints.pin");
  }
}

}  // namespace
}  // namespace polhode::test::joint_friction_tests
