// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <tuple>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_context.hpp>
#include <polhode/joints/joint.hpp>
#include <polhode/joints/registry.hpp>
#include <polhode/math/dense.hpp>

namespace polhode::io {
namespace {

/// Pose of a body at the start; for the ground the world.
struct Pose {
  Vec3 r = Vec3::Zero();    ///< Centre of mass [m].
  Vec3 com = Vec3::Zero();  ///< The same in the user's body coordinates [m].
  Mat3 Lambda = Mat3::Identity();

  [[nodiscard]] Vec3 from_world(const Vec3& point) const {
    return Lambda.transpose() * (point - r);
  }
  [[nodiscard]] Vec3 to_world(const Vec3& Z) const { return r + Lambda * Z; }
};

Pose pose_of(const ReadContext& context, int body) {
  if (body == kGround) return {};
  const BodySpec& b = context.model.bodies[static_cast<std::size_t>(body)];
  return {b.position, b.com, b.orientation.toRotationMatrix()};
}

/// Right-handed axes with this z; x as near as possible to a given direction, or along the world
/// axis most nearly normal to z.
Mat3 axes_about(const Vec3& z, const std::optional<Vec3>& wish = {}) {
  int least = 0;
  z.cwiseAbs().minCoeff(&least);
  const Vec3 x = wish.value_or(Vec3::Unit(least));
  Mat3 F;
  F.col(2) = z;
  F.col(0) = (x - x.dot(z) * z).normalized();
  F.col(1) = z.cross(F.col(0));
  return F;
}

class JointReader {
 public:
  JointReader(ReadContext& context, const SourceNode& node, JointSpec& joint,
              const FieldTable& table)
      : context_(context),
        node_(node),
        joint_(joint),
        table_(table),
        section_(context, node, joint.place, "joints." + joint.name, table) {}

  void read() {
    if (!node_.is_map()) return;
    const std::size_t before = context_.diagnostics.size();
    const auto bodies = section_.body_pair("bodies");
    if (bodies) {
      joint_.a = (*bodies)[0];
      joint_.b = (*bodies)[1];
      check_can_move();
    }
    a_ = pose_of(context_, joint_.a);
    b_ = pose_of(context_, joint_.b);
    read_points();
    read_axes();
    read_parameters();
    read_friction();
    joint_.limits = read_limits("limits");
    joint_.angle_limits = read_limits("angle_limits");
    read_frame_motion();
    read_strength();
    read_enforcement();
    // The following needs valid numbers, and bodies with valid placements.
    const auto sound = [&](int body) {
      return body == kGround || context_.body_is_sound[static_cast<std::size_t>(body)];
    };
    if (context_.diagnostics.size() != before || !bodies || !sound(joint_.a) || !sound(joint_.b))
      return;
    if (takes("distance")) complete_distance();
    check_recipe();
    if (context_.diagnostics.size() != before) return;
    read_starts();
    check_start();
  }

 private:
  [[nodiscard]] bool takes(const std::string& name) const { return table_.find(name) != nullptr; }

  void check_can_move() {
    const auto stays = [&](int body) {
      return body == kGround || context_.model.bodies[static_cast<std::size_t>(body)].fixed;
    };
    if (stays(joint_.a) && stays(joint_.b))
      section_.fault("bodies", "neither body can move",
                     "Leave the joint out, or name a body that is not fixed.");
  }

  void read_points() {
    if (section_.refuse_both("at", "at_body", "Give one of them.")) return;
    if (const auto points = section_.vector_pair("at_body")) {
      joint_.Z_a = (*points)[0] - a_.com;
      joint_.Z_b = (*points)[1] - b_.com;
      joint_.assembled_start = true;
    }
    if (section_.has("at_body")) return;
    if (!section_.has("at")) {
      // Parallel axes need only directions.
      if (joint_.type != "parallel_axes" && section_.misses("at") && section_.misses("at_body"))
        section_.fault("'at' is missing", "Give at (world) or at_body (a point on each body).");
      return;
    }
    if (table_.at("at").kind == FieldKind::kVectorPair) {
      const auto points = section_.vector_pair("at");
      if (!points) return;
      joint_.Z_a = a_.from_world((*points)[0]);
      joint_.Z_b = b_.from_world((*points)[1]);
    } else if (const auto point = section_.vector("at")) {
      joint_.Z_a = a_.from_world(*point);
      joint_.Z_b = b_.from_world(*point);
    }
  }

  void set_axes(const Mat3& F) {
    joint_.R_a = a_.Lambda.transpose() * F;
    joint_.R_b = b_.Lambda.transpose() * F;
  }

  void read_axes() {
    if (takes("axes")) {
      read_cross();
      return;
    }
    if (!takes("axis")) {
      set_axes(Mat3::Identity());
      return;
    }
    if (takes("axis_body")) {
      section_.refuse_both("axis", "axis_body", "Give one of them.");
      if (section_.misses("axis") && section_.misses("axis_body"))
        section_.fault("'axis' is missing", "Give axis (world) or axis_body (on each body).");
      if (section_.has("axis_body")) {
        read_body_axes();
        return;
      }
      if (takes("x_axis_body") && section_.has("x_axis_body"))
        section_.fault("x_axis_body", "requires 'axis_body'", "Give both, or x_axis.");
    }
    const auto axis = section_.direction("axis");
    const auto x = section_.direction("x_axis");
    if (section_.has("axis") && !axis) return;
    const std::optional<Vec3> rod = rod_direction();
    const Vec3 z = axis.value_or(rod.value_or(Vec3::UnitZ()));
    if (x && !check_x(z, *x)) return;
    set_axes(axes_about(z, x ? x : across(z, rod)));
  }

  /// From the point of a to that of b at the start, for rods.
  [[nodiscard]] std::optional<Vec3> rod_direction() const {
    if (!joint_kind(joint_.type).points_apart) return std::nullopt;
    const Vec3 u = b_.to_world(joint_.Z_b) - a_.to_world(joint_.Z_a);
    return u.norm() > 0.0 ? std::optional<Vec3>(u.normalized()) : std::nullopt;
  }

  /// The direction, unless it is parallel to z.
  [[nodiscard]] static std::optional<Vec3> across(const Vec3& z, const std::optional<Vec3>& x) {
    return x && x->cross(z).norm() > 1e-3 ? x : std::nullopt;
  }

  bool check_x(const Vec3& z, const Vec3& x) {
    if (x.cross(z).norm() > 1e-3) return true;
    section_.fault("x_axis", "is parallel to the joint's z",
                   "Give a direction transverse to the axis.");
    return false;
  }

  /// z on each body; x_axis is given in the world at the start, on a.
  void read_body_axes() {
    const auto z = section_.direction_pair("axis_body");
    const auto x = section_.direction("x_axis");
    if (!z) return;
    if (takes("x_axis_body") && section_.has("x_axis_body")) {
      read_zero(*z);
      return;
    }
    const Vec3 z_a = a_.Lambda * (*z)[0], z_b = b_.Lambda * (*z)[1];
    if (x && !check_x(z_a, *x)) return;
    const Mat3 F = axes_about(z_a, x ? x : across(z_a, rod_direction()));
    // The smallest rotation from one axis to the other keeps the joint's initial angle near zero.
    const Quat turn = rotation_between(z_a, z_b);
    joint_.R_a = a_.Lambda.transpose() * F;
    joint_.R_b = b_.Lambda.transpose() * (turn * F);
    joint_.assembled_start = true;
  }

  /// x on each body in addition to z, which says where the angle is zero.
  void read_zero(const std::array<Vec3, 2>& z) {
    if (section_.refuse_both("x_axis", "x_axis_body", "Give one of them.")) return;
    const auto x = section_.direction_pair("x_axis_body");
    if (!x) return;
    for (std::size_t k = 0; k < 2; ++k) {
      if ((*x)[k].cross(z[k]).norm() > 1e-3) continue;
      section_.fault("x_axis_body", "is parallel to the joint's z",
                     "Give directions transverse to the axis.");
      return;
    }
    joint_.R_a = axes_about(z[0], (*x)[0]);
    joint_.R_b = axes_about(z[1], (*x)[1]);
    joint_.assembled_start = true;
  }

  /// The two axes of a universal joint: x on a, y on b.
  void read_cross() {
    const auto axes = section_.direction_pair("axes");
    if (!axes) return;
    const auto& [x, y] = *axes;
    const double angle = std::atan2(x.cross(y).norm(), x.dot(y));
    if (std::abs(x.dot(y)) > 1e-6) {
      section_.fault("axes", format("are {:.6g} deg apart", angle * 180.0 / 3.14159265358979323846),
                     "The two axes of a universal joint are perpendicular.");
      return;
    }
    Mat3 F;
    F.col(0) = x;
    F.col(2) = x.cross(y).normalized();
    F.col(1) = F.col(2).cross(x);
    set_axes(F);
  }

  void read_parameters() {
    const JointKind& kind = joint_kind(joint_.type);
    if (kind.takes_free_list)
      if (const auto free = section_.choices("free")) joint_.free = *free;
    for (const Parameter& parameter : kind.parameters) {
      if (const auto value = section_.number(parameter.name))
        joint_.parameters[parameter.name] = *value;
      else if (parameter.standard)
        joint_.parameters[parameter.name] = *parameter.standard;
    }
  }

  void read_friction() {
    const SourceNode* node = takes("friction") ? section_.find("friction") : nullptr;
    if (!node) return;
    const auto kind = std::find_if(friction_tables().begin(), friction_tables().end(),
                                   [&](const KindTable& k) { return k.name == joint_.type; });
    Section section(context_, *node, context_.tree.place_of(*node), section_.path("friction"),
                    kind->table);
    if (!node->is_map()) return;
    JointFrictionSpec f;
    section.read_into(f);
    const bool by_arm =
        joint_.type == "revolute" || joint_.type == "spherical" || joint_.type == "universal";
    if (f.mu > 0.0 && by_arm && f.radius == 0.0 && f.face_radius == 0.0)
      section.fault("'radius' is missing", "mu needs the radius of the pin or ball: give it.");
    else if (f.mu == 0.0 && f.constant == 0.0 && section.misses("mu"))
      section.fault("gives no friction",
                    format("Give mu, or {}, or leave friction out.", by_arm ? "moment" : "force"));
    joint_.friction = f;
  }

  std::optional<JointLimitsSpec> read_limits(const char* key) {
    const SourceNode* node = takes(key) ? section_.find(key) : nullptr;
    if (!node) return std::nullopt;
    const std::string& title = table_.at(key).table;
    Section section(context_, *node, context_.tree.place_of(*node), section_.path(key),
                    title == angle_limit_fields().title    ? angle_limit_fields()
                    : title == stroke_limit_fields().title ? stroke_limit_fields()
                                                           : distance_limit_fields());
    if (!node->is_map()) return std::nullopt;
    JointLimitsSpec l;
    section.read_into(l);
    if (section.misses("lower") && section.misses("upper"))
      section.fault("no stop is given", "Give lower, upper, or both.");
    if (l.lower && l.upper && !(*l.lower < *l.upper))
      section.fault("upper", "is not above lower",
                    "Exchange them, or use a joint without this freedom.");
    else if (l.lower && l.upper && l.band && *l.upper - *l.lower <= *l.band)
      section.fault("band", "is wider than the distance between the stops",
                    "Give a narrower band.");
    return l;
  }

  void read_frame_motion() {
    const SourceNode* node = takes("motion") ? section_.find("motion") : nullptr;
    if (!node) return;
    for (const char* other : {"friction", "limits", "angle_limits"})
      if (takes(other) && section_.has(other))
        section_.fault("motion", format("cannot be combined with '{}'", other),
                       "Give the motion to a separate body, and use a joint to that body.");
    Section section(context_, *node, context_.tree.place_of(*node), section_.path("motion"),
                    motion_fields());
    if (!node->is_map()) return;
    std::array<bool, 3> moves{};
    joint_.motion = read_motion(context_, section, moves);
    joint_.assembled_start = joint_.assembled_start || joint_.motion;
  }

  void read_strength() {
    const SourceNode* node = section_.find("breaks");
    if (!node) return;
    Section section(context_, *node, context_.tree.place_of(*node), section_.path("breaks"),
                    strength_fields());
    if (!node->is_map()) return;
    section.read_into(joint_.breaks);
    if (section.misses("force") && section.misses("moment"))
      section.fault("no limit is given", "Give force, moment, or both.");
  }

  void read_enforcement() {
    const SourceNode* node = takes("enforcement") ? section_.find("enforcement") : nullptr;
    if (!node) return;
    Section section(context_, *node, context_.tree.place_of(*node), section_.path("enforcement"),
                    enforcement_fields());
    if (!node->is_map()) return;
    JointEnforcement e;
    section.read_into(e);
    joint_.enforcement = e;
    enforcement_at_ = node;
  }

  /// Checks that there is a stiffness for each kind of row, and none for free motions.
  void check_enforcement(const JointParts& parts) {
    if (!joint_.enforcement) return;
    Section section(context_, *enforcement_at_, context_.tree.place_of(*enforcement_at_),
                    section_.path("enforcement"), enforcement_fields());
    const StiffnessDemand demand = stiffness_demand(parts);
    const auto check = [&](const char* key, bool asked, const char* what) {
      if (asked && section.misses(key))
        section.fault(format("'{}' is missing", key),
                      format("The joint constrains {}: give their stiffness.", what));
      if (!asked && section.has(key))
        section.fault(key, format("the joint constrains no {}", what), "Leave it out.");
    };
    check("stiffness", demand.displacements, "displacements");
    check("turning_stiffness", demand.rotations, "rotations");
  }

  void read_starts() {
    if (!takes("start") || (!section_.has("start") && !section_.has("start_rate"))) return;
    const Joint joint(joint_.name, joint_.type, {joint_.a, joint_.b},
                      joint_kind(joint_.type)
                          .recipe({joint_.Z_a, joint_.Z_b, joint_.R_a, joint_.R_b},
                                  {joint_.free, joint_.parameters}));
    const std::vector<std::string> names = joint.coordinate_names();
    for (const char* key : {"start", "start_rate"})
      if (section_.has(key)) read_start(context_, section_, key, joint_.name, names);
  }

  /// Value at the start of the coordinate that has stops, if the file gives it.
  [[nodiscard]] std::optional<double> start_of(const char* coordinate) const {
    for (const JointStart& start : context_.starts)
      if (start.joint == static_cast<int>(context_.model.joints.size()) && !start.is_rate &&
          start.coordinate == coordinate)
        return start.value;
    return std::nullopt;
  }

  /// Joints given with `at` start at zero, unless starts are given; others are checked when the
  /// start is assembled.
  void check_start() {
    const bool turns = joint_.type == "revolute";
    const bool at_zero = !joint_.assembled_start && !context_.has_starts;
    if (joint_kind(joint_.type).points_apart) {
      if (!joint_.limits || !at_zero) return;
      const double start = (a_.to_world(joint_.Z_a) - b_.to_world(joint_.Z_b)).norm();
      if (start < joint_.limits->lower.value_or(start) ||
          start > joint_.limits->upper.value_or(start))
        section_.fault("limits",
                       format("the points are {:g} m apart at the start, which is outside", start),
                       "Move the points, or widen the limits.");
      return;
    }
    for (const auto& [key, coordinate, limits] :
         {std::tuple("limits", turns ? "rz" : "z", joint_.limits),
          std::tuple("angle_limits", "rz", joint_.angle_limits)}) {
      if (!limits) continue;
      const auto given = start_of(coordinate);
      const double start = given.value_or(0.0);
      if (limits->lower.value_or(start) <= start && limits->upper.value_or(start) >= start)
        continue;
      if (given)
        section_.fault("start",
                       format("{:.6g} {} is outside of the {}", start,
                              coordinate[0] == 'r' ? "rad" : "m", key),
                       "Give a start between the stops, or move these.");
      else if (at_zero)
        section_.fault(key, "the joint starts at 0, which is outside",
                       "Coordinates count from the start where the joint is given with at: shift "
                       "the limits, or give start, at_body or axis_body.");
    }
  }

  void complete_distance() {
    const double start = (a_.to_world(joint_.Z_a) - b_.to_world(joint_.Z_b)).norm();
    const auto [found, is_new] = joint_.parameters.emplace("distance", start);
    if (is_new && !(start > 0.0)) {
      section_.fault(section_.has("at") ? "at" : "at_body", "the two points coincide at the start",
                     "Use a spherical joint, or give the distance.");
    }
    if (!is_new && std::abs(found->second - start) > 1e-9 * start) joint_.assembled_start = true;
  }

  /// Further errors are found by the kind itself.
  void check_recipe() {
    try {
      check_enforcement(joint_kind(joint_.type)
                            .recipe({joint_.Z_a, joint_.Z_b, joint_.R_a, joint_.R_b},
                                    {joint_.free, joint_.parameters})
                            .parts);
    } catch (const InputError& error) {
      const bool is_key = table_.find(error.where()) != nullptr;
      section_.fault(is_key ? error.where() : "type", error.what_is_wrong(), error.hint());
    }
  }

  ReadContext& context_;
  const SourceNode& node_;
  JointSpec& joint_;
  const FieldTable& table_;
  Section section_;
  const SourceNode* enforcement_at_ = nullptr;
  Pose a_, b_;
};

}  // namespace

void read_joints(ReadContext& context, const SourceNode& node) {
  context.has_starts = std::ranges::any_of(
      node.children, [](const SourceNode& joint) { return joint.is_map() && joint.find("start"); });
  for (std::size_t k = 0; k < node.keys.size(); ++k) {
    const SourceNode::Key& key = node.keys[k];
    if (!check_name(context, key, node.children[k], "joints")) continue;
    JointSpec joint;
    joint.name = key.name;
    joint.place = context.tree.place_of(key, node.children[k]);
    if (const FieldTable* table = read_kind(context, node.children[k], joint.place,
                                            "joints." + key.name, joint_tables(), joint.type))
      JointReader(context, node.children[k], joint, *table).read();
    context.joints.emplace(joint.name, static_cast<int>(context.model.joints.size()));
    context.model.joints.push_back(std::move(joint));
  }
}

}  // namespace polhode::io
