// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/equations/trial.hpp>
#include <polhode/kernels/tree_data.hpp>

namespace polhode {

/// Motion of the nodes of deformable solids over a step: Newmark's formulas as for the bodies'
/// centres, component by component. @eq{eq:td-Newmark-COM}

/// Predicts the trial's nodes. Free nodes move with velocities extrapolated from the mean
/// velocities of past steps (with those at t_n, if weights.count is 0), prescribed components
/// follow their functions, bonded nodes follow their bodies, which have been predicted before.
void predict_nodes(const System& system, const State& state, Trial& trial,
                   const PredictWeights& weights);
/// Updates bonded nodes after their bodies have moved: x = r + Λ Z. Velocities of all nodes if
/// `rates`.
void follow_bodies(const System& system, const State& state, Trial& trial);
/// Newmark velocities at t_{n+1} of all nodes from the increments. With those at t_n they give the
/// mean over the step, which the damping of elements uses.
void update_node_velocities(const System& system, const State& state, Trial& trial);
/// Velocities of the nodes at t_{n+1}: Newmark's, and for prescribed motions the given rate.
void end_velocities(const System& system, const Trial& trial, std::vector<double>& v);
/// Keeps a part of the trial's motion over the step, of bodies and of nodes. Prescribed components
/// still follow their functions.
void shorten_motion(const System& system, const State& state, double part, Trial& trial);
/// The trial's nodes as a NodeStep for elements.
[[nodiscard]] NodeStep node_step(const State& state, const Trial& trial);
/// The nodes of a state at its instant, velocities included.
[[nodiscard]] NodeStep node_instant(const System& system, const State& state,
                                    const StepContext& context);
/// Rate of the nodes' momentum at t_{n+αm} per mass: accelerations, three a node.
/// @eq{eq:ga-momenta-Newmark}
void node_accelerations(const System& system, const State& state, const Trial& trial,
                        std::vector<double>& a);
/// Commits the nodes and the elements' histories to t_{n+1}. Bodies have been committed.
void commit_nodes(const System& system, State& state, const Trial& trial);
/// Sets prescribed components to their initial values and rates.
void start_prescribed(const System& system, State& state);
/// Moves bonded nodes of a state to their bodies, with the velocities of these.
void bond_nodes(const System& system, State& state);

}  // namespace polhode
