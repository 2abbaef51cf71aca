// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <polhode/solids/mesh/mesh.hpp>

namespace polhode {

/// One parameter of a generator, a list of numbers.
struct MeshParameter {
  enum class Kind : unsigned char { kLength, kCount, kRatio, kPoint };

  std::string name;
  Kind kind;                   ///< Lengths [m] and ratios [-] are positive, counts whole.
  std::string values;          ///< What the numbers are, by name: "x, y, z".
  std::vector<double> preset;  ///< When left out; empty: it must be given.
  std::string meaning;
  [[nodiscard]] std::size_t size() const;  ///< Count of numbers; 0: any number of them.
};

/// Parameters of a mesh by name.
using MeshParameters = std::map<std::string, std::vector<double>>;

/// One kind of mesh that Polhode makes itself.
struct MeshGenerator {
  std::string name;
  std::string meaning;
  std::vector<MeshParameter> parameters;
  std::vector<std::string> elements;  ///< Types of elements it can be made of; the first is usual.
  std::string sides;                  ///< Names of its surfaces or sets of nodes.
  Mesh (*make)(const MeshGenerator& self, const MeshParameters& given, std::string_view type);
};

/// Every generator. The registry is the documentation's and the reader's source.
[[nodiscard]] const std::vector<MeshGenerator>& mesh_generators();
[[nodiscard]] const MeshGenerator* find_mesh_generator(std::string_view name);

/// Makes a mesh, in its own coordinates: centred at the origin, round things about z. Place it with
/// move().
/// @param where       First part of messages, and the mesh's name.
/// @param parameters  By name, lengths in metres; those with a preset may be left out.
/// @param type        Type of its elements; empty: the generator's usual one.
/// @throws InputError for an unknown generator, parameter or type, a number that is missing,
///         not positive or not whole, more than 2e7 nodes, and cells that would be inverted.
[[nodiscard]] Mesh make_mesh(std::string_view where, std::string_view generator,
                             const MeshParameters& parameters, std::string_view type = {});

/// A mesh given by its numbers.
/// @param elements  Indices of nodes, the first node is 0; empty type: by their count (hex8, hex20,
///                  hex27, tet4, tet10, wedge6, line2, line3).
/// @param sets      Sets of nodes by name.
/// @throws InputError for nodes that do not exist, lists of the wrong length, and repeated nodes.
[[nodiscard]] Mesh inline_mesh(std::string_view where, const std::vector<Vec3>& nodes,
                               const std::vector<std::vector<int>>& elements,
                               const std::map<std::string, std::vector<int>>& sets,
                               std::string_view type = {});

}  // namespace polhode
