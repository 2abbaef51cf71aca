// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include <polhode/system/body_contacts.hpp>
#include <polhode/system/node_step.hpp>

namespace polhode {

/// Part of what a point stores: weight times the potential of a gap.
struct GapTerm {
  double weight = 1.0;
  double gap = 0.0;  ///< [m]
};

/// A point of a surface in an impact over a step. Its velocity against what it meets is
/// Σ J v over nodes, and the impulse on it presses on a node with Jᵀ p: what turns as a whole has
/// no velocity, so that impulses leave neither sum nor moment.
struct SurfaceImpact {
  int point = 0;                            ///< Of its group.
  std::vector<std::pair<int, Mat3>> nodes;  ///< With J at t_{n+1}, each once; see add().
  Vec3 normal = Vec3::UnitZ();              ///< At t_{n+1}, unit, world.
  double restitution = 0.0;                 ///< e of this impact.
  double mu = 0.0;                          ///< Coefficient of friction.
  double given = 0.0;                       ///< Normal impulse of the step [N s].
  std::vector<GapTerm> terms;               ///< What it stores at t_{n+1}, per area.
  double beyond = 0.0;                      ///< Of its band at t_{n+1} [m]; 0 within.
  double stored = 0.0;                      ///< At t_{n+1} [J].
  double before = 0.0;                      ///< Normal speed at t_n [m/s].
  bool turned = false;                      ///< Before the step.

  /// To the J of a node.
  void add(int node, const Mat3& J) {
    for (auto& [known, sum] : nodes)
      if (known == node) {
        sum += J;
        return;
      }
    nodes.emplace_back(node, J);
  }
};

/// A group of elements whose points are hit: their velocities jump at the end of a step.
/// @eq{surface-turn}
class SurfaceImpacts {
 public:
  virtual ~SurfaceImpacts() = default;
  /// Appends the points that are in an impact in an accepted step.
  /// @param history  At t_n.
  virtual void impacts(const NodeStep& step, const double* history,
                       std::vector<SurfaceImpact>& list) const = 0;
  /// What one of them does after it has turned (or come back): its history is at t_{n+1}.
  /// @param held  Force by which others press it on [N].
  /// @returns the energy that it stores no more [J].
  virtual double turn(const SurfaceImpact& impact, double held, double* history) const = 0;
  /// The impulse that it took at the end of the step, for its report.
  virtual void settled(const SurfaceImpact& impact, const ResolvedImpact& settled, double dt,
                       double* history) const = 0;
};

}  // namespace polhode
