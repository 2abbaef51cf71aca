// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include <polhode/system/system.hpp>

namespace polhode {

/// Breaks and rates of the functions of time of a system. `derivative` of a break is the lowest
/// derivative of the *motion* that jumps there: for a prescribed displacement its own order, for a
/// load two more: 2 means that accelerations jump.
///
/// It caches the next breaks only: results depend on the functions alone.
class TimeBreaks {
 public:
  /// @param until  End of the run [s].
  /// @param most_derivative  Breaks of higher derivatives of the motion are ignored.
  TimeBreaks(const System& system, double until, int most_derivative = 5);

  /// First break after t, up to the end of the run or beyond if t is; of simultaneous breaks the
  /// one with the lowest derivative.
  [[nodiscard]] TimeBreak next(double t);
  /// Whether there is a break within a distance of t, before or after it.
  [[nodiscard]] bool near(double t, double distance) {
    return next(std::max(0.0, t - distance)).t <= t + distance;
  }

  /// Length of at most h from t, without breaks, over which every function is sampled well: the
  /// effect of the second derivative is below a third of the change over four such lengths, or
  /// negligible. A sine is sampled seven times a period. @eq{sampled-loads}
  /// @param samples  Independent samples in a step of this length.
  [[nodiscard]] double sampled_length(double t, double h, double samples) const;

  [[nodiscard]] bool empty() const { return followed_.empty(); }

 private:
  struct Followed {
    TimeFunctionPtr function;
    int added;       ///< Order of the derivative of the motion that it gives.
    double size;     ///< Largest magnitude in the run, in its unit.
    TimeBreak next;  ///< Valid after any time from `from` on until it has passed.
    double from = -1.0;
  };
  /// Whether a function is sampled well over a step h with this distance of samples [s].
  [[nodiscard]] bool sampled(const Followed& f, double t, double h, double apart) const;

  double until_;
  int most_derivative_;
  std::vector<Followed> followed_;
};

}  // namespace polhode
