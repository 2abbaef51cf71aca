// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/assembly/system.hpp>

namespace polhode {

struct ModeOptions {
  int count = 10;            ///< Modes wanted, the lowest.
  double load_factor = 1.0;  ///< Of the equilibrium.
};

/// A free vibration about an equilibrium.
struct Mode {
  double omega_squared = 0.0;  ///< [rad²/s²]; negative: the equilibrium is unstable.
  double frequency = 0.0;      ///< [Hz], of |ω²|.
  bool rigid = false;          ///< No stiffness resists it: ω² is zero to rounding.
  Vec shape;  ///< (Δr, Δθ) by body, then the unknowns of nodes; mass-normalised, φᵀMφ = 1.
  Vec3 participation = Vec3::Zero();   ///< φᵀM e for translation along x, y, z [√kg].
  Vec3 effective_mass = Vec3::Zero();  ///< Its square, as part of the mass that moves [-].
  double residual = 0.0;               ///< |Kφ − ω²Mφ − Gᵀμ| / (ω² |Mφ|) [-].
};

struct ModesReport {
  std::vector<Mode> modes;  ///< Lowest first.
  double total_mass = 0.0;  ///< [kg]
  int freedoms = -1;        ///< 6 bodies + nodes' unknowns − rank of the constraints, if known.
  double shift = 0.0;       ///< ω² below which the modes were counted [rad²/s²].
  int below_shift = 0;      ///< By the inertia of LDLᵀ; modes found must be as many.
  bool complete = true;     ///< They are: no mode was missed.
  double unbalanced = 0.0;  ///< Largest unbalanced force of the state, as part of the largest [-].
  double asymmetry = 0.0;   ///< Of the stiffness, whose symmetric part counts [-].
  std::vector<std::string> warnings;
};

/// Natural frequencies and shapes about an equilibrium, joints, springs, beams and solids included:
///
///   K φ − Gᵀμ = ω² M φ,   G φ = 0.   @eq{modes-saddle}
///
/// K is the tangent of statics with its geometric terms and those of the multipliers. Few unknowns
/// are solved for densely, many by Lanczos iterations on the inverse of the shifted saddle matrix.
/// @param equilibrium  Velocities do not count.
/// @throws InputError if nothing can move.
[[nodiscard]] ModesReport find_modes(const System& system, const State& equilibrium,
                                     const ModeOptions& options = {});

/// Displacements of all nodes in a mode, three each.
[[nodiscard]] std::vector<double> node_shape(const System& system, const State& equilibrium,
                                             const Mode& mode);

}  // namespace polhode
