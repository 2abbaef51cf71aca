// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/dynamics/momentum_step.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// The entry of a tangent that is farthest from central differences of its residual.
struct TangentDifference {
  double error = 0.0;     ///< Relative to the largest entry of its row [-].
  double analytic = 0.0;  ///< The entry, of the scaled system.
  double numeric = 0.0;
  std::string of;      ///< "spring 'left'", "contact of 'ball' and ground"; empty: the whole.
  std::string row;     ///< "moment y of body 'arm'", "row 2 of joint 'elbow'", "force z of node 3".
  std::string column;  ///< "turn about y of body 'arm'", "displacement x of node 3".
};

/// Interactions, elements or contacts of one kind, each with its own tangent against differences.
struct TangentPart {
  std::string kind;  ///< "joint", "solid 'pad': hex8 eas9", "contact", "bodies", "nodes".
  int compared = 0, of = 0;
  TangentDifference worst;
};

/// How far tangents are from central differences: the assembled one, and that of each part by
/// itself, so that a wrong one is told by name.
struct TangentReport {
  TangentDifference worst;  ///< Of the parts and of the assembled tangent.
  std::vector<TangentPart> parts;
  std::vector<std::string> left_out;  ///< What was not compared, and why: one short phrase each.
  int bodies_moved = 0;               ///< Bodies whose assembled columns were compared.
  int nodes_moved = 0;                ///< Likewise, of deformable solids.

  [[nodiscard]] double error() const { return worst.error; }
  [[nodiscard]] std::string text() const;
};

/// Differences of first-order quality agree to about this much.
inline constexpr double kTangentTolerance = 1e-6;

/// Compares the tangents of one step from a state with central differences: of every interaction,
/// group of elements and pair of bodies in contact, and of the whole as Newton solves it, with the
/// nodes of solids eliminated. The step is the one that goes on with the velocities of the state,
/// held back where it would lead through something; multipliers are those of the state, and where
/// they are all zero, weights of the bodies, so that no geometric stiffness goes unseen.
///
/// Contacts between bodies forget what they know of the last step.
///
/// @param most_bodies  At most so many bodies are moved, evenly chosen: time grows with its square.
[[nodiscard]] TangentReport check_tangents(const System& system, const State& state, double dt,
                                           double rho_inf,
                                           MomentumRate form = MomentumRate::momentum,
                                           int most_bodies = 200);

}  // namespace polhode
