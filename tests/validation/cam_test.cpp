// SPDX-License-Identifier: Apache-2.0
// Cams and grooves in complete models.
#include <cmath>
#include <cstdio>
#include <string>

#include <gtest/gtest.h>

#include <support/convergence.hpp>
#include <validation/connector_runs.hpp>

namespace polhode::cam_tests {

using namespace connectors;

namespace {

/// An eccentric disc, a circle of 60 mm about a point 20 mm off the shaft, drives a roller of 15 mm
/// in a guide along y. The roller's centre is at e cos θ + √(r² − e² sin²θ), θ from the guide.
std::string eccentric(const std::string& curve, const std::string& drive) {
  return R"(
format: 1
variables: {h: 2 ms}
bodies:
  cam: {mass: 1, inertia: [0.01, 0.01, 0.02]}
  follower: {mass: 0.5, inertia: [0.01, 0.01, 0.01], position: [0, 95 mm, 0]}
joints:
  shaft: {type: revolute, bodies: [ground, cam], at: [0, 0, 0], axis: z}
  guide: {type: prismatic, bodies: [ground, follower], at: [0, 95 mm, 0], axis: y}
loads:
  it: {type: point_on_curve, bodies: [cam, follower], at: [[0, 0, 0], [0, 95 mm, 0]], )" +
         curve + R"(, roller_radius: 15 mm}
  drive: {type: rotary_motor, joint: shaft, )" +
         drive + R"(}
analysis: {type: dynamics, duration: 1.3 s, step: h}
output: {hdf5: false}
)";
}

constexpr const char* kCircle = "curve_x: 0.06*cos(s), curve_y: 0.02 + 0.06*sin(s)";
constexpr double kE = 0.02, kR = 0.075;

/// 48 points of the same circle, closed.
std::string points() {
  std::string list = "points: [";
  for (int i = 0; i <= 48; ++i) {
    const double s = 2.0 * kPi * (i % 48) / 48.0;
    char one[96];
    std::snprintf(one, sizeof one, "%s[%.15f, %.15f, 0]", i ? ", " : "", 0.06 * std::cos(s),
                  0.02 + 0.06 * std::sin(s));
    list += one;
  }
  return list + "]";
}

double lift(double theta) {
  return kE * std::cos(theta) + std::sqrt(kR * kR - kE * kE * std::pow(std::sin(theta), 2));
}

}  // namespace

// Ten rad/s for 1.3 s: two turns and more. Exact at the end of every step, a spline to its
// accuracy. @tests{curve-distance}
TEST(Cam, MovesItsFollowerByTheClosedForm) {
  for (const Step& step : kSteps) {
    const Outcome o = run(eccentric(kCircle, "speed: 10 rad/s"), {step_of(step)});
    EXPECT_NEAR(o.body(1).r.y(), lift(13.0), 1e-12) << step.text;
    EXPECT_LT(o.summary.energy_drift, 1e-11) << step.text;
    const double d = 1e-4;
    const double rate = 10.0 * (lift(13.0 + d) - lift(13.0 - d)) / (2.0 * d);
    const double second = 100.0 * (lift(13.0 + d) - 2.0 * lift(13.0) + lift(13.0 - d)) / (d * d);
    EXPECT_NEAR(o.body(1).v.y(), rate, 1e-6) << step.text;
    // The force of the cam along the guide is the follower's mass times its acceleration.
    EXPECT_NEAR(o.load[1], 0.5 * second, 1e-4 + 2000.0 * step.h * step.h) << step.text;
    const Outcome spline = run(eccentric(points(), "speed: 10 rad/s"), {step_of(step)});
    EXPECT_NEAR(spline.body(1).r.y(), lift(13.0), 1e-7) << step.text;
    EXPECT_LT(spline.summary.energy_drift, 1e-11) << step.text;
  }
}

// Under a moment the energy of cam and follower is the supplied work. @tests{curve-gradient}
TEST(Cam, TransmitsTheSuppliedWork) {
  for (const Step& step : kSteps) {
    const Outcome o = run(eccentric(kCircle, "moment: 0.3 N*m"), {step_of(step)});
    EXPECT_LT(o.summary.energy_drift, 1e-11) << step.text;
    const double theta = o.load.empty() ? 0.0 : 2.0 * std::atan2(o.body(0).q.z(), o.body(0).q.w());
    EXPECT_NEAR(o.body(1).r.y(), lift(theta), 1e-12) << step.text;
  }
}

TEST(Cam, ConvergesWithEachOrder) {
  const auto at = [](int order, double h) {
    return run(eccentric(kCircle, "moment: 0.3 N*m"),
               {"variables.h=" + std::to_string(h) + " s", "analysis.duration=0.8 s",
                "analysis.order=" + std::to_string(order)});
  };
  const Outcome exact = at(6, 0.002);
  for (const int order : {2, 4, 6})
    test::expect_order(
        [&](int n) {
          const Outcome o = at(order, 0.8 / n);
          return std::abs(o.body(1).r.y() - exact.body(1).r.y()) +
                 std::abs(o.body(0).W.z() - exact.body(0).W.z());
        },
        order == 6 ? std::vector<int>{20, 40} : std::vector<int>{40, 80}, order, 0.5,
        "order " + std::to_string(order));
}

// A bead in an elliptic groove: energy, reported speed, and its position in the plane.
TEST(Groove, GuidesABeadWithoutWork) {
  for (const Step& step : kSteps) {
    const Outcome o = run(R"(
format: 1
variables: {h: 2 ms}
gravity: [0, -9.81, 0]
bodies: {bead: {mass: 0.3, point_mass: true, position: [0.5, 0, 0], velocity: [0, 4, 0]}}
loads: {it: {type: point_on_curve, bodies: [ground, bead], at: [[0, 0, 0], [0.5, 0, 0]], curve_x: 0.5*cos(s), curve_y: 0.3*sin(s), holds: point}}
analysis: {type: dynamics, duration: 3 s, step: h}
output: {hdf5: false}
)",
                          {step_of(step)});
    const Vec3 r = o.body(0).r;
    EXPECT_NEAR(std::pow(r.x() / 0.5, 2) + std::pow(r.y() / 0.3, 2), 1.0, 1e-12) << step.text;
    EXPECT_EQ(r.z(), 0.0);
    EXPECT_LT(o.summary.energy_drift, 1e-11) << step.text;
  }
}

TEST(Groove, EndsWithAnOpenCurve) {
  Simulation s(io::read_model_text(R"(
format: 1
bodies: {bead: {mass: 0.3, point_mass: true, position: [0, 0, 0], velocity: [1, 0, 0]}}
loads: {it: {type: point_on_curve, bodies: [ground, bead], at: [[0, 0, 0], [0, 0, 0]], points: [[0, 0, 0], [0.2, 0.01, 0], [0.5, 0, 0]], holds: point}}
analysis: {type: dynamics, duration: 1 s, step: 5 ms}
output: {hdf5: false}
)",
                                   "groove.yaml"));
  const RunSummary summary = s.run();
  EXPECT_EQ(summary.end, RunEnd::not_converged);
  EXPECT_NE(summary.message.find("the point passed the end of the curve"), std::string::npos)
      << summary.message;
}

TEST(Groove, ReportsInvalidCurves) {
  const auto message = [](const std::string& curve) {
    try {
      (void)io::read_model_text(
          R"(
format: 1
bodies: {bead: {mass: 0.3, point_mass: true, position: [0, 0, 0]}}
loads: {it: {type: point_on_curve, bodies: [ground, bead], at: [[0, 0, 0], [0, 0, 0]])" +
              curve + "}}\nanalysis: {type: dynamics, duration: 1 s, step: 5 ms}\n",
          "groove.yaml");
    } catch (const std::exception& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const auto expect = [&](const std::string& curve, const std::string& text) {
    EXPECT_NE(message(curve).find(text), std::string::npos) << message(curve);
  };
  expect("", "loads.it: has no effect. Give one of: points, curve_x.");
  expect(", curve_x: 0.1*s", "loads.it: 'curve_y' is missing. Give both coordinates of the curve.");
  expect(", points: [[0, 0, 0], [1, 0, 0]]",
         "loads.it.points: expects a list of at least three points");
  expect(", points: [[0, 0, 0], [1, 0, 1], [2, 0, 0]]",
         "loads.it.points: leave the plane: z is not 0");
  expect(", points: [[0, 0, 0], [0, 0, 0], [2, 0, 0]]",
         "loads.it.points: give a point twice in a row");
}

}  // namespace polhode::cam_tests
