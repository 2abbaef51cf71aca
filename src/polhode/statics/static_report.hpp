// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace polhode {

/// How the search at one load factor went.
struct StaticStep {
  bool converged = false;
  double load_factor = 0.0;
  int iterations = 0;
  std::vector<double> increments;  ///< Largest scaled increment, one per iteration [-].
  double residual = 0.0;           ///< Largest unbalanced force [N], moments over ℓ.
  double force = 0.0;              ///< Largest force it is compared with [N].
  int unstable = -1;     ///< Directions in which the equilibrium is unstable; −1: not known.
  bool relaxed = false;  ///< Found by relaxation.
  std::string reason;    ///< If not converged: "diverges" ...
  std::string worst;     ///< Largest increment or residual: "body 'forearm'".
  std::vector<std::string> free_motions;  ///< That met no stiffness on the way.
};

/// A load at which the stability of the equilibrium changes: a limit point or a branch.
struct LimitPoint {
  double load_factor = 0.0;
  int unstable = -1;    ///< Directions in which equilibria beyond it are unstable; −1: not known.
  std::string motion;   ///< That meets no stiffness there, in words.
  bool jump = false;    ///< The equilibrium ends there: those beyond lie on another branch.
  double distance = 0;  ///< How far that is: lengths of the model, or rad [-].
};

/// How a static analysis went.
struct StaticReport {
  bool converged = false;              ///< The full load is carried.
  double load_factor = 0.0;            ///< Reached, in [0, 1].
  std::vector<StaticStep> steps;       ///< All that were tried, in order.
  int iterations = 0;                  ///< Of them all.
  double residual = 0.0, force = 0.0;  ///< Largest unbalanced and largest force at the end [N].
  int unstable = -1;  ///< Directions in which the equilibrium is unstable; −1: not known.
  std::vector<std::string> free_motions;  ///< That nothing in the model resists.
  std::vector<LimitPoint> limit_points;   ///< That were passed, by load factor.
  std::vector<std::string> slack;         ///< Cables that carry nothing at the end.
  int relaxations = 0;  ///< Equilibria that relaxation has found where Newton's method has not.
  std::string message;  ///< If not converged: what happened, where, what to try.
};

}  // namespace polhode
