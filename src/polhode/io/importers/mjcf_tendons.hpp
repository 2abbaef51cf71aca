// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include <polhode/io/importers/mjcf_bodies.hpp>

namespace polhode::io {

/// Reader of tendons. A spatial one is a line through sites, around geoms; a fixed one a sum of
/// coordinates.
class MjcfTendons {
 public:
  MjcfTendons(MjcfFile& file, MjcfRefusals& refusals, const MjcfBodies& bodies,
              const ImportOptions& options, Robot& robot)
      : file_(file), refusals_(refusals), bodies_(bodies), options_(options), robot_(robot) {}

  /// Reads all <tendon> sections.
  void read();

  /// Joints of fixed tendons and their factors, by the tendon's name.
  using Sums = std::map<std::string, std::vector<std::pair<std::string, double>>>;
  [[nodiscard]] const Sums& sums() const { return sums_; }
  /// A spatial tendon that is read; null if there is none of the name.
  RobotCable* spatial(const std::string& name);
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
  std::map<std::string, std::size_t> spatial_;  ///< In the robot's cables.
  std::map<std::string, Pose> relaxed_;         ///< Frames of links.
  std::map<std::string, double> rests_;         ///< Coordinates of joints.
};

}  // namespace polhode::io
