// SPDX-License-Identifier: Apache-2.0
// Cams on cams in complete models.
#include <cmath>
#include <cstdio>
#include <string>

#include <gtest/gtest.h>

#include <support/convergence.hpp>
#include <validation/connector_runs.hpp>

namespace polhode::curve_on_curve_tests {

using namespace connectors;

namespace {

constexpr Step kAtSteps[] = {{"20 ms", 0.02}, {"2 ms", 0.002}, {"0.02 ms", 0.00002}};

std::string scene(const std::string& bodies, const std::string& joints, const std::string& loads,
                  const std::string& duration, const std::string& more = "") {
  return R"(
format: 1
variables: {h: 2 ms}
)" + more +
         "\nbodies:\n" + bodies + "\njoints:\n" + joints + "\nloads:\n" + loads +
         "\nanalysis: {type: dynamics, duration: " + duration +
         ", step: h}\noutput: {hdf5: false}\n";
}

// An eccentric disc, a circle of 60 mm about a point 20 mm off the shaft, under a flat follower.
constexpr double kE = 0.02, kR = 0.06, kOmega = 10.0;
constexpr const char* kDisc = "curve_x: 0.06*cos(s), curve_y: 0.02 + 0.06*sin(s)";

std::string flat_faced(const std::string& contact, const std::string& drive,
                       const std::string& duration) {
  return scene(R"(
  cam: {mass: 1, inertia: [0.01, 0.01, 0.02]}
  follower: {mass: 0.5, inertia: [0.01, 0.01, 0.01], position: [0, 80 mm, 0]})",
               R"(
  shaft: {type: revolute, bodies: [ground, cam], at: [0, 0, 0], axis: z}
  guide: {type: prismatic, bodies: [ground, follower], at: [0, 80 mm, 0], axis: y})",
               "  it: {type: curve_on_curve, " + contact +
                   "}\n  drive: {type: rotary_motor, joint: shaft, " + drive + "}",
               duration);
}
const std::string kOnFlat =
    std::string("bodies: [cam, follower], at: [[0, 0, 0], [0, 80 mm, 0]], ") + kDisc +
    ", other_points: [[-0.1, 0, 0], [0, 0, 0], [0.1, 0, 0]]";

// Two ellipses of semi-axes 5 and 4 cm turn about foci that are twice the long semi-axis apart. One
// begins at the angle kBegin from where its nearer end points along the line of centres.
constexpr double kLong = 0.05, kEps = 0.6, kBegin = 0.7;

/// Angle of the other ellipse, in the opposite direction.
double rolled(double theta) {
  return 2.0 * std::atan((1.0 - kEps) / (1.0 + kEps) * std::tan(0.5 * theta));
}

/// Model with frames in the foci, x along the long axes in their initial directions.
std::string ellipses(const std::string& drive, const std::string& duration) {
  const auto axis = [](double angle) {
    char text[96];
    std::snprintf(text, sizeof text, "[%.17g, %.17g, 0]", std::cos(angle), std::sin(angle));
    return std::string(text);
  };
  const std::string first = "curve_x: 0.05*cos(s) - 0.03, curve_y: 0.04*sin(s)";
  // Its far end touches the near end of the other one.
  const std::string second = "other_curve_x: 0.05*cos(s) - 0.03, other_curve_y: 0.04*sin(s)";
  return scene(R"(
  one: {mass: 1, inertia: [0.01, 0.01, 0.002], position: [0, 0, 0]}
  two: {mass: 1, inertia: [0.01, 0.01, 0.003], position: [0.1, 0, 0]})",
               R"(
  shaft: {type: revolute, bodies: [ground, one], at: [0, 0, 0], axis: z}
  other: {type: revolute, bodies: [ground, two], at: [0.1, 0, 0], axis: z})",
               "  it: {type: curve_on_curve, bodies: [one, two], at: [[0, 0, 0], [0.1, 0, 0]], "
               "x_axis: " +
                   axis(kBegin) + ", other_x_axis: " + axis(-rolled(kBegin)) + ", " + first + ", " +
                   second + "}\n  drive: {type: rotary_motor, joint: shaft, " + drive + "}",
               duration);
}

double turned(const BodyMotion& body) { return 2.0 * std::atan2(body.q.z(), body.q.w()); }

}  // namespace

// The lift is r + e cos θ, and the flat follower slides at ω times the lift. The circle may be on
// either side.
// @tests{curves-distance}
TEST(CurveOnCurve, LiftsAFlatFollowerByTheClosedForm) {
  const std::string other_way =
      "bodies: [follower, cam], at: [[0, 80 mm, 0], [0, 0, 0]], points: [[-0.1, 0, 0], [0, 0, 0], "
      "[0.1, 0, 0]], other_curve_x: 0.06*cos(s), other_curve_y: 0.02 + 0.06*sin(s)";
  for (const Step& step : kAtSteps) {
    const double T = step.h < 1e-4 ? 0.4 : 1.3, theta = kOmega * T;
    const std::string duration = std::to_string(T) + " s";
    const double lift = kR + kE * std::cos(theta);
    const Outcome o = run(flat_faced(kOnFlat, "speed: 10 rad/s", duration), {step_of(step)});
    EXPECT_NEAR(o.body(1).r.y(), lift, 1e-12) << step.text;
    EXPECT_NEAR(o.body(1).v.y(), -kOmega * kE * std::sin(theta), 1e-10) << step.text;
    EXPECT_LT(o.summary.energy_drift, 1e-11) << step.text;
    ASSERT_EQ(o.load.size(), 10U);
    EXPECT_NEAR(o.load[1], -0.5 * kOmega * kOmega * kE * std::cos(theta),
                1e-6 + 200.0 * step.h * step.h)
        << step.text;
    EXPECT_NEAR(o.load[5], o.load[1], 1e-12) << step.text;
    EXPECT_NEAR(o.load[6], -kOmega * lift, 1e-9) << step.text;
    EXPECT_NEAR(o.load[7], -kE * std::sin(theta), 1e-10) << step.text;
    EXPECT_NEAR(o.load[8], lift, 1e-12) << step.text;
    const Outcome p = run(flat_faced(other_way, "speed: 10 rad/s", duration), {step_of(step)});
    EXPECT_NEAR(p.body(1).r.y(), lift, 1e-12) << step.text;
    EXPECT_NEAR(p.load[1], -o.load[1], 1e-7 * std::abs(o.load[1])) << step.text;
    EXPECT_LT(p.summary.energy_drift, 1e-11) << step.text;
  }
}

// Elliptical gears: tan(θ₂/2) = (1 − ε)/(1 + ε)·tan(θ₁/2), and they roll on each other.
TEST(CurveOnCurve, TwoEllipsesRollAboutTheirFoci) {
  for (const Step& step : kAtSteps) {
    const double T = step.h < 1e-4 ? 0.02 : 0.18;
    const Outcome o = run(ellipses("speed: 10 rad/s", std::to_string(T) + " s"), {step_of(step)});
    const double theta = kBegin + kOmega * T;
    EXPECT_NEAR(turned(o.body(0)), kOmega * T, 1e-12) << step.text;
    EXPECT_NEAR(turned(o.body(1)), rolled(kBegin) - rolled(theta), 1e-12) << step.text;
    EXPECT_NEAR(o.load[6], 0.0, 1e-9) << step.text;
    const double near = kLong * (1.0 - kEps * kEps) / (1.0 + kEps * std::cos(theta));
    EXPECT_NEAR(o.load[7], near, 1e-11) << step.text;
    EXPECT_NEAR(o.load[8], 0.0, 1e-11) << step.text;
    EXPECT_LT(o.summary.energy_drift, 1e-11) << step.text;
  }
}

// Under a moment the energy of both is the supplied work. @tests{curves-gradient}
TEST(CurveOnCurve, TransmitsTheSuppliedWork) {
  for (const Step& step : kAtSteps) {
    const std::string duration = step.h < 1e-4 ? "0.2 s" : "0.8 s";
    const Outcome o = run(flat_faced(kOnFlat, "moment: 0.3 N*m", duration), {step_of(step)});
    EXPECT_LT(o.summary.energy_drift, 1e-11) << step.text;
    EXPECT_NEAR(o.body(1).r.y(), kR + kE * std::cos(turned(o.body(0))), 1e-12) << step.text;
    const Outcome e = run(ellipses("moment: 0.2 N*m", "0.1 s"), {step_of(step)});
    EXPECT_LT(e.summary.energy_drift, 1e-11) << step.text;
  }
}

TEST(CurveOnCurve, ConvergesWithEachOrder) {
  const auto at = [](int order, double h) {
    return run(
        flat_faced(kOnFlat, "moment: 0.3 N*m", "0.8 s"),
        {"variables.h=" + std::to_string(h) + " s", "analysis.order=" + std::to_string(order)});
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

// A disc with an eccentric centre of mass that falls around another one in a plane: the distance of
// the circles' centres is that of a rod, the sum of the radii or, within a ring, their difference.
TEST(CurveOnCurve, KeepsTheCentresOfTwoCirclesApart) {
  const auto at = [](bool rod, const std::string& contact, const std::string& h,
                     const std::string& duration) {
    return run(scene(R"(
  disc: {mass: 2, inertia: [0.01, 0.01, 0.02], position: [20 mm, 150 mm, 0], angular_velocity: [0, 0, 3]})",
                     std::string(R"(
  plane: {type: planar, bodies: [ground, disc], at: [0, 0, 0], axis: z})") +
                         (rod ? R"(
  rod: {type: distance, bodies: [ground, disc], at: [[0, 0, 0], [0, 150 mm, 0]]})"
                              : ""),
                     rod ? "  none: {type: force, body: disc, force: [0, 0, 0]}"
                         : "  it: {type: curve_on_curve, bodies: [ground, disc], at: [[0, 0, 0], "
                           "[0, 150 mm, 0]], " +
                               contact + "}",
                     duration, "gravity: [0, -9.81, 0]"),
               {"variables.h=" + h, "analysis.order=4"});
  };
  const std::string beside =
      "curve_x: 0.1*cos(s), curve_y: 0.1*sin(s), other_curve_x: 0.05*cos(s), other_curve_y: "
      "0.05*sin(s)";
  const std::string ring =
      "side: left, curve_x: 0.2*cos(s), curve_y: 0.2*sin(s), other_curve_x: 0.05*cos(s), "
      "other_curve_y: 0.05*sin(s)";
  const Outcome exact = at(true, "", "1 ms", "0.6 s");
  const Outcome exact_early = at(true, "", "0.1 ms", "0.06 s");
  for (const std::string& contact : {beside, ring})
    for (const Step& step : {Step{"10 ms", 0.01}, Step{"2 ms", 0.002}, Step{"0.02 ms", 0.00002}}) {
      const bool early = step.h < 1e-4;
      const Outcome o = at(false, contact, step.text, early ? "0.06 s" : "0.6 s");
      const Outcome& of_rod = early ? exact_early : exact;
      const BodyMotion& b = o.body(0);
      const Vec3 centre = b.r + b.q * Vec3(-0.02, 0.0, 0.0);
      EXPECT_NEAR(centre.norm(), 0.15, 1e-12) << step.text;
      const double h_4 = std::pow(step.h, 4);
      EXPECT_LT((b.r - of_rod.body(0).r).norm(), 1e-9 + 1e4 * h_4) << step.text;
      EXPECT_LT((b.v - of_rod.body(0).v).norm(), 1e-8 + 1e5 * h_4) << step.text;
      EXPECT_LT(o.summary.energy_drift, 1e-11) << step.text;
    }
}

TEST(CurveOnCurve, EndsWhereACurveEnds) {
  Simulation s(io::read_model_text(
      flat_faced("bodies: [cam, follower], at: [[0, 0, 0], [0, 80 mm, 0]], " + std::string(kDisc) +
                     ", other_points: [[-15 mm, 0, 0], [0, 0, 0], [15 mm, "
                     "0, 0]]",
                 "speed: 10 rad/s", "1 s"),
      "curves.yaml"));
  const RunSummary summary = s.run();
  EXPECT_EQ(summary.end, RunEnd::not_converged);
  EXPECT_NEAR(s.time(), std::asin(0.75) / kOmega, 0.004);
  EXPECT_NE(summary.message.find("the contact point of two curves reached an end"),
            std::string::npos)
      << summary.message;
}

namespace {

/// A curve that turns within a ring of 55 mm on a vertical guide.
std::string in_a_ring(const std::string& x, const std::string& y) {
  return scene(R"(
  cam: {mass: 1, inertia: [0.01, 0.01, 0.02]}
  ring: {mass: 0.5, inertia: [0.01, 0.01, 0.01], position: [0, -5 mm, 0]})",
               R"(
  shaft: {type: revolute, bodies: [ground, cam], at: [0, 0, 0], axis: z}
  guide: {type: prismatic, bodies: [ground, ring], at: [0, -5 mm, 0], axis: y})",
               "  it: {type: curve_on_curve, bodies: [ring, cam], at: [[0, -5 mm, 0], [0, 0, 0]], "
               "side: left, curve_x: 0.055*cos(s), curve_y: 0.055*sin(s), other_x_axis: y, "
               "other_curve_x: " +
                   x + ", other_curve_y: " + y +
                   "}\n  drive: {type: rotary_motor, joint: shaft, speed: -10 rad/s}",
               "0.3 s");
}

}  // namespace

// An ellipse of semi-axes a and b turns in a ring of radius R on a vertical guide. Where its radius
// of curvature reaches R at P, the ring's centre P − R n is on the guide at an angle in closed
// form; from there on the contact point would jump. @tests{curves-distance}
TEST(CurveOnCurve, EndsWhereCurvaturesAreEqual) {
  const double a = 0.05, b = 0.04, R = 0.055;
  const double slope_2 = std::pow(a * b * R, 2.0 / 3.0);  // |dP/ds|² there
  const double s = std::asin(std::sqrt((slope_2 - b * b) / (a * a - b * b)));
  const double x = a * std::cos(s) - R * b * std::cos(s) / std::sqrt(slope_2);
  const double y = b * std::sin(s) - R * a * std::sin(s) / std::sqrt(slope_2);
  // The centre starts at the polar angle π of the ellipse's axes and turns against the drive.
  const double fit = (std::atan2(y, x) + kPi) / kOmega;
  for (const Step& step : kAtSteps) {
    Simulation run(io::read_model_text(in_a_ring("0.05*cos(s)", "0.04*sin(s)"), "curves.yaml",
                                       {std::string("variables.h=") + step.text}));
    const RunSummary summary = run.run();
    EXPECT_EQ(summary.end, RunEnd::not_converged) << step.text;
    EXPECT_LE(run.time(), fit + 1e-5) << step.text;
    EXPECT_GT(run.time(), fit - 1.5 * step.h - 1e-4) << step.text;
    EXPECT_NE(summary.message.find("is not unique"), std::string::npos) << summary.message;
  }
}

// A disc as large as its ring touches it everywhere, from the start.
TEST(CurveOnCurve, DoesNotStartWhereCurvaturesAreEqual) {
  std::string message;
  try {
    Simulation run(
        io::read_model_text(in_a_ring("0.055*cos(s) - 0.005", "0.055*sin(s)"), "curves.yaml"));
    message = run.run().message;
    EXPECT_EQ(run.time(), 0.0);
  } catch (const std::exception& e) {
    message = e.what();
  }
  EXPECT_NE(message.find("is not unique"), std::string::npos) << message;
}

TEST(CurveOnCurve, ReportsInvalidCurves) {
  const auto message = [](const std::string& contact) {
    try {
      (void)io::read_model_text(
          flat_faced("bodies: [cam, follower], at: [[0, 0, 0], [0, 80 mm, 0]], " + contact,
                     "speed: 10 rad/s", "1 s"),
          "curves.yaml");
    } catch (const std::exception& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const auto expect = [&](const std::string& contact, const std::string& text) {
    EXPECT_NE(message(contact).find(text), std::string::npos) << message(contact);
  };
  const std::string disc = kDisc;
  expect(disc,
         "loads.it: 'other_points' is missing. Give other_points, or other_curve_x and "
         "other_curve_y.");
  expect(disc + ", other_curve_y: 0.1*s",
         "loads.it: 'other_curve_x' is missing. Give both coordinates of the curve.");
  expect(disc + ", other_points: [[0, 0, 0], [1, 0, 0]]",
         "loads.it.other_points: expects a list of at least three points");
  expect(
      disc + ", other_points: [[0, 0, 0], [1, 0, 0], [2, 0, 0]], other_x_axis: z",
      "loads.it.other_x_axis: is parallel to the axis. Give a direction transverse to the axis.");
}

}  // namespace polhode::curve_on_curve_tests
