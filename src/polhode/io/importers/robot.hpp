// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <polhode/core/types.hpp>
#include <polhode/geometry/mass_properties.hpp>
#include <polhode/io/importers/import_model.hpp>
#include <polhode/io/importers/robot_signal.hpp>
#include <polhode/io/importers/xml_file.hpp>

namespace polhode::io {

/// A frame in the coordinates of another one.
struct Pose {
  Vec3 p = Vec3::Zero();  ///< Origin [m].
  Mat3 R = Mat3::Identity();

  [[nodiscard]] Pose operator*(const Pose& inner) const { return {p + R * inner.p, R * inner.R}; }
  [[nodiscard]] Vec3 operator*(const Vec3& point) const { return p + R * point; }
  [[nodiscard]] bool is_identity() const { return p.isZero(0.0) && R.isIdentity(0.0); }
  [[nodiscard]] Pose inverse() const { return {-(R.transpose() * p), R.transpose()}; }
};

/// A shape of a link.
struct RobotShape {
  const XmlFile::Element* at = nullptr;
  Pose pose;
  /// box, sphere, cylinder, capsule, ellipsoid, mesh, plane, height_field.
  std::string kind;
  std::vector<double> sizes;  ///< As in a model file: full lengths; of a height field spacing [m].
  std::vector<std::vector<double>> heights;  ///< Of a height field, rows from -y to +y [m].
  std::string file;                          ///< Of a mesh, as written.
  std::optional<std::string> folder;  ///< To which it is relative; left out: that of the robot.
  Vec3 scale = Vec3::Ones();          ///< Of a mesh.
  std::string name;                   ///< In the file; "": none.
  /// Two shapes touch if a bit of the first number of one is one of the second of the other.
  std::pair<int, int> contact_bits{1, 1};
  std::vector<int> contact_pairs;  ///< Numbers of pairs in which it touches.
  double friction = 0.0;           ///< Coefficient of contact.
};

struct RobotLink {
  std::string name;
  const XmlFile::Element* at = nullptr;
  bool has_inertial = false;
  bool name_in_file = true;       ///< Not one that stands between the joints of a body.
  double carried = 0.0;           ///< Part of its weight that a force holds.
  geometry::MassProperties mass;  ///< In the link's axes; zero if it has none.
  std::vector<RobotShape> visual, collision;
};

/// Coordinate that follows another one: multiplier times it plus an offset.
struct RobotMimic {
  const XmlFile::Element* at = nullptr;
  std::string joint;
  double multiplier = 1.0, offset = 0.0;
};

/// A joint between two links. Its frames on the two coincide where its coordinate is `zero`.
struct RobotJoint {
  std::string name;
  /// revolute, continuous, prismatic, planar, spherical, universal, screw, floating, fixed.
  std::string type;
  std::string parent, child;
  const XmlFile::Element* at = nullptr;
  Pose origin, on_child;        ///< Its frame in the coordinates of the parent, and of the child.
  Vec3 axis = Vec3::UnitX();    ///< Unit vector in the joint's frame; on the parent.
  Vec3 axis2 = Vec3::UnitY();   ///< Of a universal joint: axis on the child, normal to the other.
  double pitch = 0.0;           ///< Of a screw: displacement per turn [m].
  bool closes = false;          ///< Closes a loop: its coordinate follows from those of the tree.
  bool in_loop = false;         ///< One of a loop that such a joint closes, or that joint.
  double zero = 0.0;            ///< Also its start, unless another one is given [rad, m].
  std::optional<double> start;  ///< That the file gives, of a joint with one coordinate [rad, m].
  Pose start_motion;            ///< Likewise of spherical and floating ones: child in parent.
  /// Velocity at the start: of the coordinate; of a spherical joint the angular velocity in the
  /// child's axes; of a floating one the velocity of the child's origin in world axes, and then the
  /// angular velocity in the child's.
  std::vector<double> rate;
  std::optional<double> lower, upper;
  double damping = 0.0, friction = 0.0, stiffness = 0.0;
  double rest = 0.0;                 ///< Coordinate without force of the spring [rad, m].
  std::optional<double> rest_upper;  ///< The spring is without force from `rest` up to here.
  /// Factors of the square and cube of the coordinate less `law_rest`, and of the rate, in a moment
  /// or force against them; of the rate's square with its sign.
  std::array<double, 2> spring_law{}, damper_law{};
  double law_rest = 0.0;
  double armature = 0.0;                            ///< Inertance [kg m², kg].
  std::optional<double> least_effort, most_effort;  ///< Of all its actuators [N m, N].
  std::optional<RobotMimic> mimic;

  /// Whether its coordinate is an angle.
  [[nodiscard]] bool turns() const {
    return type == "revolute" || type == "continuous" || type == "screw";
  }
  /// Whether it has one coordinate.
  [[nodiscard]] bool is_single() const { return turns() || type == "prismatic"; }
};

/// A joint between links that closes a loop: <loop_joint>, <loop>; or a bound of a distance.
struct RobotLoop {
  std::string name, type;
  const XmlFile::Element* at = nullptr;
  std::string links[2];
  Pose frames[2];  ///< In the links' coordinates.
  Vec3 axis = Vec3::UnitX();
  std::optional<double> lower, upper;  ///< Of the distance of a slack_link [m].
};

/// A row between coordinates: the sum of factors times coordinates is constant.
struct RobotRow {
  std::string name;
  const XmlFile::Element* at = nullptr;
  std::vector<std::string> joints;
  std::vector<double> factors;  ///< Of each; the first one is not zero.
  double sum = 0.0;             ///< [rad, m]
  /// Whether the first coordinate is defined by the others: its start follows from theirs.
  bool defines_first = false;
};

/// A motor or servo of a joint with one coordinate.
struct RobotActuator {
  enum class Kind : unsigned char {
    effort,   ///< Moment or force.
    place,    ///< Angle or displacement, by a servo.
    velocity  ///< Rate, by a servo.
  };
  std::string name, joint;
  const XmlFile::Element* at = nullptr;
  Kind kind = Kind::effort;
  double stiffness = 0.0, damping = 0.0;  ///< Of a servo.
  RobotSignal target;                     ///< Effort, coordinate or rate.
  /// Bounds of the effort [N m, N].
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();

  /// Adds bounds, in either order.
  void bound(double one, double other) {
    least = std::clamp(least, std::min(one, other), std::max(one, other));
    most = std::clamp(most, std::min(one, other), std::max(one, other));
  }
};

/// A point of a link, or an obstacle on it.
struct RobotPoint {
  std::string link;
  Vec3 p = Vec3::Zero();  ///< In the link's coordinates [m].
};

/// A force and a moment at a point of a link.
struct RobotPush {
  std::string name;
  const XmlFile::Element* at = nullptr;
  RobotPoint point;
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();  ///< Per value of the signal.
  bool in_world = false;  ///< Their axes are those of the world, otherwise those of the link.
  RobotSignal signal;
};

/// Resistance of a medium to a link, along and about axes at a point.
struct RobotDrag {
  const XmlFile::Element* at = nullptr;
  std::string link;
  Pose frame;                                                     ///< In the link's coordinates.
  Vec3 linear = Vec3::Zero(), quadratic = Vec3::Zero();           ///< [N s/m], [N s²/m²]
  Vec3 turning = Vec3::Zero(), quadratic_turning = Vec3::Zero();  ///< [N m s], [N m s²]
};

/// A line over points of links, around obstacles, with one tension.
struct RobotCable {
  struct Obstacle {
    std::string name;
    std::string type;  ///< sphere, cylinder.
    RobotPoint at;
    Vec3 axis = Vec3::UnitZ();  ///< Of a cylinder, in the link's axes.
    double radius = 0.0;        ///< [m]
    std::optional<Vec3> side;   ///< Direction to where the line passes, in the link's axes.
    std::size_t after = 0;      ///< Number of the point before it, from 0.
  };
  std::string name;
  const XmlFile::Element* at = nullptr;
  std::vector<RobotPoint> through;
  std::vector<Obstacle> around;
  double stiffness = 0.0, damping = 0.0;  ///< [N/m, N s/m]
  double shortest = 0.0, longest = 0.0;   ///< Lengths between which there is no force [m].
  std::vector<RobotSignal> tension;       ///< Of actuators [N]: their sum.
};

/// Two links whose shapes do not touch.
struct RobotExclusion {
  const XmlFile::Element* at = nullptr;
  std::string links[2];
  bool by_tree = false;  ///< By their places in the tree, and not by the file.
};

/// Two links with properties of contact of their own.
struct RobotContactPair {
  std::string name;
  const XmlFile::Element* at = nullptr;
  std::string links[2];
  double friction = 0.0, torsion = 0.0, rolling = 0.0;  ///< Coefficient; lengths [m].
};

/// Exclusions and pairs of contacts, for a model with a section of contacts.
struct RobotContacts {
  bool wanted = false;
  bool off = false;       ///< The file switches them off.
  bool friction = false;  ///< By the larger coefficient of two shapes.
  std::vector<RobotExclusion> exclusions;
  std::vector<RobotContactPair> pairs;
};

/// Something to be recorded.
struct RobotProbe {
  enum class Kind : unsigned char { body, joint, load, cable };
  std::string name;
  const XmlFile::Element* at = nullptr;
  Kind kind = Kind::body;
  std::string of;         ///< Joint, actuator or cable of the file.
  RobotPoint point;       ///< Of a body.
  std::string rotation;   ///< Likewise; "": none.
  bool angular = false;   ///< Likewise.
  std::string seen_from;  ///< Likewise: a link; "": the world.
};

/// A robot as its file describes it, checked one by one but not as a tree.
struct Robot {
  std::string name;
  std::string follows = "<mimic>";  ///< Tag by which joints follow others, for messages.
  Vec3 gravity{0.0, 0.0, -9.81};    ///< [m/s²]
  std::vector<RobotRow> rows;
  std::vector<RobotActuator> actuators;
  RobotContacts contacts;
  std::vector<RobotPush> pushes;
  std::vector<RobotDrag> drags;
  std::vector<RobotCable> cables;
  std::vector<RobotProbe> probes;
  std::vector<RobotLink> links;
  std::vector<RobotJoint> joints;
  std::vector<RobotLoop> loops;
};

/// Axes with this z, and as x the world axis most nearly normal to it, made normal.
[[nodiscard]] Mat3 axes_along(const Vec3& z);

/// Rotation by roll, pitch, yaw about fixed axes: Rz(yaw) Ry(pitch) Rx(roll).
[[nodiscard]] Mat3 rotation_of_rpy(const Vec3& rpy);

}  // namespace polhode::io
