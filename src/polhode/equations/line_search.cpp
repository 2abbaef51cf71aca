// SPDX-License-Identifier: Apache-2.0
#include <polhode/equations/line_search.hpp>

#include <algorithm>
#include <cmath>

namespace polhode {

namespace {

/// Ratio of a rejected part to an accepted one below which no kink is searched for.
constexpr double kClose = 3.0;

}  // namespace

double merit_of_bodies(const System& system, const Vec& rhs) {
  double sum = 0.0;
  for (int b = 0; b < system.body_count(); ++b) {
    const BodyData& body = system.bodies()[b];
    sum += rhs.segment<3>(6 * b).squaredNorm() / body.mass +
           3.0 * rhs.segment<3>(6 * b + 3).squaredNorm() / body.inertia.trace();
  }
  return sum + rhs.tail(system.rows()).squaredNorm() / system.mean_mass();
}

bool StepLength::accepts(double after) {
  ++trials_;
  const bool enough = after <= (1.0 - rule_.decrease * part_) * before_;
  (enough ? accepted_ : rejected_) = part_;
  if (accepted_ == 0.0) {
    const double minimum = before_ / (after - (1.0 - 2.0 * part_) * before_) * part_;
    part_ *= std::isfinite(after) ? std::clamp(minimum, rule_.least_kept, rule_.most_kept)
                                  : rule_.inadmissible;
    return false;
  }
  if (rule_.searches_for_kink && rejected_ > kClose * accepted_ && trials_ < rule_.max_trials) {
    part_ = std::sqrt(accepted_ * rejected_);
    return false;
  }
  found_ = true;
  part_ = accepted_;
  return enough;
}

}  // namespace polhode
