// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/system/system.hpp>

namespace polhode {

/// The step being solved.
struct Trial {
  StepContext context;
  std::vector<TrialBlock> blocks;  ///< By slot; the last block is the ground.
  std::vector<double> lambda;      ///< Current iterate by row.
  // Nodes of deformable solids at t_{n+1}, three numbers each.
  std::vector<double> node_x, node_u, node_v;  ///< Position [m], x_{n+1} − x_n [m], velocity [m/s].
  std::vector<double> prescribed_v;            ///< At t_{n+1}, of prescribed components [m/s].
  std::vector<double> element_scratch;         ///< Of groups of elements: internal unknowns, ...
  std::vector<double> lambda_centre;           ///< By row: proximal centre; zero until converged.

  double compliance_scale = 0.0;  ///< Of statics, where it is the scale s; else 0 [m/N].

  /// s = βΔt²/m_ref: momentum rows are multiplied by it, λ̂ = s λ.
  [[nodiscard]] double scale(const System& system) const {
    if (compliance_scale > 0.0) return compliance_scale;
    return context.ga.beta * context.dt * context.dt / system.mean_mass();
  }
};

/// Allocates the blocks of bodies and ground.
void size_blocks(const State& state, Trial& trial);
/// Initialises the trial, one body after the other: no motion, λ of t_n, proximal centre zero. The
/// context must have been set. (The stepper's predictor does this several bodies at a time.)
void start_trial(const System& system, const State& state, Trial& trial);
/// Step of a body from the state at t_n and the trial at t_{n+1}; velocities by Newmark.
[[nodiscard]] BodyStep body_step(const System& system, const State& state, const Trial& trial,
                                 int body);
/// View of the same step for an interaction.
[[nodiscard]] PairView pair_view(const System& system, const State& state, const Trial& trial,
                                 const InteractionRef& ref);
/// Updates a body's step at t_{n+1} after an iteration; velocities only if `rates`.
void update_body_step(const System& system, const State& state, const Trial& trial, int body,
                      BodyStep& step, bool rates);
/// Sets a body's u, θ in the trial, and with them r and Λ at t_{n+1}.
void move_body(const State& state, Trial& trial, int slot, const Vec3& u, const Vec3& theta);

}  // namespace polhode
