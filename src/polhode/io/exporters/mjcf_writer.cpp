// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/exporters/mjcf_writer.hpp>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/exporters/export_text.hpp>
#include <polhode/io/exporters/export_tree.hpp>

namespace polhode::io {

namespace {

using Kind = ExportNote::Kind;

/// Bound of a coordinate without a bound, where the other one is there [rad, m].
constexpr double kFarStop = 1e9;
/// Difference of axes that is rounding [-].
constexpr double kWelded = 1e-6;
/// Site of the world in whose axes forces are given.
constexpr const char* kWorldAxes = "world_axes";

std::string quat_text(const Mat3& R) {
  const Quat q = Quat(R).normalized();
  return numbers_text({q.w(), q.x(), q.y(), q.z()});
}

class MjcfWriter {
 public:
  MjcfWriter(const Simulation& simulation, const ExportOptions& options, const ExportTree& tree,
             ExportNotes& notes)
      : simulation_(simulation),
        model_(simulation.model()),
        options_(options),
        tree_(tree),
        notes_(notes) {}

  std::string write() {
    out_.PushComment(" Written by Polhode. SI units; the bodies are at the start. ");
    write_all();
    return out_.CStr();
  }

 private:
  void write_all() {
    XmlTag mujoco(out_, "mujoco");
    mujoco.put("model", title_of(model_, options_.file));
    XmlTag(out_, "compiler").put("angle", "radian").put("inertiafromgeom", "false");
    XmlTag(out_, "option").put("gravity", model_.gravity);
    {
      const XmlTag defaults(out_, "default");
      XmlTag(out_, "geom").put("contype", "0").put("conaffinity", "0");
    }
    write_meshes();
    find_sites();
    find_ends();
    write_bodies();
    write_tendons();
    write_equalities();
    write_motors();
    write_start();
  }

  /// A frame of a loop's joint on one of its bodies.
  struct Site {
    std::string name;
    Vec3 p;
    Mat3 R;
  };

  [[nodiscard]] const BodySpec& spec(int body) const {
    return model_.bodies[static_cast<std::size_t>(body)];
  }

  /// Whether a shape is that of a file. There only the hulls of meshes touch.
  static bool is_mesh(const ShapeSpec& shape) {
    return shape.type == "mesh" || (shape.type == "hull" && !shape.file.empty());
  }

  void write_meshes() {
    std::set<std::string> names;
    for (const ExportBody& body : tree_.bodies)
      for (const ShapeSpec& shape : spec(body.spec).shapes) {
        const std::pair key(shape.file, shape.scale);
        if (!is_mesh(shape) || meshes_.contains(key)) continue;
        const std::string stem = std::filesystem::path(shape.file).stem().string();
        std::string name = stem;
        for (int k = 2; !names.insert(name).second; ++k) name = format("{}_{}", stem, k);
        meshes_.emplace(key, name);
      }
    if (meshes_.empty()) return;
    const XmlTag asset(out_, "asset");
    for (const auto& [key, name] : meshes_) {
      XmlTag mesh(out_, "mesh");
      mesh.put("name", name).put("file", path_from(options_.file, key.first));
      if (key.second != 1.0) mesh.put("scale", Vec3::Constant(key.second).eval());
    }
  }

  void find_sites() {
    for (const int j : tree_.loops) {
      const JointSpec& joint = model_.joints[static_cast<std::size_t>(j)];
      const auto axes = [&](int body, const Mat3& R) -> Mat3 {
        return body == kGround ? R : Mat3(simulation_.body(body).Lambda() * R);
      };
      const Mat3 M = axes(joint.a, joint.R_a).transpose() * axes(joint.b, joint.R_b);
      const bool same = joint.type != "fixed" || (M - Mat3::Identity()).norm() < kWelded;
      sites_[joint.a].push_back({joint.name + "_1", in_own_coordinates(model_, joint.a, joint.Z_a),
                                 same ? joint.R_a : Mat3(joint.R_a * M)});
      sites_[joint.b].push_back(
          {joint.name + "_2", in_own_coordinates(model_, joint.b, joint.Z_b), joint.R_b});
    }
  }

  void find_ends() {
    for (const ExportLine& line : tree_.lines) {
      const LoadSpec& load = model_.loads[static_cast<std::size_t>(line.load)];
      sites_[load.a].push_back(
          {load.name + "_1", in_own_coordinates(model_, load.a, load.Z_a), Mat3::Identity()});
      sites_[load.b].push_back(
          {load.name + "_2", in_own_coordinates(model_, load.b, load.Z_b), Mat3::Identity()});
    }
    bool by_world = false;
    for (const ExportPush& push : tree_.pushes) {
      const LoadSpec& load = model_.loads[static_cast<std::size_t>(push.load)];
      sites_[load.b].push_back(
          {load.name + "_at", in_own_coordinates(model_, load.b, load.Z_b), Mat3::Identity()});
      by_world = by_world || !load.body_fixed;
    }
    if (by_world) sites_[kGround].push_back({kWorldAxes, Vec3::Zero(), Mat3::Identity()});
  }

  void write_sites(int body) {
    const auto found = sites_.find(body);
    if (found == sites_.end()) return;
    for (const Site& site : found->second)
      XmlTag(out_, "site").put("name", site.name).put("pos", site.p).put("quat", quat_text(site.R));
  }

  void write_bodies() {
    const XmlTag world(out_, "worldbody");
    write_sites(kGround);
    std::vector<int> open{kGround};
    for (const ExportBody& body : tree_.bodies) {
      for (; open.back() != body.joint.parent; open.pop_back()) out_.CloseElement();
      out_.OpenElement("body");
      open.push_back(body.spec);
      write_body(body);
    }
    for (; open.size() > 1; open.pop_back()) out_.CloseElement();
  }

  void write_body(const ExportBody& body) {
    const BodySpec& b = spec(body.spec);
    const ExportJoint& joint = body.joint;
    out_.PushAttribute("name", file_name(model_, b.name).c_str());
    out_.PushAttribute("pos", vector_text(joint.child_at_start()).c_str());
    if (!joint.at_start.isIdentity(0.0))
      out_.PushAttribute("quat", quat_text(joint.at_start).c_str());
    if (body.carried != 0.0) out_.PushAttribute("gravcomp", number_text(body.carried).c_str());
    if (b.mass > 0.0) {
      XmlTag inertial(out_, "inertial");
      inertial.put("pos", b.com).put("mass", b.mass);
      const Mat3& J = b.inertia;
      if (J.isDiagonal(0.0))
        inertial.put("diaginertia", J.diagonal().eval());
      else
        inertial.put("fullinertia",
                     numbers_text({J(0, 0), J(1, 1), J(2, 2), J(0, 1), J(0, 2), J(1, 2)}));
    }
    if (joint.type == "free" && joint.damping == 0.0)
      XmlTag(out_, "freejoint").put("name", joint.name);
    else if (joint.type == "free")
      XmlTag(out_, "joint")
          .put("name", joint.name)
          .put("type", "free")
          .put("damping", joint.damping);
    if (joint.type == "spherical") {
      XmlTag ball(out_, "joint");
      ball.put("name", joint.name).put("type", "ball").put("pos", joint.on_child);
      if (joint.damping != 0.0) ball.put("damping", joint.damping);
    }
    for (const ExportCoordinate& q : joint.coordinates) write_coordinate(q);
    for (const ShapeSpec& shape : b.shapes) write_shape(b, shape);
    write_sites(body.spec);
  }

  void write_coordinate(const ExportCoordinate& q) {
    XmlTag tag(out_, "joint");
    tag.put("name", q.name).put("type", q.turns ? "hinge" : "slide");
    if (q.turns) tag.put("pos", q.point);
    tag.put("axis", q.axis);
    if (q.start != 0.0) tag.put("ref", q.start);
    if (q.lower || q.upper)
      tag.put("limited", "true")
          .put("range", numbers_text({q.lower.value_or(-kFarStop), q.upper.value_or(kFarStop)}));
    if (q.damping != 0.0) tag.put("damping", q.damping);
    if (q.friction != 0.0) tag.put("frictionloss", q.friction);
    if (q.stiffness != 0.0) tag.put("stiffness", q.stiffness).put("springref", q.rest);
    if (q.armature != 0.0) tag.put("armature", q.armature);
  }

  void write_shape(const BodySpec& body, const ShapeSpec& shape) {
    const std::vector<double>& s = shape.sizes;
    std::string type = shape.type, size;
    if (type == "box" || type == "ellipsoid")
      size = numbers_text({0.5 * s[0], 0.5 * s[1], 0.5 * s[2]});
    else if (type == "sphere" || (type == "capsule" && s[1] == s[0]))
      size = number_text(0.5 * s[0]);
    else if (type == "cylinder")
      size = numbers_text({0.5 * s[0], 0.5 * s[1]});
    else if (type == "capsule")
      size = numbers_text({0.5 * s[0], 0.5 * (s[1] - s[0])});  // Without its ends.
    else if (type == "plane")
      size = "0 0 1";  // Without bounds.
    else if (!is_mesh(shape))
      return notes_.refuse(shape.place, format("bodies.{}.shape", body.name),
                           format("an MJCF has no shape of the type {}{}", type,
                                  type == "hull" ? " without a file" : ""),
                           "Use a box, sphere, ellipsoid, cylinder, capsule or mesh.");
    if (type == "capsule" && s[1] == s[0]) type = "sphere";
    if (is_mesh(shape)) type = "mesh";
    XmlTag geom(out_, "geom");
    geom.put("type", type);
    if (!size.empty()) geom.put("size", size);
    if (type == "mesh") geom.put("mesh", meshes_.at({shape.file, shape.scale}));
    geom.put("pos", shape.position);
    const Mat3 R =
        type == "plane"
            ? Quat::FromTwoVectors(Vec3::UnitZ(), Vec3(s[0], s[1], s[2])).toRotationMatrix()
            : shape.orientation.toRotationMatrix();
    if (!R.isIdentity(0.0)) geom.put("quat", quat_text(R));
    if (const std::string colour = colour_text(body.color); !colour.empty())
      geom.put("rgba", colour);
    const bool touches = shape.contact.touches.value_or(body.contact.touches.value_or(true));
    if (model_.contacts.present && touches) geom.put("contype", "1").put("conaffinity", "1");
  }

  void write_equalities() {
    if (tree_.loops.empty() && tree_.couplings.empty()) return;
    const XmlTag equality(out_, "equality");
    for (const int j : tree_.loops) {
      const JointSpec& joint = model_.joints[static_cast<std::size_t>(j)];
      XmlTag(out_, joint.type == "fixed" ? "weld" : "connect")
          .put("name", joint.name)
          .put("site1", joint.name + "_1")
          .put("site2", joint.name + "_2");
    }
    for (const ExportCoupling& row : tree_.couplings) {
      const LoadSpec& load = model_.loads[static_cast<std::size_t>(row.load)];
      const ExportCoordinate& first = tree_.coordinate(row.first);
      // Displacements from the references, which are the starts.
      double constant = row.offset - first.start;
      for (const auto& [place, factor] : row.others)
        constant += factor * tree_.coordinate(place).start;
      if (row.others.size() == 1)
        XmlTag(out_, "joint")
            .put("name", load.name)
            .put("joint1", first.name)
            .put("joint2", tree_.coordinate(row.others[0].first).name)
            .put("polycoef", numbers_text({constant, row.others[0].second, 0.0, 0.0, 0.0}));
      else
        XmlTag(out_, "tendon")
            .put("name", load.name)
            .put("tendon1", load.name + "_sum")
            .put("polycoef", numbers_text({constant, 0.0, 0.0, 0.0, 0.0}));
      notes_.add(Kind::differs, "loads." + load.name,
                 "holds exactly, and is soft in programs that read the file");
    }
  }

  /// Distance of the points of a load at the start [m].
  [[nodiscard]] double distance(const LoadSpec& load) const {
    const auto place = [&](int body, const Vec3& Z) -> Vec3 {
      if (body == kGround) return Z;
      const BodyMotion motion = simulation_.body(body);
      return motion.r + motion.Lambda() * Z;
    };
    return (place(load.b, load.Z_b) - place(load.a, load.Z_a)).norm();
  }

  /// Straight lines, and sums of coordinates that <equality> holds.
  void write_tendons() {
    const auto is_sum = [](const ExportCoupling& row) { return row.others.size() != 1; };
    if (tree_.lines.empty() && std::none_of(tree_.couplings.begin(), tree_.couplings.end(), is_sum))
      return;
    const XmlTag tendon(out_, "tendon");
    for (const ExportCoupling& row : tree_.couplings) {
      if (!is_sum(row)) continue;
      XmlTag fixed(out_, "fixed");
      fixed.put("name", model_.loads[static_cast<std::size_t>(row.load)].name + "_sum");
      XmlTag(out_, "joint").put("joint", tree_.coordinate(row.first).name).put("coef", 1.0);
      for (const auto& [place, factor] : row.others)
        XmlTag(out_, "joint").put("joint", tree_.coordinate(place).name).put("coef", -factor);
    }
    for (const ExportLine& line : tree_.lines) {
      const LoadSpec& load = model_.loads[static_cast<std::size_t>(line.load)];
      const auto value = [&](const char* key, double standard) {
        const auto found = load.parameters.find(key);
        return found == load.parameters.end() ? standard : found->second;
      };
      XmlTag spatial(out_, "spatial");
      spatial.put("name", load.name);
      if (const double k = value("stiffness", 0.0); k != 0.0) {
        const double rest = value("free_length", distance(load));
        const auto acts = load.words.find("acts");
        const std::string side = acts == load.words.end() ? "both" : acts->second;
        spatial.put("stiffness", k)
            .put("springlength", side == "tension"       ? numbers_text({0.0, rest})
                                 : side == "compression" ? numbers_text({rest, kFarStop})
                                                         : number_text(rest));
      }
      if (const double damping = value("damping", 0.0); damping != 0.0)
        spatial.put("damping", damping);
      for (const char* end : {"_1", "_2"}) XmlTag(out_, "site").put("site", load.name + end);
    }
  }

  void write_motors() {
    const auto pulls = [](const ExportLine& line) { return line.pull != 0.0; };
    if (tree_.motors.empty() && tree_.pushes.empty() &&
        std::none_of(tree_.lines.begin(), tree_.lines.end(), pulls))
      return;
    const XmlTag actuator(out_, "actuator");
    for (const ExportMotor& motor : tree_.motors) {
      const LoadSpec& load = model_.loads[static_cast<std::size_t>(motor.load)];
      const auto value = [&](const char* key) {
        const auto found = load.parameters.find(key);
        return found == load.parameters.end() ? 0.0 : found->second;
      };
      const bool servo = load.type.ends_with("servo");
      XmlTag tag(out_, !servo ? "motor" : load.drive == "speed" ? "velocity" : "position");
      tag.put("name", load.name).put("joint", tree_.coordinate(motor.on).name);
      if (servo && load.drive != "speed") tag.put("kp", value("stiffness"));
      if (servo) tag.put("kv", value("damping"));
      if (const double most = value("max_moment") + value("max_force"); most > 0.0)
        tag.put("forcelimited", "true").put("forcerange", numbers_text({-most, most}));
      if (motor.target != 0.0)
        notes_.add(Kind::elsewhere, "loads." + load.name,
                   format("its control is {:.12g}, as in the keyframe", motor.target));
    }
    for (const ExportLine& line : tree_.lines)
      if (pulls(line)) {
        const std::string& name = model_.loads[static_cast<std::size_t>(line.load)].name;
        XmlTag(out_, "motor").put("name", name + "_pull").put("tendon", name).put("gear", "-1");
        notes_.add(Kind::elsewhere, "loads." + name,
                   format("its control is {:.12g}, as in the keyframe", line.pull));
      }
    for (const ExportPush& push : tree_.pushes) write_push(push);
  }

  void write_push(const ExportPush& push) {
    const LoadSpec& load = model_.loads[static_cast<std::size_t>(push.load)];
    XmlTag motor(out_, "motor");
    motor.put("name", load.name).put("site", load.name + "_at");
    if (!load.body_fixed) motor.put("refsite", kWorldAxes);
    const Vec3 &v = push.value, none = Vec3::Zero();
    const bool turns = load.type == "moment";
    motor.put("gear", vector_text(turns ? none : v) + " " + vector_text(turns ? v : none));
    notes_.add(Kind::elsewhere, "loads." + load.name, "its control is 1, as in the keyframe");
  }

  /// A keyframe with all coordinates, velocities and controls.
  void write_start() {
    std::string position, velocity, control;
    const auto add = [](std::string& list, const std::string& text) {
      list += (list.empty() ? "" : " ") + text;
    };
    for (const ExportBody& body : tree_.bodies) {
      const ExportJoint& joint = body.joint;
      if (joint.type == "free") {
        add(position, vector_text(joint.child_at_start()) + " " + quat_text(joint.at_start));
        add(velocity, vector_text(body.velocity) + " " + vector_text(body.turning));
      } else if (joint.type == "spherical") {
        add(position, "1 0 0 0");
        add(velocity, vector_text(body.turning));
      }
      for (const ExportCoordinate& q : joint.coordinates) {
        add(position, number_text(q.start));
        add(velocity, number_text(q.rate));
      }
    }
    for (const ExportMotor& motor : tree_.motors) add(control, number_text(motor.target));
    for (const ExportLine& line : tree_.lines)
      if (line.pull != 0.0) add(control, number_text(line.pull));
    for (std::size_t k = 0; k < tree_.pushes.size(); ++k) add(control, "1");
    if (position.empty()) return;
    const XmlTag keyframe(out_, "keyframe");
    XmlTag key(out_, "key");
    key.put("name", "start").put("qpos", position).put("qvel", velocity);
    if (!control.empty()) key.put("ctrl", control);
  }

  const Simulation& simulation_;
  const Model& model_;
  const ExportOptions& options_;
  const ExportTree& tree_;
  ExportNotes& notes_;
  tinyxml2::XMLPrinter out_;
  std::map<std::pair<std::string, double>, std::string> meshes_;  ///< Names by file and scale.
  std::map<int, std::vector<Site>> sites_;                        ///< By body of the model.
};

}  // namespace

Exported export_mjcf(const Simulation& simulation, const ExportOptions& options) {
  ExportNotes notes(options.allow_partial);
  const ExportAbilities can{.name = "an MJCF",
                            .joints = {"fixed", "revolute", "prismatic", "spherical", "cylindrical",
                                       "universal", "planar"},
                            .loops = true,
                            .springs = true,
                            .motors = true,
                            .turning_damping = true,
                            .lines = true,
                            .pushes = true,
                            .rows = true,
                            .free_damping = true,
                            .elsewhere = "Use joints and loads that it has."};
  const ExportTree tree = export_tree(simulation, can, notes);
  std::string text = MjcfWriter(simulation, options, tree, notes).write();
  notes.throw_if_any();
  return {"MJCF", std::move(text), notes.notes()};
}

}  // namespace polhode::io
