// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include <polhode/system/system.hpp>

namespace polhode {

/// Merit R·M⁻¹R of the bodies, plus g² of rows at the mean mass: a Newton increment is a descent
/// direction.
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

/// Line search on the merit. At the start of a barrier the merit has a kink: an increment that just
/// reaches it may be acceptable while a slightly longer one is not, and Newton's increment includes
/// the barrier only from there on. Therefore a part far below a rejected one is lengthened again.
class MeritSearch {
 public:
  /// Increment below which no search is needed: Newton converges quadratically there.
  static constexpr double kNoSearchBelow = 1e-6;

  /// @param before  Merit at the start of the increment. @param part  Initial part of the
  /// increment.
  MeritSearch(double before, double part) : before_(before), part_(part) {}
  [[nodiscard]] double part() const { return part_; }
  /// Whether the merit is needed; the number of trials is limited.
  [[nodiscard]] bool wants(double increment) const {
    return tries_ < kMaxTries && !found_ && !(increment < kNoSearchBelow);
  }
  /// Whether the increment is acceptable; if not, part() is the next trial.
  [[nodiscard]] bool accepts(double after) {
    ++tries_;
    const bool stands = after <= (1.0 - 1e-4 * part_) * before_;
    (stands ? stands_ : too_much_) = part_;
    if (stands_ == 0.0) {
      const double best =
          before_ / (after - (1.0 - 2.0 * part_) * before_) * part_;  // minimum of a parabola
      part_ *= std::isfinite(after) ? std::clamp(best, 0.1, 0.5) : 0.25;
      return false;
    }
    if (too_much_ > kClose * stands_ && tries_ < kMaxTries) {
      part_ = std::sqrt(stands_ * too_much_);
      return false;
    }
    found_ = true;
    part_ = stands_;
    return stands;
  }

 private:
  static constexpr int kMaxTries = 10;
  static constexpr double kClose = 3.0;  ///< Ratio of parts below which no kink is searched for.

  double before_, part_;
  double stands_ = 0.0,
         too_much_ = 0.0;  ///< Largest accepted part, smallest rejected one.
  int tries_ = 0;
  bool found_ = false;
};

}  // namespace polhode
