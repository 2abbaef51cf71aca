// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include <polhode/assembly/system.hpp>

namespace polhode {

/// R·M⁻¹R of the bodies, and g² of rows at the mean mass: an increment of Newton lowers it.
/// @param rhs  Scaled residuals: bodies (6 each), then rows.
[[nodiscard]] inline double merit_of_bodies(const System& system, const Vec& rhs) {
  double sum = 0.0;
  for (int b = 0; b < system.body_count(); ++b) {
    const BodyData& body = system.bodies()[b];
    sum += rhs.segment<3>(6 * b).squaredNorm() / body.mass +
           3.0 * rhs.segment<3>(6 * b + 3).squaredNorm() / body.inertia.trace();
  }
  return sum + rhs.tail(system.rows()).squaredNorm() / system.mean_mass();
}

/// Shortens an increment until the merit falls.
class MeritSearch {
 public:
  /// Increments below this need no search: Newton converges quadratically there.
  static constexpr double kNoSearchBelow = 1e-6;

  /// @param before  Merit where the increment starts. @param part  Of it that is tried first.
  MeritSearch(double before, double part) : before_(before), part_(part) {}
  [[nodiscard]] double part() const { return part_; }
  /// Whether the merit there is asked for: no increment is searched for ever.
  [[nodiscard]] bool wants(double increment) const {
    return cuts_ < kMostCuts && !(increment < kNoSearchBelow);
  }
  /// Whether the increment may stand; if not, part() is a smaller one.
  [[nodiscard]] bool accepts(double after) {
    if (after <= (1.0 - 1e-4 * part_) * before_) return true;
    const double best = before_ / (after - (1.0 - 2.0 * part_) * before_) * part_;  // of a parabola
    part_ *= std::isfinite(after) ? std::clamp(best, 0.1, 0.5) : 0.25;
    ++cuts_;
    return false;
  }

 private:
  static constexpr int kMostCuts = 10;

  double before_, part_;
  int cuts_ = 0;
};

}  // namespace polhode
