// SPDX-License-Identifier: Apache-2.0
// Drives and joints that contradict each other in statics: exit code 4, their names and the gap.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gmock/gmock.h>

#include <polhode/core/format.hpp>

#include "command_line.hpp"

namespace polhode::statics_gap_cli_tests {
namespace {

using test::CommandLine;
using testing::HasSubstr;

constexpr const char* kBar = R"(format: 1
gravity: [0, 0, -9.81]
bodies: {bar: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [0.5, 0, 0], motion: {MOTION}}}
joints: {hinge: {type: revolute, bodies: [ground, bar], at: [0, 0, 0], axis: y}}
)";
constexpr const char* kHand = R"(format: 1
gravity: [0, 0, -9.81]
bodies:
  bar: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [0.5, 0, 0]}
  hand: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [1, 0, 0], motion: {MOTION}}
joints:
  hinge: {type: revolute, bodies: [ground, bar], at: [0, 0, 0], axis: y}
  grip: {type: spherical, bodies: [bar, hand], at: [1, 0, 0]}
)";
constexpr const char* kSliderCrank = R"(format: 1
gravity: [0, 0, -9.81]
variables: {a: 0.5, b: asin(0.2*sin(0.5)/0.4), x: 0.2*cos(a) + 0.4*cos(b)}
bodies:
  crank: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [0.1*cos(a), 0, 0.1*sin(a)]}
  rod: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [0.2*cos(a) + 0.2*cos(b), 0, 0.1*sin(a)]}
  slider: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [x, 0, 0]}
joints:
  pivot: {type: revolute, bodies: [ground, crank], at: [0, 0, 0], axis: y}
  elbow: {type: revolute, bodies: [crank, rod], at: [0.2*cos(a), 0, 0.2*sin(a)], axis: y}
  wrist: {type: spherical, bodies: [rod, slider], at: [x, 0, 0]}
  guide: {type: prismatic, bodies: [ground, slider], at: [0, 0, 0], axis: x}
loads: {drive: {type: linear_motor, joint: guide, MOTION}}
)";
constexpr const char* kLink = R"(format: 1
bodies:
  a: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [0, 0, 0], motion: {x: 0, y: 0, z: 0}}
  b: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [1, 0, 0], motion: {MOTION}}
joints: {link: {type: distance, bodies: [a, b], at: [[0, 0, 0], [1, 0, 0]]}}
)";

/// What cannot hold, and what it leaves.
struct Impossible {
  const char* model;
  std::string motion, names, drive;
  double from;                   ///< Load factor up to which it holds.
  double (*gap)(double factor);  ///< At a load factor [m].
};

/// Reach of the stretched slider-crank, and its slider at the start [m].
double start_of_slider() {
  const double a = 0.5, b = std::asin(0.2 * std::sin(a) / 0.4);
  return 0.2 * std::cos(a) + 0.4 * std::cos(b);
}
constexpr double kReach = 0.6, kWay = 0.2;

const Impossible kCases[] = {
    {kBar, "x: 0.1", "joint 'bar.motion', joint 'hinge'", "joint 'bar.motion'", 0.0,
     [](double s) { return 0.1 * s; }},
    {kBar, "x: 0, z: -0.2", "joint 'bar.motion', joint 'hinge'", "joint 'bar.motion'", 0.0,
     [](double s) { return std::hypot(0.5, 0.2 * s) - 0.5; }},
    {kHand, "x: -0.3, y: 0, z: -0.2", "joint 'hand.motion', joint 'hinge', joint 'grip'",
     "joint 'hand.motion'", 0.0, [](double s) { return 1.0 - std::hypot(1.0 - 0.3 * s, 0.2 * s); }},
    {kSliderCrank, "displacement: 0.2",
     "joint 'pivot', joint 'elbow', joint 'wrist', linear_motor 'drive'", "linear_motor 'drive'",
     (kReach - start_of_slider()) / kWay,
     [](double s) { return start_of_slider() + kWay * s - kReach; }},
    {kLink, "x: 0.1, y: 0, z: 0.3", "joint 'a.motion', joint 'b.motion', joint 'link'",
     "joint 'a.motion'", 0.0, [](double s) { return std::hypot(1.0 + 0.1 * s, 0.3 * s) - 1.0; }},
};

// @tests{statics-gap}
TEST_F(CommandLine, NamesWhatCannotHoldInStaticsAndTheGap) {
  for (const Impossible& c : kCases)
    for (const int steps : {1, 10, 100}) {
      std::string model = c.model;
      model.replace(model.find("MOTION"), 6, c.motion);
      write("gap.yaml", model + format("analysis: {{type: statics, load_steps: {}}}\n", steps));
      const auto result = run({"run", "gap.yaml", "-o", "r", "--quiet"});
      const std::string where = format("{}, {} load steps: {}", c.names, steps, result.err);
      EXPECT_EQ(result.code, 4) << where;
      double from = -1.0, factor = -1.0, gap = -1.0;
      EXPECT_EQ(
          std::sscanf(result.err.c_str(), "No equilibrium was found beyond load factor %lf", &from),
          1);
      const std::size_t at = result.err.find("; at load factor ");
      ASSERT_NE(at, std::string::npos) << where;
      ASSERT_EQ(std::sscanf(result.err.c_str() + at, "; at load factor %lf a gap of %lf m remains",
                            &factor, &gap),
                2)
          << where;
      // The last load step tried is longer than 1e-4, and at most four times that.
      EXPECT_LE(from, c.from + 1e-6) << where;
      EXPECT_GE(from, c.from - 4e-4) << where;
      EXPECT_NEAR(factor, std::min(1.0, from + 1.0 / steps), 1e-5) << where;
      EXPECT_NEAR(gap, c.gap(factor), 0.05 * c.gap(factor)) << where;  // two figures
      EXPECT_THAT(result.err, HasSubstr("these cannot all hold: " + c.names + "; at load"));
      EXPECT_THAT(result.err, HasSubstr("m remains at " + c.drive +
                                        ". Remove one of them, or change its motion."));
      if (c.model == kLink) {  // what nothing holds is named whatever else fails
        EXPECT_THAT(result.err, HasSubstr(" Free motion: the whole model rotates about x; body"));
      }
    }
}

// Before the run: the load factor is that of the end of the reach, to a hundredth of the load.
// @tests{statics-gap}
TEST_F(CommandLine, ChecksTheReachOfDrivesBeforeAStaticRun) {
  for (const Impossible& c : kCases) {
    std::string model = c.model;
    model.replace(model.find("MOTION"), 6, c.motion);
    write("gap.yaml", model + "analysis: {type: statics}\n");
    const auto result = run({"check", "gap.yaml"});
    EXPECT_EQ(result.code, 0) << result.err;
    const std::size_t at = result.err.find("Beyond load factor ");
    ASSERT_NE(at, std::string::npos) << result.err;
    double from = -1.0, gap = -1.0;
    ASSERT_EQ(std::sscanf(result.err.c_str() + at, "Beyond load factor %lf", &from), 1);
    EXPECT_LE(from, c.from + 1e-3) << c.names;  // three figures
    EXPECT_GE(from, c.from - 0.01 - 1e-3) << c.names;
    const std::size_t whole = result.err.find("; at the whole load a gap of ", at);
    ASSERT_NE(whole, std::string::npos) << result.err;
    ASSERT_EQ(
        std::sscanf(result.err.c_str() + whole, "; at the whole load a gap of %lf m remains", &gap),
        1);
    EXPECT_NEAR(gap, c.gap(1.0), 0.05 * c.gap(1.0)) << c.names;
    EXPECT_THAT(result.err, HasSubstr("these cannot all hold: " + c.names + "; at the whole load"));
    EXPECT_THAT(result.err, HasSubstr("m remains at " + c.drive + ". Remove one of them"));
  }
  // A crank that turns three times takes its slider along; a bar follows its circle.
  std::string crank = kSliderCrank, bar = kBar;
  crank.replace(crank.find("linear_motor, joint: guide, MOTION"), 34,
                "rotary_motor, joint: pivot, angle: 6*pi");
  bar.replace(bar.find("MOTION"), 6, "z: -0.3");
  for (const std::string& model : {crank, bar}) {
    write("holds.yaml", model + "analysis: {type: statics}\n");
    EXPECT_THAT(run({"check", "holds.yaml"}).err, testing::Not(HasSubstr("Beyond load factor")));
  }
}

// What the drives ask for can be done: the message is not about them.
TEST_F(CommandLine, NamesNoGapInStaticsWhereTheDrivesCanHold) {
  for (const int steps : {1, 10, 100}) {
    std::string model = kBar;
    model.replace(model.find("MOTION"), 6, "z: -0.3");
    write("gap.yaml", model + format("analysis: {{type: statics, load_steps: {}}}\n", steps));
    EXPECT_EQ(run({"run", "gap.yaml", "-o", "r", "--quiet"}).code, 0) << steps;
  }
  // Nothing carries the second body.
  std::string model = kBar;
  model.replace(model.find("MOTION"), 6, "z: -0.3");
  model.replace(model.find("}}}\njoints"), 3, "}}, lost: {mass: 1, inertia: [1, 1, 1]}}");
  write("gap.yaml", model + "analysis: {type: statics}\n");
  const auto result = run({"run", "gap.yaml", "-o", "r", "--quiet"});
  EXPECT_EQ(result.code, 4);
  EXPECT_THAT(result.err, testing::Not(HasSubstr("cannot all hold"))) << result.err;
}

}  // namespace
}  // namespace polhode::statics_gap_cli_tests
