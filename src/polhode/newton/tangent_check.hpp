// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/dynamics/momentum_step.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// Entry of a tangent with the largest deviation from central differences of its residual.
struct TangentDifference {
  double error = 0.0;     ///< Relative to the largest entry of its row [-].
  double analytic = 0.0;  ///< The entry, of the scaled system.
  double numeric = 0.0;
  std::string of;      ///< "spring 'left'", "contact of 'ball' and ground"; empty: the whole.
  std::string row;     ///< "moment y of body 'arm'", "row 2 of joint 'elbow'", "force z of node 3".
  std::string column;  ///< "turn about y of body 'arm'", "displacement x of node 3".
};

/// Interactions, elements or contacts of one kind, each tangent compared with differences.
struct TangentPart {
  std::string kind;  ///< "joint", "solid 'pad': hex8 eas9", "contact", "bodies", "nodes".
  int compared = 0, of = 0;
  TangentDifference worst;
};

/// Deviations of tangents from central differences: of the assembled one, and of each part alone,
/// so that an error is reported with its name.
struct TangentReport {
  TangentDifference worst;  ///< Of the parts and of the assembled tangent.
  std::vector<TangentPart> parts;
  /// Parts that were not compared, and why: one short phrase each.
  std::vector<std::string> left_out;
  int bodies_moved = 0;  ///< Bodies whose assembled columns were compared.
  int nodes_moved = 0;   ///< Likewise, of deformable solids.

  [[nodiscard]] double error() const { return worst.error; }
  [[nodiscard]] std::string text() const;
};

/// Agreement to expect of first-order differences.
inline constexpr double kTangentTolerance = 1e-6;

/// Compares the tangents of one step from a state with central differences: of every interaction,
/// group of elements and pair of bodies in contact, and of the whole as solved by Newton, with the
/// nodes of solids eliminated. The step continues with the velocities of the state and is shortened
/// where it would pass through something. Multipliers are those of the state; where they are all
/// zero, weights of the bodies, so that the geometric stiffness is tested.
///
/// Histories of contacts between bodies are dropped.
///
/// @param most_bodies  Largest number of displaced bodies, evenly chosen: the time grows with its
/// square.
[[nodiscard]] TangentReport check_tangents(const System& system, const State& state, double dt,
                                           double rho_inf,
                                           MomentumRate form = MomentumRate::momentum,
                                           int most_bodies = 200);

}  // namespace polhode
