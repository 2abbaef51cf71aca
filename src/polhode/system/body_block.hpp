// SPDX-License-Identifier: Apache-2.0
// Plain data only: the SIMD kernels include this for several instruction sets, so nothing here may
// instantiate library code.
#pragma once

namespace polhode {

/// Number of bodies per block: each number of eight bodies is stored contiguously, so that one SIMD
/// instruction serves several bodies. The layout is the same for every instruction set.
inline constexpr int kLanes = 8;
/// Number of past steps whose mean velocities the predictor uses.
inline constexpr int kPast = 4;

using Lane = double[kLanes];
using Lane3 = double[3][kLanes];

/// Motion of eight bodies at t_n. Lanes without a body contain a body at rest.
struct alignas(64) BodyBlock {
  Lane3 r;              ///< Centre of mass, world [m].
  Lane3 r_rest;         ///< Rounding error of r (Kahan summation) [m].
  double q[4][kLanes];  ///< Unit quaternion (w, x, y, z), body to world.
  Lane3 v;              ///< [m/s], world.
  Lane3 W;              ///< Material angular velocity [rad/s].
  Lane3 a;      ///< Newmark acceleration, of time t_n + δΔt [m/s²]; used for ρ∞ < 1 only.
  Lane3 A;      ///< Material angular acceleration, likewise [rad/s²].
  Lane3 h_dot;  ///< Rate of angular momentum, world, likewise [N m].
  Lane3 past_v[kPast];  ///< Mean velocities u/Δt of the last steps, ring [m/s].
  Lane3 past_W[kPast];  ///< Mean material angular velocities Θ/Δt, ring [rad/s].
};

/// Eight bodies at the current iterate of t_{n+1}, and the data of t_n that the step needs.
struct alignas(64) TrialBlock {
  Lane3 r;                   ///< r_{n+1} [m]. First, with Lambda and Lambda_n: joints gather these.
  double Lambda[9][kLanes];  ///< Λ_{n+1}, row by row.
  double Lambda_n[9][kLanes];  ///< Λ_n.
  Lane3 u;                     ///< r_{n+1} − r_n [m].
  Lane3 theta;                 ///< Cayley vector of the step, world: Λ_{n+1} = cay[θ] Λ_n [-].
  Lane3 h_n;                   ///< Angular momentum at t_n, world [N m s].
};

/// Consecutive blocks whose joints to the parent have one shape.
struct TreeRun {
  int first_block, blocks, shape;
};

/// A section of the elimination order: its runs and its positions in the order, half-open.
struct TreeChunk {
  int first_run, last_run, first, last;
};

/// Largest number of bodies in a chunk: their rows stay in the cache between assembly and
/// elimination.
inline constexpr int kChunkBodies = 64;

}  // namespace polhode
