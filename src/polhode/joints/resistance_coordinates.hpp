// SPDX-License-Identifier: Apache-2.0
// Coordinates of Resistance over a step; included only by its source files.
#pragma once

#include <cmath>
#include <limits>

#include <polhode/joints/resistance.hpp>

namespace polhode {

/// Values of a coordinate at both ends of the step.
struct Resistance::Place {
  double at_n = 0.0, at_n1 = 0.0;
};

/// One free coordinate over the step.
struct Resistance::Coordinate : Resistance::Place {
  /// Factor of the coordinate in the bristle: for an angle the sleeve's radius.
  double lever = 1.0;
  Vec6 on_a, on_b;     ///< Discrete gradient: wrench by generalised force.
  Vec6 by_a, by_b;     ///< Derivative of at_n1.
  double force = 0.0;  ///< Generalised, on b along +.
  Vec6 D_a, D_b;       ///< Its derivative.
  Vec6 by_lambda;      ///< Likewise, by the multipliers.
  int angle = -1;      ///< Index among the joint's angles.
};

struct Resistance::Motion {
  int count = 0;
  Coordinate of[kMax];
  AngleStep angle[2];
  int slide = -1, turn = -1;  ///< Indices of the coordinates.
};

template <class What>
void Resistance::for_limits(What&& what) const {
  int memory = static_cast<int>(kNumbersOf<BristleMemory>);
  if (data_.slide) {
    if (!data_.slide->by_rows) what(*data_.slide, true, memory);
    memory += static_cast<int>(kNumbersOf<StopMemory>);
  }
  if (data_.turn && !data_.turn->by_rows) what(*data_.turn, false, memory);
}

template <class What>
void Resistance::for_ends(What&& what) const {
  int entry = row_entry();
  const auto of = [&](const std::optional<JointLimits>& limits, bool slides) {
    if (!limits || !limits->by_rows) return;
    const auto end = [&](double sign, double limit) {
      what(*limits, slides, sign, limit, entry);
      entry += static_cast<int>(kNumbersOf<UnilateralMemory>);
    };
    // No distance is negative.
    if (limits->lower > (kind_ == Kind::link ? 0.0 : -std::numeric_limits<double>::infinity()))
      end(1.0, limits->lower);
    if (std::isfinite(limits->upper)) end(-1.0, limits->upper);
  };
  of(data_.slide, true);
  of(data_.turn, false);
}

}  // namespace polhode
