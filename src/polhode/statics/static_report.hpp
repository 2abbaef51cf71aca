// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/newton/row_check.hpp>

namespace polhode {

/// Search at one load factor.
struct StaticStep {
  bool converged = false;
  double load_factor = 0.0;
  int iterations = 0;
  std::vector<double> increments;  ///< Largest scaled increment, one per iteration [-].
  double residual = 0.0;           ///< Largest unbalanced force [N], moments over ℓ.
  double force = 0.0;              ///< Largest force, the reference of the residual [N].
  int unstable = -1;     ///< Number of unstable directions of the equilibrium; −1: not known.
  bool relaxed = false;  ///< Found by relaxation.
  std::string reason;    ///< If not converged: "diverges" ...
  std::string worst;     ///< Largest increment or residual: "body 'forearm'".
  std::vector<std::string> free_motions;  ///< Motions without stiffness, found in the search.
};

/// Rows that cannot all hold at a load factor.
struct RowGap {
  std::vector<std::string> names;  ///< "joint 'elbow'"; empty: they can.
  OpenRow open;                    ///< The drive among them, or another, with the whole gap.
};

/// A load at which the stability of the equilibrium changes: a limit point or a branch.
struct LimitPoint {
  double load_factor = 0.0;
  int unstable = -1;    ///< Number of unstable directions of equilibria beyond it; −1: not known.
  std::string motion;   ///< Description of the motion whose stiffness vanishes there.
  bool jump = false;    ///< The equilibrium ends there: those beyond lie on another branch.
  double distance = 0;  ///< Distance to that branch: lengths of the model, or rad [-].
};

/// Report of a static analysis.
struct StaticReport {
  bool converged = false;              ///< The full load is carried.
  double load_factor = 0.0;            ///< Reached, in [0, 1]; in a history the time [s].
  double history = 0.0;                ///< End of a history [s]; 0: none.
  std::vector<StaticStep> steps;       ///< All trials, in order.
  int iterations = 0;                  ///< Of all trials.
  double residual = 0.0, force = 0.0;  ///< Largest unbalanced and largest force at the end [N].
  int unstable = -1;  ///< Number of unstable directions of the equilibrium; −1: not known.
  std::vector<std::string> free_motions;  ///< Motions without stiffness.
  std::vector<LimitPoint> limit_points;   ///< Limit points passed, by load factor.
  std::vector<std::string> slack;         ///< Cables without tension at the end.
  int relaxations = 0;  ///< Equilibria found by relaxation where Newton's method failed.
  std::string message;  ///< If not converged: what happened, where, and a hint what to try.
};

}  // namespace polhode
