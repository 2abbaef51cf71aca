// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/exporters/urdf_writer.hpp>

#include <algorithm>
#include <cmath>
#include <set>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/exporters/export_text.hpp>
#include <polhode/io/exporters/export_tree.hpp>

namespace polhode::io {

namespace {

using Kind = ExportNote::Kind;

/// Bound of a coordinate, an effort or a rate without a bound, where the format demands a number.
constexpr double kNoBound = 1e9;
/// Coordinates and rates at the start below it are rounding [rad, m, s].
constexpr double kNoMotion = 1e-12;

class UrdfWriter {
 public:
  UrdfWriter(const Simulation& simulation, const ExportOptions& options, const ExportTree& tree,
             ExportNotes& notes)
      : model_(simulation.model()), options_(options), tree_(tree), notes_(notes) {}

  std::string write() {
    put_mimics();
    out_.PushComment(" Written by Polhode. SI units; a link has the axes of its body. ");
    {
      XmlTag robot(out_, "robot");
      robot.put("name", title_of(model_, options_.file));
      XmlTag(out_, "link").put("name", kGroundName);
      for (const ExportBody& body : tree_.bodies) {
        write_link(body);
        write_joint(body);
      }
    }
    note_rest();
    return out_.CStr();
  }

 private:
  [[nodiscard]] const BodySpec& spec(int body) const {
    return model_.bodies[static_cast<std::size_t>(body)];
  }
  [[nodiscard]] std::string link_name(int body) const {
    return body == kGround ? kGroundName : file_name(model_, spec(body).name);
  }
  /// Origin of a link in the coordinates of its body [m].
  [[nodiscard]] Vec3 origin_of(int body) const {
    if (body == kGround) return Vec3::Zero();
    const int at = tree_.at[static_cast<std::size_t>(body)];
    return tree_.bodies[static_cast<std::size_t>(at)].joint.on_child;
  }

  void write_origin(const Vec3& p, const Mat3& R) {
    const Vec3 rpy = rpy_of_rotation(R);
    XmlTag(out_, "origin").put("xyz", p).put("rpy", rpy);
  }

  void write_link(const ExportBody& body) {
    const BodySpec& b = spec(body.spec);
    const Vec3 origin = body.joint.on_child;
    XmlTag link(out_, "link");
    link.put("name", link_name(body.spec));
    if (b.mass > 0.0) {
      const XmlTag inertial(out_, "inertial");
      write_origin(b.com - origin, Mat3::Identity());
      XmlTag(out_, "mass").put("value", b.mass);
      const Mat3& J = b.inertia;
      XmlTag(out_, "inertia")
          .put("ixx", J(0, 0))
          .put("ixy", J(0, 1))
          .put("ixz", J(0, 2))
          .put("iyy", J(1, 1))
          .put("iyz", J(1, 2))
          .put("izz", J(2, 2));
    }
    for (std::size_t k = 0; k < b.shapes.size(); ++k) {
      const ShapeSpec& shape = b.shapes[k];
      if (!is_known(shape)) {
        notes_.refuse(shape.place, format("bodies.{}.shape", b.name),
                      format("a URDF has no shape of the type {}", shape.type),
                      "Use a box, sphere, cylinder, capsule or mesh.");
        continue;
      }
      for (const bool seen : {true, false}) {
        const XmlTag tag(out_, seen ? "visual" : "collision");
        write_origin(shape.position - origin, shape.orientation.toRotationMatrix());
        write_geometry(shape);
        const std::string colour = colour_text(b.color);
        if (!seen || colour.empty()) continue;
        XmlTag material(out_, "material");
        material.put("name", b.name + "_colour");
        XmlTag(out_, "color").put("rgba", colour);
      }
    }
  }

  static bool is_known(const ShapeSpec& shape) {
    return shape.type == "box" || shape.type == "sphere" || shape.type == "cylinder" ||
           shape.type == "capsule" || shape.type == "mesh";
  }

  void write_geometry(const ShapeSpec& shape) {
    const XmlTag geometry(out_, "geometry");
    const std::vector<double>& s = shape.sizes;
    XmlTag tag(out_, shape.type.c_str());
    if (shape.type == "box") {
      tag.put("size", Vec3(s[0], s[1], s[2]));
    } else if (shape.type == "mesh") {
      tag.put("filename", path_from(options_.file, shape.file));
      if (shape.scale != 1.0) tag.put("scale", Vec3::Constant(shape.scale).eval());
    } else {
      tag.put("radius", 0.5 * s[0]);
      if (shape.type == "cylinder") tag.put("length", s[1]);
      if (shape.type == "capsule") tag.put("length", s[1] - s[0]);  // Without its ends.
    }
  }

  void write_joint(const ExportBody& body) {
    const ExportJoint& joint = body.joint;
    const bool bounded =
        !joint.coordinates.empty() && (joint.coordinates[0].lower || joint.coordinates[0].upper);
    const std::string type = joint.type == "free"       ? "floating"
                             : joint.type != "revolute" ? joint.type
                             : bounded                  ? "revolute"
                                                        : "continuous";
    XmlTag tag(out_, "joint");
    tag.put("name", joint.name).put("type", type);
    XmlTag(out_, "parent").put("link", link_name(joint.parent));
    XmlTag(out_, "child").put("link", link_name(body.spec));
    write_origin(joint.on_parent - origin_of(joint.parent), joint.at_zero);
    if (joint.coordinates.empty()) return;
    const std::string path = "joints." + model_.joints[static_cast<std::size_t>(joint.spec)].name;
    const bool planar = joint.type == "planar";
    const auto normal = std::find_if(joint.coordinates.begin(), joint.coordinates.end(),
                                     [&](const auto& q) { return !planar || q.turns; });
    XmlTag(out_, "axis").put("xyz", normal->axis);
    if (planar) {
      for (const ExportCoordinate& q : joint.coordinates)
        if (q.damping != 0.0 || q.friction != 0.0)
          notes_.refuse({}, path, "a URDF has no damping of a planar joint", "Leave it out.");
    } else {
      write_single(joint, joint.coordinates[0], type, path);
    }
    for (const ExportCoordinate& q : joint.coordinates)
      if (std::abs(q.start) > kNoMotion && !mimics_.contains(q.name))
        notes_.add(Kind::elsewhere, path + ".start",
                   format("it starts at {:.12g} {}{}", q.start, q.turns ? "rad" : "m",
                          planar ? " along " + q.key : ""));
  }

  void write_single(const ExportJoint& joint, const ExportCoordinate& q, const std::string& type,
                    const std::string& path) {
    if (type != "continuous") {
      XmlTag(out_, "limit")
          .put("lower", q.lower.value_or(-kNoBound))
          .put("upper", q.upper.value_or(kNoBound))
          .put("effort", kNoBound)
          .put("velocity", kNoBound);
      if ((q.lower || q.upper) && !(q.lower && q.upper))
        notes_.add(Kind::differs, path + ".limits",
                   format("has one limit; the other one is written as {}", kNoBound));
    }
    if (q.damping != 0.0 || q.friction != 0.0)
      XmlTag(out_, "dynamics").put("damping", q.damping).put("friction", q.friction);
    const auto follows = mimics_.find(joint.name);
    if (follows == mimics_.end()) return;
    const ExportCoupling& row = *follows->second;
    XmlTag(out_, "mimic")
        .put("joint", tree_.coordinate(row.others[0].first).name)
        .put("multiplier", row.others[0].second)
        .put("offset", row.offset);
  }

  /// Chooses the coupling by which each joint follows another one.
  void put_mimics() {
    for (const ExportCoupling& row : tree_.couplings) {
      const LoadSpec& load = model_.loads[static_cast<std::size_t>(row.load)];
      const auto refuse = [&](const char* what) {
        notes_.refuse(load.place, "loads." + load.name, what, "Couple pairs of joints in a chain.");
      };
      const auto single = [&](const ExportPlace& p) {
        return tree_.bodies[static_cast<std::size_t>(p.body)].joint.coordinates.size() == 1;
      };
      if (!single(row.first) || !single(row.others[0].first))
        refuse("a URDF couples only revolute and prismatic joints");
      else if (!mimics_.emplace(tree_.coordinate(row.first).name, &row).second)
        refuse("in a URDF a joint follows at most one other joint");
    }
  }

  /// Gravity and velocities, which no URDF has.
  void note_rest() {
    if ((model_.gravity - Vec3(0.0, 0.0, -9.81)).norm() > 0.0)
      notes_.add(Kind::elsewhere, "gravity",
                 format("it is [{}] m/s^2", vector_text(model_.gravity)));
    const bool moves =
        std::any_of(tree_.bodies.begin(), tree_.bodies.end(), [](const ExportBody& body) {
          return body.velocity.norm() > kNoMotion || body.turning.norm() > kNoMotion;
        });
    if (moves) notes_.add(Kind::elsewhere, "bodies", "they have velocities at the start");
  }

  const Model& model_;
  const ExportOptions& options_;
  const ExportTree& tree_;
  ExportNotes& notes_;
  tinyxml2::XMLPrinter out_;
  std::map<std::string, const ExportCoupling*> mimics_;  ///< By the joint that follows.
};

}  // namespace

Exported export_urdf(const Simulation& simulation, const ExportOptions& options) {
  ExportNotes notes(options.allow_partial);
  const ExportAbilities can{.name = "a URDF",
                            .joints = {"fixed", "revolute", "prismatic", "planar"},
                            .elsewhere = "Export an MJCF (.xml), if that has it."};
  const ExportTree tree = export_tree(simulation, can, notes);
  std::string text = UrdfWriter(simulation, options, tree, notes).write();
  notes.throw_if_any();
  return {"URDF", std::move(text), notes.notes()};
}

}  // namespace polhode::io
