// SPDX-License-Identifier: Apache-2.0
// Tangent of statics: its factorisation, its free motions, and its softest motion.
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/statics/static_newton.hpp>
#include <polhode/stepping/plain_motions.hpp>

namespace polhode {

namespace {

/// Asymmetry up to which a matrix is treated as symmetric: the neglected part does not slow
/// convergence.
constexpr double kSymmetric = 1e-7;
/// Stiffness added where a motion has none, as a part of the largest.
constexpr double kTangentShift = 1e-6;
/// Size of a solution for a right-hand side of size one that indicates a free motion.
constexpr double kNearlySingular = 1e10;
/// Largest number of free motions that are sought and supported; the first ones are named.
constexpr int kMaxSupported = 24;
/// Number of iterative refinements of a solution.
constexpr int kRefinements = 3;
constexpr int kSoftestIterations = 6;
/// Largest number of free motions that are named.
constexpr int kMaxFreeMotions = 6;

}  // namespace

/// Solves for increments of all unknowns; those of prescribed components are given.
bool StaticNewton::factor_and_solve(StaticStep& step) {
  // Increments of prescribed components are given: K_fp Δu_p goes to the right-hand side.
  const Nodes& nodes = system_->nodes();
  aim(given_);
  if (!nodes.prescribed().empty()) {
    forces_.assign(given_.size(), 0.0);
    for (int i = 0; i < nodes.count(); ++i)
      for (int k = nodes.row_start()[i]; k < nodes.row_start()[i + 1]; ++k) {
        const double* d = given_.data() + 3 * nodes.column()[k];
        if (d[0] == 0.0 && d[1] == 0.0 && d[2] == 0.0) continue;
        const double* K = nodes_.tangent().data() + 9 * static_cast<std::size_t>(k);
        for (int r = 0; r < 3; ++r)
          for (int c = 0; c < 3; ++c) forces_[3 * i + r] += K[3 * r + c] * d[c];
      }
    matrix_.gather(forces_, -scale(), rhs_);
  }
  if (matrix_.size() == 0) return true;  // every component of every node is prescribed
  if (!factor(make_symmetric(), step)) return false;
  solve_refined();
  leave_out_free();
  return x_.allFinite();
}

/// Factors the tangent. Each free motion gets a support as stiff as the stiffest part at its
/// largest component: balanced loads cause no reaction there, so that nothing else changes. Models
/// with more free motions get a shift of all stiffnesses. @eq{statics-supports}
bool StaticNewton::factor(bool symmetric, StaticStep& step) {
  shifted_ = false;
  free_.clear();
  const bool factored = solver_.factor(matrix_, symmetric);
  if (factored && (resisted_ || !nearly_singular())) return true;
  const std::vector<Vec> free = name_free_motions(step);
  if (free.empty() && factored) return resisted_ = true;
  const double length = system_->length_scale();
  const auto weight = [&](int unknown) {
    return unknown < 6 * system_->body_count() && unknown % 6 >= 3 ? length * length : 1.0;
  };
  if (!free.empty() && static_cast<int>(free.size()) < kMaxSupported) {
    std::vector<double> supports(matrix_.movable(), 0.0);
    for (const int unknown : supports_of(free, matrix_, length))
      supports[unknown] = weight(unknown);
    keep_free(free);
    if (solver_.factor(matrix_, symmetric, supports)) return true;
    free_.clear();
  }
  shifted_ = true;
  std::vector<double> shift(matrix_.movable());
  for (int i = 0; i < matrix_.movable(); ++i) shift[i] = kTangentShift * weight(i);
  return solver_.factor(matrix_, symmetric, shift);
}

/// Makes free motions orthonormal, with rotations scaled by ℓ.
void StaticNewton::keep_free(std::vector<Vec> motions) {
  const int n = matrix_.movable();
  for (Vec& motion : motions) {
    Vec x = motion.head(n);
    for (int b = 0; b < system_->body_count(); ++b)
      x.segment<3>(6 * b + 3) *= system_->length_scale();
    for (int twice = 0; twice < 2; ++twice)
      for (const Vec& other : free_) x -= other.dot(x) * other;
    free_.push_back(x.normalized());
  }
}

/// Removes free motions from the increment, so that neither the position of supports nor rounding
/// along free motions causes displacements. @eq{statics-deflation}
void StaticNewton::leave_out_free() {
  if (free_.empty() || !x_.allFinite()) return;
  const int n = matrix_.movable();
  const double length = system_->length_scale();
  const auto scale_turns = [&](double factor) {
    for (int b = 0; b < system_->body_count(); ++b) x_.segment<3>(6 * b + 3) *= factor;
  };
  scale_turns(length);
  for (const Vec& motion : free_) x_.head(n) -= motion.dot(x_.head(n)) * motion;
  scale_turns(1.0 / length);
}

/// x_ = K⁻¹ rhs_ with iterative refinement as long as the residual decreases.
void StaticNewton::solve_refined() {
  x_ = rhs_;
  solver_.solve(x_);
  if (!resisted_) return;
  Vec left;
  double before = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kRefinements && x_.allFinite(); ++k) {
    matrix_.times(x_, left);
    left = rhs_ - left;
    const double size = left.lpNorm<Eigen::Infinity>();
    if (!(size < 0.5 * before)) return;
    before = size;
    solver_.solve(left);
    x_ += left;
  }
}

/// Adds the part of the unbalanced moments that makes the matrix of a conservative system symmetric
/// off equilibrium. @eq{statics-hessian}
bool StaticNewton::make_symmetric() {
  if (matrix_.asymmetry() < kSymmetric) return true;
  matrix_.make_hessian(moments_);
  if (matrix_.asymmetry() < kSymmetric) return true;
  for (Vec6& m : moments_) m = -m;
  matrix_.make_hessian(moments_);
  for (Vec6& m : moments_) m = -m;
  return false;
}

/// Whether a solution grows beyond all bounds, after a factorisation.
bool StaticNewton::nearly_singular() const {
  Vec probe = Vec::Zero(matrix_.size());
  for (int i = 0; i < matrix_.movable(); ++i) probe[i] = std::sin(1.0 + 3.7 * i);
  if (probe.size() == 0) return false;
  solver_.solve(probe);
  return !(probe.lpNorm<Eigen::Infinity>() < kNearlySingular);
}

std::vector<Vec> StaticNewton::name_free_motions(StaticStep& step) {
  std::vector<Vec> free = free_motions(matrix_, system_->length_scale(), kMaxSupported,
                                       rigid_free_motions(*system_, work_, matrix_));
  for (const PlainMotion& motion : plain_motions(*system_, work_, matrix_, free)) {
    if (static_cast<int>(step.free_motions.size()) == kMaxFreeMotions) break;
    const std::string& text = motion.text;
    if (std::find(step.free_motions.begin(), step.free_motions.end(), text) ==
        step.free_motions.end())
      step.free_motions.push_back(text);
  }
  return free;
}

/// Finds the free motions at the equilibrium, and the number of unstable directions.
void StaticNewton::count_unstable(StaticStep& step) {
  step.free_motions.clear();
  if (matrix_.movable() == 0) {
    step.unstable = 0;
    return;
  }
  start_scratch(work_);
  hold_ = true;
  assemble_unmixed();
  // The stiffness of round bodies that roll is not symmetric; the count is that of its symmetric
  // part.
  const bool symmetric = make_symmetric() || rows_;
  const bool factored = solver_.factor(matrix_, symmetric);
  if (!factored || nearly_singular()) {
    if (!name_free_motions(step).empty() || !factored) return;
  }
  if (symmetric) step.unstable = std::max(0, solver_.negative_pivots() - matrix_rows());
}

int StaticNewton::unstable_with(const State& state, double load_factor,
                                const std::vector<double>& more) {
  assemble_at(state, load_factor);
  std::vector<double> blocks = nodes_.tangent();
  for (std::size_t k = 0; k < more.size(); ++k) blocks[k] += more[k];
  matrix_.set(rows_ ? values_ : newton_.values(), blocks, nodes_.residual().data(), scale());
  matrix_.hold_point_masses(system_->length_scale() * system_->length_scale());
  if (!make_symmetric() || !solver_.factor(matrix_, true)) return -1;
  return std::max(0, solver_.negative_pivots() - matrix_rows());
}

/// Softest motion, by inverse iterations with the factors of count_unstable().
SoftestMotion StaticNewton::softest() {
  SoftestMotion soft;
  if (matrix_.movable() == 0) return soft;
  if (!solver_.factor(matrix_, make_symmetric())) return soft;
  const double length = system_->length_scale();
  const int n = matrix_.movable(), bodies = 6 * system_->body_count();
  Vec x(matrix_.size()), force;
  for (int i = 0; i < x.size(); ++i) x[i] = std::sin(1.0 + 3.7 * i);
  for (int k = 0; k < kSoftestIterations; ++k) {
    x.tail(x.size() - n).setZero();
    for (int i = 0; i < bodies; ++i)
      if (i % 6 >= 3) x[i] *= length * length;
    solver_.solve(x);
    if (!x.allFinite()) return soft;
    x /= x.head(n).lpNorm<Eigen::Infinity>();
  }
  x.tail(x.size() - n).setZero();
  matrix_.times(x, force);
  double square = 0.0;
  for (int i = 0; i < n; ++i)
    square += x[i] * x[i] * (i < bodies && i % 6 >= 3 ? length * length : 1.0);
  soft.stiffness = x.head(n).dot(force.head(n)) / square / scale();
  soft.text = describe_motion(*system_, matrix_, x);
  return soft;
}

}  // namespace polhode
