// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>

namespace polhode {

/// A number that may depend on time: constant, expression in t, or table. SI units.
class TimeFunction {
 public:
  virtual ~TimeFunction() = default;
  [[nodiscard]] virtual double operator()(double t) const = 0;
  [[nodiscard]] virtual bool is_constant() const { return false; }
};
using TimeFunctionPtr = std::shared_ptr<const TimeFunction>;

/// Three time functions, one per component.
using TimeVector = std::array<TimeFunctionPtr, 3>;

}  // namespace polhode
