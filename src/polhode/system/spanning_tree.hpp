// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <polhode/system/body_block.hpp>
#include <polhode/system/motion_basis.hpp>

namespace polhode {

/// A joint that may be part of the tree: parent side a, child side b.
struct TreeCandidate {
  int a = kGround, b = kGround;  ///< Body indices.
  int interaction = 0;           ///< Index into System::interactions().
  bool may_reverse = false;      ///< b may be the parent: the item supports exchanged sides.
};

/// Position of a body in the tree: its parent and the joint to it.
struct TreeLink {
  int parent = kGround;  ///< Body index of the parent.
  int interaction = -1;  ///< Joint to the parent; -1 for a free root.
};

/// Spanning forest of the bodies, rooted at the ground or at free bodies, and the order in which
/// bodies are stored (slots) and eliminated.
///
/// Bodies are numbered parents first and divided into chunks. Inside a chunk the slots are sorted
/// by the shape of the joint to the parent, so that one SIMD instruction serves several joints of
/// one shape; each (chunk, shape) run is padded to whole blocks of kLanes.
struct SpanningTree {
  std::vector<TreeLink> link;                   ///< By body.
  std::vector<int> order;                       ///< Bodies, parents first.
  std::vector<int> slot_of_body, body_of_slot;  ///< body_of_slot is -1 in padding lanes.
  std::vector<TreeRun> runs;
  std::vector<TreeChunk> chunks;
  std::vector<char> in_tree;  ///< By interaction: eliminated along the tree.
  std::vector<int> reversed;  ///< Interactions whose sides must be exchanged.
  int slots = 0;              ///< Padded: a multiple of kLanes.
};

/// Code of a joint's shape: equal codes use the same kernel. Free roots have their own.
[[nodiscard]] int shape_code(const std::optional<MotionBasis>& basis);

/// @param bodies  Number of bodies.
/// @param candidates  Joints that may be part of the tree, in the user's order.
/// @param shapes  By interaction: shape code of its motion basis.
[[nodiscard]] SpanningTree build_spanning_tree(int bodies, int interactions,
                                               std::span<const TreeCandidate> candidates,
                                               std::span<const int> shapes);

}  // namespace polhode
