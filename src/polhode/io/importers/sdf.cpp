// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/sdf.hpp>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <set>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/robot_span.hpp>
#include <polhode/io/importers/sdf_include.hpp>
#include <polhode/io/importers/sdf_joints.hpp>
#include <polhode/io/importers/sdf_links.hpp>
#include <polhode/io/importers/sdf_state.hpp>
#include <polhode/io/importers/write_robot.hpp>

namespace polhode::io {

namespace {

using Element = XmlFile::Element;

/// Versions of SDFormat that are read: 1.4 to 1.12.
constexpr int kFirstVersion = 4, kLastVersion = 12;
/// Files that include each other one in the other, and all that are included.
constexpr std::size_t kDeepestInclude = 20, kMostIncludes = 2000;
/// Gravity of a world that gives none [m/s²].
const Vec3 kWorldGravity(0.0, 0.0, -9.8);

/// Reader of worlds and models: names all that is in them, then reads links and joints.
class SdfReader {
 public:
  SdfReader(XmlFile& xml, const ImportOptions& options, std::vector<ImportNote>& notes)
      : xml_(xml), file_(xml, notes, options), frames_(file_), state_(file_) {}

  Robot read(const std::string& folder) {
    const Element& root = xml_.root();
    if (std::string_view(root.Name()) != "sdf") {
      xml_.fault(root, format("the file's tag is <{}>, not <sdf>", root.Name()),
                 "Give an SDFormat file, which starts with <sdf version=\"...\">.");
      return {};
    }
    if (file_.options.base != "fixed")
      xml_.fault(root, "an SDFormat file says itself which models move freely",
                 "Leave import.base out.");
    Place place{0, folder, version_of(root), false, {real_path(file_.options.file)}};
    RobotLink world;
    world.name = "world";
    world.at = &root;
    robot_.links.push_back(std::move(world));
    read_root(root, place);
    frames_.connect();
    fill();
    return std::move(robot_);
  }

 private:
  /// Surroundings of a tag: its model, its file and the files that include that.
  struct Place {
    int scope;
    std::string folder;  ///< Of its file.
    int version;         ///< Minor one of its file.
    bool is_static;
    std::vector<std::string> open;  ///< Files that include each other up to here, without links.
  };

  static std::string real_path(const std::string& path) {
    std::error_code unknown;
    return std::filesystem::weakly_canonical(path, unknown).string();
  }

  int version_of(const Element& root) {
    const std::string text = xml_.required_text(root, "version");
    int minor = -1;
    if (text.starts_with("1.")) {
      const char* end = text.data() + text.size();
      if (std::from_chars(text.data() + 2, end, minor).ptr != end) minor = -1;
    }
    if (!text.empty() && (minor < kFirstVersion || minor > kLastVersion))
      xml_.fault(root, format("the version {} of SDFormat is not read", quote(text)),
                 format("Versions 1.{} to 1.{} are; gz sdf converts others.", kFirstVersion,
                        kLastVersion));
    return minor < 0 ? kLastVersion : minor;
  }

  void read_root(const Element& root, const Place& place) {
    const auto worlds = xml_.children(root, "world");
    const auto models = xml_.children(root, "model");
    if (worlds.size() > 1 || (!worlds.empty() && !models.empty()))
      xml_.fault(*(worlds.size() > 1 ? worlds[1] : models[0]),
                 "the file has more than one world or model",
                 "Keep one world, or models without a world.");
    if (worlds.empty()) {
      if (!models.empty()) robot_.name = xml_.text(*models[0], "name").value_or("");
      for (const Element* e : models) read_model(*e, place, nullptr, models.size() == 1);
      for (const Element* e : xml_.children(root, "include")) read_include(*e, place);
    } else {
      read_world(*worlds[0], place);
    }
    file_.ignored.skip(root, {"light", "actor"});
  }

  void read_world(const Element& e, const Place& place) {
    robot_.name = xml_.text(e, "name").value_or("");
    robot_.gravity = file_.vector(e, "gravity").value_or(kWorldGravity);
    state_.read(e);
    read_content(e, place);
    if (const Element* wind = xml_.child(e, "wind")) {
      const Vec3 v = file_.vector(*wind, "linear_velocity").value_or(Vec3::Zero());
      if (!v.isZero(0.0)) file_.refuse(*wind, "the world has wind", "Add loads of type drag.");
    }
    file_.ignored.skip(e, {"physics", "scene", "light", "gui", "plugin", "atmosphere",
                           "magnetic_field", "spherical_coordinates", "audio", "actor", "road"});
    for (const Element* population : xml_.children(e, "population")) {
      xml_.skip(*population);
      file_.refuse(*population, "<population> is not read", "Write its models out.");
    }
  }

  /// Reads links, joints, frames, models and includes, of a model or a world.
  void read_content(const Element& e, const Place& place) {
    for (const Element* link : xml_.children(e, "link")) name_link(*link, place);
    for (const Element* joint : xml_.children(e, "joint")) name_joint(*joint, place);
    for (const Element* frame : xml_.children(e, "frame")) {
      SdfFrame named = named_frame(*frame, place, SdfFrame::Kind::frame);
      named.attached_to = xml_.text(*frame, "attached_to").value_or("");
      const std::string name = xml_.text(*frame, "name").value_or("");
      frames_.add(std::move(named), name);
    }
    for (const Element* model : xml_.children(e, "model"))
      read_model(*model, place, nullptr, false);
    for (const Element* include : xml_.children(e, "include")) read_include(*include, place);
    for (const Element* other = e.FirstChildElement(); other != nullptr;
         other = other->NextSiblingElement())
      if (std::string_view(other->Name()).ends_with(":joint")) {
        xml_.skip(*other);
        file_.refuse(*other, format("<{}> is not read", other->Name()),
                     "Leave it out, and add a joint to the model.");
      }
  }

  /// A frame with the name and the pose of its tag.
  SdfFrame named_frame(const Element& e, const Place& place, SdfFrame::Kind kind) {
    SdfFrame frame;
    frame.kind = kind;
    frame.at = &e;
    frame.scope = place.scope;
    frame.name = frames_.prefix(place.scope) + xml_.required_text(e, "name");
    frame.pose = file_.pose(e);
    return frame;
  }

  void name_link(const Element& e, const Place& place) {
    SdfFrame frame = named_frame(e, place, SdfFrame::Kind::link);
    frame.link = static_cast<int>(robot_.links.size());
    RobotLink link;
    link.name = frame.name;
    link.at = &e;
    robot_.links.push_back(std::move(link));
    const std::string name = xml_.text(e, "name").value_or("");
    links_.push_back({&e, frames_.add(std::move(frame), name), place.is_static, place.folder});
  }

  void name_joint(const Element& e, const Place& place) {
    SdfFrame frame = named_frame(e, place, SdfFrame::Kind::joint);
    frame.attached_to = file_.text(e, "child");
    const std::string name = xml_.text(e, "name").value_or("");
    const int number = frames_.add(std::move(frame), name);
    if (!place.is_static) {
      joints_.push_back({&e, number, place.version});
      return;
    }
    xml_.skip(e);
    file_.ignored.add(e, "a joint of a static model", "moves nothing");
  }

  /// @param include  Tag that includes it; may be null.
  /// @param alone    The only one of its file, whose names need no prefix.
  void read_model(const Element& e, Place place, const Element* include, bool alone) {
    SdfFrame frame = named_frame(e, place, SdfFrame::Kind::model);
    frame.attached_to = xml_.text(e, "canonical_link").value_or("");
    frame.placement = xml_.text(e, "placement_frame").value_or("");
    bool is_static = file_.boolean(e, "static", false), merged = file_.flag(e, "merge", false);
    std::string name = xml_.text(e, "name").value_or("");
    if (include != nullptr) {
      if (const std::string given = file_.text(*include, "name"); !given.empty()) name = given;
      frame.name = frames_.prefix(place.scope) + name;
      if (xml_.child(*include, "pose") != nullptr) {
        frame.pose = file_.pose(*include);
        frame.placement = file_.text(*include, "placement_frame");
      } else if (xml_.child(*include, "placement_frame") != nullptr) {
        xml_.fault(*include, "<placement_frame> has no <pose> beside it", "Add <pose>.");
      }
      is_static = file_.boolean(*include, "static", is_static);
      merged = merged || file_.flag(*include, "merge", false);
    }
    if (place.scope == 0) state_.place(name, frame);
    place.is_static = place.is_static || is_static;
    const int number = frames_.add(std::move(frame), merged || alone ? "" : name);
    place.scope = frames_.add_scope(number, merged || alone);
    read_content(e, place);
    file_.ignored.attributes(e, {"namespace"});
    file_.ignored.skip(
        e, {"self_collide", "allow_auto_disable", "enable_wind", "plugin", "gripper", "light"});
  }

  void read_include(const Element& e, const Place& place) {
    file_.ignored.skip(e, {"plugin", "namespace"});
    const std::string uri = file_.required_text(e, "uri");
    if (uri.empty()) return;
    if (place.open.size() > kDeepestInclude) {
      xml_.fault(e, format("files are included more than {} deep", kDeepestInclude),
                 "Include fewer files one in the other.");
      return;
    }
    if (++includes_ > kMostIncludes) {
      if (includes_ == kMostIncludes + 1)
        xml_.fault(e, format("more than {} files are included", kMostIncludes),
                   "Look for files that include others several times.");
      return;
    }
    const auto path = find_sdf(uri, place.folder, file_.options.package_paths);
    if (!path) {
      file_.refuse(e, format("there is no SDFormat file {} to include", quote(uri)),
                   "Give import.package_paths; nothing is downloaded.");
      return;
    }
    const std::string real = real_path(*path);
    if (std::find(place.open.begin(), place.open.end(), real) != place.open.end()) {
      xml_.fault(e, format("the file {} includes itself", quote(*path)), "Remove this include.");
      return;
    }
    const Element* root = xml_.include_below(e, *path, *path);
    if (root == nullptr) return;
    const Element* model = xml_.child(*root, "model");
    if (std::string_view(root->Name()) != "sdf" || model == nullptr) {
      xml_.fault(e, format("the file {} has no model", quote(*path)), "Include a model.");
      return;
    }
    Place inside = place;
    inside.folder = std::filesystem::path(*path).parent_path().string();
    inside.version = version_of(*root);
    inside.open.push_back(real);
    read_model(*model, inside, &e, false);
  }

  void fill() {
    std::vector<Pose> placed(1);
    std::vector<RobotJoint> welds;
    for (const SdfLink& from : links_) {
      RobotLink& link = robot_.links[static_cast<std::size_t>(frames_[from.frame].link)];
      read_sdf_link(file_, frames_, from, link);
      placed.push_back(frames_.in_world(from.frame));
      if (!from.is_static) continue;
      RobotJoint weld;
      weld.at = from.at;
      weld.name = link.name + "_static";
      weld.type = "fixed";
      weld.parent = "world";
      weld.child = link.name;
      weld.origin = placed.back();
      robot_.joints.push_back(std::move(weld));
    }
    state_.check(frames_);
    read_sdf_joints(file_, frames_, joints_, robot_);
    state_.check(robot_.joints);
    refuse_taken_names();
    placed.resize(robot_.links.size());
    file_.ignored.add_unread();
    for (const RobotJoint& joint : robot_.joints)
      if (joint.parent == joint.child) return;  // An error of the tree.
    span_tree(robot_, placed);
  }

  /// Names that joints are given here may be those of joints of the file.
  void refuse_taken_names() {
    std::set<std::string> names;
    for (const RobotJoint& joint : robot_.joints)
      if (!names.insert(joint.name).second)
        xml_.fault(*joint.at,
                   format("the name {} is that of another joint too, which has it for a second "
                          "axis or a static link",
                          quote(joint.name)),
                   "Rename the joint.");
  }

  XmlFile& xml_;
  SdfFile file_;
  SdfFrames frames_;
  SdfState state_;
  Robot robot_;
  std::vector<SdfLink> links_;
  std::vector<SdfJoint> joints_;
  std::size_t includes_ = 0;
};

}  // namespace

Imported import_sdf(std::shared_ptr<const SourceText> source, const ImportOptions& options,
                    const std::string& folder) {
  Imported result;
  result.format = "SDFormat";
  result.source = source;
  Diagnostics diagnostics(*source);
  XmlFile xml(source, diagnostics);
  const std::string own_folder = std::filesystem::path(options.file).parent_path().string();
  const Robot robot = SdfReader(xml, options, result.notes).read(own_folder);
  if (robot.links.size() < 2 && diagnostics.empty())
    xml.fault(xml.root(), "the file has no link", "Add <model> with <link> to it.");
  diagnostics.throw_if_any();
  write_robot(robot, options, xml, diagnostics, folder, result);
  diagnostics.throw_if_any();
  return result;
}

}  // namespace polhode::io
