// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <polhode/core/source_location.hpp>
#include <polhode/core/time_function.hpp>
#include <polhode/core/types.hpp>
#include <polhode/model/contact_spec.hpp>
#include <polhode/solids/mesh/selection.hpp>

namespace polhode {

/// Source and placement of the mesh of a solid.
struct MeshSpec {
  std::string type;  ///< file, inline, or a generator: block, cylinder, tube, sphere ...
  // From a file
  std::string file;    ///< Resolved against the model file's folder.
  std::string group;   ///< Elements of this group only; "": all.
  double scale = 1.0;  ///< Metres per unit of the file.
  // From a generator: its parameters by name, lengths in metres
  std::map<std::string, std::vector<double>> parameters;
  // Inline
  std::vector<Vec3> nodes;                       ///< [m]
  std::vector<std::vector<int>> elements;        ///< Indices of nodes, the first node is 0.
  std::map<std::string, std::vector<int>> sets;  ///< Nodes by name of the set.
  // Placement
  Vec3 position = Vec3::Zero();         ///< Of the origin of the mesh's coordinates, world [m].
  Quat orientation = Quat::Identity();  ///< From the mesh's axes to the world's.
};

/// Nodes that move rigidly with a body.
struct BondSpec {
  int body = kGround;  ///< Index into Model::bodies, or kGround.
  SourceLocation place;
  std::vector<solids::Selection> nodes;
};

/// Nodes with a displacement from the start given as a function of time.
struct PrescribedSpec {
  std::string name;
  SourceLocation place;
  std::vector<solids::Selection> nodes;
  TimeVector displacement;  ///< World components [m]; null: this component is free.
};

/// Elements of a solid with a material of their own.
struct RegionSpec {
  std::string name;
  SourceLocation place;
  std::string material;                   ///< Name of a material of the model.
  std::string element;                    ///< A kind of element; "": that of the solid.
  std::optional<double> density;          ///< Instead of the material's [kg/m^3].
  std::vector<solids::Selection> within;  ///< Elements of which these contain all nodes.
  std::vector<int> elements;              ///< Numbers of elements of the mesh, the first is 0.
};

/// Description of a deformable solid.
struct SolidSpec {
  std::string name;
  SourceLocation place;
  MeshSpec mesh;
  std::string element;   ///< A kind of the registry of elements; "": chosen by mesh and material.
  std::string material;  ///< Name of a material of the model.
  std::string stress = "conserving";  ///< conserving | midpoint.
  std::optional<double> density;      ///< Instead of the material's [kg/m^3].
  std::vector<RegionSpec> regions;    ///< Elements with another material.
  /// Instead of the materials': by element of the mesh and family of its material, along the mesh's
  /// axes; empty: those of the materials.
  std::vector<Vec3> fibre_directions;
  std::vector<BondSpec> bonded;
  std::vector<PrescribedSpec> prescribed;
  ContactSideSpec contact;                         ///< Contact settings of its surface.
  std::vector<solids::Selection> contact_surface;  ///< Contact faces; empty: the whole boundary.
  bool self_contact = false;                       ///< Its surface has self-contact.
  std::optional<Vec3> velocity;  ///< Of the centre of mass, world [m/s]; absent: see below.
  /// World [rad/s]. Without velocity and angular_velocity a solid initially moves rigidly with the
  /// first body it is bonded to, or is at rest.
  std::optional<Vec3> angular_velocity;
};

}  // namespace polhode
