// SPDX-License-Identifier: Apache-2.0
// Prescribed motion of nodes: velocity of the drive, and reactions, energy and work at any step.
#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::prescribed_motion_tests {
namespace {

// 1 m long, 0.1 m square, pushed at its end along its axis. No lateral contraction, so that its
// elements are those of a bar.
std::string bar(const std::string& end, const std::string& more, const std::string& step,
                const std::string& duration, const std::string& analysis = "") {
  return R"(
format: 1
materials: {m: {type: elastic, youngs_modulus: 1 MPa, poisson_ratio: 0, density: 1000)" +
         more + R"(}}
solids:
  bar:
    mesh: {block: {size: [1, 0.1, 0.1], cells: [4, 1, 1]}, position: [0.5, 0, 0]}
    element: hex8_standard
    material: m
    prescribed:
      wall: {nodes: xmin, x: 0, y: 0, z: 0}
      end: {nodes: xmax, x: )" +
         end + R"(, y: 0, z: 0}
analysis: {type: dynamics, duration: )" +
         duration + ", step: " + step + analysis + R"(}
output: {hdf5: false}
)";
}

struct Seen {
  RunSummary summary;
  double force = 0.0, largest_speed = 0.0, kinetic = 0.0;
  std::array<Vec3, 2> reaction;  ///< Of wall and end, at the end of the run.
};

Seen run(const std::string& text) {
  Simulation s(io::read_model_text(text, "bar.yaml"));
  Seen seen;
  seen.summary = s.run();
  EXPECT_EQ(seen.summary.end, RunEnd::finished) << seen.summary.message;
  for (int k = 0; k < 2; ++k)
    seen.reaction[static_cast<std::size_t>(k)] = s.interface_reaction(0, k).force;
  for (const Vec3& v : s.solid(0).velocity)
    seen.largest_speed = std::max(seen.largest_speed, v.norm());
  seen.kinetic = s.balance().kinetic;
  return seen;
}

constexpr const char* kSteps[] = {"5 ms", "1 ms", "0.2 ms"};

// A ramp of 10 mm over 0.1 s, held from then on; the material damps waves within a second.
// @tests{prescribed-velocity} @tests{prescribed-kink}
TEST(PrescribedMotion, AViscousBarThatIsHeldAfterARampRests) {
  const std::string ramp = "{table: [[0, 0], [0.1, -0.01]], interpolation: linear}";
  for (const char* step : kSteps) {
    const Seen s = run(bar(ramp, ", viscosity: {relaxation_time: 5 ms}", step, "2 s"));
    EXPECT_LT(s.largest_speed, 1e-9) << step;
    EXPECT_LT(s.kinetic, 1e-15) << step;
    EXPECT_NEAR(s.reaction[1].x() + s.reaction[0].x(), 0.0, 1e-6) << step;
    // E A ε F with Green's strain ε = −0.00995 and F = 0.99.
    EXPECT_NEAR(s.reaction[1].x(), -98.505, 1e-6) << step;
    EXPECT_LT(s.summary.energy_drift, 1e-10) << step;
    EXPECT_LT(s.summary.linear_momentum_drift, 1e-10) << step;
    EXPECT_LT(s.summary.angular_momentum_drift, 1e-10) << step;
  }
}

// Drives by a sine, a table with kinks, a spline, jumps of acceleration or velocity: the supplied
// work is the energy of the model.
// @tests{prescribed-work}
TEST(PrescribedMotion, SuppliedWorkIsTheEnergyForAnyDrive) {
  for (const char* end :
       {"\"1e-2*sin(30*t)\"", "{table: [[0, 0], [0.13, 0.01], [0.37, -0.02], [0.5, 0]]}",
        "{table: [[0, 0], [0.13, 0.01], [0.37, -0.02], [0.5, 0]], interpolation: cubic}",
        "\"t < 0.25 ? 0.08*t^2 : 0.04*t - 0.005\"", "\"0.01*abs(sin(20*t))\""})
    for (const char* step : {"10 ms", "1 ms", "0.1 ms"}) {
      const Seen s = run(bar(end, "", step, "0.5 s"));
      EXPECT_LT(s.summary.energy_drift, 1e-10) << end << ' ' << step;
      EXPECT_LT(s.summary.linear_momentum_drift, 1e-10) << end << ' ' << step;
      EXPECT_LT(s.summary.angular_momentum_drift, 1e-10) << end << ' ' << step;
    }
}

// Velocities at the ends of the drive are its rates from the first step on.
TEST(PrescribedMotion, NodesMoveAtTheRateOfTheDrive) {
  for (const char* step : kSteps) {
    Simulation s(
        io::read_model_text(bar("\"0.01*sin(30*t) + 0.2*t\"", "", step, "0.2 s"), "bar.yaml"));
    int driven = -1;
    for (int i = 0; i < s.system().nodes().count(); ++i)
      if (std::abs(s.system().nodes()[i].position.x() - 1.0) < 1e-9) driven = i;
    ASSERT_GE(driven, 0);
    const auto look = [&](Simulation& now) {
      EXPECT_NEAR(now.solid(0).velocity[static_cast<std::size_t>(driven)].x(),
                  0.3 * std::cos(30.0 * now.time()) + 0.2, 1e-12)
          << step << ' ' << now.time();
    };
    s.run(look, look);
  }
}

// Order 2 of reaction and motion for a smooth drive, without a damper.
TEST(PrescribedMotion, ConvergesWithTheOrderOfTheMethod) {
  for (const int order : {2, 4, 6}) {
    std::vector<double> force;
    for (const char* step : {"8 ms", "4 ms", "2 ms", "1 ms"})
      force.push_back(
          run(bar("\"0.01*sin(5*t)^2\"", "", step, "0.4 s", ", order: " + std::to_string(order)))
              .reaction[1]
              .x());
    const double before = std::abs(force[2] - force[1]), after = std::abs(force[3] - force[2]);
    EXPECT_GT(std::log2(before / after), order - 0.4) << order << ' ' << before << ' ' << after;
  }
}

// The same at rho_inf < 1: fixed nodes are at rest, and the wave of the ramp is damped.
TEST(PrescribedMotion, HeldNodesRestWithNumericalDamping) {
  for (const char* rho : {"0", "0.5", "0.9"})
    for (const char* step : {"2 ms", "0.2 ms"}) {
      const Seen s = run(bar("{table: [[0, 0], [0.1, -0.01]], interpolation: linear}",
                             ", viscosity: {relaxation_time: 5 ms}", step, "2 s",
                             std::string(", rho_inf: ") + rho));
      EXPECT_LT(s.largest_speed, 1e-9) << rho << ' ' << step;
      EXPECT_NEAR(s.reaction[1].x(), -98.505, 1e-6) << rho << ' ' << step;
    }
}

}  // namespace
}  // namespace polhode::prescribed_motion_tests
