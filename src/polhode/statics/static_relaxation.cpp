// SPDX-License-Identifier: Apache-2.0
// Equilibria with initially slack or yielding parts: descent in small steps.
#include <algorithm>
#include <cmath>

#include <polhode/statics/static_newton.hpp>

namespace polhode {

namespace {

constexpr int kMaxSteps = 2000;
/// Displacement aimed at in each step, as a part of the model's size, and largest displacement or
/// rotation [-].
constexpr double kMove = 0.02, kMaxMove = 0.1;
/// Factors by which the damping may change from one step to the next.
constexpr double kEase = 0.5, kBrake = 1.5;
/// Factor on the damping where the displacement is against the unbalanced force.
constexpr double kUphill = 4.0;
/// Cosine between the two below which it is; gaps of joints give smaller ones. Largest number of
/// such steps in turn.
constexpr double kAgainst = -0.1;
constexpr int kMostUphill = 20;
/// Step size, as a part of the model's size, below which Newton's method is tried, and number of
/// steps between trials.
constexpr double kSmallSpeed = 1e-3;
constexpr int kTries = 50;
/// Number of steps, about half the model's size, after which the unbalanced force of a model
/// without slack parts has to be below this part of the first one. If not, steps grow to the
/// largest, and the search ends after the second number of them, about twenty times that size:
/// springs with free play or a free length meet the model within it.
constexpr int kLook = 25, kFarLook = 225;
constexpr double kSameForce = 0.999;

}  // namespace

/// Stiffness of all unknowns, rotations times ℓ².
std::vector<double> StaticNewton::all_diagonal(double stiffness) const {
  const double square = system_->length_scale() * system_->length_scale();
  std::vector<double> diagonal(static_cast<std::size_t>(matrix_.movable()), stiffness);
  for (int i = 0; i < 6 * system_->body_count(); ++i)
    if (i % 6 >= 3) diagonal[static_cast<std::size_t>(i)] *= square;
  return diagonal;
}

/// @eq{statics-relaxation}
StaticStep StaticNewton::relax(State& state, double load_factor, bool slack) {
  StaticStep step;
  step.load_factor = load_factor;
  enter(load_factor, state.t);
  start_at(state);
  x_before_.clear();
  kinks_.clear();
  start_scratch(work_);
  choose_scale();
  const bool mixed = mixed_;
  mixed_ = false;  // no Newton iterations: the stresses are the actual ones
  nodes_.set_static(true, false);
  const auto leave = [&](StaticStep result) {
    mixed_ = mixed;
    nodes_.set_static(true, mixed_);
    result.relaxed = true;
    return result;
  };
  const int bodies = 6 * system_->body_count();
  const double length = system_->length_scale();
  double resistance = 0.0, first_force = 0.0;
  int uphill = 0;
  bool coasts = false;  // without more resistance than at the start
  for (int k = 0; k < kMaxSteps && !stopped(); ++k) {
    if (!(assemble().least_volume > 0.0)) break;
    aim(given_);
    ++step.iterations;
    if (k == 0) {  // the largest force causes this displacement at its node
      for (int i = 0; i < matrix_.movable(); ++i)
        resistance =
            std::max(resistance, std::abs(rhs_[i]) / (i < bodies && i % 6 >= 3 ? length : 1.0));
      resistance /= kMove * length;
    }
    measure(step);
    if (k == 0) first_force = step.residual;
    if (k <= kLook || coasts)
      coasts = !slack && k >= kLook && step.residual > kSameForce * first_force;
    if (coasts && k >= kFarLook) break;
    if (!(resistance > 0.0)) break;
    if (!solver_.factor(matrix_, make_symmetric(), all_diagonal(resistance))) {
      resistance *= kBrake;
      continue;
    }
    x_ = rhs_;
    solver_.solve(x_);
    if (!x_.allFinite()) break;
    double power = 0.0, displaced = 0.0, pushed = 0.0;
    for (int i = 0; i < matrix_.movable(); ++i) {
      power += x_[i] * rhs_[i];
      displaced += x_[i] * x_[i];
      pushed += rhs_[i] * rhs_[i];
    }
    if (power < kAgainst * std::sqrt(displaced * pushed) && uphill++ < kMostUphill) {
      resistance *= kUphill;  // as beyond a limit point, where the stiffness is negative
      continue;
    }
    uphill = 0;
    double move = 0.0;
    for (int i = 0; i < matrix_.movable(); ++i)
      move = std::max(move, std::abs(x_[i]) / (i < bodies && i % 6 >= 3 ? 1.0 : length));
    const double part = std::min(move > kMaxMove ? kMaxMove / move : 1.0, free_part_of_increment());
    step.increments.push_back(apply(part, step));
    resistance *= std::clamp(move / (coasts ? kMaxMove : kMove), kEase, kBrake);
    if ((move < kSmallSpeed && k % 5 == 4) || k % kTries == kTries - 1) {
      const State here = work_;
      const State from = last_;
      State near = here;
      mixed_ = mixed;
      nodes_.set_static(true, mixed_);
      StaticStep found = solve(near, load_factor);
      found.iterations += step.iterations;
      if (found.converged && found.unstable <= 0) {
        state = near;
        return leave(found);
      }
      mixed_ = false;  // it diverged: continue from its start
      nodes_.set_static(true, false);
      work_ = here;
      last_ = from;
      enter(load_factor, from.t);
      start_scratch(work_);
    }
  }
  step.converged = false;
  step.reason = "dynamic relaxation has not converged";
  return leave(step);
}

}  // namespace polhode
