// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>

#include <polhode/core/types.hpp>

namespace polhode {

/// Equilibria where a potential has a kink: where two triangles of a dent are as near to a point,
/// its gap, the smaller distance, has two gradients, and Newton's iterates go to and fro between
/// the sides. Balanced is what the sides' residuals can be mixed to: zero is in the convex hull of
/// the limits of the gradient (F. H. Clarke, Optimization and Nonsmooth Analysis, 1983,
/// section 2.5).
/// @eq{statics-kink}
class ClarkeCombination {
 public:
  void clear() { residuals_.clear(); }
  /// The residual of one more iterate; the oldest of more than four is forgotten.
  void add(const Vec& residual);
  /// The shortest mixture Σ w_i r_i, w_i >= 0, Σ w_i = 1; with one residual, that.
  [[nodiscard]] Vec shortest() const;

 private:
  std::deque<Vec> residuals_;
};

}  // namespace polhode
