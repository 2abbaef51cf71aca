// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <polhode/equations/constraint_check.hpp>
#include <polhode/equations/trial.hpp>

namespace polhode {

/// The row of a trial that is furthest from its tolerance.
struct OpenRow {
  int interaction = -1;
  double gap = 0.0;     ///< |g + compliance λ| [m or rad].
  double over = 0.0;    ///< Gap by tolerance; the row holds up to 1.
  bool length = false;  ///< The gap is a length; else an angle or the cosine of one.
  /// "a gap of 0.01 m".
  [[nodiscard]] std::string gap_text() const;
};

/// Tolerance of the exact rows of a trial, G (Δr, Δθ) = −g:
///
///   |g| ≤ τ (|G_r| L + |G_θ|) + 8 eps (|G_r| (L + |r|) + |G_θ| c),
///
/// where L is the size of the larger of the two bodies and c is 1, or a bound of its angle for a
/// row that counts turns. The first part is a displacement of τ L or a rotation of τ; the second
/// the rounding of the coordinates of the row. @eq{row-tolerance}
class RowCheck {
 public:
  /// τ, ten times the largest proximal ε: at a distance d from a singular position, in sizes of
  /// bodies, the residual of the row that becomes dependent there is d²/2, and it does not contract
  /// where d² < ε [-].
  static constexpr double kTolerance = 1e-10;

  explicit RowCheck(const System& system);

  /// Whether the largest |g| is below the tolerance of every row.
  /// @param rounded  The tolerance is only the rounding, fourfold.
  [[nodiscard]] bool surely_hold(const ConstraintCheck& check, bool rounded) const {
    return check.residual <= (rounded ? 0.0 : smallest_);
  }
  /// Whether all rows of a complete trial hold.
  [[nodiscard]] bool hold(const State& state, const Trial& trial, bool rounded);
  /// The row found by the last hold() that returned false.
  [[nodiscard]] const OpenRow& open() const { return open_; }
  /// Values of all rows in the last hold() [m or rad].
  [[nodiscard]] std::span<const double> gaps() const { return gaps_; }

 private:
  const System* system_;
  std::vector<double> size_;  ///< Of each body: its joint arms, or radius of gyration [m].
  double smallest_ = 0.0;     ///< Lower bound of the tolerances [m or -].
  std::vector<double> gaps_;
  OpenRow open_;
};

}  // namespace polhode
