// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <polhode/io/exporters/export_notes.hpp>
#include <polhode/simulation/simulation.hpp>

namespace polhode::io {

/// Abilities of a format.
struct ExportAbilities {
  std::string name;                 ///< With its article: "a URDF".
  std::vector<std::string> joints;  ///< Types of joints of a model.
  bool loops = false;               ///< Spherical and fixed joints may close loops.
  bool springs = false;             ///< Of joints, and inerters.
  bool motors = false;
  bool turning_damping = false;  ///< Of spherical joints.
  bool lines = false;            ///< Springs, dampers and pulls between two points.
  bool pushes = false;           ///< Constant forces and moments on bodies.
  bool rows = false;             ///< Rows of more than two coordinates.
  bool free_damping = false;     ///< Dampers of bodies that move freely.
  std::string elsewhere;         ///< Hint for what it cannot represent.
};

/// A free coordinate of a joint, with all that acts along it.
struct ExportCoordinate {
  std::string name;             ///< Of the file's joint.
  std::string key;              ///< Of the model: x, y, z, rx, ry, rz.
  bool turns = false;           ///< Whether it is an angle.
  Vec3 axis = Vec3::UnitZ();    ///< In the child's axes at the start.
  Vec3 point = Vec3::Zero();    ///< On an axis of rotation, in the child's coordinates [m].
  double start = 0.0;           ///< [rad, m]
  double rate = 0.0;            ///< At the start.
  std::optional<double> lower;  ///< Stop [rad, m].
  std::optional<double> upper;
  double damping = 0.0, friction = 0.0, stiffness = 0.0;
  double rest = 0.0;      ///< Coordinate without force of the spring [rad, m].
  double armature = 0.0;  ///< Inertance [kg m², kg].
};

/// The joint of a body to its parent in the tree. Coordinates of a body are those of the model
/// file, of the ground those of the world.
struct ExportJoint {
  int spec = -1;                     ///< In Model::joints; -1: the body is free or fixed.
  std::string name;                  ///< Of the file's joint.
  std::string type;                  ///< Of the model; "free".
  int parent = kGround;              ///< In Model::bodies.
  bool reversed = false;             ///< The parent is the second body of the model's joint.
  Vec3 on_parent = Vec3::Zero();     ///< Its point in the parent's coordinates [m].
  Vec3 on_child = Vec3::Zero();      ///< Likewise in the child's.
  Mat3 at_zero = Mat3::Identity();   ///< Axes of the child in the parent's, coordinates 0.
  Mat3 at_start = Mat3::Identity();  ///< Likewise at the start.
  Vec3 slid = Vec3::Zero();          ///< Child's point from the parent's, parent's axes [m].
  std::vector<ExportCoordinate> coordinates;  ///< The one nearest to the parent first.
  double damping = 0.0;  ///< Of a spherical joint [N m s], of a free one also [N s/m].

  /// Origin of the child in the parent's coordinates at the start [m].
  [[nodiscard]] Vec3 child_at_start() const { return on_parent + slid - at_start * on_child; }
};

/// A body, with its joint to its parent.
struct ExportBody {
  int spec = 0;  ///< In Model::bodies.
  ExportJoint joint;
  Vec3 velocity = Vec3::Zero();  ///< Of its origin at the start, world [m/s].
  Vec3 turning = Vec3::Zero();   ///< Angular velocity relative to the parent, own axes [rad/s].
  double carried = 0.0;          ///< Part of its weight that a force holds.
};

/// A coordinate of the tree.
struct ExportPlace {
  int body = 0;   ///< In ExportTree::bodies.
  int index = 0;  ///< In the coordinates of its joint.
};

/// A motor or servo.
struct ExportMotor {
  int load = 0;  ///< In Model::loads.
  ExportPlace on;
  double target = 0.0;  ///< At the start.
};

/// A spring, damper or pull between two points.
struct ExportLine {
  int load = 0;       ///< In Model::loads.
  double pull = 0.0;  ///< Force that attracts the points [N].
};

/// A constant force at a point of a body, or a moment.
struct ExportPush {
  int load = 0;  ///< In Model::loads.
  Vec3 value = Vec3::Zero();
};

/// A coordinate as a sum of others.
struct ExportCoupling {
  int load = 0;  ///< In Model::loads.
  ExportPlace first;
  std::vector<std::pair<ExportPlace, double>> others;
  double offset = 0.0;
};

/// A model as a tree of bodies, parents first and each with all bodies below it before the next.
struct ExportTree {
  std::vector<ExportBody> bodies;
  std::vector<int> at;     ///< By body of the model: its place in bodies; -1: left out.
  std::vector<int> loops;  ///< Spherical and fixed joints of the model that close loops.
  std::vector<ExportMotor> motors;
  std::vector<ExportCoupling> couplings;
  std::vector<ExportLine> lines;
  std::vector<ExportPush> pushes;

  [[nodiscard]] ExportCoordinate& coordinate(const ExportPlace& p) {
    return bodies[static_cast<std::size_t>(p.body)]
        .joint.coordinates[static_cast<std::size_t>(p.index)];
  }
  [[nodiscard]] const ExportCoordinate& coordinate(const ExportPlace& p) const {
    return bodies[static_cast<std::size_t>(p.body)]
        .joint.coordinates[static_cast<std::size_t>(p.index)];
  }
};

/// The tree of a model; what the format cannot represent is refused.
[[nodiscard]] ExportTree export_tree(const Simulation& simulation, const ExportAbilities& can,
                                     ExportNotes& notes);

/// Gives the coordinates of a joint, in the order from its parent, and its axes.
void put_coordinates(const Simulation& simulation, int body, ExportJoint& joint);

/// Gives all loads of a model to the coordinates they act along, or refuses them.
void put_loads(const Model& model, const ExportAbilities& can, ExportNotes& notes,
               ExportTree& tree);

/// Name of the ground in files of robots.
inline constexpr const char* kGroundName = "world";
/// Name of a body in the file: its own, unless that is the ground's.
[[nodiscard]] std::string file_name(const Model& model, const std::string& body);

/// Point of a joint on a body in the body's own coordinates; of the ground in the world's.
[[nodiscard]] Vec3 in_own_coordinates(const Model& model, int body, const Vec3& Z);

}  // namespace polhode::io
