// SPDX-License-Identifier: Apache-2.0
// Newton's method for equilibria with unilateral rows.
#include <algorithm>
#include <cmath>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/statics/static_newton.hpp>

namespace polhode {

namespace {

/// Proximal stiffness of all motions in the row problem: parts of the largest stiffness, and of the
/// largest force over the size of the model. It vanishes with the increments.
constexpr double kProximalStiffness = 1e-10, kProximalForce = 1e-2;
/// Its factor while the stiffness has a negative direction, and its largest value, in largest
/// stiffnesses: no row problem is convex otherwise.
constexpr double kMoreProximal = 10.0, kMostProximal = 1e4;
/// Its factor after an increment longer than this part of the last one, and its least value, in
/// largest stiffnesses: what holds the model is softer, or nothing does.
constexpr double kLessProximalStiffness = 0.1, kLongIncrement = 0.5,
                 kLeastProximalStiffness = 1e-13;
/// Increment, and way of a body so far, after which nothing holds it, in sizes of the model.
constexpr double kEndless = 1e4, kNothingOnTheWay = 1e3;
/// Increment below which the remaining misfit of rows is rounding.
constexpr double kRowsClose = 1e-8;
/// Row problems without a solution, one after the other, after which there is none.
constexpr int kMostUnsolved = 10;
constexpr std::size_t kMostSliding = 4;

}  // namespace

/// Sets the matrix from the values of the last assembly.
void StaticNewton::set_matrix() {
  const double s = scale();
  if (rows_) {
    const auto known = [&](const linear::KktTopology& t) {
      return t.rows == topology_.rows && t.pairs.size() == topology_.pairs.size() &&
             std::equal(t.pairs.begin(), t.pairs.end(), topology_.pairs.begin(),
                        [](const linear::KktPair& x, const linear::KktPair& y) {
                          return x.a == y.a && x.b == y.b && x.rows == y.rows;
                        });
    };
    linear::KktTopology topology = newton_.topology();
    values_ = newton_.values();
    rows_->extend(topology, values_, s, hold_);
    if (!known(topology)) {
      topology_ = std::move(topology);
      matrix_ = SaddleMatrix(*system_, topology_);
      solver_.forget();
    }
    rhs_ = x_ = noise_ = Vec::Zero(matrix_.size());
    contact_noise_ = Vec::Zero(6 * system_->body_count());
  }
  matrix_.place(trial_);
  matrix_.set(rows_ ? values_ : newton_.values(), nodes_.tangent(), nodes_.residual().data(), s);
  matrix_.hold_point_masses(system_->length_scale() * system_->length_scale());
}

/// Increments with the forces of the rows: those of the smooth equations with the convex part of
/// their stiffness, then the row problem. @eq{statics-row-problem}
/// @param ease  Factor of the proximal stiffness.
bool StaticNewton::row_increment(double ease) {
  (void)make_symmetric();  // otherwise by the symmetric part: iterations then converge linearly
  const double s = scale();
  double proximal =
      ease * std::max(kProximalStiffness, kProximalForce * s * force_ / system_->length_scale());
  proximal = std::max(proximal, kLeastProximalStiffness);
  for (;; proximal *= kMoreProximal) {
    if (proximal > kMostProximal) return false;
    if (solver_.factor(matrix_, true, all_diagonal(proximal)) &&
        solver_.negative_pivots() == matrix_rows())
      break;
  }
  x_ = rhs_;
  solver_.solve(x_);
  return x_.allFinite() && rows_->solve(
                               s, [&](Vec& x) { solver_.solve(x); }, x_);
}

/// Message about a body that nothing holds.
std::string StaticNewton::endless() {
  std::string text = format("nothing holds the model: {}, and on without end",
                            describe_motion(*system_, matrix_, x_));
  if (const std::vector<std::string> slide = rows_->sliding(); !slide.empty())
    text += format("; friction is at its bound, and slides, at {}", name_list(slide, kMostSliding));
  return text;
}

StaticStep StaticNewton::solve_with_rows(State& state, double load_factor) {
  StaticStep step;
  step.load_factor = load_factor;
  enter(load_factor, state.t);
  start_at(state);
  kinks_.clear();
  resisted_ = shifted_ = hold_ = closes_ = false;
  start_scratch(work_);
  rows_->begin(last_);
  choose_scale();
  const auto fail = [&](std::string reason) {
    step.reason = std::move(reason);
    return step;
  };
  assemble();
  bool whole = true;
  double travel = 0.0, ease = 1.0;
  int unsolved = 0;
  for (;;) {
    const Balance balance = balanced(step);
    const std::size_t n = step.increments.size();
    const double miss = rows_->miss();
    if (whole && balance != Balance::off && rows_->unsolved().empty()) {
      const double e = n > 0 ? step.increments[n - 1] : 0.0;
      const double rate = std::min(n > 1 ? e / step.increments[n - 2] : e, 0.99);
      const bool small = e <= options_.tolerance || e * rate <= options_.tolerance * (1.0 - rate) ||
                         (balance == Balance::rounded && e < kRowsClose);
      const bool exact =
          miss <= 1.0 || (e < kRowsClose && miss * rows_->accuracy() <= system_->touching_gap());
      if (small && exact && !rows_->lose_static_friction()) break;
    }
    if (stopped()) return fail("stopped");
    if (step.iterations == options_.max_iterations)
      return fail(unsolved > 0
                      ? rows_->unsolved()
                      : format("has not converged in {} iterations", options_.max_iterations));
    ++step.iterations;
    if (!row_increment(ease))
      return fail(rows_->unsolved().empty()
                      ? "the linear system is singular, or a value is not finite"
                      : rows_->unsolved());
    unsolved = rows_->unsolved().empty() ? 0 : unsolved + 1;
    if (unsolved == kMostUnsolved) return fail(rows_->unsolved());
    const double part = std::min(rows_->free_part(), free_part_of_increment());
    const double most = apply(part, step);
    if (n > 0 && most > std::max(kRowsClose, kLongIncrement * step.increments.back())) {
      if (most <= kEndless) ease *= kLessProximalStiffness;
    } else if (!whole) {
      ease = 1.0;  // something was on the way
    }
    step.increments.push_back(most);
    travel += part * most;
    if (!std::isfinite(most)) return fail("diverges");
    if (most > kEndless && travel > kNothingOnTheWay) return fail(endless());
    for (const int b : rows_->bodies_with_friction())
      if (system_->motion(work_, b).q.dot(system_->motion(last_, b).q) <= 0.0)
        return fail(format("body '{}' turns by half a turn or more in one load step",
                           system_->bodies()[static_cast<std::size_t>(b)].name));
    rows_->move(part);
    whole = part == 1.0;
    assemble();
  }
  if (const std::string refusal = refused(step); !refusal.empty()) return fail(refusal);
  if (const std::string overlap = rows_->overlap(); !overlap.empty()) return fail(overlap);
  if (const std::string wrong = rows_->inadmissible(); !wrong.empty()) return fail(wrong);
  step.converged = true;
  closes_ = rows_->closes();
  if (closes_) rows_->note_closing();
  rows_->freeze();
  commit(state, load_factor);
  count_unstable(step);
  hold_ = false;
  rows_->commit(state);
  last_ = work_ = state;
  return step;
}

}  // namespace polhode
