// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <unordered_map>
#include <vector>

#include <polhode/solids/mesh/mesh.hpp>

namespace polhode::solids {

/// Faces of the solid elements of a mesh, found by their corners in any order.
class FaceIndex {
 public:
  explicit FaceIndex(const Mesh& mesh);

  /// Elements with a face, in ascending order; −1 for missing ones.
  struct Entry {
    std::array<int, 2> element{-1, -1};
    std::array<int, 2> face{-1, -1};  ///< Local number in the element's shape.
    int times = 0;                    ///< 1 or 2 in a valid mesh.
  };
  /// Finds a face. @param corners  Three or four nodes. @returns null if no solid has such a face.
  [[nodiscard]] const Entry* find(std::span<const int> corners) const;
  /// All faces, in the order of the elements.
  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }

 private:
  using Key = std::array<int, 4>;
  struct Hash {
    std::size_t operator()(const Key& key) const;
  };
  static Key key_of(std::span<const int> corners);

  std::unordered_map<Key, std::size_t, Hash> index_;
  std::vector<Entry> entries_;
};

/// Nodes of a face of an element.
[[nodiscard]] std::vector<int> face_nodes(const Mesh& mesh, int element, int face);

}  // namespace polhode::solids
