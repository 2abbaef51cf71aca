// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include <polhode/io/importers/node_builder.hpp>
#include <polhode/io/importers/robot_tree.hpp>

namespace polhode::io {

/// Writer of the lines over points of a robot, and of its probes, as the content of a model file.
class CableWriter {
 public:
  /// All outlive this object. @param link_names  Names of the links in the model.
  CableWriter(const Robot& robot, const RobotTree& tree, const std::vector<std::string>& link_names,
              XmlFile& xml, std::vector<ImportNote>& notes)
      : robot_(robot), tree_(tree), link_names_(link_names), xml_(xml), notes_(notes) {}

  /// Adds a line between two points to the loads, as springs, dampers and pulls, others to the
  /// cables.
  void write(SourceNode& cables, SourceNode& loads);
  /// Adds forces and moments at points of links to the loads.
  void write_pushes(SourceNode& loads);
  /// Adds forces that hold the weight of links, or part of it.
  void write_weights(SourceNode& loads);
  /// Adds the resistance of a medium to the loads.
  void write_drags(SourceNode& loads);

  /// Names of joints and of actuators in the model, by those in the file.
  struct Names {
    const std::map<std::string, std::string>&joints, &actuators;
  };
  /// To be called after the lines are written. @param joints  Those of the model.
  void write_probes(const Names& names, const SourceNode& joints, SourceNode& probes);

 private:
  void write_line(const RobotCable& cable, SourceNode& cables);
  void write_springs(const RobotCable& cable, SourceNode& loads);
  [[nodiscard]] int link(const std::string& name) const { return tree_.link_index.at(name); }
  [[nodiscard]] const std::string& body(const std::string& link_name) const;
  [[nodiscard]] Vec3 place(const RobotPoint& point) const;

  const Robot& robot_;
  const RobotTree& tree_;
  const std::vector<std::string>& link_names_;
  XmlFile& xml_;
  std::vector<ImportNote>& notes_;
  /// Key and value of the probe of each line, by its name in the file.
  std::map<std::string, std::pair<std::string, std::string>> written_;
};

}  // namespace polhode::io
