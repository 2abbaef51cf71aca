// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include <polhode/io/importers/sdf_file.hpp>

namespace polhode::io {

/// A frame of an SDFormat file: the world, or that of a link, joint, model or <frame>.
struct SdfFrame {
  enum class Kind : unsigned char { world, link, joint, model, frame };
  Kind kind = Kind::frame;
  const XmlFile::Element* at = nullptr;
  std::string name;  ///< As seen from outside of all models.
  int scope = 0;     ///< Where its names are looked up.
  int inner = -1;    ///< Scope of what a model contains.
  SdfPose pose;
  std::string attached_to;  ///< Of a <frame>; child of a joint; canonical link of a model.
  std::string placement;    ///< Of a model: name of the frame in it that `pose` places.
  int link = -1;            ///< Of a link: index in the robot.
};

/// The frames of a file and the names by which each is known. Frames are added first; poses are
/// known after connect().
class SdfFrames {
 public:
  explicit SdfFrames(SdfFile& file);

  /// Adds a frame to its scope. @param local  Its name there. @returns its number.
  int add(SdfFrame frame, const std::string& local);
  /// Adds the scope of a model. @param merged  Whether what it contains belongs to the one around.
  int add_scope(int model, bool merged);
  /// Finds the frames that poses are relative to. Errors go to the file's diagnostics.
  void connect();

  [[nodiscard]] const SdfFrame& operator[](int frame) const { return frames_[index(frame)]; }
  /// Prefix of the names of a scope, by which they are known outside of it.
  [[nodiscard]] const std::string& prefix(int scope) const { return scopes_[index(scope)].prefix; }
  [[nodiscard]] int model_frame(int scope) const { return scopes_[index(scope)].frame; }
  /// Frame of a name, which may be scoped; −1 if there is none.
  [[nodiscard]] int find(int scope, const std::string& name) const;
  /// Frame of a name, which must exist; −1 after an error.
  int required(const XmlFile::Element& at, int scope, const std::string& name);
  /// Frame of the link that a frame is attached to; −1 after an error.
  int link_of(const XmlFile::Element& at, int frame);
  /// Frame in the world.
  const Pose& in_world(int frame);
  /// Frame b in the coordinates of a.
  Pose between(int a, int b);

 private:
  struct Scope {
    std::string prefix;
    int frame = 0;   ///< Of its model, or the world's.
    int above = -1;  ///< Scope around it, if what it contains belongs there.
    int first_link = -1, first_model = -1;
    std::unordered_map<std::string, int> names;
  };
  [[nodiscard]] static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  int base_of(int frame);
  const Pose& local(int frame);
  std::optional<Pose> within(int frame, int model);

  SdfFile& file_;
  std::vector<SdfFrame> frames_;
  std::vector<Scope> scopes_;
  std::vector<int> base_;  ///< Frame that the pose of each is relative to; −1: none.
  enum class State : unsigned char { open, busy, known };
  std::vector<State> local_state_, world_state_;
  std::vector<Pose> local_, world_;
};

}  // namespace polhode::io
