// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/stepping/instant.hpp>
#include <polhode/stepping/local_error.hpp>

namespace polhode {

namespace {

/// Mean velocities of the last three steps, weighted so that their sum is Δt³ times the second
/// derivative of the velocity.
struct ThirdDifference {
  int place[3];
  double weight[3];
  double dt;

  explicit ThirdDifference(const State& state) : dt(state.dt_last) {
    double t[3];
    for (int k = 0; k < 3; ++k) {
      place[k] = (state.past_next - 1 - k + 2 * kPast) % kPast;
      t[k] = state.past_time[static_cast<std::size_t>(place[k])];
    }
    for (int k = 0; k < 3; ++k) {
      double spread = 1.0;
      for (int j = 0; j < 3; ++j)
        if (j != k) spread *= t[k] - t[j];
      weight[k] = 2.0 * dt * dt * dt / spread;
    }
  }
};

/// Estimate above which it is projected [-].
constexpr double kProjected = 1e-2;

/// The error of the last step in the motions that constraints and drives leave free: the vector of
/// the estimate is projected onto G e = 0 in the mass metric. A rotor that a drive turns is where
/// the drive puts it, whatever its rotation in a step. @eq{step-error-projected}
StepError free_error_of_last_step(const System& system, const State& state) {
  const ThirdDifference d(state);
  std::vector<Vec6> field(static_cast<std::size_t>(system.body_count()));
  for (int b = 0; b < system.body_count(); ++b) {
    const int slot = system.slot(b), lane = slot % kLanes;
    const BodyBlock& block = state.blocks[static_cast<std::size_t>(slot / kLanes)];
    Vec3 moved = Vec3::Zero(), turned = Vec3::Zero(), Theta;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        moved[i] -= d.weight[k] * block.past_v[d.place[k]][i][lane];
        turned[i] -= d.weight[k] * block.past_W[d.place[k]][i][lane];
      }
      Theta[i] = d.dt * block.past_W[d.place[0]][i][lane];
    }
    turned += Theta.squaredNorm() * Theta;
    field[static_cast<std::size_t>(b)] << moved, system.motion(state, b).Lambda() * turned;
  }
  InstantSolver(system).keep_admissible(state, field);
  StepError worst;
  for (int b = 0; b < system.body_count(); ++b) {
    const Vec6& e = field[static_cast<std::size_t>(b)];
    const double error =
        std::max(e.head<3>().norm() / system.length_scale(), e.tail<3>().norm()) / 12.0;
    if (error <= worst.value && worst.body >= 0) continue;
    worst.value = error;
    worst.body = b;
  }
  return worst;
}

}  // namespace

std::optional<StepError> error_of_last_step(const System& system, const State& state) {
  if (state.past_count < 3) return std::nullopt;
  const ThirdDifference d(state);
  const double per_length = 1.0 / system.length_scale();
  StepError worst;
  double largest = 0.0;
  for (std::size_t b = 0; b < state.blocks.size(); ++b) {
    const BodyBlock& block = state.blocks[b];
    double moved[kLanes] = {}, turned[kLanes] = {}, turn[kLanes] = {};
    for (int i = 0; i < 3; ++i)
      for (int l = 0; l < kLanes; ++l) {
        const double v = d.weight[0] * block.past_v[d.place[0]][i][l] +
                         d.weight[1] * block.past_v[d.place[1]][i][l] +
                         d.weight[2] * block.past_v[d.place[2]][i][l];
        const double W = d.weight[0] * block.past_W[d.place[0]][i][l] +
                         d.weight[1] * block.past_W[d.place[1]][i][l] +
                         d.weight[2] * block.past_W[d.place[2]][i][l];
        const double Theta = d.dt * block.past_W[d.place[0]][i][l];
        moved[l] += v * v;
        turned[l] += W * W;
        turn[l] += Theta * Theta;
      }
    for (int l = 0; l < kLanes; ++l) {
      const double error = std::max(per_length * std::sqrt(moved[l]),
                                    std::sqrt(turned[l]) + turn[l] * std::sqrt(turn[l]));
      if (error <= largest) continue;
      largest = error;
      worst.body = system.tree().body_of_slot[b * kLanes + static_cast<std::size_t>(l)];
    }
  }
  const std::size_t count = state.node_x.size();
  const double* past[3];
  for (int k = 0; k < 3; ++k)
    past[k] = state.node_past.data() + static_cast<std::size_t>(d.place[k]) * count;
  for (std::size_t k = 0; k < count; ++k) {
    const double moved = per_length * std::abs(d.weight[0] * past[0][k] + d.weight[1] * past[1][k] +
                                               d.weight[2] * past[2][k]);
    if (moved <= largest) continue;
    largest = moved;
    worst.node = static_cast<int>(k / 3);
  }
  if (worst.node >= 0) worst.body = -1;
  worst.value = largest / 12.0;
  return worst;
}

void record_error(State& state, const StepError& error, int steps) {
  StepErrors& e = state.ledger.errors;
  e.steps += steps;
  e.sum += steps * error.value;
  if (error.value <= e.largest) return;
  e.largest = error.value;
  e.time = state.t;
  e.body = error.body;
  e.node = error.node;
}

void record_last_step(const System& system, State& state) {
  auto error = error_of_last_step(system, state);
  if (!error) return;
  if (system.rows() > 0 && error->body >= 0 &&
      error->value > std::max(kProjected, state.ledger.errors.largest))
    error = free_error_of_last_step(system, state);
  record_error(state, *error);
}

void record_hard(State& state) {
  StepErrors& e = state.ledger.errors;
  if (e.hard++ == 0) e.hard_time = state.t;
}

}  // namespace polhode
