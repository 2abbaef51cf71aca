// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <polhode/base/time_function.hpp>
#include <polhode/base/types.hpp>
#include <polhode/model/place.hpp>

namespace polhode {

/// Which nodes or faces of a solid are meant. Coordinates are the mesh's own: in metres, before
/// the mesh is placed by its position and orientation. Faces are meant if all their nodes are.
struct SelectionSpec {
  enum class Kind : unsigned char { kAll, kSet, kPlane, kBox, kSphere, kNodes };
  enum class Level : unsigned char { kLeast, kMost, kValue };

  Kind kind = Kind::kAll;
  Place place;
  std::string set;              ///< kSet: name of a set of nodes or faces of the mesh.
  Vec3 normal = Vec3::UnitZ();  ///< kPlane: unit normal.
  Level level = Level::kValue;  ///< kPlane: at the mesh's least or largest extent, or at a value.
  double value = 0.0;           ///< kPlane: normal · X [m].
  Vec3 least = Vec3::Zero();    ///< kBox: corner of least coordinates [m].
  Vec3 most = Vec3::Zero();     ///< kBox: corner of largest coordinates [m].
  Vec3 centre = Vec3::Zero();   ///< kSphere [m].
  double radius = 0.0;          ///< kSphere; inside it, or with on_surface on it [m].
  bool on_surface = false;      ///< kSphere: only what lies at the radius itself.
  double tolerance = 0.0;       ///< [m]; 0: a small part of the mesh's extent.
  std::vector<int> nodes;       ///< kNodes: indices, the first node is 0.
};

/// One or several selections: what any of them holds.
using SelectionSpecs = std::vector<SelectionSpec>;

/// Where the mesh of a solid comes from and where it stands.
struct MeshSpec {
  Place place;
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
  // Where it stands
  Vec3 position = Vec3::Zero();         ///< Of the origin of the mesh's coordinates, world [m].
  Quat orientation = Quat::Identity();  ///< From the mesh's axes to the world's.
};

/// Nodes that move rigidly with a body.
struct BondSpec {
  int body = kGround;  ///< Index into Model::bodies, or kGround.
  Place place;
  SelectionSpecs nodes;
};

/// Nodes whose displacement from the start is given as a function of time.
struct PrescribedSpec {
  std::string name;
  Place place;
  SelectionSpecs nodes;
  TimeVector displacement;  ///< World components [m]; null: this component is free.
};

/// A deformable solid as described.
struct SolidSpec {
  std::string name;
  Place place;
  MeshSpec mesh;
  std::string element;   ///< A kind of the registry of elements; "": what suits mesh and material.
  std::string material;  ///< Name of a material of the model.
  std::string stress = "conserving";  ///< conserving | midpoint.
  std::string tangent = "full";       ///< full | symmetric.
  std::optional<double> density;      ///< Instead of the material's [kg/m^3].
  std::vector<BondSpec> bonded;
  std::vector<PrescribedSpec> prescribed;
  std::optional<Vec3> velocity;  ///< Of the centre of mass, world [m/s]; absent: see below.
  /// World [rad/s]. Without velocity and angular_velocity a solid starts by moving rigidly with the
  /// first body it is bonded to, or rests.
  std::optional<Vec3> angular_velocity;
};

}  // namespace polhode
