// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <polhode/core/source_location.hpp>
#include <polhode/core/time_function.hpp>
#include <polhode/model/event_spec.hpp>

namespace polhode {

/// Output of a controller over the next step: linear in time, within its limits.
struct ControllerOutput {
  double t = 0.0;      ///< Time of evaluation [s].
  double value = 0.0;  ///< Value at that time.
  double slope = 0.0;  ///< [1/s]; 0 for a sampled one.
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
};

/// A number set by a controller, usable as any number over time. SI units.
class ControlledValue final : public TimeFunction {
 public:
  /// @param controller  Into Model::controllers.
  /// @param output  Of one simulation; null in a model that is not run.
  explicit ControlledValue(int controller, std::shared_ptr<const ControllerOutput> output = nullptr)
      : controller_(controller), output_(std::move(output)) {}
  [[nodiscard]] int controller() const override { return controller_; }
  [[nodiscard]] double operator()(double t) const override {
    if (!output_) return 0.0;
    const ControllerOutput& o = *output_;
    return std::clamp(o.value + o.slope * (t - o.t), o.least, o.most);
  }
  [[nodiscard]] TimeRates rates(double t, TimeSide) const override {
    return {(*this)(t), output_ ? output_->slope : 0.0, 0.0};
  }

 private:
  int controller_;
  std::shared_ptr<const ControllerOutput> output_;
};

/// Description of a controller as a function of the error r(t) − y of a channel y. @eq{controller}
struct ControllerSpec {
  std::string name;
  SourceLocation place;
  ChannelSpec channel;
  TimeFunctionPtr setpoint;      ///< In SI; null: zero.
  std::optional<double> sample;  ///< Time between samples [s]; none: continuous.
  // PID: proportional·e + integral·∫e dt + derivative·ė, ė through a lag of `filter` [s].
  double proportional = 0.0, integral = 0.0, derivative = 0.0, filter = 0.0;
  /// Transfer function instead of a PID: coefficients of polynomials in s, the highest power first.
  std::vector<double> numerator, denominator;
  double least = -std::numeric_limits<double>::infinity();  ///< Of the output.
  double most = std::numeric_limits<double>::infinity();
};

}  // namespace polhode
