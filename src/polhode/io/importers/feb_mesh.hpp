// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include <polhode/core/types.hpp>
#include <polhode/geometry/mass_properties.hpp>
#include <polhode/io/importers/feb_file.hpp>

namespace polhode::io {

/// One <Elements> of a mesh.
struct FebPart {
  std::string name;
  std::string type;  ///< As FEBio writes it, in lower case: hex8, penta6, ...
  std::string
      shape;  ///< Of a model file, in whose order the nodes are; "" if it has no such shape.
  const XmlFile::Element* at = nullptr;
  const XmlFile::Element* domain = nullptr;  ///< That gives its material; null without one.
  int size = 0;                              ///< Nodes of an element.
  std::vector<int> nodes;                    ///< Places in FebMesh::nodes, element by element.
  std::vector<std::int64_t> ids;             ///< Of the elements.
  std::string material;                      ///< Of its domain; "" without one.
  double area = 0.0;                         ///< Of the cross section of trusses [m²].

  [[nodiscard]] bool is_solid() const;
};

/// The mesh of an FEBio file with its sets and domains.
struct FebMesh {
  std::vector<Vec3> nodes;
  std::vector<std::int64_t> labels;  ///< Numbers of the nodes in the file.
  std::unordered_map<std::int64_t, int> place;
  std::vector<FebPart> parts;
  std::map<std::string, std::vector<int>, std::less<>> node_sets;
  std::map<std::string, std::vector<std::vector<int>>, std::less<>> surfaces;  ///< Facets.
  std::map<std::string, std::vector<std::int64_t>, std::less<>> element_sets;
  std::map<std::string, std::pair<std::string, std::string>, std::less<>> surface_pairs;
  std::map<std::string, std::vector<std::array<int, 2>>, std::less<>> discrete_sets;

  /// Puts nodes in place of others everywhere. @param twins  The new one by the old one.
  void replace(const std::map<int, int>& twins);
};

/// Reads <Mesh> and <MeshDomains>.
[[nodiscard]] FebMesh read_feb_mesh(FebFile& file, const XmlFile::Element* mesh,
                                    const XmlFile::Element* domains);

/// Mass properties of a part by integration over its elements; nothing after an error.
std::optional<geometry::MassProperties> feb_mass(FebFile& file, const FebMesh& mesh,
                                                 const FebPart& part, double density);

}  // namespace polhode::io
