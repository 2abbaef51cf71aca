// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <complex>
#include <exception>
#include <optional>
#include <string>
#include <vector>

#include <polhode/dynamics/turning_frame.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

struct ModeOptions {
  /// Requested number of modes, those closest to zero; overdamped ones are additional.
  int count = 10;
  double load_factor = 1.0;  ///< Of the equilibrium.
  /// By body: steady angular velocity in body axes, about which vibrations are computed [rad/s].
  /// Empty: nothing rotates.
  std::vector<Vec3> spin = {};
  /// Frame in which the model is at rest and the modes are seen; the system has its centrifugal
  /// forces.
  std::optional<TurningFrame> frame = {};
  const std::atomic<bool>* stop = nullptr;  ///< Ends the iterations when it becomes true.
};

/// The end of a search for modes by ModeOptions::stop.
class ModesStopped : public std::exception {
 public:
  [[nodiscard]] const char* what() const noexcept override { return "modes: stopped"; }
};

/// Behaviour of a motion exp(λt).
enum class ModeKind {
  oscillation,  ///< Of constant or decaying amplitude.
  flutter,      ///< An oscillation that grows.
  divergence,   ///< Grows without oscillating: the equilibrium is unstable.
  overdamped,   ///< Decays without oscillating.
  free          ///< No stiffness and no damping: λ is zero to rounding.
};
/// "oscillation", ...
[[nodiscard]] const char* kind_name(ModeKind kind);

/// Sense of a motion in the world about the axis of a steady spin.
enum class Whirl {
  unknown,  ///< Neither of the others alone, or no resultant.
  none,     ///< Along the axis or about it, or nothing turns.
  forward,  ///< Around the axis, in the sense of the spin.
  backward
};
/// "unknown", ...
[[nodiscard]] const char* whirl_name(Whirl whirl);

/// A free vibration about an equilibrium: the motion Re((shape + i shape_imag) exp(λt)).
struct Mode {
  std::complex<double> eigenvalue;  ///< λ, of a conjugate pair the one with Im λ ≥ 0 [rad/s].
  ModeKind kind = ModeKind::oscillation;
  double frequency = 0.0;  ///< |λ|/2π [Hz]; without damping the frequency of the oscillation.
  double damping = 0.0;  ///< −Re λ/|λ| [-]: the damping ratio; negative: grows; of free motions 0.
  double omega_squared = 0.0;  ///< |λ|² [rad²/s²], negative of divergence.
  Whirl whirl = Whirl::unknown;
  /// Frequency in the world [Hz], where the whirl is known; `frequency` is that in the frame.
  std::optional<double> world_frequency;
  bool rigid = false;  ///< The kind is free.
  std::string motion;  ///< Of a free motion: "body 'bob' turns about z".
  Vec shape;  ///< (Δr, Δθ) by body, then the unknowns of nodes; mass-normalised, φᴴMφ = 1.
  Vec shape_imag;  ///< A quarter of a period later, with the other sign; empty: zero.
  Vec3 participation = Vec3::Zero();   ///< Size of φᵀM e for translation along x, y, z [√kg].
  Vec3 effective_mass = Vec3::Zero();  ///< Its square, as a part of the moving mass [-].
  /// Change of the shape by an inverse iteration, in the metric of M, times (σ² + |λ|²)/|λ|² [-].
  double residual = 0.0;
};

struct ModesReport {
  std::vector<Mode> modes;  ///< Divergence first, the fastest foremost; then by |λ|;
                            ///< behind them what is overdamped.
  double total_mass = 0.0;  ///< [kg]
  int freedoms = -1;        ///< 6 bodies + nodes' unknowns − rank of the constraints, if known.
  bool symmetric = true;    ///< No damping, rotation or follower forces: λ² is real.
  bool counted = false;     ///< Modes below a shift were counted, see `complete`.
  double shift = 0.0;       ///< ω² below which the modes were counted [rad²/s²].
  int below_shift = 0;      ///< By the inertia of LDLᵀ; as many modes must be found.
  bool complete = true;     ///< The numbers agree: no mode was missed.
  /// Largest unbalanced force of the state, relative to the largest force [-].
  double unbalanced = 0.0;
  double asymmetry = 0.0;  ///< Of the stiffness [-].
  /// Contacts and stops with a force that are rows: "the contact of body 'a' and the ground:
  /// 4 points, held along the normal and by friction". They hold like joints.
  std::vector<std::string> held;
  std::vector<std::string> warnings;
};

/// Natural frequencies and shapes about an equilibrium, joints, springs, beams and solids included:
///
///   K φ − Gᵀμ = ω² M φ,   G φ = 0,   λ = iω   @eq{modes-saddle}
///
/// or, with follower forces, damping or rotating bodies,
///
///   λ² M φ + λ C φ + K φ − Gᵀμ = 0,   G φ = 0   @eq{modes-damped}
///
/// In a turning frame C has the Coriolis forces and K those of the centrifugal ones.
/// @eq{spin-matrices}
///
/// K is the tangent of statics with its geometric terms and those of the multipliers. Few unknowns
/// are solved densely, many by Lanczos or Arnoldi iterations on the inverse of the shifted saddle
/// matrix.
/// @param equilibrium  Velocities are ignored, except for options.spin.
/// @throws ModesStopped
[[nodiscard]] ModesReport find_modes(const System& system, const State& equilibrium,
                                     const ModeOptions& options = {});

/// Displacements of all nodes in a shape, three each.
[[nodiscard]] std::vector<double> node_shape(const System& system, const State& equilibrium,
                                             const Vec& shape);

}  // namespace polhode
