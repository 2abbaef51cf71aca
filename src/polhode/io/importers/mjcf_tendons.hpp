// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <polhode/io/importers/mjcf_bodies.hpp>
#include <polhode/io/importers/mjcf_inertia.hpp>

namespace polhode::io {

/// Reader of tendons. A spatial one is a line through sites, around geoms; a fixed one a sum of
/// coordinates.
class MjcfTendons {
 public:
  MjcfTendons(MjcfFile& file, MjcfRefusals& refusals, const MjcfBodies& bodies,
              const ImportOptions& options, Robot& robot)
      : file_(file), refusals_(refusals), bodies_(bodies), options_(options), robot_(robot) {}

  /// Adds a damping and an armature of an actuator on a tendon. To be called before `read`.
  void add_of_actuator(const std::string& tendon, double damping, double armature) {
    of_actuators_[tendon].first += damping;
    of_actuators_[tendon].second += armature;
  }
  /// Reads all <tendon> sections.
  void read();
  /// Bounds of the sum of the forces of its actuators; empty: none.
  [[nodiscard]] std::vector<double> force_range(const std::string& tendon) const {
    const auto found = force_ranges_.find(tendon);
    return found == force_ranges_.end() ? std::vector<double>() : found->second;
  }

  /// Joints of fixed tendons and their factors, by the tendon's name.
  using Sums = std::map<std::string, std::vector<std::pair<std::string, double>>>;
  [[nodiscard]] const Sums& sums() const { return sums_; }
  /// A spatial tendon that is read; null if there is none of the name.
  RobotCable* spatial(const std::string& name);
  /// Joint whose coordinate is the sum of a fixed tendon: that of a slide that is made for it.
  const std::string& length_joint(const std::string& name);
  /// Inertia of the joints and links of the file.
  [[nodiscard]] const MjcfInertia& inertia();
  /// Inertia that moves with a fixed tendon while all else is free; zero if it has none.
  [[nodiscard]] double inertia_of(const std::string& name);
  /// Says which tendons exert no force, and removes them. To be called when all is read.
  void finish();

 private:
  using Element = XmlFile::Element;
  /// Length of a tendon without force, from the lower to the upper bound [m, rad].
  struct Rest {
    double lower, upper;
  };
  void read_spatial(const MjcfTag& tag, const std::string& name);
  bool read_path(const Element& e, RobotCable& cable);
  bool add_obstacle(const Element& e, RobotCable& cable);
  void read_sum(const MjcfTag& tag, const std::string& name);
  /// Properties of a fixed tendon as those of its length's joint.
  struct Law {
    double stiffness = 0.0, damping = 0.0, friction = 0.0, armature = 0.0;
    Rest rest{0.0, 0.0};
    std::optional<Rest> range;
  };
  [[nodiscard]] Law law_of(const MjcfTag& tag, const std::string& name, double length_at_rest);
  /// Adds them to the joint of a tendon that has only one.
  void put_law(const Law& law, double factor, RobotJoint& joint) const;
  /// Limits of its length, if it has any.
  [[nodiscard]] std::optional<Rest> range_of(const MjcfTag& tag, const std::string& name);
  void add_link(const RobotCable& cable, const Rest& range);
  [[nodiscard]] Rest rest_of(const MjcfTag& tag, double length_at_rest);
  [[nodiscard]] double length_at_rest(const RobotCable& cable);
  /// Frame of each link where all joint springs are relaxed.
  [[nodiscard]] std::map<std::string, Pose> relaxed() const;

  MjcfFile& file_;
  MjcfRefusals& refusals_;
  const MjcfBodies& bodies_;
  const ImportOptions& options_;
  Robot& robot_;
  Sums sums_;
  std::map<std::string, std::pair<double, double>> of_actuators_;  ///< Damping, armature.
  std::map<std::string, std::vector<double>> force_ranges_;
  std::map<std::string, const Element*> sum_tags_;    ///< Tags of fixed tendons.
  std::map<std::string, std::string> length_joints_;  ///< By fixed tendon.
  std::optional<MjcfInertia> inertia_;
  std::map<std::string, std::size_t> spatial_;  ///< In the robot's cables.
  std::map<std::string, Pose> relaxed_;         ///< Frames of links.
  std::map<std::string, double> rests_;         ///< Coordinates of joints.
};

}  // namespace polhode::io
