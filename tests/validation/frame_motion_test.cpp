// SPDX-License-Identifier: Apache-2.0
// Prescribed motion of bodies and of joints' frames: reactions of closed forms, balances, orders.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::frame_motion_tests {
namespace {

constexpr double kG = 9.81;

std::string shaken(const std::string& motion) {
  return R"yaml(
format: 1
gravity: [0, 0, -9.81]
variables: {h: 2 ms}
bodies:
  table:
    mass: 3
    inertia: [0.2, 0.3, 0.4]
    position: [1, 2, 3]
    orientation: {axis: [1, 2, 3], angle: 40 deg}
    motion: {)yaml" +
         motion + R"yaml(}
analysis: {type: dynamics, duration: 1 s, step: h}
output: {hdf5: false}
)yaml";
}

// A body whose whole motion is prescribed: position, rotation, and the reaction m (a + g), ḣ, with
// ḣ by differences of Λ J Λᵀ ω made with Eigen's rotations.
TEST(PrescribedMotion, HoldsABodyWithTheForcesOfItsMotion) {
  const std::string translation = "x: \"0.1*sin(9*t)\", y: \"t^2\", z: 0, ";
  const auto phi = [](double t) { return Vec3(std::sin(3.0 * t), t * t, 0.5 * t); };
  struct Case {
    const char* name;
    std::string rotation;
    Quat (*turn)(const Vec3&);
  };
  const Case cases[] = {
      {"vector", R"yaml(rotation_vector: ["sin(3*t)", "t^2", "t/2"])yaml",
       [](const Vec3& p) {
         const double angle = p.norm();
         return Quat(Eigen::AngleAxisd(angle, angle > 0.0 ? Vec3(p / angle) : Vec3::UnitX()));
       }},
      {"euler", R"yaml(euler: {sequence: zxz, angles: ["sin(3*t)", "t^2", "t/2"]})yaml",
       [](const Vec3& p) {
         return Quat(Eigen::AngleAxisd(p[0], Vec3::UnitZ()) *
                     Eigen::AngleAxisd(p[1], Vec3::UnitX()) *
                     Eigen::AngleAxisd(p[2], Vec3::UnitZ()));
       }},
      {"quaternion", R"yaml(quaternion: {w: 2, x: "sin(3*t)", y: "t^2", z: "t/2"})yaml",
       [](const Vec3& p) { return Quat(2.0, p[0], p[1], p[2]).normalized(); }}};
  const Quat start(
      Eigen::AngleAxisd(40.0 * 3.14159265358979323846 / 180.0, Vec3(1.0, 2.0, 3.0).normalized()));
  const Mat3 J = Vec3(0.2, 0.3, 0.4).asDiagonal();
  for (const Case& c : cases) {
    const auto placed = [&](double t) -> Mat3 {
      return (c.turn(phi(t)) * start).toRotationMatrix();
    };
    const auto h_of = [&](double t) -> Vec3 {
      constexpr double e = 1e-4;
      const Mat3 W = placed(t).transpose() * (placed(t + e) - placed(t - e)) / (2.0 * e);
      return placed(t) * (J * Vec3(W(2, 1), W(0, 2), W(1, 0)));
    };
    for (const char* step : {"50 ms", "2 ms", "0.5 ms"}) {
      Simulation s(io::read_model_text(shaken(translation + c.rotation), "table.yaml",
                                       {std::string("variables.h=") + step}));
      double worst_place = 0.0, worst_force = 0.0, worst_moment = 0.0;
      const auto look = [&](Simulation& now) {
        const double t = now.time();
        const BodyMotion body = now.body(0);
        const Vec3 at = Vec3(1.0 + 0.1 * std::sin(9.0 * t), 2.0 + t * t, 3.0);
        worst_place =
            std::max({worst_place, (body.r - at).norm(), (body.Lambda() - placed(t)).norm()});
        const JointReport joint = now.joint(0);
        const Vec3 force(-3.0 * 8.1 * std::sin(9.0 * t), 6.0, 3.0 * kG);
        worst_force = std::max(worst_force, (joint.force - force).norm());
        constexpr double e = 1e-3;
        if (t < e) return;
        const Vec3 moment = (h_of(t + e) - h_of(t - e)) / (2.0 * e);
        worst_moment = std::max(worst_moment, (joint.moment - moment).norm());
      };
      const RunSummary r = s.run(look);
      ASSERT_EQ(r.end, RunEnd::finished) << r.message;
      EXPECT_LT(worst_place, 1e-11) << c.name << ' ' << step;
      EXPECT_LT(worst_force, 1e-8) << c.name << ' ' << step;
      EXPECT_LT(worst_moment, 1e-4) << c.name << ' ' << step;  // of the differences
      EXPECT_LT(r.energy_drift, 1e-11) << c.name << ' ' << step;
      EXPECT_LT(r.linear_momentum_drift, 1e-10) << c.name << ' ' << step;
      EXPECT_LT(r.angular_momentum_drift, 1e-10) << c.name << ' ' << step;
      const double put_in = s.balance().put_in;
      EXPECT_NEAR(s.joint(0).work.front(), put_in, 1e-9 * std::abs(put_in))
          << c.name << ' ' << step;
    }
  }
}

// Part of the motion prescribed, the rest free: a ball thrown in x and z that follows y.
TEST(PrescribedMotion, LeavesFreeWhatIsNotGiven) {
  for (const char* step : {"50 ms", "0.5 ms"}) {
    Simulation s(io::read_model_text(
        R"yaml(
format: 1
gravity: [0, 0, -9.81]
variables: {h: 2 ms}
bodies:
  ball: {mass: 2, inertia: [1, 2, 3], position: [0, 1, 0], velocity: [3, 7, 5], angular_velocity: [0, 0, 4],
         motion: {y: "1 + sin(2*t)", measured_from: world
  }
}
analysis: {type: dynamics, duration: 1 s, step: h}
output: {hdf5: false}
)yaml",
        "ball.yaml", {std::string("variables.h=") + step}));
    const RunSummary r = s.run();
    ASSERT_EQ(r.end, RunEnd::finished) << r.message;
    const BodyMotion ball = s.body(0);
    EXPECT_NEAR(ball.r.x(), 3.0, 1e-11);
    EXPECT_NEAR(ball.r.y(), 1.0 + std::sin(2.0), 1e-12);
    EXPECT_NEAR(ball.r.z(), 5.0 - 0.5 * kG, 1e-11);
    EXPECT_NEAR(ball.omega().z(), 4.0, 1e-11);
    EXPECT_NEAR(s.joint(0).force.y(), -8.0 * std::sin(2.0), 1e-9);
    EXPECT_NEAR(s.joint(0).power.front(), -8.0 * std::sin(2.0) * 2.0 * std::cos(2.0), 1e-8);
  }
}

/// A free satellite that turns an antenna about a prescribed cone, with a pendulum on it.
constexpr const char* kSatellite = R"yaml(
format: 1
variables: {h: 20 ms, T: 2 s}
bodies:
  hull: {mass: 20, inertia: [3, 4, 5], position: [0, 0, 0], angular_velocity: [0.1, 0.3, 0.2]}
  antenna: {mass: 4, inertia: [0.3, 0.2, 0.1], position: [0.8, 0, 0]}
  bob: {mass: 1, inertia: [0.01, 0.01, 0.01], position: [1.4, 0, 0], velocity: [0, 0.5, 0.2]}
joints:
  drive:
    type: fixed
    bodies: [hull, antenna]
    at: [0.5, 0, 0]
    motion: {x: "0.1*sin(2*t)", euler: {sequence: zyx, angles: ["0.4*sin(3*t)", "0.3*(1-cos(3*t))", "t"]}}
  string: {type: spherical, bodies: [antenna, bob], at: [1.1, 0, 0]}
analysis: {type: dynamics, duration: T, step: h, order: 2}
output: {hdf5: false}
)yaml";

TEST(PrescribedMotion, BetweenFreeBodiesKeepsMomentaAndTheEnergyBalance) {
  for (const int order : {2, 4})
    for (const char* h : {"100 ms", "20 ms", "2 ms"}) {
      Simulation s(io::read_model_text(
          kSatellite, "satellite.yaml",
          {std::string("variables.h=") + h, "analysis.order=" + std::to_string(order)}));
      const RunSummary r = s.run();
      ASSERT_EQ(r.end, RunEnd::finished) << r.message;
      EXPECT_LT(r.energy_drift, 1e-11) << order << ' ' << h;
      EXPECT_LT(r.linear_momentum_drift, 1e-12) << order << ' ' << h;
      EXPECT_LT(r.angular_momentum_drift, 1e-12) << order << ' ' << h;
      EXPECT_LT(r.constraint_residual_max, 1e-11) << order << ' ' << h;
    }
}

TEST(PrescribedMotion, HasTheOrderOfTheMethod) {
  for (const int order : {2, 4, 6, 8}) {
    std::vector<Vec3> r;
    for (const char* h : {"40 ms", "20 ms", "10 ms"}) {
      Simulation s(io::read_model_text(
          kSatellite, "satellite.yaml",
          {std::string("variables.h=") + h, "analysis.order=" + std::to_string(order)}));
      const RunSummary run = s.run();
      ASSERT_EQ(run.end, RunEnd::finished) << run.message;
      r.push_back(s.body(2).r);
    }
    const double coarse = (r[0] - r[1]).norm(), fine = (r[1] - r[2]).norm();
    if (fine < 1e-13) continue;  // round-off
    EXPECT_GT(std::log2(coarse / fine), order - 0.6) << order << ": " << coarse << ' ' << fine;
  }
}

// A table's ramp: the body has the velocity of the slope from the kink on, and rests after the last
// one.
TEST(PrescribedMotion, HasTheVelocityOfTheDriveAfterKinks) {
  for (const char* h : {"30 ms", "2 ms", "0.2 ms"}) {
    Simulation s(io::read_model_text(
        R"yaml(
format: 1
gravity: [0, 0, -9.81]
variables: {h: 2 ms}
bodies:
  cart: {mass: 3, inertia: [1, 1, 1], motion: {x: {table: [[0, 0], [0.2, 0], [0.7, 1]], interpolation: linear}, y: 0, z: 0, rotation_vector: [0, 0, 0]}}
  bob: {mass: 1, inertia: [0.01, 0.01, 0.01], position: [0, 0, -0.5]}
joints: {string: {type: spherical, bodies: [cart, bob], at: [0, 0, 0]}}
analysis: {type: dynamics, duration: 1 s, step: h}
output: {hdf5: false}
)yaml",
        "cart.yaml", {std::string("variables.h=") + h}));
    const auto look = [&](Simulation& now) {
      const double t = now.time();
      if (std::abs(t - 0.2) < 1e-9 || std::abs(t - 0.7) < 1e-9) return;
      EXPECT_NEAR(now.body(0).v.x(), t > 0.2 && t < 0.7 ? 2.0 : 0.0, 1e-8) << h << ' ' << t;
    };
    const RunSummary r = s.run(look);
    ASSERT_EQ(r.end, RunEnd::finished) << r.message;
    EXPECT_LT(r.energy_drift, 1e-10) << h;
  }
}

// A spring of 100 N/m pulled by 0.3 m, and a bar turned by a torsional spring's angle.
TEST(PrescribedMotion, FollowsTheLoadFactorInStatics) {
  Simulation s(io::read_model_text(R"yaml(
format: 1
bodies:
  grip: {mass: 1, inertia: [1, 1, 1], position: [1, 0, 0], motion: {x: 0.3, y: 0, z: 0, rotation_vector: [0, 90 deg, 0]}}
loads: {spring: {type: spring_damper, bodies: [ground, grip], at: [[0, 0, 0], [1, 0, 0]], stiffness: 100}}
analysis: {type: statics}
output: {hdf5: false}
)yaml",
                                   "statics.yaml"));
  const RunSummary r = s.run();
  ASSERT_EQ(r.end, RunEnd::finished) << r.message;
  EXPECT_NEAR(s.body(0).r.x(), 1.3, 1e-12);
  EXPECT_LT(
      (s.body(0).Lambda() - Eigen::AngleAxisd(1.5707963267948966, Vec3::UnitY()).matrix()).norm(),
      1e-12);
  EXPECT_NEAR(s.joint(0).force.x(), 30.0, 1e-9);
}

TEST(PrescribedMotion, ReportsInvalidInput) {
  const auto refused = [](const std::string& motion, const std::string& what) {
    try {
      (void)io::read_model_text(shaken(motion), "table.yaml");
      ADD_FAILURE() << motion;
    } catch (const std::exception& e) {
      EXPECT_NE(std::string(e.what()).find(what), std::string::npos) << e.what();
    }
  };
  refused("measured_from: world", "nothing moves");
  refused("x: 0, rotation_vector: [0, 0, 0], euler: {sequence: zxz, angles: [0, 0, 0]}",
          "Give one");
  refused("euler: {sequence: zzx, angles: [0, 0, 0]}", "no Euler sequence");
  refused("quaternion: {w: 0, x: 0, y: 0, z: 0}", "zero at t = 0");
}

}  // namespace
}  // namespace polhode::frame_motion_tests
