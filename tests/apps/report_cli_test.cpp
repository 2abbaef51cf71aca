// SPDX-License-Identifier: Apache-2.0
// Reports of runs.
#include <gmock/gmock.h>

#include "command_line.hpp"

namespace polhode::report_cli_tests {
namespace {

using testing::HasSubstr;
using testing::Not;

using ReportCommand = test::CommandLine;

// A stone that rises for a second, slowed by gravity and pushed aside by a wind.
constexpr const char* kStone = R"(format: 1
title: Stone & <sky>
gravity: [0, 0, -10]
bodies: {stone: {mass: 2, inertia: [1, 1, 1], velocity: [0, 0, 15]}}
loads: {wind: {type: force, body: stone, force: ["6*t", 0, 0]}}
analysis: {duration: 1 s, step: STEP}
output: {probes: {height: {body: stone}}}
)";

std::string stone(const std::string& step) {
  std::string text = kStone;
  return text.replace(text.find("STEP"), 4, step);
}

/// The page holds the extremes of the closed form: height 10 m at the end, a speed from 15 to 5 m/s
/// with an RMS of sqrt(325/3) m/s, and a force with a mean of 3 N.
TEST_F(ReportCommand, HoldsExtremesOfTheClosedFormAtEveryStep) {
  for (const char* step : {"100 ms", "10 ms", "0.1 ms"}) {
    SCOPED_TRACE(step);
    write("stone.yaml", stone(step));
    ASSERT_EQ(run({"run", "stone.yaml", "--quiet", "-o", "out"}).code, 0);
    const test::ProgramResult done = run({"report", "out", "--no-picture"});
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_THAT(done.err, HasSubstr("report.html: "));
    EXPECT_THAT(done.err, HasSubstr(", 1 probes."));
    const std::string page = read("out/report.html");
    EXPECT_THAT(page, HasSubstr("<title>Stone &amp; &lt;sky&gt;</title>"));
    EXPECT_THAT(page, HasSubstr("<p class=\"yes\">Trusted: "));
    const auto row = [&](const std::string& name, const std::string& unit,
                         const std::string& numbers) {
      std::string text = "<tr><td>" + name + "</td><td>" + unit + "</td>";
      std::size_t at = 0;
      while (at <= numbers.size()) {
        const std::size_t end = std::min(numbers.find(' ', at), numbers.size());
        text += "<td class=\"n\">" + numbers.substr(at, end - at) + "</td>";
        at = end + 1;
      }
      return text;
    };
    EXPECT_THAT(page, HasSubstr(row("height.vz", "m/s", "5 1 15 0 10 10.408")));
    EXPECT_THAT(page, HasSubstr(row("loads.wind.force.x", "N", "0 0 6 1 3 3.4641")));
    EXPECT_THAT(page, HasSubstr(row("height.z", "m", "0 0 10 1")));
    EXPECT_THAT(page, HasSubstr("<td>energy put in [J]</td>"));
    EXPECT_THAT(page, HasSubstr("<svg"));
    EXPECT_THAT(page, HasSubstr("title: Stone &amp; &lt;sky&gt;"));
    EXPECT_THAT(page, Not(HasSubstr("http://127")));
    EXPECT_THAT(page, Not(HasSubstr("<script")));
    EXPECT_THAT(page, Not(HasSubstr("<img")));
  }
}

TEST_F(ReportCommand, WritesMarkdownWithPictures) {
  write("stone.yaml", stone("10 ms"));
  ASSERT_EQ(run({"run", "stone.yaml", "--quiet", "-o", "out"}).code, 0);
  ASSERT_EQ(run({"report", "out/results.h5", "--no-picture", "-o", "stone.md"}).code, 0);
  const std::string text = read("stone.md");
  EXPECT_THAT(text, HasSubstr("# Stone & \\<sky>\n\nTrusted: "));
  EXPECT_THAT(text, HasSubstr("| height.vz | m/s | 5 | 1 | 15 | 0 | 10 | 10.408 |"));
  EXPECT_THAT(text, HasSubstr("![height](stone_pictures/height.svg)"));
  EXPECT_THAT(text, HasSubstr("```yaml\nformat: 1\n"));
  EXPECT_THAT(read("stone_pictures/height.svg"), HasSubstr("<svg"));
  EXPECT_THAT(read("stone_pictures/energy.svg"), HasSubstr("kinetic"));
  const test::ProgramResult wrong = run({"report", "out", "-o", "stone.pdf"});
  EXPECT_EQ(wrong.code, 3);
  EXPECT_THAT(wrong.err,
              HasSubstr("'.pdf' is no kind of report. Name a file that ends with .html"));
}

/// A bar swings in the plane x, z and falls onto the stop of its hinge after 0.5 s: rows of
/// impulses are those of the run with the stop, and what is noise across the plane is 0.
TEST_F(ReportCommand, LeavesOutImpulsesThatThereAreNot) {
  const std::string bar = R"(format: 1
gravity: [0, 0, -9.81]
bodies: {bar: {shape: {box: [1, 0.1, 0.1]}, density: 1000, position: [0.5, 0, 0]}}
joints: {hinge: {type: revolute, bodies: [ground, bar], at: [0, 0, 0], axis: y, LIMITS}}
analysis: {duration: 1 s, step: 5 ms}
output: {probes: {hinge: {joint: hinge}}}
)";
  for (const bool stop : {false, true}) {
    std::string text = bar;
    text.replace(text.find(", LIMITS"), 8,
                 stop ? ", limits: {upper: 60 deg, restitution: 0.2}" : "");
    write("bar.yaml", text);
    ASSERT_EQ(run({"run", "bar.yaml", "--quiet", "-o", "out"}).code, 0);
    ASSERT_EQ(run({"report", "out", "--no-picture", "-o", "bar.md"}).code, 0);
    const std::string page = read("bar.md");
    const std::string tables = page.substr(0, page.find("## Model"));
    EXPECT_EQ(tables.find("impulse") != std::string::npos, stop);
    EXPECT_THAT(tables, HasSubstr("| joints.hinge.force.size | N |"));
    EXPECT_THAT(tables, Not(testing::ContainsRegex("e-[1-3][0-9][0-9]")));
  }
}

/// A run with long steps, whose kinematic momentum rate does not conserve energy, is not trusted:
/// the report says so and why, and gives the other warnings apart.
TEST_F(ReportCommand, SaysWhenARunIsNotTrusted) {
  write("top.yaml", R"(format: 1
bodies: {top: {mass: 1, inertia: [1, 2, 3], angular_velocity: [3, 0.1, 0.2]}}
analysis: {duration: 20 s, step: 0.5 s, momentum_rate: kinematic}
)");
  ASSERT_EQ(run({"run", "top.yaml", "--quiet", "-o", "out"}).code, 0);
  ASSERT_EQ(run({"report", "out", "--no-picture"}).code, 0);
  const std::string page = read("out/report.html");
  EXPECT_THAT(page, HasSubstr("<p class=\"no\">Not trusted:</p>"));
  EXPECT_THAT(page, HasSubstr("<li>the balance of energy does not close"));
  EXPECT_THAT(page, HasSubstr("<p>Warnings:</p>\n<ul>\n<li>the steps are too long"));
}

TEST_F(ReportCommand, IsLeftOutWithTheResultsOfARunThatIsRepeated) {
  write("stone.yaml", stone("10 ms"));
  ASSERT_EQ(run({"run", "stone.yaml", "--quiet", "-o", "out"}).code, 0);
  ASSERT_EQ(run({"report", "out", "--no-picture"}).code, 0);
  ASSERT_EQ(run({"run", "stone.yaml", "--quiet", "-o", "out"}).code, 0);
  EXPECT_FALSE(exists("out/report.html"));
  EXPECT_EQ(run({"report", "missing", "--no-picture"}).code, 5);
}

}  // namespace
}  // namespace polhode::report_cli_tests
