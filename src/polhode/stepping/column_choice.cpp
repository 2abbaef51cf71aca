// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/stepping/column_choice.hpp>
#include <polhode/stepping/extrapolation_table.hpp>
#include <polhode/stepping/step_control.hpp>

namespace polhode {

using namespace step_control;

namespace {

/// Single steps that cost as much as a step's projections and sums.
constexpr double kOverhead = 1.0;
/// Ratio of two works below which the number of members changes (Hairer, Nørsett, Wanner, II.9).
constexpr double kFewer = 0.8, kMore = 0.9;

/// Factor on the length with which a column has the allowed error: it grows by the power 2j−1, that
/// of the first one, a step of order 2, by the third.
double factor_of(int column, double error, double allowed) {
  if (error <= 0.0) return kMaxFactorTable;
  const double power = 1.0 / std::max(3, 2 * column - 1);
  return std::clamp(kSafetyComposed * std::pow(allowed / error, power), kMinFactorTable,
                    kMaxFactorTable);
}

/// Single steps per unit of time, the last step's length being one.
double work(int column, double factor) {
  return (ExtrapolationTable::substeps(column) + kOverhead) / factor;
}

}  // namespace

int first_columns(double tolerance, int most) {
  return std::clamp(static_cast<int>(1.5 - 0.4 * std::log10(tolerance)),
                    std::min(kLeastColumns, most), most);
}

ColumnPlan plan_columns(const ColumnErrors& errors, double allowed, int least, int most) {
  const int k = errors.columns;
  const double here = factor_of(k, errors.last, allowed);
  const double before = factor_of(k - 1, errors.before, allowed);
  const double work_here = work(k, here), work_before = work(k - 1, before);
  if (k > least && work_before < kFewer * work_here) return {k - 1, before};
  if (k >= most || work_here >= kMore * work_before) return {k, here};
  const double longer =
      static_cast<double>(ExtrapolationTable::substeps(k + 1)) / ExtrapolationTable::substeps(k);
  return {k + 1, std::min(kMaxFactorTable, here * longer)};
}

}  // namespace polhode
