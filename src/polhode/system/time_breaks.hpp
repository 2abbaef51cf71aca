// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/system/system.hpp>

namespace polhode {

/// The functions of time of a system: where they break, and how fast they change. Of a break,
/// `derivative` is the lowest derivative of the *motion* that jumps there: that of a prescribed
/// displacement's own, and two more for a load: 2 says that accelerations jump.
///
/// A cache of what comes next, and nothing else: the answers hang on the functions alone.
class TimeBreaks {
 public:
  /// @param until            End of the run [s].
  /// @param most_derivative  Breaks of higher derivatives of the motion are left out.
  TimeBreaks(const System& system, double until, int most_derivative = 5);

  /// The first break after t, up to the end of the run or beyond if t is; of those that fall
  /// together the strongest.
  [[nodiscard]] TimeBreak next(double t);

  /// A length of at most h from t, no break between, over which every function is sampled: the
  /// second derivative bends none of them by more than a third of what it changes by over four
  /// such lengths, unless by next to nothing. A sine is looked at seven times a period.
  /// @eq{sampled-loads}
  /// @param samples  Independent ones that a step of this length takes.
  [[nodiscard]] double sampled_length(double t, double h, double samples) const;

  [[nodiscard]] bool empty() const { return followed_.empty(); }

 private:
  struct Followed {
    TimeFunctionPtr function;
    int added;       ///< Derivatives between it and the motion.
    double size;     ///< Largest magnitude in the run, in its unit.
    TimeBreak next;  ///< After any time from `from` on until it has passed.
    double from = -1.0;
  };
  /// Over a step h with samples so far apart [s].
  [[nodiscard]] bool sampled(const Followed& f, double t, double h, double apart) const;

  double until_;
  int most_derivative_;
  std::vector<Followed> followed_;
};

}  // namespace polhode
