// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include <polhode/io/importers/feb_file.hpp>
#include <polhode/io/importers/feb_mesh.hpp>
#include <polhode/solids/mesh/mesh.hpp>

namespace polhode::io {

struct FebModel;
struct FebBody;

/// Elements of a solid with another material or kind of element than the rest.
struct FebRegion {
  std::string name;      ///< In the model: that of its first part.
  std::string material;  ///< In the model.
  std::string element;   ///< Kind of element; "": that of the solid.
  std::vector<int> elements;
};

/// A deformable solid: connected parts of the mesh.
struct FebSolid {
  std::string name;      ///< In the model: that of its first part.
  std::string material;  ///< In the model.
  std::vector<FebRegion> regions;
  const XmlFile::Element* at = nullptr;
  std::vector<const FebPart*> parts;
  std::vector<int> nodes;                  ///< Places in FebMesh::nodes, ascending.
  std::unordered_map<int, int> place;      ///< Number in the solid by place in FebMesh::nodes.
  std::optional<Vec3> velocity;            ///< At the start [m/s].
  std::vector<std::vector<int>> touching;  ///< Facets that may touch others.
  std::set<std::string> groups, meets;     ///< Of contact; none: it does not touch.
  std::string element;                     ///< Kind of element; "": chosen by the cells.
  solids::Surface boundary;                ///< With numbers of the solid's nodes.
};

/// A material of deformable solids.
struct FebMaterial {
  std::string name;  ///< In the model.
  bool uncoupled = false;
  SourceNode node;
  std::vector<Vec3> fibres;      ///< Directions by family, in these axes.
  Mat3 axes = Mat3::Identity();  ///< Of its <mat_axis>.
};

/// Data of one element in place of its material's.
struct FebElementData {
  std::optional<Mat3> axes;
  std::optional<Vec3> fibre;
};

/// Values at the nodes of a set or on the facets of a surface, in their order.
struct FebMap {
  const XmlFile::Element* at = nullptr;
  std::string set;
  std::vector<double> values;
};

/// A boundary condition on displacements.
struct FebHold {
  std::string name;
  const XmlFile::Element* at = nullptr;
  bool prescribed = false;         ///< Else fixed.
  std::array<FebValue, 3> values;  ///< By component.
  bool relative = false;           ///< Values are added to those at the start of the step.
  std::vector<int> by_step;  ///< Condition of each step in place of this one; empty: the same.
};

/// A material of linear trusses.
struct FebTruss {
  double modulus = 0.0;  ///< [Pa]
  double density = 0.0;  ///< [kg/m³]
};

/// The deformable solids of a file.
class FebSolids {
 public:
  explicit FebSolids(FebModel& model) : model_(model) {}

  /// Reads a material; one of an unknown type is refused.
  void read_material(const XmlFile::Element& e, const std::string& type);
  /// Makes solids of the parts that have one of these materials.
  void assemble();
  /// Reads <Boundary>.
  void read_boundary(const XmlFile::Element& section);
  /// Merges the conditions of several steps.
  void settle_boundary();
  /// Reads <MeshData>: directions of fibres by element, maps of nodes and surfaces.
  void read_mesh_data(const XmlFile::Element& section);
  /// Makes springs of trusses.
  void add_trusses();
  /// Makes beams of linear beams.
  void add_beams();
  /// Reads <Discrete>: springs between nodes.
  void read_discrete(const XmlFile::Element& section);
  /// Reads <Initial>.
  void read_initial(const XmlFile::Element& section);
  /// Reads <Contact>.
  void read_contact(const XmlFile::Element& section);
  /// Adds to a body how it touches.
  void put_contact(const FebBody& body, const NodeBuilder& make, SourceNode& node) const;
  /// Reads a <nodal_load>.
  void read_nodal_load(const XmlFile::Element& e);
  /// Reads a <surface_load>.
  void read_surface_load(const XmlFile::Element& e);
  /// Adds a force on all mass, in proportion to a body force of FEBio.
  void add_body_force(const XmlFile::Element& e, const std::array<FebValue, 3>& values);
  /// Adds `materials` and `solids`.
  void write(SourceNode& root);
  /// Nodes of a set that a tag names, also "@surface:name"; null after an error.
  const std::vector<int>* named_nodes(const XmlFile::Element& e);
  /// Whether nodes of a solid are bonded to a body, by its name.
  [[nodiscard]] bool is_bonded_to(const std::string& body) const;
  /// Adds to a probe the solid or the body of a node. @returns whether it has one.
  bool put_node(int node, const NodeBuilder& make, SourceNode& probe) const;
  [[nodiscard]] bool empty() const {
    return solids_.empty() && beams_.kind != SourceNode::Kind::kMap;
  }

 private:
  using Held = std::map<int, std::array<int, 3>>;
  void read_beam_material(const XmlFile::Element& e, const std::string& name);
  void add_beam(const FebPart& part, const std::string& section, const std::vector<int>& chain);
  /// Attaches a node of a beam to what is there already.
  void hold_beam_node(const FebPart& part, int node, const std::string& name);
  [[nodiscard]] bool on_solid(int node) const;
  [[nodiscard]] bool on_beam(int node) const;
  void merge_held();
  /// Refuses a condition that some of several steps do not have.
  void refuse_released(int hold, int node);
  SourceNode hold_node(const FebHold& hold, std::size_t component);
  SourceNode node_list(const NodeBuilder& make, const FebSolid& solid,
                       const std::vector<int>& nodes) const;
  /// A surface that touches another one: of a solid or of a rigid body.
  struct Side {
    const std::vector<std::vector<int>>* facets = nullptr;
    FebSolid* solid = nullptr;
    FebBody* body = nullptr;
  };
  Side side_of(const std::string& surface);
  void tie(const XmlFile::Element& e, const Side& a, const Side& b);
  /// Lets tied surfaces of deformable parts share their nodes where all nodes of one coincide with
  /// nodes of the other.
  void merge_ties();
  void touch(const XmlFile::Element& e, const Side& side, const std::string& own,
             const std::string& other);
  void put_contact(const FebSolid& solid, const NodeBuilder& make, SourceNode& node);
  SourceNode write_solid(const FebSolid& solid);
  /// Directions of fibres by element, if they differ from the materials'.
  void put_fibres(const FebSolid& solid, const NodeBuilder& make, SourceNode& node) const;
  void put_bonds(const FebSolid& solid, const NodeBuilder& make, SourceNode& node);
  /// Body of a node, or its solid, or the ground of a fixed one; "" if it has none.
  [[nodiscard]] std::string holder(int node) const;
  [[nodiscard]] bool is_solid(const std::string& name) const;
  /// Chooses material and kind of element of a solid and its regions.
  void choose_regions(FebSolid& solid);
  /// Ends of a load between nodes, as `bodies` and `at`; false, with an error, if one is nowhere.
  bool put_ends(const XmlFile::Element& e, const std::string& what, const std::array<int, 2>& ends,
                SourceNode& load);
  void read_map(const XmlFile::Element& data);
  /// Map that a tag names with type="map", of the set of that name; null if it has a value, or
  /// after an error.
  const FebMap* map_of(const XmlFile::Element& parent, const char* tag, const std::string& set);
  /// Value of a tag, or of one with a map the factor 1 with its load controller.
  FebValue value_of(const XmlFile::Element& parent, const char* tag);
  /// Whether a map has few enough different values; an error otherwise.
  bool is_short(const XmlFile::Element& e, std::size_t values);
  void hold_by(const FebMap& map, const std::vector<int>& nodes, const FebHold& condition);
  /// Lets a boundary condition hold a component of nodes.
  void hold(const std::vector<int>& nodes, int component, int hold);
  /// Faces of a solid as a selection; an error if the facets are not on its boundary.
  /// @param sign  -1 if the facets face inward.
  bool select(const XmlFile::Element& e, const FebSolid& solid,
              const std::vector<std::vector<int>>& facets, SourceNode& selection, double& sign);
  void put_surface_load(const XmlFile::Element& e, const std::string& type, const FebSolid& solid,
                        SourceNode selection, double sign);
  void put_on(const XmlFile::Element& e, const std::string& type, double factor,
              const std::vector<std::vector<int>>& facets);

  FebModel& model_;
  std::map<std::string, FebMaterial> materials_;      ///< By name in the file.
  std::map<std::string, FebTruss> trusses_;           ///< Likewise.
  std::map<std::string, std::string> beam_sections_;  ///< Sections of beams, likewise.
  std::set<std::string> section_names_;
  std::set<int> clamped_;        ///< Nodes of beams without rotation.
  SourceNode sections_, beams_;  ///< Maps if there are any.
  std::unordered_map<std::int64_t, FebElementData> element_data_;  ///< By number of the element.
  std::map<std::string, FebMap> maps_;
  std::set<std::string> material_names_, solid_names_, hold_names_;
  std::vector<FebSolid> solids_;
  std::vector<FebHold> holds_;
  Held held_;                            ///< Number of the condition by node and component.
  std::map<std::size_t, Held> held_in_;  ///< Those of single steps, by number of the step.
  std::map<int, std::string> attached_;  ///< Body to which a node is attached, by node.
  std::map<std::string, std::vector<int>> surface_nodes_;
  std::set<std::string> contact_names_;
  std::set<const XmlFile::Element*> merged_;  ///< Ties whose surfaces share their nodes.
  SourceNode contacts_;                       ///< Laws of pairs; a map if there are any.
};

}  // namespace polhode::io
