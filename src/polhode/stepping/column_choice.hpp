// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace polhode {

/// What a step of an extrapolation has shown: errors of its last column but one, and of the one
/// before that, at the length H of the step [-].
struct ColumnErrors {
  int columns = 2;  ///< Members of the step.
  double last = 0.0, before = 0.0;
};

/// Members of the next extrapolated step, and its length as a multiple of the last one.
struct ColumnPlan {
  int columns = 2;
  double factor = 1.0;
};

/// Fewest members of steps of varying order. The estimate of two has the order of one: it would
/// never show that three are better.
inline constexpr int kLeastColumns = 3;

/// Members of a first step: more for a smaller tolerance. @eq{column-work}
[[nodiscard]] int first_columns(double tolerance, int most);

/// The members and the length that need the fewest single steps per unit of time.
/// @eq{column-work} @param allowed  Error of the next step [-]. @param least, most  Numbers of
/// members that may be chosen.
[[nodiscard]] ColumnPlan plan_columns(const ColumnErrors& errors, double allowed, int least,
                                      int most);

}  // namespace polhode
