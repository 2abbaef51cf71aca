// SPDX-License-Identifier: Apache-2.0
// Weights of potentials that fade, and their difference quotients.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <polhode/contact/fading.hpp>

#include "support/random_steps.hpp"

namespace polhode::fading_tests {
namespace {

using namespace contact;
using namespace test;

struct Kind {
  std::string name;
  FeaturePair pair;
  double near;  ///< Cosine about which it fades.
};

std::vector<Kind> kinds() {
  const double aligned = std::cos(0.5), opposed = -std::cos(0.1);
  return {{"parallel", {GapKind::edge_edge, 0, 0, Fade::parallel}, 1.0},
          {"opposite", {GapKind::edge_edge, 0, 0, Fade::parallel}, -1.0},
          {"flat", {GapKind::point_solid, 0, 0, Fade::flat}, -1.0},
          {"aligned", {GapKind::point_solid, 0, 0, Fade::aligned}, 1.0},
          {"halves", {GapKind::rim_bar, 0, 0, Fade::parallel, 8e-3, 2e-3}, 1.0},
          {"whole", {GapKind::rim_edge, 4, 0, Fade::aligned, 8e-3, 2e-3}, -1.0},
          {"flank", {GapKind::round_edge, 0, 0, Fade::flank, 1e-3, 0.0, aligned, opposed}, aligned},
          {"flank_opposed",
           {GapKind::round_edge, 0, 0, Fade::flank, 1e-3, 0.0, aligned, opposed},
           opposed}};
}

/// A cosine near the one about which a kind fades.
double cosine(const Kind& kind, Random& random) {
  const double y =
      kind.near + (kind.pair.fade_square + kind.pair.fade_from) * random.vector(1.0).x();
  return std::clamp(y, -1.0, 1.0);
}

// @tests{contact-fading} @tests{contact-rim-fading}
TEST(Fading, HasTheQuotientOfItsDifference) {
  Random random(81);
  for (const Kind& kind : kinds())
    for (int trial = 0; trial < 400; ++trial) {
      const double y_0 = cosine(kind, random), y_1 = cosine(kind, random);
      const double change = fading(kind.pair, y_1) - fading(kind.pair, y_0);
      EXPECT_NEAR(fading_quotient(kind.pair, y_0, y_1) * (y_1 - y_0), change, 1e-12)
          << kind.name << " " << y_0 << " " << y_1;
      EXPECT_GE(fading(kind.pair, y_0), 0.0);
      EXPECT_LE(fading(kind.pair, y_0), 1.0);
    }
}

TEST(Fading, HasTheDerivativeOfItsQuotient) {
  Random random(82);
  for (const Kind& kind : kinds())
    for (int trial = 0; trial < 100; ++trial) {
      const double y_0 = cosine(kind, random), y_1 = cosine(kind, random), d = 1e-7;
      if (std::abs(y_1 - y_0) < 1e-5) continue;
      Dual y(y_1);
      y.d[0] = 1.0;
      const double by_differences =
          (fading_quotient(kind.pair, y_0, y_1 + d) - fading_quotient(kind.pair, y_0, y_1 - d)) /
          (2.0 * d);
      const double scale = std::abs(fading_quotient(kind.pair, y_0, y_1)) / 1e-4 + 1e4;
      EXPECT_NEAR(fading_quotient(kind.pair, y_0, y).d[0], by_differences, 1e-2 * scale)
          << kind.name << " " << y_0 << " " << y_1;
    }
}

/// Contacts of a bar with halves of a rim and with all of it count once together.
TEST(Fading, OfHalvesAndAllOfARimAddUp) {
  const FeaturePair halves{GapKind::rim_edge, 0, 0, Fade::parallel, 8e-3, 2e-3},
      whole{GapKind::rim_edge, 4, 0, Fade::aligned, 8e-3, 2e-3};
  for (double angle = 0.0; angle < 0.2; angle += 1e-3) {
    const double y = std::cos(angle);
    EXPECT_NEAR(fading(halves, y) + fading(whole, y), 1.0, 1e-15) << angle;
    if (std::pow(std::sin(angle), 2) < 2e-3) {
      EXPECT_EQ(fading(halves, y), 0.0) << angle;
    }
  }
}

}  // namespace
}  // namespace polhode::fading_tests
