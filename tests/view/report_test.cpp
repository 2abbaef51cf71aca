// SPDX-License-Identifier: Apache-2.0
#include <polhode/view/report.hpp>

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

namespace polhode::report_tests {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// A sine over whole periods has mean zero and RMS 1/sqrt(2); samples that are not equally long do
/// not count by their number.
TEST(Report, MeansAreThoseOverTime) {
  double before = std::numeric_limits<double>::infinity();
  for (const int count : {40, 400, 40000}) {
    std::vector<double> t, values;
    for (int k = 0; k <= count; ++k) {
      const double part = static_cast<double>(k) / count;
      t.push_back(part * part);  // denser at the start
      values.push_back(std::sin(4.0 * std::numbers::pi * t.back()));
    }
    const Extremes e = extremes_of(t, values);
    const double step = 2.0 / count, allowed = 60.0 * step * step;
    EXPECT_NEAR(e.mean, 0.0, allowed);
    EXPECT_NEAR(e.rms, std::sqrt(0.5), allowed);
    EXPECT_NEAR(e.greatest, 1.0, allowed);
    EXPECT_NEAR(e.least, -1.0, allowed);
    EXPECT_NEAR(e.least_time, 0.375, step);
    const double error = std::abs(e.rms - std::sqrt(0.5));
    EXPECT_LT(error, before);
    before = error;
  }
}

TEST(Report, ExtremesAreTheFirstOfEqualValues) {
  const Extremes e = extremes_of({0.0, 1.0, 2.0, 3.0}, {1.0, 3.0, 3.0, 1.0});
  EXPECT_EQ(e.least, 1.0);
  EXPECT_EQ(e.least_time, 0.0);
  EXPECT_EQ(e.greatest, 3.0);
  EXPECT_EQ(e.greatest_time, 1.0);
  EXPECT_DOUBLE_EQ(e.mean, 7.0 / 3.0);
  EXPECT_DOUBLE_EQ(e.rms, std::sqrt((13.0 / 3.0 + 9.0 + 13.0 / 3.0) / 3.0));
}

TEST(Report, ValuesThatAreNotFiniteCountInNoMean) {
  const Extremes e = extremes_of({0.0, 1.0, 2.0, 3.0, 4.0}, {2.0, 2.0, kNone, 4.0, 4.0});
  EXPECT_EQ(e.least, 2.0);
  EXPECT_EQ(e.greatest, 4.0);
  EXPECT_EQ(e.greatest_time, 3.0);
  EXPECT_DOUBLE_EQ(e.mean, 3.0);
  const Extremes none = extremes_of({0.0, 1.0}, {kNone, kNone});
  EXPECT_TRUE(std::isnan(none.least) && std::isnan(none.mean) && std::isnan(none.rms));
  const Extremes one = extremes_of({5.0}, {-2.0});
  EXPECT_EQ(one.mean, -2.0);
  EXPECT_EQ(one.rms, 2.0);
  EXPECT_EQ(one.least_time, 5.0);
}

TEST(Report, VectorsHaveSizes) {
  const auto names = [](const std::vector<ChannelColumn>& columns) {
    std::string list;
    for (const ChannelColumn& c : columns) list += c.name + " ";
    return list;
  };
  const std::vector<ChannelColumn> of_probe = with_sizes({{"x", "m", {3.0}},
                                                          {"y", "m", {4.0}},
                                                          {"z", "m", {12.0}},
                                                          {"fx", "N", {1.0}},
                                                          {"fy", "N", {2.0}},
                                                          {"fz", "N", {2.0}},
                                                          {"power", "W", {9.0}}});
  EXPECT_EQ(names(of_probe), "x y z distance fx fy fz f.size power ");
  EXPECT_EQ(of_probe[3].values, std::vector<double>{13.0});
  EXPECT_EQ(of_probe[7].values, std::vector<double>{3.0});
  EXPECT_EQ(names(with_sizes({{"j.force.x", "N", {}},
                              {"j.force.y", "N", {}},
                              {"j.force.z", "N", {}},
                              {"j.angle", "rad", {}},
                              {"other.z", "m", {}}})),
            "j.force.x j.force.y j.force.z j.force.size j.angle other.z ");
  EXPECT_EQ(names(with_sizes(
                {{"impulse x", "N s", {}}, {"impulse y", "N s", {}}, {"impulse z", "N s", {}}})),
            "impulse x impulse y impulse z impulse.size ");
  EXPECT_EQ(names(with_sizes({{"ax", "m", {}}, {"by", "m", {}}, {"az", "m", {}}})), "ax by az ");
}

}  // namespace
}  // namespace polhode::report_tests
