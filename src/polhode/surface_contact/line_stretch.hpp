// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include <polhode/system/node_step.hpp>

namespace polhode::surface_contact {

/// Kind of the element groups that are contacts of cables.
inline constexpr const char* kCableContact = "cable contact";

/// A round cross-section about points of a line, such as a cable.
struct RoundLine {
  double radius = 0.0;  ///< 0: none [m].
  /// Largest distance of points; through a wider one something could pass [m].
  double most_apart = std::numeric_limits<double>::infinity();
  /// Two nodes, and the part of the segment between them that lies before the next point.
  struct Span {
    int a = 0, b = 0;
    double part = 0.0;
  };
  std::vector<Span> spans;  ///< By point.
};

/// Factor by which a segment that is already overstretched may stretch further per iterate.
inline constexpr double kMoreStretch = 1.1;

/// Part of the displacement between two iterates on which points stay within their largest
/// distance.
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

}  // namespace polhode::surface_contact
