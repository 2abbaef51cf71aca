// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <polhode/core/types.hpp>
#include <polhode/dynamics/body_motion.hpp>
#include <polhode/system/body_block.hpp>

namespace polhode {

/// Vector of a node in a field of three numbers per node.
[[nodiscard]] inline Eigen::Map<const Vec3> at_node(const std::vector<double>& field, int node) {
  return Eigen::Map<const Vec3>(field.data() + 3 * node);
}
[[nodiscard]] inline Eigen::Map<Vec3> at_node(std::vector<double>& field, int node) {
  return Eigen::Map<Vec3>(field.data() + 3 * node);
}

/// A sum with compensated rounding (Neumaier).
struct ExactSum {
  double sum = 0.0, rest = 0.0;
  void add(double x) {
    const double t = sum + x;
    rest += (sum < 0 ? -sum : sum) >= (x < 0 ? -x : x) ? (sum - t) + x : (x - t) + sum;
    sum = t;
  }
  [[nodiscard]] double value() const { return sum + rest; }
};

/// Estimated errors of single steps: lengths over ℓ, angles in radians. @eq{step-error}
struct StepErrors {
  double largest = 0.0, sum = 0.0;
  double time = 0.0;         ///< End of the step with the largest [s].
  int body = -1, node = -1;  ///< Location of the largest; −1: not known.
  std::int64_t steps = 0;    ///< Steps with an estimate.
  std::int64_t hard = 0;     ///< Steps in which Newton's method only just converged.
  double hard_time = 0.0;    ///< End of the first of these [s].
};

/// Impacts whose impulses do not meet the law of impact: velocities that differ from it by more
/// than their rounding allows.
struct UnsolvedImpacts {
  std::int64_t steps = 0;  ///< Number of steps with one.
  double largest = 0.0;    ///< Largest error of a velocity [m/s].
  double time = 0.0;       ///< Its time [s].
  int a = -1, b = -1;      ///< Its bodies; −1: not known, or the ground.
  int group = -1;          ///< Elements in contact instead of bodies; −1: none.
};

/// Balance of the run so far, in SI units.
struct Ledger {
  double initial_energy = 0.0;                     ///< T + V at the start [J].
  double initial_potential = 0.0;                  ///< V at the start [J].
  std::array<double, 3> initial_p{}, initial_l{};  ///< Momentum, angular momentum about the origin.
  ExactSum dissipated, put_in;                     ///< [J]
  std::array<ExactSum, 3> impulse, angular_impulse;         ///< Of loads and ground [N s, N m s].
  double energy_scale = 0.0, p_scale = 0.0, l_scale = 0.0;  ///< Largest magnitudes reached.
  double energy_drift = 0.0, p_drift = 0.0, l_drift = 0.0;  ///< Largest absolute drifts.
  /// Rounding noise in energy [J], and the sums of its squares for the momenta.
  double energy_noise = 0.0, p_noise = 0.0, l_noise = 0.0;
  double constraint_max = 0.0;  ///< Largest residual [m or -].
  StepErrors errors;
  UnsolvedImpacts impacts;
  std::int64_t steps = 0, rejected = 0, iterations = 0;
};

/// Stored accelerations for ρ∞ < 1, where they depend on the length of the step: their values after
/// the last step, and their rates of change. World components but for A.
struct alignas(64) RatesBlock {
  Lane3 a, A, h_dot;                 ///< As in BodyBlock, at t_n + δΔt of the last step.
  Lane3 a_rate, A_rate, h_dot_rate;  ///< Their change over the last step, divided by its length.
};

/// Complete state of a run. A value type: it can be copied, saved, and compared bit for bit.
struct State {
  double t = 0.0;                 ///< [s]
  std::vector<BodyBlock> blocks;  ///< By slot, see LaneOrder.
  std::vector<RatesBlock> rates;  ///< Likewise, for ρ∞ < 1; else empty.
  double rates_dt = 0.0;          ///< Step for which the accelerations in `rates` hold [s].
  std::vector<double> lambda;     ///< Multipliers by row, acting at t_{n+αf} of the last step.
  std::vector<double> history;    ///< Of interactions: turns of an angle, ...
  // Nodes of deformable solids, three numbers each, world.
  std::vector<double> node_x;      ///< [m]
  std::vector<double> node_v;      ///< Newmark velocities [m/s].
  std::vector<double> node_a;      ///< Newmark accelerations of t_n + δΔt [m/s²]; for ρ∞ < 1.
  std::vector<double> node_past;   ///< Mean velocities of the last steps, ring [m/s].
  std::vector<double> node_rates;  ///< Of node_a like `rates`: stored numbers, then their changes.
  std::vector<double> element_history;  ///< Of groups of elements: enhanced strains, ...
  std::vector<double> contacts;         ///< Of BodyContacts: references of candidates, points.
  int past_count = 0;                   ///< Valid entries of the predictor's rings.
  int past_next = 0;                    ///< Ring position to be written next.
  std::array<double, kPast>
      past_time{};          ///< Middle times of the stored steps [s], by ring position.
  double dt_last = 0.0;     ///< Length of the last accepted step [s].
  double dt_next = 0.0;     ///< Next length planned by the step control [s].
  double error_last = 0.0;  ///< Error estimate of the last step, or the noise level [-].
  double turned = 0.0;      ///< Largest possible rotation of a body since turns were counted [rad].
  /// Consecutive steps with few iterations; -1: the length has to be found again.
  int easy_steps = 0;
  /// Members of the next extrapolated step; 1: steps of order 2 for now; 0: not yet chosen.
  int columns = 0;
  /// Steps until extrapolation and order 2 are compared, or until extrapolation is tried again; and
  /// the number of steps after which they were last [-].
  int steps_to_compare = 0, steps_compared = 0;
  Ledger ledger;

  [[nodiscard]] BodyMotion motion(int slot) const;
  void set_motion(int slot, const BodyMotion& m);
};

}  // namespace polhode
