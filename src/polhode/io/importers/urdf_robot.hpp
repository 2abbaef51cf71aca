// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <polhode/core/types.hpp>
#include <polhode/geometry/mass_properties.hpp>
#include <polhode/io/importers/import_model.hpp>
#include <polhode/io/importers/xml_file.hpp>

namespace polhode::io {

/// A frame in the coordinates of another one.
struct Pose {
  Vec3 p = Vec3::Zero();  ///< Origin [m].
  Mat3 R = Mat3::Identity();

  [[nodiscard]] Pose operator*(const Pose& inner) const { return {p + R * inner.p, R * inner.R}; }
  [[nodiscard]] Vec3 operator*(const Vec3& point) const { return p + R * point; }
  [[nodiscard]] Pose inverse() const { return {-(R.transpose() * p), R.transpose()}; }
};

/// A shape of a link, as in the file.
struct UrdfShape {
  const XmlFile::Element* at = nullptr;
  Pose pose;
  std::string kind;           ///< box, sphere, cylinder, capsule, mesh.
  std::vector<double> sizes;  ///< As in a model file: full lengths [m].
  std::string file;           ///< Of a mesh, as written.
  Vec3 scale = Vec3::Ones();  ///< Of a mesh.
};

struct UrdfLink {
  std::string name;
  const XmlFile::Element* at = nullptr;
  bool has_inertial = false;
  geometry::MassProperties mass;  ///< In the link's axes; zero if it has none.
  std::vector<UrdfShape> visual, collision;
};

/// Coordinate that follows another one: multiplier times it plus an offset.
struct UrdfMimic {
  const XmlFile::Element* at = nullptr;
  std::string joint;
  double multiplier = 1.0, offset = 0.0;
};

struct UrdfJoint {
  std::string name, type, parent, child;
  const XmlFile::Element* at = nullptr;
  Pose origin;
  Vec3 axis = Vec3::UnitX();  ///< Unit vector in the joint's frame.
  std::optional<double> lower, upper;
  double damping = 0.0, friction = 0.0;
  std::optional<UrdfMimic> mimic;

  [[nodiscard]] bool turns() const { return type == "revolute" || type == "continuous"; }
  /// Whether it has one coordinate.
  [[nodiscard]] bool is_single() const { return turns() || type == "prismatic"; }
};

/// A joint between links that closes a loop: <loop_joint>, <loop>.
struct UrdfLoop {
  std::string name, type;
  const XmlFile::Element* at = nullptr;
  std::string links[2];
  Pose frames[2];  ///< In the links' coordinates.
  Vec3 axis = Vec3::UnitX();
};

/// A robot as its URDF describes it, checked one by one but not as a tree.
struct UrdfRobot {
  std::string name;
  std::vector<UrdfLink> links;
  std::vector<UrdfJoint> joints;
  std::vector<UrdfLoop> loops;
};

/// Axes with this z, and as x the world axis most nearly normal to it, made normal.
[[nodiscard]] Mat3 axes_along(const Vec3& z);

/// Reads the tags of a URDF. Errors go to the file's diagnostics, and tags without influence on the
/// motion to the notes.
[[nodiscard]] UrdfRobot read_urdf_robot(XmlFile& xml, std::vector<ImportNote>& notes);

}  // namespace polhode::io
