// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include <polhode/system/system.hpp>

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

/// Shortens an increment until the merit falls. Where a barrier begins the merit has a kink: what
/// just reaches it may stand although a little more may not, and Newton sees the barrier only from
/// there on. So a part far below one that may not stand is lengthened again.
class MeritSearch {
 public:
  /// Increments below this need no search: Newton converges quadratically there.
  static constexpr double kNoSearchBelow = 1e-6;

  /// @param before  Merit where the increment starts. @param part  Of it that is tried first.
  MeritSearch(double before, double part) : before_(before), part_(part) {}
  [[nodiscard]] double part() const { return part_; }
  /// Whether the merit there is asked for: no increment is searched for ever.
  [[nodiscard]] bool wants(double increment) const {
    return tries_ < kMaxTries && !found_ && !(increment < kNoSearchBelow);
  }
  /// Whether the increment may stand as it is; if not, part() is another one.
  [[nodiscard]] bool accepts(double after) {
    ++tries_;
    const bool stands = after <= (1.0 - 1e-4 * part_) * before_;
    (stands ? stands_ : too_much_) = part_;
    if (stands_ == 0.0) {
      const double best =
          before_ / (after - (1.0 - 2.0 * part_) * before_) * part_;  // of a parabola
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
  static constexpr double kClose = 3.0;  ///< No kink is looked for between parts closer than this.

  double before_, part_;
  double stands_ = 0.0,
         too_much_ = 0.0;  ///< The largest part that may stand, the least that may not.
  int tries_ = 0;
  bool found_ = false;
};

}  // namespace polhode
