// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/robot_signal.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <polhode/core/format.hpp>

namespace polhode::io {

bool RobotSignal::is_bounded() const { return std::isfinite(lower) || std::isfinite(upper); }

double RobotSignal::at_start() const { return std::clamp(constant + decay, lower, upper); }

RobotSignal RobotSignal::times(double factor) const {
  if (factor == 0.0) return {};
  RobotSignal s = *this;
  s.constant *= factor;
  s.decay *= factor;
  s.ramp *= factor;
  s.lower *= factor;
  s.upper *= factor;
  if (factor < 0.0) std::swap(s.lower, s.upper);
  return s;
}

RobotSignal RobotSignal::plus(double summand) const {
  RobotSignal s = *this;
  s.constant += summand;
  s.lower += summand;
  s.upper += summand;
  return s;
}

RobotSignal RobotSignal::within(double least, double most) const {
  RobotSignal s = *this;
  s.lower = std::clamp(lower, least, most);
  s.upper = std::clamp(upper, least, most);
  if (!s.is_constant()) return s;
  RobotSignal constant_one;
  constant_one.constant = s.at_start();
  return constant_one;
}

std::string RobotSignal::text() const {
  std::string value = format("{}", constant == 0.0 ? 0.0 : constant);
  const auto add = [&](double factor, const std::string& function) {
    if (factor != 0.0)
      value += format(" {} {}*{}", factor < 0.0 ? "-" : "+", std::abs(factor), function);
  };
  add(decay, format("exp(-t/{})", time));
  add(ramp, "t");
  if (std::isfinite(lower)) value = format("max({}, {})", value, lower);
  if (std::isfinite(upper)) value = format("min({}, {})", value, upper);
  return value;
}

SourceNode signal_node(const NodeBuilder& make, const std::vector<RobotSignal>& summands) {
  double constant = 0.0;
  std::string moving;
  for (const RobotSignal& s : summands)
    if (s.is_constant())
      constant += s.at_start();
    else
      moving += (moving.empty() ? "" : " + ") + s.text();
  if (moving.empty()) return make.number(constant);
  if (constant != 0.0) moving += format(" {} {}", constant < 0.0 ? "-" : "+", std::abs(constant));
  SourceNode node = make.text(moving);
  node.in_quotes = true;
  return node;
}

}  // namespace polhode::io
