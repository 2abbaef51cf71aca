// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <polhode/equations/newton_engine.hpp>
#include <polhode/equations/node_condensation.hpp>

namespace polhode {

/// Policies for the factorisation of the nodes of solids.
enum class NodeFactor {
  automatic,        ///< Few unknowns: every iteration. Many: as long as it converges well.
  every_iteration,  ///< Full Newton.
  reuse,            ///< Reuses the factorisation, rotated with the solids' bodies.
};

/// Nodes of deformable solids in the iterations of a SparseEngine: evaluated and factored at an
/// iterate, condensed to their bodies, and moved with these.
class CondensedNodes {
 public:
  CondensedNodes(const System& system, NodeFactor policy);

  /// Pairs of bodies that solids couple; they change when pair_changes() does.
  [[nodiscard]] const std::vector<linear::KktPair>& pairs() const { return condensation_.pairs(); }
  [[nodiscard]] int pair_changes() const { return condensation_.meetings(); }

  /// Start of the iterations of a step, or return to one of its iterates.
  void begin();
  /// Whether the next iteration needs a factorisation: by policy, as others converge too slowly, or
  /// as the step differs.
  [[nodiscard]] bool must_factor(const Trial& trial, bool refactor) const;
  /// Evaluates residual and, if `tangent`, tangent. Inverted elements have a least_volume of 0 or
  /// less.
  ElementReport evaluate(const State& state, Trial& trial, bool tangent);
  /// Factors the tangent last evaluated. @returns false if it is singular.
  [[nodiscard]] bool factor(const Trial& trial);
  /// Adds the condensed tangent, times `scale`, to the bodies' blocks and to those of pairs().
  void condense(double scale, linear::KktValues& values, std::span<linear::KktValues::Pair> pairs);
  /// Right-hand side of the bodies with the condensed residual; after condense().
  void reduce(Vec& rhs) const;
  /// Increments of the nodes from those of bodies and rows.
  void expand(const Vec& x) { condensation_.expand(x.data(), du_); }

  /// Adds the residuals of bonded nodes, times `scale`, to the right-hand side of the bodies.
  /// @returns R·M⁻¹R of the free nodes.
  double merit(double scale, Vec& rhs);
  /// Largest displacement β Δt² R/m of a node by its residual, at the mean mass of nodes [m].
  /// @param scale  As for merit().
  [[nodiscard]] double largest_residual(double scale) const;

  /// Moves nodes and internal unknowns of elements by this part of the increment, after the bodies.
  /// `done.increment` becomes that of a node if it is larger.
  void move(const State& state, Trial& trial, double part, Iteration& done);
  /// Moves the nodes only, from an iterate that was restored.
  void move_again(const State& state, Trial& trial, double part) const;
  /// End of an iteration with the size of its increment.
  void finish(double increment, bool factored);
  /// Size of the last increment in this step, 0 before the first [-].
  [[nodiscard]] double last_increment() const { return last_increment_; }

  [[nodiscard]] bool reuses_factor() const { return reuse_; }
  /// Description of an element that the last evaluate() reported.
  [[nodiscard]] std::string element_name(int element) const;
  /// Description of the node with the largest increment; empty if a body has it.
  [[nodiscard]] std::string worst_node() const;
  [[nodiscard]] int factorisations() const { return factorisations_; }
  [[nodiscard]] double factor_entries() const {
    return condensation_.factorisation().factor_entries();
  }

 private:
  const System* system_;
  NodeCondensation condensation_;
  NodeSystem nodes_;
  std::vector<Vec6> shares_;   ///< By body: of the condensed residual, or of that of merit().
  std::vector<double> du_;     ///< Whole increments, three per node.
  std::vector<double> moved_;  ///< Applied part of them.
  double node_mass_ = 0.0;     ///< Mean of free nodes [kg].
  bool reuse_ = false;
  double factored_dt_ = 0.0;
  int step_iterations_ = 0, factorisations_ = 0, worst_node_ = -1;
  double last_increment_ = 0.0, contraction_ = 0.0;
};

}  // namespace polhode
