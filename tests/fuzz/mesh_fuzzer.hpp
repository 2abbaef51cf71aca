// SPDX-License-Identifier: Apache-2.0
// Feeds arbitrary bytes to one reader of meshes. The only accepted outcomes are a consistent mesh
// and an InputError with its location: no crash, no other exception.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include <polhode/core/error.hpp>
#include <polhode/solids/mesh/check_mesh.hpp>
#include <polhode/solids/mesh/read_mesh.hpp>

namespace polhode::fuzz {

inline void require(bool holds) {
  if (!holds) std::abort();
}

inline void check_numbers(const solids::Mesh& mesh) {
  const int nodes = static_cast<int>(mesh.nodes.size());
  const auto exists = [&](int node) { return node >= 0 && node < nodes; };
  for (const solids::ElementBlock& block : mesh.blocks) {
    require(block.nodes.size() % block.shape().nodes.size() == 0);
    for (int node : block.nodes) require(exists(node));
  }
  const int elements = mesh.element_count();
  require(mesh.element_labels.size() == static_cast<std::size_t>(elements));
  for (const auto& [name, set] : mesh.node_sets)
    for (int node : set) require(exists(node));
  for (const auto& [name, set] : mesh.element_sets)
    for (int element : set) require(element >= 0 && element < elements);
  for (const auto& [name, surface] : mesh.surfaces)
    for (const solids::FaceBlock& block : surface.blocks) {
      require(block.nodes.size() == block.owners.size() * block.shape().nodes.size());
      for (int node : block.nodes) require(exists(node));
      for (int owner : block.owners) require(owner >= -1 && owner < elements);
    }
}

using Parser = solids::Mesh (*)(const std::string& name, std::string_view bytes);

inline int read(Parser parse, const std::uint8_t* data, std::size_t size) {
  try {
    const solids::Mesh mesh =
        parse("fuzz", std::string_view(reinterpret_cast<const char*>(data), size));
    check_numbers(mesh);
    (void)solids::mesh_faults(mesh);
    check_numbers(solids::part_of(mesh, {}));
    (void)solids::boundary(mesh);
  } catch (const InputError& error) {
    require(error.where().starts_with("fuzz") && !error.what_is_wrong().empty() &&
            !error.hint().empty());
  }
  return 0;
}

}  // namespace polhode::fuzz
