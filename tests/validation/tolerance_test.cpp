// SPDX-License-Identifier: Apache-2.0
// Automatic steps: analysis.tolerance alone chooses order and steps, and the error follows it.
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include <support/published_cases.hpp>

namespace polhode::test::tolerance_tests {
namespace {

struct ToleranceCase {
  std::string name;
  PublishedCase published;
  double duration;
};

std::vector<ToleranceCase> cases() {
  return {
      {"A01", planar_pendulum_case(), 10.0},
      {"A02N1", n_four_bar_case(1), 10.0},
      {"A03", andrews_case(), 0.03},
      {"A04", bricard_case(), 10.0},
      {"A05", flyball_case(), 10.0},
      {"HeavyTop", heavy_top_case(), 0.5},
      {"SliderCrank", slider_crank_case(), 5.0},
  };
}

class Tolerance : public testing::TestWithParam<std::tuple<ToleranceCase, double>> {};

/// The end of a run with automatic steps, compared with the reference. No output shortens a step.
Deviation end_of(const ToleranceCase& c, double tolerance, std::optional<int> order) {
  Reference reference = Reference::read(c.published.data);
  for (std::size_t i = 0; i < reference.t.size(); ++i)
    if (std::abs(reference.t[i] - c.duration) < 1e-9) {
      reference.t = {reference.t[i]};
      reference.values = {Vec(reference.values[i])};
    }
  if (reference.t.size() != 1) throw std::runtime_error("no sample at the end");
  Model model = c.published.model;
  model.analysis.tolerance = tolerance;
  model.analysis.order = order;
  return deviation_from(reference, model, c.duration, c.published.observe);
}

/// Requirements on step control: an error of at most 200 times the tolerance over these spans, in
/// metres or radians, and energy at round-off, within the bounds of conservation_test.cpp.
void expect_followed(const Deviation& d, double tolerance) {
  testing::Test::RecordProperty("error", testing::PrintToString(d.at_end));
  testing::Test::RecordProperty("steps", std::to_string(d.summary.steps));
  EXPECT_LE(d.at_end, 200.0 * tolerance);
  // By composition to round-off, by extrapolation to the accuracy of the run.
  const bool extrapolated = d.summary.scheme.ends_with("extrapolation");
  EXPECT_LE(d.summary.energy_drift, extrapolated ? tolerance : 1e-10);
}

TEST_P(Tolerance, BoundsTheErrorUpToAFactor) {
  const auto& [c, tolerance] = GetParam();
  const Deviation d = end_of(c, tolerance, {});
  const bool conserves = c.name != "A03" && c.name != "A05";
  EXPECT_EQ(d.summary.scheme,
            conserves ? "order 6 by composition" : "orders 4 to 12 by extrapolation");
  expect_followed(d, tolerance);
}

TEST_P(Tolerance, BoundsTheErrorAtOrderEight) {
  const auto& [c, tolerance] = GetParam();
  expect_followed(end_of(c, tolerance, 8), tolerance);
}

/// Bars that lie on one line twice in a turn, where rows become dependent and members of an
/// extrapolated step are known to 1e-11 at best: with smaller tolerances the run goes on and says
/// so.
TEST(ToleranceInSingularPositions, IsReachedOrSaidNotToBe) {
  for (const int cells : {2, 10, 40})
    for (const double tolerance : {1e-7, 1e-8, 1e-9, 1e-10}) {
      SCOPED_TRACE(testing::Message() << cells << " cells, tolerance " << tolerance);
      ToleranceCase c{"A02", n_four_bar_case(cells), 10.0};
      c.published.model.analysis.method = "extrapolation";
      const Deviation d = end_of(c, tolerance, {});
      EXPECT_EQ(d.summary.end, RunEnd::finished) << d.summary.message;
      EXPECT_LE(d.at_end, 200.0 * tolerance);
      ASSERT_TRUE(d.summary.errors.has_value());
      EXPECT_LE(d.at_end, d.summary.errors->sum);
      const bool said = std::any_of(
          d.summary.warnings.begin(), d.summary.warnings.end(),
          [](const std::string& text) { return text.find("was not reached") != text.npos; });
      EXPECT_EQ(said, d.summary.errors->largest > tolerance);
    }
}

INSTANTIATE_TEST_SUITE_P(Of, Tolerance,
                         testing::Combine(testing::ValuesIn(cases()),
                                          testing::Values(1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9,
                                                          1e-10)),
                         [](const auto& p) {
                           const int digits =
                               static_cast<int>(std::lround(-std::log10(std::get<1>(p.param))));
                           return std::get<0>(p.param).name + "_1em" + std::to_string(digits);
                         });

}  // namespace
}  // namespace polhode::test::tolerance_tests
