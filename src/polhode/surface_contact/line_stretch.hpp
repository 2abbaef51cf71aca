// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include <polhode/system/node_step.hpp>

namespace polhode {

/// Kind of the element groups that are contacts of cables.
inline constexpr const char* kCableContact = "cable contact";

/// What is round about points of a line, such as a cable.
struct RoundLine {
  double radius = 0.0;  ///< 0: none [m].
  /// Points farther apart than this would let something pass between them [m].
  double most_apart = std::numeric_limits<double>::infinity();
  /// Two nodes, and the part of the piece between them that lies before the next point.
  struct Span {
    int a = 0, b = 0;
    double part = 0.0;
  };
  std::vector<Span> spans;  ///< By point.
};

/// What is drawn out as far as it may be goes on by this factor at a time.
inline constexpr double kMoreStretch = 1.1;

/// Of the way from one iterate to another, the part on which points come no farther apart than they
/// may.
[[nodiscard]] inline double free_of_stretch(const RoundLine::Span& span, double most_apart,
                                            const NodeStep& from, const NodeStep& to) {
  const auto apart = [&](const NodeStep& step) {
    return span.part * (NodeStep::at(step.x_n1, span.b) - NodeStep::at(step.x_n1, span.a)).norm();
  };
  const double at_end = apart(to);
  if (at_end <= most_apart) return 1.0;
  const double at_start = apart(from), allowed = std::max(most_apart, kMoreStretch * at_start);
  return at_end > allowed ? (allowed - at_start) / (at_end - at_start) : 1.0;
}

}  // namespace polhode
