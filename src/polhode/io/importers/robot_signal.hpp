// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>
#include <vector>

#include <polhode/io/importers/node_builder.hpp>

namespace polhode::io {

/// A value over time, such as that of a first-order lag or of an integrator with a constant input:
/// the constant plus a decay and a ramp, between bounds.
struct RobotSignal {
  double constant = 0.0;
  double decay = 0.0, time = 1.0;  ///< decay times exp(-t/time), time in s.
  double ramp = 0.0;               ///< [1/s]
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool is_constant() const { return decay == 0.0 && ramp == 0.0; }
  [[nodiscard]] bool is_bounded() const;
  [[nodiscard]] double at_start() const;
  [[nodiscard]] RobotSignal times(double factor) const;
  [[nodiscard]] RobotSignal plus(double summand) const;
  /// This value where it is within bounds, otherwise the bound.
  [[nodiscard]] RobotSignal within(double least, double most) const;
  /// As an expression of a model file.
  [[nodiscard]] std::string text() const;
};

/// A sum of signals as a value of a model file.
[[nodiscard]] SourceNode signal_node(const NodeBuilder& make,
                                     const std::vector<RobotSignal>& summands);

}  // namespace polhode::io
