// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>

#include <polhode/core/types.hpp>

namespace polhode {

/// Equilibrium test at a kink of a potential. Where two triangles of a concave surface are equally
/// near to a point, its gap, the smaller distance, has two gradients, and Newton's iterates
/// alternate between the sides. The state is in equilibrium if zero is in the convex hull of the
/// limits of the gradient, the residuals of the sides (Clarke subgradient; F. H. Clarke,
/// Optimization and Nonsmooth Analysis, 1983, section 2.5). @eq{statics-kink}
class ClarkeCombination {
 public:
  void clear() { residuals_.clear(); }
  /// Adds the residual of an iterate; at most the last four are kept.
  void add(const Vec& residual);
  /// Shortest convex combination Σ w_i r_i, w_i >= 0, Σ w_i = 1; the residual itself if there is
  /// one.
  [[nodiscard]] Vec shortest() const;

 private:
  std::deque<Vec> residuals_;
};

}  // namespace polhode
