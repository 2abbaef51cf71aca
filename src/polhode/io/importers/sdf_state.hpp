// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>

#include <polhode/io/importers/sdf_frames.hpp>

namespace polhode::io {

/// The <state> of a world, in which a simulator saved where its models were.
///
/// Poses of models and links are in the world there, also those of links. A model is moved as a
/// whole; a state in which links have moved within their model, or move, is refused.
class SdfState {
 public:
  /// @param file  Outlives this object.
  explicit SdfState(SdfFile& file) : file_(file) {}

  /// Reads the <state> of a world, if it has one.
  void read(const XmlFile::Element& world);
  /// Gives the frame of a model of the world the pose of the state, if that differs.
  void place(const std::string& model, SdfFrame& frame);
  /// Errors about what the state changes within models; the frames are connected.
  void check(SdfFrames& frames);
  /// Errors about joints between models that the state has moved.
  void check(const std::vector<RobotJoint>& joints);

 private:
  using Element = XmlFile::Element;
  void read_model(const Element& e);
  void check_model(const Element& e, const std::string& name, SdfFrames& frames);
  /// Whether a list of numbers has one that is not negligible.
  bool moves(const Element& parent, const char* tag);

  SdfFile& file_;
  std::map<std::string, const Element*> models_;
  std::set<std::string> moved_;
};

}  // namespace polhode::io
