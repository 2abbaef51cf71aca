// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include <polhode/core/assert.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// Merit R·M⁻¹R of the bodies, plus g² of rows at the mean mass: a Newton increment is a descent
/// direction.
/// @param rhs  Scaled residuals: bodies (6 each), then rows.
[[nodiscard]] double merit_of_bodies(const System& system, const Vec& rhs);

/// Rule by which a line search shortens an increment.
struct LineSearchRule {
  double decrease;    ///< Part of the merit by which a whole increment has to reduce it.
  int max_trials;     ///< Number of merits evaluated; the next part is applied without one.
  double least_kept;  ///< Bounds of the factor by which a rejected part is multiplied; the minimum
  double most_kept;   ///< of a parabola decides between them.
  double inadmissible;             ///< That factor where the merit is not finite.
  double no_search_below = 0.0;    ///< Increment whose merit is not evaluated [-].
  bool searches_for_kink = false;  ///< See StepLength.
};

/// Armijo's rule with the minimum of a parabola, for the residual of bodies, rows and nodes.
/// Newton's method converges quadratically from the increment on that is not searched.
inline constexpr LineSearchRule kReduceMerit{1e-4, 10, 0.1, 0.5, 0.25, 1e-6, true};
/// Halvings until no element is inverted.
inline constexpr LineSearchRule kUntilAdmissible{0.0, 9, 0.5, 0.5, 0.5};
/// Merit of an admissible iterate under that rule, whatever its residual.
inline constexpr double kAdmissible = 0.0;
inline constexpr double kInadmissible = std::numeric_limits<double>::infinity();

/// Parts of an increment in the order in which they are tried. At the start of a barrier the merit
/// has a kink: an increment that just reaches it may be acceptable while a slightly longer one is
/// not, and Newton's increment includes the barrier only from there on. Where the rule says so, a
/// part far below a rejected one is therefore lengthened again.
class StepLength {
 public:
  /// @param before  Merit at the start of the increment. @param part  Initial part.
  StepLength(const LineSearchRule& rule, double before, double part)
      : rule_(rule), before_(before), part_(part) {}
  [[nodiscard]] double part() const { return part_; }
  /// Whether the merit at part() is needed.
  [[nodiscard]] bool wants_merit(double increment) const {
    return trials_ < rule_.max_trials && !found_ && !(increment < rule_.no_search_below);
  }
  /// Whether all trials were rejected.
  [[nodiscard]] bool exhausted() const { return accepted_ == 0.0 && trials_ >= rule_.max_trials; }
  /// Whether the part is acceptable; if not, part() is the next trial.
  [[nodiscard]] bool accepts(double after);

 private:
  LineSearchRule rule_;
  double before_, part_;
  double accepted_ = 0.0, rejected_ = 0.0;  ///< Largest accepted part, smallest rejected one.
  int trials_ = 0;
  bool found_ = false;
};

/// The line search of dynamics, statics and impulses. Applies part of an increment; reduces it
/// until the merit decreases enough.
/// @param part   Largest admissible part. @param before  Merit at the start.
/// @param apply  apply(part): sets the iterate to its start plus this part. @returns the size of
///               the whole increment [-].
/// @param merit  merit(): at the iterate; infinite where it is not admissible, negative where it
///               cannot be reduced, as it is round-off.
/// @returns whether the iterate is acceptable, as far as its merit was needed.
template <class Apply, class Merit>
bool search_along(const LineSearchRule& rule, double before, double part, Apply&& apply,
                  Merit&& merit) {
  POLHODE_ASSERT(part >= 0.0 && part <= 1.0);
  StepLength length(rule, before, part);
  for (;;) {
    const double increment = apply(length.part());
    if (!length.wants_merit(increment)) return !length.exhausted();
    const double after = merit();
    if (after < 0.0 || length.accepts(after)) return true;
  }
}

}  // namespace polhode
