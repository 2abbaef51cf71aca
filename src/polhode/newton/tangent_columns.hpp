// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <polhode/equations/trial.hpp>
#include <polhode/newton/tangent_check.hpp>

namespace polhode {

/// Columns of a tangent, one after the other, compared with central differences of its residual.
class TangentColumns {
 public:
  /// @param row_size  Largest entry of each row of the tangent.
  explicit TangentColumns(Vec row_size) : row_size_(std::move(row_size)) {}

  /// Compares a column with differences of decreasing displacement until they agree: stiff forces
  /// such as contacts and friction are differentiable only over tiny displacements. Where one-sided
  /// differences disagree and the column is that of one side, it counts as right, at a kink.
  /// @param residual  Residual after the displacement h of this column's unknown.
  template <class Residual>
  void compare(int column, const Vec& analytic, Residual&& residual) {
    Entry best;
    best.error = std::numeric_limits<double>::infinity();
    double shortest = 0.0;
    for (const double h : {1e-5, 1e-6, 1e-7, 1e-8}) {
      const Vec ahead = residual(h), behind = residual(-h);
      const Entry found =
          largest(analytic, (ahead - behind) / (2.0 * h), noise(ahead, behind) / h, row_size_);
      shortest = h;
      if (found.error < best.error || best.row < 0) best = found;
      if (best.error < kAgrees) break;
    }
    best.column = column;
    if (best.error > kTangentTolerance && is_one_side(analytic, shortest, residual)) {
      ++kinks_;
      return;
    }
    if (!(best.error <= worst_.error)) worst_ = best;
  }

  struct Entry {
    double error = 0.0, analytic = 0.0, numeric = 0.0;
    int row = -1, column = -1;
  };
  [[nodiscard]] const Entry& worst() const { return worst_; }
  [[nodiscard]] int kinks() const { return kinks_; }  ///< Number of columns at a kink.

 private:
  static constexpr double kAgrees = 0.01 * kTangentTolerance;
  /// Error of a one-sided difference of a smooth function: its curvature times the displacement.
  static constexpr double kOneSided = 1e-4;
  /// Entry of the scaled system below which it is negligible compared with inertia.
  static constexpr double kNothing = 1e-6;

  [[nodiscard]] static Vec noise(const Vec& ahead, const Vec& behind) {
    return 8.0 * std::numeric_limits<double>::epsilon() *
           ahead.cwiseAbs().cwiseMax(behind.cwiseAbs());
  }
  [[nodiscard]] static Entry largest(const Vec& analytic, const Vec& numeric, const Vec& noise,
                                     const Vec& row_size) {
    Entry found;
    for (int i = 0; i < analytic.size(); ++i) {
      const double size = std::max({row_size[i], std::abs(numeric[i]), kNothing});
      const double off = std::abs(analytic[i] - numeric[i]);
      const double error = off > noise[i] ? (off - noise[i]) / size : off <= noise[i] ? 0.0 : off;
      if (found.row >= 0 && error <= found.error) continue;  // a NaN is kept and stays
      found = {error, analytic[i], numeric[i], i, -1};
      if (std::isnan(error)) found.error = std::numeric_limits<double>::infinity();
    }
    return found;
  }
  template <class Residual>
  [[nodiscard]] bool is_one_side(const Vec& analytic, double h, Residual&& residual) const {
    const Vec ahead = residual(h), behind = residual(-h), here = residual(0.0);
    const Vec rounding = noise(ahead, behind) / h;
    return largest(analytic, (ahead - here) / h, rounding, row_size_).error < kOneSided ||
           largest(analytic, (here - behind) / h, rounding, row_size_).error < kOneSided;
  }

  Vec row_size_;
  Entry worst_;
  int kinks_ = 0;
};

/// Largest absolute entry of each row.
[[nodiscard]] inline Vec row_sizes(const Mat& tangent) {
  if (tangent.cols() == 0) return Vec::Zero(tangent.rows());
  return tangent.cwiseAbs().rowwise().maxCoeff();
}

/// Name of a component 0 to 5 of a body: "force y of body 'arm'"; `words` for the first three and
/// the others.
[[nodiscard]] std::string body_component(const System& system, int body, int component,
                                         const char* moved, const char* turned);
/// Stride through `count` items that visits at most `most`.
[[nodiscard]] int stride_of(int count, int most);
/// Displaces a component of a body in the trial: 0 to 2 along an axis [m], 3 to 5 about it [-].
void move_component(const System& system, const State& state, Trial& trial, int body,
                    const BodyStep& from, int component, double h);
/// Displaces a component of a node in the trial, with its velocity.
void move_node(const State& state, Trial& trial, int node, int component, double h);

/// Compares every interaction alone: wrenches and rows by the motion of its bodies and by its
/// multipliers.
void check_interactions(const System& system, const State& state, Trial& trial,
                        TangentReport& report);
/// Compares every group of elements alone: forces by the positions of nodes, with internal unknowns
/// condensed.
void check_elements(const System& system, const State& state, Trial& trial, TangentReport& report);
/// Compares every pair of bodies in contact: wrenches by the motion of both.
void check_contacts(const System& system, const State& state, Trial& trial, TangentReport& report);

}  // namespace polhode
