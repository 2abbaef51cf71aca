// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <vector>

#include <polhode/kernels/tree_data.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// An interaction outside the tree: loop joint, spring, load; or what a joint of the tree exerts
/// beside its rows.
struct OffTreeInteraction {
  int interaction = -1;
  int slot_a = -1, slot_b = -1;  ///< −1: the ground.
  int rows = 0;
  int edge = -1;  ///< Its bodies are parent and child: index of the edge.
  bool edge_child_is_b = true;
  int loop = -1;                 ///< Index of its loop, if it needs one.
  int pair_a = -1, pair_b = -1;  ///< Positions of its loop's columns and rows.
  /// Whether it is the first that writes to these: another part of its row may have done so.
  bool first_at_a = true, first_at_b = true;
  bool further_part = false;  ///< Part of the row of an earlier interaction, and of its loop.
  /// Coupling of its distant bodies, for which the loop has further unknowns: the couple (3, for
  /// all direction rows), or the effect of each body's motion on the other's rows (12).
  Coupling coupling = Coupling::none;
  /// Loop of these unknowns, and the positions of its columns and rows: its own, or that of the
  /// coupling alone if its row has several parts.
  int coupling_loop = -1, coupling_pair_a = -1, coupling_pair_b = -1;
  int coupling_first = 0;       ///< Their first unknown in the loop.
  int translation_rows = 0;     ///< Of a joint coupled by a couple: rows before the direction rows.
  int couple = -1;              ///< Its index among joints coupled by a couple.
  bool rotations_only = false;  ///< Its tangents are derivatives of moments by rotations.
  /// A joint with coincident points, assembled with others in SIMD lanes: LoopJoints.
  bool in_lanes = false;
};

/// Symbolic part of elimination along the tree with loops: what is carried along which path, the
/// elimination order of the loops, and the fill between them.
/// docs/theory/elimination_along_the_tree.md
struct TreeLoopPlan {
  std::vector<OffTreeInteraction> extras;
  std::vector<int> extra_of_slot;  ///< Index of a slot's extra rows, −1 none.
  std::vector<int> edge_of_slot;   ///< Index of the edge to the parent, −1 none.
  int extra_count = 0, edge_count = 0, couple_count = 0;

  std::vector<TreeLoop> loops;
  std::vector<LaterLoop> later;
  std::vector<int> product;
  std::vector<int> ground_loops;
  std::vector<int> first_open;
  std::vector<LoopAtBody> open;
  std::vector<int> first_update;
  std::vector<LoopUpdate> update;
  std::vector<int> first_common, common;
  int pair_rows = 0, kept_rows = 0, S_size = 0, nu_size = 0, U_rows = 0;  ///< Rows of 8; doubles.
  int most_open = 0;   ///< Largest number of loops open at one body.
  double flops = 0.0;  ///< Floating-point operations of one elimination.
};

/// @param coupled  Forces on one body of an interaction depend on the motion of the other, as in
/// the tangent of a step; false at an instant, where only rows couple them.
[[nodiscard]] TreeLoopPlan plan_tree_loops(const System& system, bool coupled = true);

}  // namespace polhode
