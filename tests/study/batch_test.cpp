// SPDX-License-Identifier: Apache-2.0
#include <polhode/study/batch.hpp>

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation.hpp>
#include <support/paths.hpp>

namespace polhode::batch_tests {
namespace {

using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// A slider-crank with balls and a universal joint: a loop, three moving bodies.
Model slider_crank(const io::Overrides& overrides) {
  return io::read_model(test::source_dir() + "/examples/spatial_slider_crank/model.yaml",
                        overrides);
}

/// Slider-cranks whose masses and springs of gravity differ from run to run.
auto slider_cranks(const std::string& step, int order) {
  return [=](std::size_t run) {
    return slider_crank({"analysis.step=" + step, format("analysis.order={}", order),
                         "analysis.duration=0.5 s", "output.every=20 ms",
                         format("bodies.rod.mass={}", 0.4 + 0.01 * static_cast<double>(run)),
                         format("speed={} rad/s", 5.0 + 0.1 * static_cast<double>(run))});
  };
}

double number(const Batch& b, std::size_t channel, std::size_t run, std::size_t frame,
              std::size_t i = 0) {
  const Batch::Channel& c = b.channels[channel];
  return c.numbers[(run * b.times.size() + frame) * c.size + i];
}

/// Largest difference between the numbers of two batches of the same channels.
double difference(const Batch& a, const Batch& b) {
  double most = 0.0;
  for (std::size_t c = 0; c < a.channels.size(); ++c)
    for (std::size_t i = 0; i < a.channels[c].numbers.size(); ++i)
      most = std::max(most, std::abs(a.channels[c].numbers[i] - b.channels[c].numbers[i]));
  return most;
}

std::string free_body(double v, const std::string& step) {
  return format(
      "format: 1\ngravity: [0, 0, -9.81]\nbodies:\n"
      "  ball: {{shape: {{sphere: 0.1}}, density: 1000, velocity: [{:.17g}, 0, 2]}}\n"
      "analysis: {{duration: 1 s, step: {}}}\noutput: {{every: 100 ms}}\n",
      v, step);
}

TEST(Batch, FreeFlightIsTheParabolaOfEachRun) {
  for (const char* step : {"100 ms", "10 ms", "1 ms"}) {
    const Batch b = run_batch(
        [&](std::size_t run) {
          return io::read_model_text(free_body(0.5 * static_cast<double>(run), step), "ball.yaml");
        },
        40);
    EXPECT_THAT(b.why_alone, IsEmpty());
    ASSERT_EQ(b.times.size(), 11U);
    EXPECT_THAT(b.alone, Each(0));
    ASSERT_EQ(b.channels[0].text, "bodies.ball.position");
    for (std::size_t run = 0; run < 40; ++run)
      for (std::size_t k = 0; k < b.times.size(); ++k) {
        const double t = 0.1 * static_cast<double>(k);
        EXPECT_NEAR(b.times[k], t, 1e-15);
        EXPECT_NEAR(number(b, 0, run, k, 0), 0.5 * static_cast<double>(run) * t, 1e-12);
        EXPECT_NEAR(number(b, 0, run, k, 2), 2.0 * t - 0.5 * 9.81 * t * t, 1e-12);
      }
  }
}

TEST(Batch, RunsSideBySideAreThoseAloneToRounding) {
  struct Case {
    const char* step;
    int order;
  };
  for (const Case& c : {Case{"20 ms", 8}, Case{"5 ms", 6}, Case{"2 ms", 4}, Case{"0.2 ms", 2}}) {
    BatchOptions options;
    options.channels = {"bodies.slider.position", "bodies.rod.orientation", "joints.A.rz",
                        "joints.B.force"};
    const Batch together = run_batch(slider_cranks(c.step, c.order), 9, options);
    options.together = 1;
    const Batch alone = run_batch(slider_cranks(c.step, c.order), 9, options);
    EXPECT_THAT(together.messages, Each(IsEmpty()));
    EXPECT_THAT(together.alone, Each(0)) << c.step;
    EXPECT_THAT(alone.alone, Each(1));
    // Forces of some 10 N come from accelerations, which rounding of velocities enters over a step.
    EXPECT_LT(difference(together, alone), 1e-9) << c.step;
    EXPECT_GT(std::abs(number(together, 0, 0, 25) - number(together, 0, 8, 25)), 1e-4);
  }
}

TEST(Batch, RunsAloneHaveTheBitsOfASimulation) {
  BatchOptions options;
  options.channels = {"bodies.slider.position.x"};
  options.together = 1;
  const Batch b = run_batch(slider_cranks("5 ms", 4), 2, options);
  Simulation simulation(slider_cranks("5 ms", 4)(1));
  std::vector<double> x;
  (void)simulation.run([&](Simulation& s) { x.push_back(s.body("slider").r.x()); });
  ASSERT_EQ(x.size(), b.times.size());
  for (std::size_t k = 0; k < x.size(); ++k) EXPECT_EQ(number(b, 0, 1, k), x[k]);
}

TEST(Batch, NumbersDoNotDependOnThreads) {
  BatchOptions options;
  options.together = 4;
  const Batch one = run_batch(slider_cranks("5 ms", 4), 13, options);
  for (const int threads : {2, 3, 8}) {
    options.threads = threads;
    const Batch more = run_batch(slider_cranks("5 ms", 4), 13, options);
    for (std::size_t c = 0; c < one.channels.size(); ++c)
      EXPECT_EQ(one.channels[c].numbers, more.channels[c].numbers) << threads;
  }
}

TEST(Batch, ARunThatFailsDoesNotDisturbTheOthers) {
  // Pushed by the root of end − t: no number after that.
  const auto pushed = [](std::size_t run) {
    if (run == 5) throw InputError("bodies.ball", "is no ball", "Take another one");
    return io::read_model_text(
        format(
            "format: 1\nbodies:\n  ball: {{mass: 1, inertia: [1, 1, 1]}}\nloads:\n"
            "  push: {{type: force, body: ball, at: [0, 0, 0], force: [\"sqrt({} - t)\", 0, 0]}}\n"
            "analysis: {{duration: 0.5 s, step: 1 ms, order: 4}}\noutput: {{every: 50 ms}}\n",
            run == 3 ? 0.26 : 1.0 + 0.1 * static_cast<double>(run)),
        "ball.yaml");
  };
  const Batch b = run_batch(pushed, 8);
  for (std::size_t run = 0; run < 8; ++run) {
    const double end = 1.0 + 0.1 * static_cast<double>(run);
    if (run == 3 || run == 5) {
      EXPECT_TRUE(std::isnan(number(b, 0, run, 10)));
      EXPECT_THAT(b.messages[run],
                  HasSubstr(run == 3 ? "'push' is not a finite number at t = 0.26" : "is no ball"));
      EXPECT_EQ(std::isnan(number(b, 0, run, 5)), run == 5);
    } else {
      EXPECT_EQ(b.messages[run], "");
      // x'' = √(end − t): twice integrated.
      const double t = 0.5, x = 2.0 / 3.0 * std::pow(end, 1.5) * t -
                                4.0 / 15.0 * (std::pow(end, 2.5) - std::pow(end - t, 2.5));
      EXPECT_NEAR(number(b, 0, run, 10), x, 1e-11);
    }
  }
}

TEST(Batch, ARunOfAnotherMechanismGoesAlone) {
  const auto swing = [](std::size_t run) {
    return io::read_model_text(
        format("format: 1\ngravity: [0, 0, -9.81]\nbodies:\n"
               "  bar: {{shape: {{box: [1, 0.05, 0.05]}}, density: 1000, position: [0.5, 0, 0]}}\n"
               "joints:\n  A: {{type: {}, bodies: [ground, bar], at: [0, 0, 0]{}}}\n"
               "analysis: {{duration: 0.5 s, step: 5 ms}}\noutput: {{every: 50 ms}}\n",
               run == 2 ? "spherical" : "revolute", run == 2 ? "" : ", axis: y"),
        "swing.yaml");
  };
  const Batch b = run_batch(swing, 4);
  EXPECT_THAT(b.messages, Each(IsEmpty()));
  EXPECT_EQ(b.alone, (std::vector<unsigned char>{0, 0, 1, 0}));
  for (std::size_t k = 0; k < b.times.size(); ++k)  // both swing in the plane
    EXPECT_NEAR(number(b, 0, 2, k, 2), number(b, 0, 1, k, 2), 1e-9);
}

TEST(Batch, WhatCannotBeSideBySideRunsOneByOneAndSaysWhy) {
  const auto ball = [](const std::string& more) {
    return [more](std::size_t) {
      return io::read_model_text(
          "format: 1\ngravity: [0, 0, -9.81]\nbodies:\n"
          "  ball: {shape: {sphere: 0.1}, density: 1000, position: [0, 0, 1]}\n" +
              more,
          "ball.yaml");
    };
  };
  const Batch automatic =
      run_batch(ball("analysis: {duration: 0.3 s, tolerance: 1e-8}\noutput: {every: 0.1 s}\n"), 3);
  EXPECT_EQ(automatic.why_alone, "its steps are automatic: give analysis.step");
  EXPECT_THAT(automatic.alone, Each(1));
  EXPECT_NEAR(number(automatic, 0, 2, 3, 2), 1.0 - 0.5 * 9.81 * 0.09, 1e-7);
  const Batch contact =
      run_batch(ball("  floor: {fixed: true, shape: {plane: z}}\ncontacts: {default: {}}\n"
                     "analysis: {duration: 0.3 s, step: 1 ms}\noutput: {every: 0.1 s}\n"),
                2);
  EXPECT_EQ(contact.why_alone, "it has contacts");
  EXPECT_NEAR(number(contact, 0, 1, 3, 2), 1.0 - 0.5 * 9.81 * 0.09, 1e-9);
}

TEST(Batch, RefusesWhatHasNoCommonFrames) {
  const auto message = [](const std::string& analysis) {
    try {
      (void)run_batch(
          [&](std::size_t) {
            return io::read_model_text(
                "format: 1\nbodies:\n  ball: {shape: {sphere: 0.1}, density: 1000}\n" + analysis,
                "ball.yaml");
          },
          2);
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_THAT(message("analysis: {duration: 1 s, tolerance: 1e-6}\n"),
              HasSubstr("output.every: is not given, and steps are automatic"));
  EXPECT_THAT(message("analysis: {duration: 1 s, step: 3 ms}\noutput: {every: 10 ms}\n"),
              HasSubstr("Give a multiple of analysis.step"));
  EXPECT_THAT(message("analysis: {type: statics}\n"), HasSubstr("A batch needs type: dynamics"));
  EXPECT_THAT(message("analysis: {duration: none, step: 1 ms}\n"), Not(IsEmpty()));
  EXPECT_THROW((void)run_batch([](std::size_t) { return Model{}; }, 0), InputError);
}

TEST(Batch, StopsWhenAsked) {
  const std::atomic<bool> stop{true};
  BatchOptions options;
  options.stop = &stop;
  const Batch b = run_batch(slider_cranks("5 ms", 4), 5, options);
  EXPECT_TRUE(b.stopped);
  EXPECT_TRUE(std::isnan(number(b, 0, 4, 3)));
}

}  // namespace
}  // namespace polhode::batch_tests
