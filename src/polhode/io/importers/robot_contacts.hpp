// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <vector>

#include <polhode/io/importers/node_builder.hpp>
#include <polhode/io/importers/robot_tree.hpp>

namespace polhode::io {

/// Writer of which shapes of a robot touch, in a model with contacts.
class ContactWriter {
 public:
  /// All outlive this object. @param link_names  Names of the links in the model.
  ContactWriter(const Robot& robot, const RobotTree& tree,
                const std::vector<std::string>& link_names, XmlFile& xml,
                std::vector<ImportNote>& notes);

  /// Adds to a shape what it touches.
  void put_shape(const RobotShape& shape, const NodeBuilder& make, SourceNode& node) const;
  /// The section of pairs and exclusions; empty if there are none. @param bodies  Of the model.
  [[nodiscard]] SourceNode section(const SourceNode& bodies);

 private:
  void put_groups(const RobotShape& shape, const NodeBuilder& make, SourceNode& contact) const;
  /// Body of a link, if it has a shape. @returns "" after a note.
  std::string body_with_shape(const std::string& link, const XmlFile::Element& at,
                              const SourceNode& bodies, const std::string& what);
  [[nodiscard]] bool are_fixed(const std::string (&links)[2]) const;

  const Robot& robot_;
  const RobotTree& tree_;
  const std::vector<std::string>& link_names_;
  XmlFile& xml_;
  std::vector<ImportNote>& notes_;
  /// Kinds of shapes by the bits of their contact, and whether all of them touch each other.
  std::vector<std::pair<int, int>> kinds_;
  bool by_groups_ = false;
  std::set<double> frictions_;  ///< Coefficients of all shapes that touch.
};

/// Says how many shapes of a file touch nothing, as the model has no contacts.
void note_idle_shapes(const Robot& robot, const RobotTree& tree, const XmlFile& xml,
                      std::vector<ImportNote>& notes);

}  // namespace polhode::io
