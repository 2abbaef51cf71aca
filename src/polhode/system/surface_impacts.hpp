// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include <polhode/system/body_contacts.hpp>
#include <polhode/system/node_step.hpp>

namespace polhode {

/// Term of the stored energy of a point: weight times the potential of a gap.
struct GapTerm {
  double weight = 1.0;
  double gap = 0.0;  ///< [m]
};

/// Impact of a point of a surface over a step. Its relative velocity is Σ J v over nodes, and its
/// impulse acts on a node by Jᵀ p: a rigid motion of the whole has no relative velocity, so that
/// impulses have neither resultant nor moment.
struct SurfaceImpact {
  int point = 0;                            ///< Number in its group.
  std::vector<std::pair<int, Mat3>> nodes;  ///< With J at t_{n+1}, each once; see add().
  Vec3 normal = Vec3::UnitZ();              ///< At t_{n+1}, unit, world.
  double restitution = 0.0;                 ///< e of this impact.
  double mu = 0.0;                          ///< Coefficient of friction.
  double given = 0.0;                       ///< Normal impulse of the step [N s].
  std::vector<GapTerm> terms;               ///< Terms of its potential at t_{n+1}, per area.
  double beyond = 0.0;                      ///< Distance beyond its band at t_{n+1} [m]; 0 within.
  double stored = 0.0;                      ///< At t_{n+1} [J].
  double before = 0.0;                      ///< Normal speed at t_n [m/s].
  bool turned = false;                      ///< It turned before the step.

  /// Adds to the J of a node.
  void add(int node, const Mat3& J) {
    for (auto& [known, sum] : nodes)
      if (known == node) {
        sum += J;
        return;
      }
    nodes.emplace_back(node, J);
  }
};

/// Interface of a group of elements with impacts of points: their velocities jump at the end of a
/// step. @eq{surface-turn}
class SurfaceImpacts {
 public:
  virtual ~SurfaceImpacts() = default;
  /// Appends the points in an impact in an accepted step.
  /// @param history  At t_n.
  virtual void impacts(const NodeStep& step, const double* history,
                       std::vector<SurfaceImpact>& list) const = 0;
  /// Updates the history, at t_{n+1}, of a point after its turn.
  /// @param held  Force of others on it [N].
  /// @returns the released energy [J].
  virtual double turn(const SurfaceImpact& impact, double held, double* history) const = 0;
  /// Receives the impulse at the end of the step, for its report.
  virtual void settled(const SurfaceImpact& impact, const ResolvedImpact& settled, double dt,
                       double* history) const = 0;
};

}  // namespace polhode
