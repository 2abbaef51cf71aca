// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/core/types.hpp>
#include <polhode/dynamics/body_step.hpp>

namespace polhode {

/// Motion of all nodes of deformable solids over the current step, the only input of elements and
/// loads on nodes. Three numbers per node, world components. Bonded and prescribed nodes are
/// included.
struct NodeStep {
  const double* x_n;   ///< Positions at t_n [m].
  const double* x_n1;  ///< Positions at t_{n+1} [m].
  const double* u;     ///< x_{n+1} − x_n, stored separately [m].
  const double* v_n;   ///< Newmark velocities at t_n [m/s].
  const double* v_n1;  ///< At t_{n+1} [m/s].
  const StepContext& context;
  double alpha_f = 0.5;  ///< Weight of t_{n+1} [-]; 1 at an instant and in statics.
  double rate = 0.0;     ///< γ/(βΔt): D v_{n+1}/D x_{n+1} [1/s]; 0 at an instant, in statics.
  /// Geometric stiffness by extrapolated stresses (statics): the residual is unchanged.
  bool mixed_point = false;

  [[nodiscard]] static Eigen::Map<const Vec3> at(const double* field, int node) {
    return Eigen::Map<const Vec3>(field + 3 * node);
  }
  [[nodiscard]] Vec3 position_alpha(int node) const {
    return (1.0 - alpha_f) * at(x_n, node) + alpha_f * at(x_n1, node);
  }
  [[nodiscard]] Vec3 velocity_alpha(int node) const {
    return (1.0 - alpha_f) * at(v_n, node) + alpha_f * at(v_n1, node);
  }
};

}  // namespace polhode
