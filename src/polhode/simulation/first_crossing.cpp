// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/simulation/first_crossing.hpp>

namespace polhode {

namespace {

/// Accuracy of a crossing: value as a part of its change over the step.
constexpr double kFound = 1e-13;
/// Trials within which the interval must have been halved; otherwise it is bisected.
constexpr int kPatience = 3;
/// Trials that halve any interval down to round-off at this patience.
constexpr int kMaxTrials = 52 * (kPatience + 1);

}  // namespace

FirstCrossing::FirstCrossing(std::span<const double> at_start, std::span<const double> at_end,
                             double length, double same)
    : high_(length), same_(same), width_(length) {
  for (std::size_t k = 0; k < at_start.size(); ++k)
    functions_.push_back({at_start[k], at_end[k], at_start[k], at_end[k], at_end[k]});
}

bool FirstCrossing::found() const {
  const auto is_at_zero = [](const Function& f) {
    return std::isfinite(f.at_start) && std::isfinite(f.at_end) &&
           f.beyond <= kFound * (f.at_end - f.at_start);
  };
  return high_ - low_ <= same_ || all_trials_ >= kMaxTrials ||
         std::all_of(functions_.begin(), functions_.end(),
                     [&](const Function& f) { return !f.crosses() || is_at_zero(f); });
}

double FirstCrossing::next() const {
  const double middle = 0.5 * (low_ + high_);
  if (trials_ >= kPatience) return middle;
  double first = high_;
  for (const Function& f : functions_) {
    if (!f.crosses()) continue;
    const bool far = std::isinf(f.low) || std::isinf(f.high);
    first = std::min(first, far ? middle : (low_ * f.high - high_ * f.low) / (f.high - f.low));
  }
  // A little beyond the estimate, which then becomes the far side.
  return std::clamp(first + 0.25 * same_, low_ + 0.25 * same_, high_ - 0.25 * same_);
}

bool FirstCrossing::add(double length, std::span<const double> values) {
  const bool beyond = std::any_of(values.begin(), values.end(), [](double v) { return v >= 0.0; });
  (beyond ? high_ : low_) = length;
  for (std::size_t k = 0; k < values.size(); ++k) {
    Function& f = functions_[k];
    const double v = values[k];
    const int side = beyond ? 1 : -1;
    double& moved = beyond ? f.high : f.low;
    double& kept = beyond ? f.low : f.high;
    if (side == f.side) kept *= 0.5;
    f.side = side;
    moved = v;
    if (beyond) f.beyond = v;
  }
  ++all_trials_;
  ++trials_;
  if (high_ - low_ <= 0.5 * width_) {
    width_ = high_ - low_;
    trials_ = 0;
  }
  return beyond;
}

std::vector<int> FirstCrossing::crossed() const {
  std::vector<int> list;
  for (std::size_t k = 0; k < functions_.size(); ++k)
    if (functions_[k].crosses()) list.push_back(static_cast<int>(k));
  return list;
}

}  // namespace polhode
