// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <vector>

#include <polhode/kernels/tree_data.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// An interaction that the tree does not hold: loop joint, spring, load.
struct OffTreeInteraction {
  int interaction = -1;
  int slot_a = -1, slot_b = -1;  ///< −1: the ground.
  int rows = 0;
  int edge = -1;  ///< Its bodies are parent and child: index of the edge.
  bool edge_child_is_b = true;
  int loop = -1;                 ///< Index of its loop, if it needs one.
  int pair_a = -1, pair_b = -1;  ///< Where its loop's columns and rows stand.
  /// How its distant bodies are coupled; the loop has further unknowns for that: the couple (3, for
  /// all direction rows), or what each body's rows owe to the other's motion (12).
  Coupling coupling = Coupling::none;
  int translation_rows = 0;     ///< Of a joint coupled by a couple: rows before the direction rows.
  int couple = -1;              ///< Its index among those.
  bool rotations_only = false;  ///< Its tangents are of moments by rotations.
  bool in_lanes = false;  ///< A joint with coincident points, assembled with others: LoopJoints.
};

/// Symbolic part of elimination along the tree with loops: what is carried where, in which order
/// loops are eliminated, which blocks between loops fill in.
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
  int most_open = 0;   ///< Most loops open at one body.
  double flops = 0.0;  ///< Multiplications and additions of one elimination.
};

[[nodiscard]] TreeLoopPlan plan_tree_loops(const System& system);

}  // namespace polhode
