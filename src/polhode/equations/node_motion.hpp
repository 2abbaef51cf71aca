// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/equations/trial.hpp>
#include <polhode/kernels/tree_data.hpp>

namespace polhode {

/// Motion of the nodes of deformable solids over a step: Newmark like that of the bodies' centres,
/// component by component. @eq{eq:td-Newmark-COM}

/// Fills the trial's nodes: free ones go on as extrapolated from the mean velocities of past steps
/// (with their velocities, if weights.count is 0), prescribed components go where they must, bonded
/// ones follow their bodies, which have been predicted before.
void predict_nodes(const System& system, const State& state, Trial& trial,
                   const PredictWeights& weights);
/// Bonded nodes after their bodies have moved: x = r + Λ Z. Velocities of all nodes if `rates`.
void follow_bodies(const System& system, const State& state, Trial& trial);
/// Newmark velocities at t_{n+1} from the increments, all nodes: with those at t_n they make the
/// mean over the step, by which elements damp.
void update_node_velocities(const System& system, const State& state, Trial& trial);
/// Velocities that the nodes have at t_{n+1}: Newmark's, and where a motion is prescribed its rate.
void end_velocities(const System& system, const Trial& trial, std::vector<double>& v);
/// Leaves a part of the trial's motion over the step, of bodies and of nodes. Prescribed components
/// go where they must.
void shorten_motion(const System& system, const State& state, double part, Trial& trial);
/// The trial's nodes as elements see them.
[[nodiscard]] NodeStep node_step(const State& state, const Trial& trial);
/// The nodes of a state at its instant, velocities included.
[[nodiscard]] NodeStep node_instant(const State& state, const StepContext& context);
/// Rate of the nodes' momentum at t_{n+αm} per mass: accelerations, three a node.
/// @eq{eq:ga-momenta-Newmark}
void node_accelerations(const System& system, const State& state, const Trial& trial,
                        std::vector<double>& a);
/// Moves the state's nodes and the elements' histories to t_{n+1}. Bodies have been committed.
void commit_nodes(const System& system, State& state, const Trial& trial);
/// Puts prescribed components where they begin, with the rates that they begin with.
void start_prescribed(const System& system, State& state);
/// Puts bonded nodes of a state where their bodies are, with the velocities of these.
void bond_nodes(const System& system, State& state);

}  // namespace polhode
