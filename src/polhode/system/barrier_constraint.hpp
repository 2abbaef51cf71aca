// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/system/node_step.hpp>

namespace polhode {

/// Interface of a group of elements with inadmissible configurations, such as points of a surface
/// that would pass through another one.
class BarrierConstraint {
 public:
  virtual ~BarrierConstraint() = default;
  /// Appends the clearances of the points at t_{n+1}: 0 at such a configuration, 1 where the
  /// barrier becomes active.
  /// @param history  Of the group, at t_n.
  virtual void clearances(const NodeStep& step, const double* history,
                          std::vector<double>& list) const = 0;
  /// Largest part, at most 1, of the straight displacement from x_n1 of one step to that of the
  /// other on which no point comes nearer than a tenth of its clearance at the start. Points that
  /// would exit on the far side are stopped too.
  [[nodiscard]] virtual double free_part(const NodeStep& from, const NodeStep& to,
                                         const double* history) const = 0;
};

}  // namespace polhode
