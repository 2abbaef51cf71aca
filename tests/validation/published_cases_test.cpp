// SPDX-License-Identifier: Apache-2.0
// The published cases at the steps of another program, Exudyn 1.11, on the same definitions
// (sources are in docs/validation.md): error of this program against the reference, its bound from
// the step, and the error of the other program at the same step.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <support/published_cases.hpp>

namespace polhode::test::published_cases_tests {
namespace {

struct PeerStep {
  std::string name;
  PublishedCase published;
  double step, duration;
  double peer;      ///< Smallest error of the other program's implicit integrators at this step.
  double constant;  ///< Bound on error/Δt², see below.
  bool peer_ahead =
      false;  ///< The other program is more accurate here; the reason is in docs/validation.md.
};

/// The bound C Δt²: twice the phase by which Cayley steps lag, ∫|ω|³ dt/12 per Δt², from the
/// references, times the lever of what is compared; twice, as the trapezoidal rule adds as much
/// again in the velocities.
///   A01   27 rad, 1 m                                     → 55
///   A02   60 rad to 10 s, 121 rad to 20 s, 1 m            → 121, 242
///   A03   6.9e5 rad to 0.03 s, 2.0e6 rad to 0.05 s, angles → 1.4e6, 4e6
///   A04   3.2 rad, 1 m                                    → 6.4
///   A05   148 rad, the height moves by 0.12 m             → 36
///   SC3D  928 rad; with dx/dφ of the slider at most 48 m  → 97
///   free  550 rad                                         → 1100
/// The heavy top's spin of 150 rad/s lags by 5.6e5 rad, which its centre does not see; there the
/// rate of the precession counts, and the bound is 1.5 times the constant found at 0.1 ms.
std::vector<PeerStep> steps() {
  return {
      {"A01_0p8ms", planar_pendulum_case(), 8e-4, 10.0, 7.528e-5, 55.0},
      {"A01_1ms", planar_pendulum_case(), 1e-3, 10.0, 5.744e-5, 55.0},
      {"A01_0p1ms", planar_pendulum_case(), 1e-4, 10.0, 6.037e-7, 55.0},
      {"A02_N1_10ms", n_four_bar_case(1), 1e-2, 10.0, 0.0, 121.0},
      {"A02_N2_10ms", n_four_bar_case(2), 1e-2, 10.0, 1.912e-2, 121.0},
      {"A02_N2_1ms", n_four_bar_case(2), 1e-3, 10.0, 1.906e-4, 121.0},
      {"A02_N2_0p125ms", n_four_bar_case(2), 1.25e-4, 10.0, 2.529e-6, 121.0},
      {"A02_N10_10ms", n_four_bar_case(10), 1e-2, 10.0, 0.0, 121.0},
      {"A02_N40_1ms_10s", n_four_bar_case(40), 1e-3, 10.0, 1.888e-4, 121.0},
      {"A02_N40_1ms_20s", n_four_bar_case(40), 1e-3, 20.0, 3.972e-4, 242.0},
      {"A03_100us_30ms", andrews_case(), 1e-4, 0.03, 1.081e-2, 1.4e6},
      {"A03_10us_30ms", andrews_case(), 1e-5, 0.03, 4.504e-5, 1.4e6, true},
      {"A03_1us_30ms", andrews_case(), 1e-6, 0.03, 4.584e-6, 1.4e6},
      {"A03_100us_50ms", andrews_case(), 1e-4, 0.05, 2.708e-2, 4e6},
      {"A03_10us_50ms", andrews_case(), 1e-5, 0.05, 1.214e-4, 4e6, true},
      {"A03_1us_50ms", andrews_case(), 1e-6, 0.05, 5.113e-6, 4e6},
      {"A04_10ms", bricard_case(), 1e-2, 10.0, 5.241e-4, 6.4},
      {"A04_1ms", bricard_case(), 1e-3, 10.0, 3.662e-6, 6.4},
      {"A05_10ms", flyball_case(), 1e-2, 10.0, 3.234e-3, 36.0},
      {"A05_1ms", flyball_case(), 1e-3, 10.0, 3.24e-5, 36.0},
      {"A05_0p1ms", flyball_case(), 1e-4, 10.0, 3.225e-7, 36.0},
      {"HeavyTop_1ms", heavy_top_case(), 1e-3, 2.0, 4.734e-3, 1280.0},
      {"HeavyTop_0p1ms", heavy_top_case(), 1e-4, 2.0, 4.747e-5, 1280.0},
      {"SliderCrank_4ms", slider_crank_case(), 4e-3, 5.0, 7.312e-4, 97.0, true},
      {"SliderCrank_1ms", slider_crank_case(), 1e-3, 5.0, 3.281e-5, 97.0, true},
      {"SliderCrank_0p1ms", slider_crank_case(), 1e-4, 5.0, 4.589e-7, 97.0, true},
      {"FreeTop_1ms", asymmetric_top_case(), 1e-3, 50.0, 1.906e-3, 1100.0},
  };
}

class Published : public testing::TestWithParam<PeerStep> {};

TEST_P(Published, IsReproducedAtThePeersStep) {
  const PeerStep& c = GetParam();
  Model model = c.published.model;
  model.analysis.step = c.step;
  const Deviation d =
      deviation_from(Reference::read(c.published.data), model, c.duration, c.published.observe);
  RecordProperty("largest", testing::PrintToString(d.largest));
  RecordProperty("at_end", testing::PrintToString(d.at_end));
  EXPECT_GE(d.samples, 50);
  EXPECT_EQ(d.summary.rejected_steps, 0);
  EXPECT_LE(d.largest, c.constant * c.step * c.step);
  if (c.peer > 0.0 && !c.peer_ahead) {
    EXPECT_LE(d.largest, c.peer) << "the other program is more accurate at this step";
  }
  EXPECT_LE(d.summary.energy_drift, 1e-10);
}

INSTANTIATE_TEST_SUITE_P(Cases, Published, testing::ValuesIn(steps()),
                         [](const auto& p) { return p.param.name; });

}  // namespace
}  // namespace polhode::test::published_cases_tests
