// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/system/node_step.hpp>

namespace polhode {

/// A group of elements with configurations that no step may reach, such as points of a surface that
/// would pass through another one.
class BarrierConstraint {
 public:
  virtual ~BarrierConstraint() = default;
  /// Appends how far the points at t_{n+1} are from such configurations: 0 there, 1 where they
  /// begin to be felt.
  /// @param history  Of the group, at t_n.
  virtual void clearances(const NodeStep& step, const double* history,
                          std::vector<double>& list) const = 0;
  /// The largest part, at most 1, of the straight way from x_n1 of one step to that of the other
  /// on which no point comes nearer than a tenth of its clearance at the start: points that would
  /// leave on the far side are stopped, too.
  [[nodiscard]] virtual double free_part(const NodeStep& from, const NodeStep& to,
                                         const double* history) const = 0;
};

}  // namespace polhode
