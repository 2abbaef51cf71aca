// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/assembly/node_step.hpp>

namespace polhode {

/// A group of elements with configurations that no step may reach, such as points of a surface that
/// would pass through another one.
class BarrierPoints {
 public:
  virtual ~BarrierPoints() = default;
  /// Appends how far the points at t_{n+1} are from such configurations: 0 there, 1 where they
  /// begin to be felt.
  virtual void clearances(const NodeStep& step, std::vector<double>& list) const = 0;
};

}  // namespace polhode
