// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/feb_model.hpp>

namespace polhode::io {

namespace {

using Element = XmlFile::Element;

/// Part of a length up to which two points are one.
constexpr double kSamePlace = 1e-9;

/// Reader of one connector between two rigid bodies.
class ConnectorReader {
 public:
  ConnectorReader(FebModel& model, const Element& e)
      : model_(model), file_(model.file), e_(e), make_(file_.make(e)) {}

  void read() {
    const std::string type = file_.type(e_);
    if (type.empty()) return;
    name_ = file_.xml.text(e_, "name").value_or(type);
    if (!is_known(type)) {
      file_.refuse(e_, format("a connector of type {} is not read", quote(type)),
                   "Leave it out, and add a joint or load to the model.");
      return;
    }
    a_ = model_.body(e_, "body_a");
    b_ = model_.body(e_, "body_b");
    skip_solver_tags();
    if (a_ == nullptr || b_ == nullptr) return;
    if (a_ == b_) {
      file_.xml.fault(e_, format("{} connects a body with itself", quote(name_)),
                      "Name two bodies.");
      return;
    }
    if (a_->is_fixed() && b_->is_fixed()) {
      file_.xml.skip(e_);
      file_.ignored.add(e_, "a connector of two fixed bodies", "moves nothing");
      return;
    }
    read_type(type);
  }

 private:
  static bool is_known(const std::string& type) {
    static const std::vector<std::string> types{"rigid joint",
                                                "rigid spherical joint",
                                                "rigid revolute joint",
                                                "rigid prismatic joint",
                                                "rigid cylindrical joint",
                                                "rigid planar joint",
                                                "rigid lock",
                                                "rigid spring",
                                                "rigid damper",
                                                "rigid angular damper",
                                                "rigid contractile force",
                                                "generic rigid joint"};
    return std::find(types.begin(), types.end(), type) != types.end();
  }

  void read_type(const std::string& type) {
    if (type == "rigid spring") return read_spring();
    if (type == "rigid damper") return read_damper();
    if (type == "rigid angular damper") return read_angular_damper();
    if (type == "rigid contractile force") return read_contractile();
    if (type == "generic rigid joint") return read_generic();
    if (type == "rigid joint" || type == "rigid spherical joint") return read_spherical();
    if (type == "rigid lock") {
      static_cast<void>(file_.vector(e_, "first_axis"));
      static_cast<void>(file_.vector(e_, "second_axis"));
      model_.add_joint(e_, name_, joint("fixed"));
      return;
    }
    if (type == "rigid revolute joint") return read_hinge();
    if (type == "rigid prismatic joint") return read_slider();
    if (type == "rigid cylindrical joint") return read_sleeve();
    read_planar();
  }

  /// Penalties and augmentations, which exact joints do not need.
  void skip_solver_tags() {
    bool any = false;
    for (const char* tag : {"laugon", "tolerance", "gaptol", "angtol", "force_penalty",
                            "moment_penalty", "force_damping", "moment_damping", "auto_penalty",
                            "minaug", "maxaug", "penalty", "symmetric_stiffness"})
      for (const Element* unused : file_.xml.children(e_, tag)) {
        file_.xml.skip(*unused);
        any = true;
      }
    if (any)
      file_.ignored.add(e_, "penalties and augmentations of a connector",
                        "are not needed: joints hold exactly");
  }

  [[nodiscard]] SourceNode bodies() const {
    return make_.list({make_.text(a_->name), make_.text(b_->name)});
  }

  /// A joint at the connector's origin.
  SourceNode joint(const char* type, const char* origin = "joint_origin") {
    SourceNode node = make_.map();
    make_.put(node, "type", make_.text(type));
    make_.put(node, "bodies", bodies());
    make_.put(node, "at", make_.vector(file_.vector(e_, origin).value_or(Vec3::Zero())));
    return node;
  }

  /// A joint with an axis and a direction across it.
  SourceNode joint_along(const char* type, const char* axis, const Vec3& standard,
                         const char* across, const Vec3& across_standard) {
    SourceNode node = joint(type);
    const Vec3 z = file_.direction(e_, axis, standard);
    Vec3 x = file_.direction(e_, across, across_standard);
    if (z.cross(x).norm() < 1e-6) x = z.unitOrthogonal();
    make_.put(node, "axis", make_.direction(z));
    make_.put(node, "x_axis", make_.direction(x));
    return node;
  }

  /// A coordinate that is prescribed, or has a force.
  /// @param coordinate  "" for the joint's only one.
  void drive(const std::string& joint_name, bool turns, const std::string& coordinate,
             const char* flag, const char* value, const char* force) {
    const bool prescribed = file_.boolean(e_, flag, false);
    const FebValue motion = file_.value(e_, value);
    const FebValue effort = force == nullptr ? FebValue{} : file_.value(e_, force);
    SourceNode load = make_.map();
    const auto start = [&](const char* type) {
      make_.put(load, "type", make_.text(type));
      make_.put(load, "joint", make_.text(joint_name));
      if (!coordinate.empty()) make_.put(load, "coordinate", make_.text(coordinate));
    };
    if (prescribed && !effort.is_zero())
      file_.xml.fault(e_, format("{} has a motion and a force along it", quote(name_)),
                      "Keep one of them.");
    if (prescribed) {
      start(turns ? "rotary_motor" : "linear_motor");
      make_.put(load, turns ? "angle" : "displacement", model_.curves.node(motion));
      model_.add_load(e_, format("{}_{}", joint_name, value), std::move(load));
    } else if (!effort.is_zero()) {
      // FEBio's force and moment act on body a, those of a joint on its second body.
      start(turns ? "joint_moment" : "joint_force");
      make_.put(load, turns ? "moment" : "force", model_.curves.node(effort, -1.0));
      model_.add_load(e_, format("{}_{}", joint_name, force), std::move(load));
    }
  }

  void read_hinge() {
    const std::string name = model_.add_joint(
        e_, name_,
        joint_along("revolute", "rotation_axis", Vec3::UnitZ(), "transverse_axis", Vec3::UnitX()));
    drive(name, true, "", "prescribed_rotation", "rotation", "moment");
  }

  void read_slider() {
    const std::string name =
        model_.add_joint(e_, name_,
                         joint_along("prismatic", "translation_axis", Vec3::UnitX(),
                                     "transverse_axis", Vec3::UnitY()));
    drive(name, false, "", "prescribed_translation", "translation", "force");
  }

  void read_sleeve() {
    const std::string name = model_.add_joint(
        e_, name_,
        joint_along("cylindrical", "joint_axis", Vec3::UnitX(), "transverse_axis", Vec3::UnitY()));
    drive(name, false, "", "prescribed_translation", "translation", "force");
    drive(name, true, "", "prescribed_rotation", "rotation", "moment");
  }

  void read_planar() {
    SourceNode node =
        joint_along("planar", "rotation_axis", Vec3::UnitX(), "translation_axis_1", Vec3::UnitY());
    static_cast<void>(file_.vector(e_, "translation_axis_2"));  // Follows from the other two.
    const std::string name = model_.add_joint(e_, name_, std::move(node));
    drive(name, false, "x", "prescribed_translation_1", "translation_1", nullptr);
    drive(name, false, "y", "prescribed_translation_2", "translation_2", nullptr);
    drive(name, true, "", "prescribed_rotation", "rotation", nullptr);
  }

  void read_spherical() {
    const bool prescribed = file_.boolean(e_, "prescribed_rotation", false);
    std::array<FebValue, 3> turn, moment;
    static const char* const turns[] = {"rotation_x", "rotation_y", "rotation_z"};
    static const char* const moments[] = {"moment_x", "moment_y", "moment_z"};
    bool loaded = false;
    for (std::size_t k = 0; k < 3; ++k) {
      turn[k] = file_.value(e_, turns[k]);
      moment[k] = file_.value(e_, moments[k]);
      loaded = loaded || !moment[k].is_zero();
    }
    SourceNode node = joint(prescribed ? "fixed" : "spherical");
    if (prescribed) {
      SourceNode motion = make_.map();
      make_.put(motion, "rotation_vector", model_.vector(e_, turn));
      // Axes along the world's at the start.
      make_.put(node, "axis", make_.text("z"));
      make_.put(node, "x_axis", make_.text("x"));
      make_.put(node, "motion", std::move(motion));
    }
    const std::string name = model_.add_joint(e_, name_, std::move(node));
    if (!loaded) return;
    if (prescribed) {
      file_.xml.fault(e_, format("{} has a rotation and a moment", quote(name_)),
                      "Keep one of them.");
      return;
    }
    for (const FebBody* body : {a_, b_}) {
      if (body->is_fixed()) continue;
      SourceNode load = make_.map();
      make_.put(load, "type", make_.text("moment"));
      make_.put(load, "body", make_.text(body->name));
      make_.put(load, "moment", model_.vector(e_, moment, body == a_ ? 1.0 : -1.0));
      model_.add_load(e_, format("{}_moment_{}", name, body == a_ ? "a" : "b"), std::move(load));
    }
  }

  /// A joint that locks the coordinates whose tags it has.
  void read_generic() {
    SourceNode node = joint("generic", "joint");
    make_.put(node, "axis", make_.text("z"));
    make_.put(node, "x_axis", make_.text("x"));
    static const char* const tags[] = {"prescribe_x",  "prescribe_y",  "prescribe_z",
                                       "prescribe_Rx", "prescribe_Ry", "prescribe_Rz"};
    static const char* const names[] = {"x", "y", "z", "rx", "ry", "rz"};
    SourceNode free = make_.list(), motion = make_.map();
    std::array<FebValue, 6> values;
    int turned = 0, locked_turns = 0;
    for (std::size_t k = 0; k < 6; ++k) {
      values[k] = file_.value(e_, tags[k]);
      const bool locked = values[k].at != nullptr;
      if (!locked) free.children.push_back(make_.text(names[k]));
      if (k < 3 && !values[k].is_zero()) make_.put(motion, names[k], model_.curves.node(values[k]));
      if (k >= 3 && locked) ++locked_turns;
      if (k >= 3 && !values[k].is_zero()) ++turned;
    }
    if (turned > 1 || (turned == 1 && locked_turns < 3))
      file_.refuse(
          e_, format("{} turns about several axes, or about one with others free", quote(name_)),
          "Use a revolute or spherical joint with a prescribed rotation.");
    else if (turned == 1)
      make_.put(motion, "rotation_vector", model_.vector(e_, {values[3], values[4], values[5]}));
    if (free.children.empty())
      node.children[0] = make_.text("fixed");
    else
      make_.put(node, "free", std::move(free));
    if (!motion.keys.empty()) make_.put(node, "motion", std::move(motion));
    model_.add_joint(e_, name_, std::move(node));
  }

  /// Both insertion points.
  std::array<Vec3, 2> insertions() {
    return {file_.vector(e_, "insertion_a").value_or(Vec3::Zero()),
            file_.vector(e_, "insertion_b").value_or(Vec3::Zero())};
  }

  SourceNode load_between(const char* type, const std::array<Vec3, 2>& at) {
    SourceNode load = make_.map();
    make_.put(load, "type", make_.text(type));
    make_.put(load, "bodies", bodies());
    make_.put(load, "at", make_.list({make_.vector(at[0]), make_.vector(at[1])}));
    return load;
  }

  /// A constant that must not be negative; a load controller on it is refused.
  double constant(const char* tag, double standard) {
    const FebValue value = file_.value(e_, tag, standard);
    if (!value.is_constant())
      file_.refuse(*value.at, format("<{}> changes over time", tag), "Give a constant.");
    if (value.factor < 0.0)
      file_.xml.fault(*value.at, format("<{}> is {}", tag, value.factor),
                      "Give a value that is not negative.");
    return std::max(0.0, value.factor);
  }

  void read_spring() {
    const auto at = insertions();
    SourceNode load = load_between("spring_damper", at);
    make_.put(load, "stiffness", make_.number(constant("k", 1.0)));
    const double free = constant("free_length", 0.0);
    make_.put(load, "free_length", make_.number(free > 0.0 ? free : (at[1] - at[0]).norm()));
    model_.add_load(e_, name_, std::move(load));
  }

  void read_damper() {
    auto at = insertions();
    const double c = constant("c", 1.0);
    // Between a fixed body and another one the velocity is that of the second body's point.
    const bool swapped = b_->is_fixed();
    if (swapped) {
      std::swap(a_, b_);
      std::swap(at[0], at[1]);
    }
    SourceNode load = load_between("vector_damper", at);
    make_.put(load, "damping", make_.number(c));
    if (!a_->is_fixed() && (at[1] - at[0]).norm() > kSamePlace * (1.0 + at[1].norm()))
      file_.approximated(e_,
                         format("the damper {} has its points apart: it damps the velocity of the "
                                "second one relative to the first body, without FEBio's couple",
                                quote(name_)));
    model_.add_load(e_, name_, std::move(load));
  }

  void read_angular_damper() {
    const double c = constant("c", 1.0);
    SourceNode load = load_between("vector_damper", {a_->com, a_->com});
    make_.put(load, "turning_damping", make_.number(c));
    model_.add_load(e_, name_, std::move(load));
  }

  void read_contractile() {
    const auto at = insertions();
    const FebValue force = file_.value(e_, "f0");
    SourceNode load = load_between("axial_force", at);
    make_.put(load, "pull", model_.curves.node(force));
    model_.add_load(e_, name_, std::move(load));
  }

  FebModel& model_;
  FebFile& file_;
  const Element& e_;
  NodeBuilder make_;
  std::string name_;
  const FebBody *a_ = nullptr, *b_ = nullptr;
};

}  // namespace

void read_feb_connector(FebModel& model, const Element& e) {
  const std::size_t joints = model.joints.keys.size(), loads = model.loads.keys.size();
  ConnectorReader(model, e).read();
  if (model.joints.keys.size() > joints)
    model.connectors.emplace_back("joint", model.joints.keys[joints].name);
  else if (model.loads.keys.size() > loads)
    model.connectors.emplace_back("load", model.loads.keys[loads].name);
  else
    model.connectors.emplace_back("", "");
}

}  // namespace polhode::io
