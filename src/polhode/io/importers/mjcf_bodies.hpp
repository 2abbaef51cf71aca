// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include <polhode/io/importers/mjcf_geom.hpp>

namespace polhode::io {

/// Errors about parts of a file that a model cannot represent, or notes where partial imports are
/// allowed.
class MjcfRefusals {
 public:
  MjcfRefusals(MjcfFile& file, bool allow_partial) : file_(file), partial_(allow_partial) {}
  void add(const XmlFile::Element& at, const std::string& what, const std::string& hint);

 private:
  MjcfFile& file_;
  bool partial_;
};

/// Reader of the tree of bodies. Each joint of a body moves a link of its own, all but the last one
/// without mass: joints act one after the other, as in MuJoCo.
class MjcfBodies {
 public:
  MjcfBodies(MjcfFile& file, MjcfGeoms& geoms, MjcfRefusals& refusals, const ImportOptions& options,
             Robot& robot)
      : file_(file), geoms_(geoms), refusals_(refusals), options_(options), robot_(robot) {}

  /// Reads all <worldbody> sections.
  void read();

  /// Frame of a link at the model's configuration, in the world.
  [[nodiscard]] const std::map<std::string, Pose>& frames() const { return frames_; }
  /// Frames of sites, and the links that they are on.
  struct Site {
    std::string link;
    Pose frame;
  };
  [[nodiscard]] const std::map<std::string, Site>& sites() const { return sites_; }
  /// Geoms that a tendon can run around.
  struct Wrap {
    std::string link;
    Pose frame;
    bool sphere;    ///< Otherwise a cylinder along z.
    double radius;  ///< [m]
  };
  [[nodiscard]] const std::map<std::string, Wrap>& wraps() const { return wraps_; }

  /// Geoms for pairs of contact.
  struct Touching {
    std::string link;
    std::array<double, 3> friction;
    double dimensions;
  };
  [[nodiscard]] const std::map<std::string, Touching>& touching() const { return touching_; }
  /// Axes of inertia of each body, in its coordinates.
  [[nodiscard]] const std::map<std::string, Mat3>& axes() const { return axes_; }
  /// Joints of mocap bodies in the robot, in the order of the file.
  [[nodiscard]] const std::vector<std::size_t>& mocaps() const { return mocaps_; }
  /// Geoms around which a medium flows as around ellipsoids.
  [[nodiscard]] const std::vector<const XmlFile::Element*>& ellipsoids() const {
    return ellipsoids_;
  }

 private:
  using Element = XmlFile::Element;
  /// A body, or a <frame> in it, while its content is read.
  struct Place {
    std::string link;
    int body;    ///< Index of the link.
    Pose frame;  ///< Of the tag in the coordinates of the link.
    std::string child_class;
    std::string suffix = {};  ///< Of names, in <replicate>.
  };
  /// Mass of the geoms of a body, in its coordinates.
  struct Parts {
    std::vector<geometry::MassProperties> mass;
    Mat3 axes = Mat3::Identity();  ///< Axes of inertia of the last one.
  };
  [[nodiscard]] int add_link(const std::string& name, const Element& at);
  void read_content(const Element& e, const Place& place, Parts& parts, bool massive);
  void read_body(const Element& e, const Place& parent);
  void read_copies(const Element& e, const Place& place, Parts& parts, bool massive);
  void read_joint(const MjcfTag& tag, RobotJoint& joint);
  void read_limits(const MjcfTag& tag, RobotJoint& joint);
  void read_ball(const MjcfTag& tag, RobotJoint& joint);
  /// @param axes  Its axes of inertia, if it gives them.
  [[nodiscard]] geometry::MassProperties inertial(const Element& e, Mat3& axes);
  void tune();
  void bound(geometry::MassProperties& mass) const;

  MjcfFile& file_;
  MjcfGeoms& geoms_;
  MjcfRefusals& refusals_;
  const ImportOptions& options_;
  Robot& robot_;
  std::map<std::string, Pose> frames_;
  std::map<std::string, Site> sites_;
  std::map<std::string, Wrap> wraps_;
  std::map<std::string, Touching> touching_;
  std::map<std::string, Mat3> axes_;
  std::vector<const Element*> ellipsoids_;
  std::set<std::string> joint_names_, given_joints_;
  std::vector<std::size_t> mocaps_;
  int copies_ = 0;  ///< Of all <replicate>.
  /// A joint whose spring and damper follow from a time constant and a damping ratio.
  struct Tuned {
    const Element* at;
    std::size_t joint;
    double time, ratio;  ///< [s], [-]
  };
  std::vector<Tuned> tuned_;
};

/// Joint of a name, with one coordinate; null after an error.
const RobotJoint* single_joint(XmlFile& xml, const Robot& robot, const XmlFile::Element& at,
                               const std::string& name);

}  // namespace polhode::io
