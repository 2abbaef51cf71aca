// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/solids/mesh/face_index.hpp>

namespace polhode::solids {

std::size_t FaceIndex::Hash::operator()(const Key& key) const {
  std::size_t hash = 0;
  for (int node : key) {
    hash = (hash + static_cast<std::size_t>(node + 1)) * 0x9E3779B97F4A7C15ULL;
    hash ^= hash >> 29;
  }
  return hash;
}

FaceIndex::Key FaceIndex::key_of(std::span<const int> corners) {
  Key key{-1, -1, -1, -1};
  std::copy_n(corners.begin(), std::min<std::size_t>(corners.size(), 4), key.begin());
  std::sort(key.begin(), key.end());
  return key;
}

FaceIndex::FaceIndex(const Mesh& mesh) {
  int element = 0;
  for (const ElementBlock& block : mesh.blocks) {
    const CellShape& shape = block.shape();
    const std::size_t n = shape.nodes.size();
    for (std::size_t at = 0; at + n <= block.nodes.size(); at += n, ++element)
      for (int f = 0; f < static_cast<int>(shape.faces.size()); ++f) {
        const CellFace& face = shape.faces[f];
        const std::size_t corners = face.type.starts_with("tri") ? 3 : 4;
        std::array<int, 4> nodes{};
        for (std::size_t i = 0; i < corners; ++i) nodes[i] = block.nodes[at + face.nodes[i]];
        const auto [place, fresh] =
            index_.try_emplace(key_of({nodes.data(), corners}), entries_.size());
        if (fresh) entries_.emplace_back();
        Entry& entry = entries_[place->second];
        if (entry.times < 2) {
          entry.element[entry.times] = element;
          entry.face[entry.times] = f;
        }
        ++entry.times;
      }
  }
}

const FaceIndex::Entry* FaceIndex::find(std::span<const int> corners) const {
  const auto found = index_.find(key_of(corners));
  return found == index_.end() ? nullptr : &entries_[found->second];
}

std::vector<int> face_nodes(const Mesh& mesh, int element, int face) {
  const std::span<const int> cell = mesh.element_nodes(element);
  std::vector<int> nodes;
  for (int local : mesh.element_shape(element).faces[face].nodes) nodes.push_back(cell[local]);
  return nodes;
}

Surface boundary(const Mesh& mesh) {
  Surface surface;
  const FaceIndex faces(mesh);
  for (const FaceIndex::Entry& entry : faces.entries()) {
    if (entry.times != 1) continue;
    const CellFace& face = mesh.element_shape(entry.element[0]).faces[entry.face[0]];
    surface.add(face.type, face_nodes(mesh, entry.element[0], entry.face[0]), entry.element[0]);
  }
  return surface;
}

}  // namespace polhode::solids
