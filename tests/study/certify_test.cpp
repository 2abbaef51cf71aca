// SPDX-License-Identifier: Apache-2.0
#include <polhode/study/certify.hpp>

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <polhode/core/error.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/study/certificate_picture.hpp>
#include <support/models.hpp>

namespace polhode::certify_tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Model swing(const std::string& analysis, const std::string& more = "") {
  return io::read_model_text(
      "format: 1\ntitle: Swing & <co>\ngravity: [0, 0, -9.81]\nbodies:\n"
      "  bar: {shape: {box: [1, 0.05, 0.05]}, density: 1000, position: [0.5, 0, 0]}\n"
      "joints:\n  A: {type: revolute, bodies: [ground, bar], at: [0, 0, 0], axis: y}\n"
      "analysis: {" +
          analysis + "}\n" + more,
      "swing.yaml");
}

const CertifiedQuantity& quantity(const Certificate& c, const std::string& name) {
  for (const CertifiedQuantity& q : c.quantities)
    if (q.name() == name) return q;
  throw std::runtime_error("no quantity " + name);
}

TEST(Certify, HalvesTheStepTwiceAndFindsTheOrder) {
  const Certificate c =
      certify(swing("duration: 2 s, step: 10 ms",
                    "output: {probes: {tip: {body: bar, point: [0.5, 0, 0]}, A: {joint: A}}}\n"));
  EXPECT_FALSE(c.automatic);
  EXPECT_TRUE(c.converges());
  EXPECT_THAT(c.orders, ElementsAre(2.0));
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(c.runs[k].setting, 0.01 / std::pow(2.0, k));
    EXPECT_EQ(c.runs[k].summary.steps, 200 << k);
  }
  std::vector<std::string> names;
  for (const CertifiedQuantity& q : c.quantities) names.push_back(q.name() + " [" + q.unit + "]");
  EXPECT_THAT(names,
              ElementsAre("tip x y z [m]", "tip vx vy vz [m/s]", "tip ax ay az [m/s^2]",
                          "A fx fy fz [N]", "A mx my mz [N m]", "A rz [rad]", "A rate rz [rad/s]"));
  for (const CertifiedQuantity& q : c.quantities) {
    EXPECT_EQ(q.series.t.size(), 201U);
    if (q.probe == "A" && q.columns[0] == "mx") continue;  // The hinge carries no moment.
    ASSERT_TRUE(q.report.order.has_value()) << q.name();
    EXPECT_NEAR(*q.report.order, 2.0, 0.1) << q.name();
    EXPECT_GT(q.report.largest_bar, 0.0);
    EXPECT_GT(q.report.largest_own, 10.0 * q.report.largest_bar);
  }
  EXPECT_TRUE(quantity(c, "A mx my mz").report.noise);
}

TEST(Certify, FindsOnlyRoundingErrorsInFreeFlight) {
  const Certificate c = certify(io::read_model_text(
      "format: 1\ngravity: [0, 0, -9.81]\nbodies:\n"
      "  stone: {mass: 1, inertia: [1, 1, 1], velocity: [3, 0, 4]}\n"
      "analysis: {duration: 1 s, step: 10 ms}\noutput: {probes: {p: {body: stone}}}\n",
      "stone.yaml"));
  EXPECT_TRUE(c.converges());
  for (const CertifiedQuantity& q : c.quantities) {
    EXPECT_TRUE(q.report.noise) << q.name();
    EXPECT_LE(q.report.largest_bar, 1e-10 * q.scale) << q.name();
  }
}

TEST(Certify, RefinesTheToleranceOfAutomaticSteps) {
  for (const char* output : {"", "output: {every: 0.5 s}\n", "output: {every: 1 ms}\n"}) {
    const Certificate c = certify(swing("duration: 2 s, tolerance: 1e-5", output));
    EXPECT_TRUE(c.automatic);
    EXPECT_TRUE(c.converges());
    EXPECT_THAT(c.orders, ElementsAre(6.0));
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(c.runs[k].setting, 1e-5 * std::pow(0.1, k), 1e-12);
    // Close output times do not prevent the tolerance from changing the steps.
    EXPECT_GT(c.runs[1].summary.steps, 1.1 * static_cast<double>(c.runs[0].summary.steps));
    EXPECT_GT(c.runs[2].summary.steps, 1.1 * static_cast<double>(c.runs[1].summary.steps));
    EXPECT_GT(quantity(c, "bar x y z").report.largest_own, 0.0);
  }
}

// A servo that reaches its limit: extrapolated steps end there, so that the run has its tolerance,
// and the bar of the model's own step is that of the results of its run. Reference by DOP853 with
// the instants of the limit located.
TEST(Certify, TheOwnStepIsThatOfTheRunAlsoByExtrapolation) {
  const Model model = io::read_model_text(R"(
format: 1
gravity: [0, 0, -9.81]
bodies: {b: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [0.5, 0, 0]}}
joints: {j: {type: revolute, bodies: [ground, b], at: [0, 0, 0], axis: y}}
loads:
  s: {type: rotary_servo, joint: j, angle: 0.5*sin(3*t), stiffness: 40, damping: 2, max_moment: 5}
analysis: {duration: 5, tolerance: 1e-6}
output: {every: 1, hdf5: false, probes: {j: {joint: j}}}
)",
                                          "servo.yaml", {});
  Simulation simulation(model);
  simulation.run();
  const double error = std::abs(simulation.joint("j").coordinates[0] - 0.78834571);
  EXPECT_LT(error, 1e-6);
  const Certificate c = certify(model);
  EXPECT_THAT(c.orders, ElementsAre(2.0));
  EXPECT_THAT(c.notes, testing::Contains(HasSubstr("by extrapolation")));
  EXPECT_GE(1.01 * quantity(c, "j rz").report.largest_own, error);
  EXPECT_LT(quantity(c, "j rz").report.largest_bar, 1e-7);
}

// The motion of a chaotic triple pendulum: two runs diverge within seconds.
TEST(Certify, TakesTheOrderOfAModelWithAContinuousController) {
  const Certificate c = certify(io::read_model_text(
      "format: 1\nbodies:\n  slider: {mass: 2, inertia: [1, 1, 1]}\n"
      "joints:\n  rail: {type: prismatic, bodies: [ground, slider], at: [0, 0, 0], axis: x}\n"
      "loads:\n  push: {type: joint_force, joint: rail, force: {controller: hold}}\n"
      "controllers:\n  hold: {joint: rail, channel: z, setpoint: '0.1*step(t, 0.4)', "
      "proportional: 800, derivative: 12}\n"
      "analysis: {duration: 1 s, tolerance: 1e-5}\noutput: {every: 0.1 s, probes: {p: {body: "
      "slider}}}\n",
      "slider.yaml"));
  EXPECT_TRUE(c.converges());
  for (const CertifiedQuantity& q : c.quantities)
    EXPECT_LE(q.report.largest_bar, 1e-3 * q.scale) << q.name();
}

TEST(Certify, ReportsWhenChaosEndsConvergence) {
  Model model = io::read_model_text(
      "format: 1\ngravity: [0, 0, -9.81]\nbodies:\n"
      "  a: {mass: 1, inertia: [0.01, 0.1, 0.1], position: [0.5, 0, 0]}\n"
      "  b: {mass: 1, inertia: [0.01, 0.1, 0.1], position: [1.5, 0, 0]}\n"
      "  c: {mass: 1, inertia: [0.01, 0.1, 0.1], position: [2.5, 0, 0]}\n"
      "joints:\n"
      "  A: {type: revolute, bodies: [ground, a], at: [0, 0, 0], axis: y}\n"
      "  B: {type: revolute, bodies: [a, b], at: [1, 0, 0], axis: y}\n"
      "  C: {type: revolute, bodies: [b, c], at: [2, 0, 0], axis: y}\n"
      "analysis: {duration: 40 s, step: 10 ms}\noutput: {probes: {tip: {body: c}}}\n",
      "triple.yaml");
  const Certificate c = certify(model);
  EXPECT_TRUE(c.finished());
  EXPECT_FALSE(c.converges());
  const ConvergenceReport& r = quantity(c, "tip x y z").report;
  ASSERT_TRUE(r.lost_from.has_value());
  EXPECT_GT(*r.lost_from, 1.0);
  EXPECT_LT(*r.lost_from, 30.0);
  EXPECT_TRUE(std::isinf(r.bar.back()));
  EXPECT_TRUE(std::isfinite(r.bar[50]));
  // The certified part: a run with a hundredth of the step lies within the bars.
  model.analysis.step = 0.1e-3;
  model.analysis.duration = *r.lost_from;
  Simulation fine(model);
  const CertifiedQuantity& q = quantity(c, "tip x y z");
  std::size_t next = 0, inside = 0, all = 0;
  const auto look = [&](Simulation& s) {
    if (next >= q.series.t.size() || std::abs(s.time() - q.series.t[next]) > 1e-9) return;
    const Vec3 x = s.point(2, Vec3::Zero()).position;
    const double error = (Vec3(q.series.values[2].row(static_cast<Eigen::Index>(next))) - x).norm();
    inside += error <= q.report.bar[next] ? 1 : 0;
    ++all;
    ++next;
  };
  look(fine);
  fine.run({}, look);
  EXPECT_GT(all, 100U);
  EXPECT_GE(static_cast<double>(inside), 0.95 * static_cast<double>(all));
}

TEST(Certify, ExpectsOrderOneWithImpacts) {
  const Certificate c = certify(
      io::read_model_text("format: 1\ngravity: [0, 0, -9.81]\nbodies:\n"
                          "  floor: {fixed: true, shape: {plane: z}}\n"
                          "  ball: {shape: {sphere: 0.1}, mass: 1, position: [0, 0, 0.5]}\n"
                          "contacts: {default: {restitution: 0.5}}\n"
                          "analysis: {duration: 1 s, step: 2 ms}\noutput: {probes: {p: {body: "
                          "ball}, c: {contact: [ball, floor]}}}\n",
                          "ball.yaml"));
  EXPECT_THAT(c.orders, ElementsAre(1.0, 2.0));
  EXPECT_TRUE(c.finished());
  const CertifiedQuantity& place = quantity(c, "p x y z");
  EXPECT_FALSE(place.report.lost_from.has_value());
  EXPECT_LT(place.report.largest_bar, 0.01 * place.scale);
  for (const CertifiedQuantity& q : c.quantities) EXPECT_NE(q.columns[0], "status");
}

TEST(Certify, ComparesMovingBodiesOfAModelWithoutProbes) {
  const Certificate c = certify(swing("duration: 0.2 s, step: 10 ms"));
  ASSERT_EQ(c.quantities.size(), 3U);
  EXPECT_EQ(c.quantities[0].name(), "bar x y z");
  EXPECT_THAT(c.notes, ElementsAre(HasSubstr("has no probes")));
  Model row = test::chain("revolute", 30, true);
  row.analysis.step = 0.01;
  row.analysis.duration = 0.05;
  EXPECT_THAT(certify(row).notes, ElementsAre(HasSubstr("the first 20 of 30 moving bodies")));
}

TEST(Certify, RefusesAnalysesWithoutTimeSteps) {
  const auto message = [](const Model& model) -> std::string {
    try {
      (void)certify(model);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  Model model = swing("duration: 1 s, step: 10 ms");
  model.analysis.type = "statics";
  EXPECT_EQ(message(model),
            "analysis.type: is statics, which takes no steps in time. Certify a model of type "
            "dynamics; refine a mesh by hand.");
  EXPECT_EQ(
      message(swing("duration: 1 s, tolerance: 1e-13")),
      "analysis.tolerance: is 1e-13; certify also runs with a hundredth of it, which is below the "
      "round-off. Write 1e-12 or more.");
  model = swing("duration: 1 s, step: 10 ms");
  model.bodies[0].fixed = true;
  model.joints.clear();
  EXPECT_THAT(message(model), HasSubstr("output.probes: are missing"));
}

TEST(Certify, StopsOnRequest) {
  std::atomic<bool> stop{false};
  CertifyHooks hooks;
  hooks.stop = &stop;
  hooks.step = [&](int run, Simulation& s) { stop = run == 1 && s.time() > 0.05; };
  const Certificate c = certify(swing("duration: 1 s, step: 10 ms"), hooks);
  EXPECT_FALSE(c.finished());
  EXPECT_EQ(c.runs[1].summary.end, RunEnd::interrupted);
  EXPECT_EQ(c.runs[2].summary.steps, 0);
  EXPECT_TRUE(c.quantities.empty());
}

TEST(Certify, ReportsARunThatDoesNotConverge) {
  Model model = swing("duration: 1 s, step: 10 ms");
  model.analysis.max_iterations = 1;
  model.analysis.min_step = 2e-3;
  const Certificate c = certify(model);
  EXPECT_FALSE(c.finished());
  EXPECT_EQ(c.runs[0].summary.end, RunEnd::not_converged);
  EXPECT_FALSE(c.runs[0].summary.message.empty());
}

TEST(CertificatePicture, ShowsEveryQuantity) {
  const Certificate c = certify(swing("duration: 1 s, step: 10 ms"));
  const std::string svg = certificate_svg(c);
  EXPECT_THAT(svg, testing::StartsWith("<svg xmlns="));
  EXPECT_THAT(svg, testing::EndsWith("</svg>\n"));
  EXPECT_THAT(svg, HasSubstr("Swing &amp; &lt;co&gt;"));
  EXPECT_THAT(svg, HasSubstr("bar vx vy vz [m/s]: order 2.0"));
  EXPECT_THAT(svg, testing::Not(HasSubstr("nan")));
  EXPECT_THAT(svg, testing::Not(HasSubstr("inf")));
  const auto count = [&](const std::string& what) {
    std::size_t n = 0;
    for (std::size_t at = svg.find(what); at != std::string::npos; at = svg.find(what, at + 1)) ++n;
    return n;
  };
  EXPECT_EQ(count("class=\"frame\""), 3U * 3U);
  EXPECT_EQ(count("<g "), count("</g>"));
}

}  // namespace
}  // namespace polhode::certify_tests
