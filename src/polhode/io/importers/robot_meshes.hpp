// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/io/importers/node_builder.hpp>
#include <polhode/io/importers/robot.hpp>

namespace polhode::io {

/// Writer of a robot's meshes.
class RobotMeshes {
 public:
  /// All outlive this object. @param folder  Folder to which paths are relative in the result.
  RobotMeshes(const ImportOptions& options, XmlFile& xml, const std::string& folder,
              std::vector<ImportNote>& notes)
      : options_(options), xml_(xml), folder_(folder), notes_(notes) {}

  /// Mesh as a surface if it is closed, else its convex hull. @returns whether there is one
  bool write(const RobotShape& shape, const NodeBuilder& make, SourceNode& node);
  /// Error, or a note where partial imports are allowed.
  void refuse(const XmlFile::Element& e, const std::string& what, const std::string& hint);

 private:
  void note(ImportNote::Kind kind, const XmlFile::Element& e, std::string what);
  [[nodiscard]] std::string relative(const std::string& path) const;

  const ImportOptions& options_;
  XmlFile& xml_;
  const std::string& folder_;
  std::vector<ImportNote>& notes_;
};

/// Adds the sizes of a shape that is no mesh: the normal of a plane, the heights of a field.
/// @param pose  In the body's coordinates.
void put_sizes(const NodeBuilder& make, const RobotShape& shape, const Pose& pose,
               SourceNode& node);

}  // namespace polhode::io
