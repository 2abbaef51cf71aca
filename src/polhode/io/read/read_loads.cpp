// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_beam_name.hpp>
#include <polhode/io/read/read_context.hpp>
#include <polhode/io/read/read_coupling.hpp>
#include <polhode/io/read/read_load_values.hpp>
#include <polhode/io/read/time_function.hpp>
#include <polhode/joints/registry.hpp>
#include <polhode/loads/pair_on_nodes.hpp>
#include <polhode/loads/slide_on_beam_kind.hpp>
#include <polhode/solids/loads/registry.hpp>

namespace polhode::io {
namespace {

/// World point at the start, relative to a body's centre of mass in its axes.
Vec3 seen_from(const ReadContext& context, int body, const Vec3& point) {
  if (body == kGround) return point;
  const BodySpec& b = context.model.bodies[static_cast<std::size_t>(body)];
  return b.orientation.conjugate() * (point - b.position);
}

/// Point in the user's body coordinates, relative to the centre of mass.
Vec3 from_com(const ReadContext& context, int body, const Vec3& point) {
  if (body == kGround) return point;
  return point - context.model.bodies[static_cast<std::size_t>(body)].com;
}

/// Whether the only free rotation of a joint is that about its z.
bool turns_about_z(const JointSpec& joint) {
  if (joint.type.empty()) return true;  // Its own error is already reported.
  const auto has = [&](const std::string& freedom) {
    return std::find(joint.free.begin(), joint.free.end(), freedom) != joint.free.end();
  };
  const JointKind& kind = joint_kind(joint.type);
  if (kind.takes_free_list) return has("rz") && !has("rx") && !has("ry");
  const std::string& free = kind.free;
  const auto leaves = [&](const char* freedom) { return free.find(freedom) != std::string::npos; };
  return leaves("Rz") && !leaves("Rx") && !leaves("Ry");
}

class LoadReader {
 public:
  LoadReader(ReadContext& context, const SourceNode& node, LoadSpec& load, const FieldTable& table)
      : context_(context),
        load_(load),
        table_(table),
        section_(context, node, load.place, "loads." + load.name, table) {}

  void read() {
    if (load_.type == kJointMoment || load_.type == kJointForce) {
      read_on_joint(load_.type == kJointMoment);
    } else if (table_.find("solid")) {
      read_on_solid(solids::solid_load_kind(section_.path("type"), load_.type));
    } else {
      read_on_bodies(load_kind(load_.type));
    }
    if (table_.find("factors")) return;  // dimensions are those of the coordinates
    for (const Field& field : table_.fields)
      if (field.kind == FieldKind::kNumber)
        if (const auto value = section_.number(field.name)) load_.parameters[field.name] = *value;
  }

 private:
  /// A force or moment on one body, or one that slides along a beam.
  void read_wrench(const LoadKind& kind) {
    const bool on_beam = acts_on_beam(kind);
    if (on_beam) load_.a = read_first_node(context_, section_);
    if (const auto body = section_.body("body")) {
      load_.b = *body;
      if (*body == kGround && !on_beam)
        section_.fault("body", "a load on the ground has no effect", "Name a body.");
    }
    if (!on_beam) {
      if (kind.vector.empty()) return;
      if (const auto vector = section_.time_vector(kind.vector)) load_.vector = *vector;
      load_.body_fixed = section_.boolean("body_fixed").value_or(false);
      if (kind.turns) return;  // Independent of the point of application.
    }
    if (section_.refuse_both("at", "at_body", "Give one of them.")) return;
    if (const auto point = section_.vector("at")) load_.Z_b = seen_from(context_, load_.b, *point);
    if (const auto point = section_.vector("at_body"))
      load_.Z_b = from_com(context_, load_.b, *point);
  }

  void read_on_bodies(const LoadKind& kind) {
    switch (kind.place) {
      case LoadPlace::body:
        read_wrench(kind);
        break;
      case LoadPlace::axis:
        read_wrench(kind);
        read_axis();
        break;
      case LoadPlace::points:
        read_ends(kind);
        read_points();
        break;
      case LoadPlace::joint:
        load_.joint = read_joint("joint", section_.find("joint"), &load_.a, &load_.b);
        read_stays();
        if (table_.find("coordinate"))
          if (const auto coordinate = section_.choice("coordinate")) load_.coordinate = *coordinate;
        check_angle(kind);
        break;
      case LoadPlace::joints:
        read_joint_pair();
        read_stays();
        break;
      case LoadPlace::row:
        read_coupling(context_, section_, load_);
        break;
      case LoadPlace::frames:
        read_bodies();
        read_frames();
        break;
      case LoadPlace::surface:
      case LoadPlace::curves:
        read_bodies();
        read_points();
        read_axes();
        break;
      case LoadPlace::wheel:
        read_bodies();
        read_points();
        read_axes();
        read_axle();
        break;
      case LoadPlace::centres:
        read_bodies();
        break;
    }
    read_drive(kind);
    read_laws(kind);
    require_effect(kind);
  }

  /// A moment or force along a coordinate of a joint: the moment of a motor over time, or that of a
  /// damper over the rate.
  void read_on_joint(bool turns) {
    load_.joint = read_joint("joint", section_.find("joint"), &load_.a, &load_.b);
    read_stays();
    if (const auto coordinate = section_.choice("coordinate")) load_.coordinate = *coordinate;
    const std::string value = turns ? "moment" : "force";
    section_.refuse_both(value.c_str(), "resistance", "Make two loads of them.");
    if (section_.misses(value) && section_.misses("resistance"))
      section_.fault(format("has neither {} nor resistance", value), "Give one of them.");
    if (!section_.has("resistance")) {
      load_.type = turns ? "rotary_motor" : "linear_motor";
      load_.drive = value;
      load_.value = section_.time_number(value);
      return;
    }
    load_.type = turns ? "torsional_spring" : "translational_spring";
    if (const TimeFunctionPtr law = section_.law("resistance")) {
      check_resistance(section_, "resistance", *law);
      load_.laws[turns ? "damper_moment" : "damper_force"] = law;
    }
  }

  /// A load on nodes or faces of a deformable solid.
  void read_on_solid(const solids::SolidLoadKind& kind) {
    if (const SourceNode* value = section_.find("solid"))
      if (const auto solid = read_solid_name(context_, *value, section_.path("solid")))
        load_.solid = *solid;
    for (const char* key : {"surface", "nodes"}) {
      if (!table_.find(key) || !section_.has(key)) continue;
      if (auto selection = read_selections(context_, *section_.find(key), section_.path(key)))
        load_.selection = std::move(*selection);
    }
    if (kind.value) load_.value = section_.time_number(kind.value->name);
    if (kind.vector)
      if (const auto vector = section_.time_vector(kind.vector->name)) load_.vector = *vector;
    if (!kind.can_follow) return;
    load_.follower = section_.boolean("follower").value_or(true);
    if (const auto keeps = section_.choice("keeps")) load_.keeps = *keeps;
  }

  void read_stays() {
    if (section_.boolean("stays").value_or(false)) load_.words["stays"] = "true";
  }

  void read_bodies() {
    if (const auto bodies = section_.body_pair("bodies")) {
      load_.a = (*bodies)[0];
      load_.b = (*bodies)[1];
    }
  }

  /// Two bodies, or solids, of a load between points.
  void read_ends(const LoadKind& kind) {
    const SourceNode* names = section_.find("bodies");
    bool any = false;
    if (names && names->is_list() && names->children.size() == 2)
      for (std::size_t k = 0; k < 2; ++k) {
        const SourceNode& name = names->children[k];
        if (!name.is_text() || context_.bodies.contains(name.text)) continue;
        const auto solid = context_.solids.find(name.text);
        if (solid == context_.solids.end()) continue;
        any = true;
        load_.end_solids[k] = load_.solid = solid->second;
      }
    if (!any) return read_bodies();
    if (make_on_nodes(kind.name) == nullptr) {
      section_.fault("bodies", format("a {} does not act on points of solids", kind.name),
                     "Name a body that the solid is bonded to.");
      return;
    }
    for (std::size_t k = 0; k < 2; ++k) {
      if (load_.end_solids[k] >= 0) continue;
      if (const auto body = read_body(context_, names->children[k], section_.path("bodies")))
        (k == 0 ? load_.a : load_.b) = *body;
    }
  }

  /// Point at the start, on an end: relative to a body's centre of mass in its axes, or in the own
  /// coordinates of a solid's mesh.
  [[nodiscard]] Vec3 seen_from_end(std::size_t end, const Vec3& point) const {
    const int solid = load_.end_solids[end];
    if (solid < 0) return seen_from(context_, end == 0 ? load_.a : load_.b, point);
    const MeshSpec& mesh = context_.model.solids[static_cast<std::size_t>(solid)].mesh;
    return mesh.orientation.conjugate() * (point - mesh.position);
  }

  /// False after a fault.
  bool check_point_keys() {
    if (section_.refuse_both("at", "at_body", "Give one of them.")) return false;
    if (section_.misses("at") && section_.misses("at_body"))
      section_.fault("'at' is missing", "Give at (world) or at_body (a point on each body).");
    return true;
  }

  void read_points() {
    if (!check_point_keys()) return;
    if (const auto points = section_.vector_pair("at")) {
      load_.Z_a = seen_from_end(0, (*points)[0]);
      load_.Z_b = seen_from_end(1, (*points)[1]);
    }
    read_points_on_bodies();
  }

  void read_points_on_bodies() {
    if (const auto points = section_.vector_pair("at_body")) {
      const auto on_end = [&](std::size_t end, int body) {
        const Vec3& point = (*points)[end];
        return load_.end_solids[end] < 0 ? from_com(context_, body, point) : point;
      };
      load_.Z_a = on_end(0, load_.a);
      load_.Z_b = on_end(1, load_.b);
    }
  }

  /// One point and one set of axes at the start, fixed to both bodies.
  void read_frames() {
    if (!check_point_keys()) return;
    if (const auto point = section_.vector("at")) {
      load_.Z_a = seen_from(context_, load_.a, *point);
      load_.Z_b = seen_from(context_, load_.b, *point);
    }
    read_points_on_bodies();
    read_axes();
  }

  void read_axes() {
    const auto axis = section_.direction("axis");
    const auto wish = section_.direction("x_axis");
    const Vec3 z = axis.value_or(Vec3::UnitZ());
    int least = 0;
    z.cwiseAbs().minCoeff(&least);
    const Vec3 x = wish.value_or(Vec3::Unit(least));
    const auto F = axes_about(z, x, "x_axis");
    if (!F) return;
    load_.R_a = axes_on(load_.a, *F);
    load_.R_b = axes_on(load_.b, *F);
    if (!table_.find("other_x_axis")) return;
    if (const auto x_b = section_.direction("other_x_axis"))
      if (const auto F_b = axes_about(z, *x_b, "other_x_axis")) load_.R_b = axes_on(load_.b, *F_b);
  }

  /// An axis fixed in the body.
  void read_axis() {
    if (section_.refuse_both("axis", "axis_body", "Give one of them.")) return;
    const bool in_body = section_.has("axis_body");
    const auto axis = section_.direction(in_body ? "axis_body" : "axis");
    const Vec3 z = axis.value_or(Vec3::UnitZ());
    load_.R_b.col(2) = in_body ? z : Vec3(axes_on(load_.b, Mat3::Identity()) * z);
    if (!section_.has("speed")) return;
    section_.refuse_both("speed", "start_speed", "Leave start_speed out: the speed is given.");
  }

  /// Axes with this z and this x, made perpendicular to it.
  std::optional<Mat3> axes_about(const Vec3& z, const Vec3& x, const char* key) {
    if (x.cross(z).norm() < 1e-3) {
      section_.fault(key, "is parallel to the axis", "Give a direction transverse to the axis.");
      return std::nullopt;
    }
    Mat3 F;
    F.col(2) = z;
    F.col(0) = (x - x.dot(z) * z).normalized();
    F.col(1) = z.cross(F.col(0));
    return F;
  }

  /// World axes at the start in the axes of a body.
  [[nodiscard]] Mat3 axes_on(int body, const Mat3& F) const {
    if (body == kGround) return F;
    const BodySpec& b = context_.model.bodies[static_cast<std::size_t>(body)];
    return b.orientation.toRotationMatrix().transpose() * F;
  }

  void read_axle() {
    const Vec3 axle = section_.direction("axle").value_or(Vec3::UnitY());
    load_.R_b.col(2) = axes_on(load_.b, Mat3::Identity()) * axle;
  }

  /// Checks a spring about an axis: the joint has one such axis or a coordinate is given.
  void check_angle(const LoadKind& kind) {
    if (!kind.turns || !kind.drives.empty() || !table_.find("coordinate")) return;
    if (section_.has("coordinate")) return;
    const auto found = context_.joints.find(load_.joint);
    if (found == context_.joints.end()) return;
    const JointSpec& joint = context_.model.joints[static_cast<std::size_t>(found->second)];
    if (turns_about_z(joint)) return;
    section_.fault(
        "joint",
        format("the {} joint {} has no angle about its axis alone", joint.type, quote(joint.name)),
        "Name a joint that turns about its axis, such as a revolute one.");
  }

  void read_joint_pair() {
    const SourceNode* joints = section_.find("joints");
    if (!joints) return;
    if (!joints->is_list() || joints->children.size() != 2) {
      section_.fault("joints", "expects two joints", "Write [first, second].");
      return;
    }
    int b_1 = kGround;
    load_.joint = read_joint("joints", &joints->children[0], &load_.a, &load_.b);
    load_.joint_2 = read_joint("joints", &joints->children[1], &b_1, &b_1);
    if (!load_.joint.empty() && load_.joint == load_.joint_2 && !section_.has("coordinates"))
      section_.fault("joints", "are the same", "Name two joints, or give both coordinates.");
    const SourceNode* names = section_.find("coordinates");
    if (!names) return;
    if (!names->is_list() || names->children.size() != 2) {
      section_.fault("coordinates", "expects two coordinates", "Write [rz, z], for example.");
      return;
    }
    const std::vector<std::string> known{"x", "y", "z", "rx", "ry", "rz"};
    for (std::size_t i = 0; i < 2; ++i)
      if (const auto word =
              read_choice(context_, names->children[i], section_.path("coordinates"), known))
        (i == 0 ? load_.coordinate : load_.coordinate_2) = *word;
  }

  /// Reads the function of time of a kind of load.
  void read_drive(const LoadKind& kind) {
    if (kind.drives.empty()) return;
    std::string keys;
    for (const TimeParameter& d : kind.drives) {
      keys += (keys.empty() ? "" : ", ") + d.name;
      if (!section_.has(d.name)) continue;
      if (!load_.drive.empty()) {
        section_.fault(d.name, format("cannot be combined with '{}'", load_.drive),
                       "Give one of them: a motor follows one function of time.");
        return;
      }
      load_.drive = d.name;
      load_.value = section_.time_number(d.name);
    }
    if (load_.drive.empty() && !acts_on_beam(kind))
      section_.fault("has no function of time", format("Give one of: {}.", keys));
  }

  /// Laws, words, vectors and matrices.
  void read_laws(const LoadKind& kind) {
    for (const LawParameter& l : kind.laws) {
      const TimeFunctionPtr law = section_.law(l.name);
      if (!law) continue;
      load_.laws[l.name] = law;
      if (l.variable == "v") check_resistance(section_, l.name, *law);
    }
    for (const std::string& prefix : kind.curves) read_curve(prefix);
    for (const ChoiceParameter& w : kind.words)
      if (const auto word = section_.choice(w.name)) load_.words[w.name] = *word;
    for (const Parameter& p : kind.vectors)
      if (const auto v = section_.vector(p.name))
        for (int i = 0; i < 3; ++i) load_.parameters[p.name + "." + "xyz"[i]] = (*v)[i];
    for (const Parameter& p : kind.matrices)
      if (const SourceNode* node = section_.find(p.name))
        if (const auto matrix = read_stiffness_matrix(context_, section_, p.name, *node))
          load_.matrices[p.name] = *matrix;
  }

  /// Reads a spline through points over the chord length, or a curve over s.
  /// @param prefix  Of the names: "", or "other_" for a second curve.
  void read_curve(const std::string& prefix) {
    const std::string points = prefix + "points", x_key = prefix + "curve_x";
    const std::string y_key = prefix + "curve_y";
    section_.refuse_both(points.c_str(), x_key.c_str(), "Give one of them.");
    if (section_.misses(points)) {
      const bool has_x = load_.laws.contains(x_key), has_y = load_.laws.contains(y_key);
      if (has_x != has_y)
        section_.fault(format("'{}' is missing", has_x ? y_key : x_key),
                       "Give both coordinates of the curve.");
      else if (!has_x && !prefix.empty())
        section_.fault(format("'{}' is missing", points),
                       format("Give {}, or {} and {}.", points, x_key, y_key));
      return;
    }
    const SourceNode* node = section_.find(points);
    if (!node) return;
    if (!node->is_list() || node->children.size() < 3) {
      section_.fault(points, "expects a list of at least three points",
                     "Write [[0, 0, 0], [0.1, 0.02, 0], [0.2, 0, 0]].");
      return;
    }
    std::vector<double> s, x, y;
    for (const SourceNode& child : node->children) {
      const auto point = read_vector(context_, child, section_.path(points), table_.at(points));
      if (!point) return;
      if (point->z() != 0.0) {
        section_.fault(points, "leave the plane: z is not 0",
                       "Turn the frame with axis and x_axis, so that the curve has x and y only.");
        return;
      }
      const double way = s.empty() ? 0.0 : std::hypot(point->x() - x.back(), point->y() - y.back());
      if (!s.empty() && !(way > 0.0)) {
        section_.fault(points, "give a point twice in a row", "Leave one of them out.");
        return;
      }
      s.push_back(s.empty() ? 0.0 : s.back() + way);
      x.push_back(point->x());
      y.push_back(point->y());
    }
    const bool closed = x.front() == x.back() && y.front() == y.back();
    load_.parameters[prefix + "period"] = s.back();
    load_.parameters[prefix + "open"] = closed ? 0.0 : 1.0;
    load_.laws[x_key] = std::make_shared<TableFunction>(s, x, Interpolation::kCubic, closed);
    load_.laws[y_key] = std::make_shared<TableFunction>(s, y, Interpolation::kCubic, closed);
  }

  std::string read_joint(const char* key, const SourceNode* value, int* a, int* b) {
    return read_joint_of_load(context_, section_, key, value, a, b);
  }

  void require_effect(const LoadKind& kind) {
    const std::vector<std::string>& keys = kind.needs_one_of;
    if (keys.empty()) return;
    for (const std::string& key : keys)
      if (!section_.misses(key)) return;
    if (keys.size() == 1)
      section_.fault(format("'{}' is missing", keys[0]), "Give it.");
    else if (keys[0] == "stiffness" && keys[1] == "damping")
      section_.fault("has neither stiffness nor damping", "Give one of them, or both.");
    else
      section_.fault("has no effect", "Give one of: " + name_list(keys) + ".");
  }

  ReadContext& context_;
  LoadSpec& load_;
  const FieldTable& table_;
  Section section_;
};

}  // namespace

void read_loads(ReadContext& context, const SourceNode& node) {
  for (std::size_t k = 0; k < node.keys.size(); ++k) {
    const SourceNode::Key& key = node.keys[k];
    if (!check_name(context, key, node.children[k], "loads")) continue;
    LoadSpec load;
    load.name = key.name;
    load.place = context.tree.place_of(key, node.children[k]);
    if (const FieldTable* table = read_kind(context, node.children[k], load.place,
                                            "loads." + key.name, load_tables(), load.type)) {
      if ((load.type == "moment" || load.type == "force") && node.children[k].find("joint"))
        context.diagnostics.add(load.place, "loads." + key.name + ".type",
                                format("a {} acts on a body", load.type),
                                format("In a joint it is the type joint_{}.", load.type));
      else
        LoadReader(context, node.children[k], load, *table).read();
    }
    context.loads.emplace(load.name, static_cast<int>(context.model.loads.size()));
    context.model.loads.push_back(std::move(load));
  }
}

}  // namespace polhode::io
