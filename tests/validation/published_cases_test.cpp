// SPDX-License-Identifier: Apache-2.0
// The published cases at the steps that a peer, Exudyn 1.11, was measured with on the same
// definitions (docs/validation.md says from where): our error against the reference, its bound from
// the step, and the peer's error at the same step.
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <support/published_cases.hpp>

namespace polhode::test {
namespace {

struct PeerStep {
  std::string name;
  PublishedCase published;
  double step, duration;
  double peer;  ///< Best figure of the peer's implicit integrators at this step.
  /// Bound on error/Δt², see bound().
  double constant;
  bool peer_ahead = false;  ///< The peer is better here; the reason is in docs/validation.md.
};

/// The bound: C Δt², where C is the phase error of a Cayley step, ∫|ω|³ dt/12 radians per Δt² over
/// the run, times the lever and how far the motion carries a phase error on. With ω from the
/// references:
///   A01   period 2.37 s, |ω| to 4.4: ∫|ω|³/12 = 26, 1 m              → 26 (amplitude too), 60
///   A02   a revolution in 1.95 s, |ω| to 6.7: ∫ω³/12 = 50 in 10 s, 1 m → 60; in 20 s 120
///   A03   crank to 1,900 rad/s: ∫β'³/12 = 9.2e5 to 0.03 s, 2.3e6 to 0.05 s → 1.2e6, 3e6
///   A04   |ω| to 1.6, with some motion per angle of 1 m                → 6
///   A05   the rods' turn about the shaft, 2π: the height moves by a few tenths of it → 30
///   HT    150 rad/s turn about the own axis, precession carries it: 0.15 of 2 s 150³/12... → 1500
///   SC3D  crank to 22 rad/s: ∫ω³/12 = 1100; 0.08 m lever                → 100
///   free  5 rad/s, 50 s: ∫ω³/12 = 520, an unstable axis carries on by e → 1000
std::vector<PeerStep> steps() {
  return {
      {"A01_0p8ms", planar_pendulum_case(), 8e-4, 10.0, 7.528e-5, 60.0},
      {"A01_1ms", planar_pendulum_case(), 1e-3, 10.0, 5.744e-5, 60.0},
      {"A01_0p1ms", planar_pendulum_case(), 1e-4, 10.0, 6.037e-7, 60.0},
      {"A02_N1_10ms", n_four_bar_case(1), 1e-2, 10.0, 0.0, 60.0},
      {"A02_N2_10ms", n_four_bar_case(2), 1e-2, 10.0, 1.912e-2, 60.0},
      {"A02_N2_1ms", n_four_bar_case(2), 1e-3, 10.0, 1.906e-4, 60.0},
      {"A02_N2_0p125ms", n_four_bar_case(2), 1.25e-4, 10.0, 2.529e-6, 60.0},
      {"A02_N10_10ms", n_four_bar_case(10), 1e-2, 10.0, 0.0, 60.0},
      {"A02_N40_1ms_10s", n_four_bar_case(40), 1e-3, 10.0, 1.888e-4, 60.0},
      {"A02_N40_1ms_20s", n_four_bar_case(40), 1e-3, 20.0, 3.972e-4, 120.0},
      {"A03_100us_30ms", andrews_case(), 1e-4, 0.03, 1.081e-2, 1.2e6},
      {"A03_10us_30ms", andrews_case(), 1e-5, 0.03, 4.504e-5, 1.2e6, true},
      {"A03_1us_30ms", andrews_case(), 1e-6, 0.03, 4.584e-6, 1.2e6},
      {"A03_100us_50ms", andrews_case(), 1e-4, 0.05, 2.708e-2, 3e6},
      {"A03_10us_50ms", andrews_case(), 1e-5, 0.05, 1.214e-4, 3e6, true},
      {"A03_1us_50ms", andrews_case(), 1e-6, 0.05, 5.113e-6, 3e6},
      {"A04_10ms", bricard_case(), 1e-2, 10.0, 5.241e-4, 6.0},
      {"A04_1ms", bricard_case(), 1e-3, 10.0, 3.662e-6, 6.0},
      {"A05_10ms", flyball_case(), 1e-2, 10.0, 3.234e-3, 30.0},
      {"A05_1ms", flyball_case(), 1e-3, 10.0, 3.24e-5, 30.0},
      {"A05_0p1ms", flyball_case(), 1e-4, 10.0, 3.225e-7, 30.0},
      {"HeavyTop_1ms", heavy_top_case(), 1e-3, 2.0, 4.734e-3, 1500.0},
      {"HeavyTop_0p1ms", heavy_top_case(), 1e-4, 2.0, 4.747e-5, 1500.0},
      {"SliderCrank_4ms", slider_crank_case(), 4e-3, 5.0, 7.312e-4, 100.0, true},
      {"SliderCrank_1ms", slider_crank_case(), 1e-3, 5.0, 3.281e-5, 100.0, true},
      {"SliderCrank_0p1ms", slider_crank_case(), 1e-4, 5.0, 4.589e-7, 100.0, true},
      {"FreeTop_1ms", asymmetric_top_case(), 1e-3, 50.0, 1.906e-3, 1000.0},
  };
}

class Published : public testing::TestWithParam<PeerStep> {};

TEST_P(Published, IsMetAtThePeersStep) {
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
    EXPECT_LE(d.largest, c.peer) << "the peer is better at this step";
  }
  EXPECT_LE(d.summary.energy_drift, 1e-10);
}

INSTANTIATE_TEST_SUITE_P(Cases, Published, testing::ValuesIn(steps()),
                         [](const auto& p) { return p.param.name; });

}  // namespace
}  // namespace polhode::test
