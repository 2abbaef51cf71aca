// SPDX-License-Identifier: Apache-2.0
// Loads of a model as properties of the joints of a tree.
#include <algorithm>
#include <numbers>
#include <optional>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/exporters/export_tree.hpp>

namespace polhode::io {

namespace {

/// Difference of a force from a part of the weight that is rounding, relative to the weight.
constexpr double kOfWeight = 1e-14;
/// Distance of a point from a centre of mass that is rounding of coordinates [m].
constexpr double kSamePlace = 1e-14;

double parameter(const LoadSpec& load, const std::string& key) {
  const auto found = load.parameters.find(key);
  return found == load.parameters.end() ? 0.0 : found->second;
}

class LoadSorter {
 public:
  LoadSorter(const Model& model, const ExportAbilities& can, ExportNotes& notes, ExportTree& tree)
      : model_(model), can_(can), notes_(notes), tree_(tree) {
    for (std::size_t i = 0; i < tree.bodies.size(); ++i)
      if (const int j = tree.bodies[i].joint.spec; j >= 0)
        body_of_[model.joints[static_cast<std::size_t>(j)].name] = static_cast<int>(i);
  }

  void sort() {
    for (std::size_t i = 0; i < model_.loads.size(); ++i) {
      const LoadSpec& load = model_.loads[i];
      const std::string& type = load.type;
      load_ = static_cast<int>(i);
      if (type == "torsional_spring" || type == "translational_spring")
        put_spring(load);
      else if (type == "rotary_inerter" || type == "linear_inerter")
        put_inerter(load);
      else if (type == "rotary_motor" || type == "linear_motor" || type == "rotary_servo" ||
               type == "linear_servo")
        put_motor(load);
      else if (type == "coupling")
        put_coupling(load);
      else if (type == "screw")
        put_screw(load);
      else if (can_.lines && (type == "spring_damper" || type == "axial_force"))
        put_line(load);
      else if (type == "vector_damper")
        put_vector_damper(load);
      else if (can_.pushes && (type == "force" || type == "moment"))
        put_push(load);
      else
        refuse(load, format("{} has no load of the type {}", can_.name, type),
               "Apply it where the file is read.");
    }
  }

 private:
  void refuse(const LoadSpec& load, const std::string& what, const std::string& hint) {
    notes_.refuse(load.place, "loads." + load.name, what, hint);
  }

  /// Coordinate of a joint in the tree. @param turns  Whether it must be an angle, if given.
  std::optional<ExportPlace> place_of(const LoadSpec& load, const std::string& joint,
                                      const std::string& key, std::optional<bool> turns) {
    if (const auto found = body_of_.find(joint); found != body_of_.end()) {
      const auto& list = tree_.bodies[static_cast<std::size_t>(found->second)].joint.coordinates;
      for (std::size_t k = 0; k < list.size(); ++k)
        if (key.empty() ? !turns || list[k].turns == *turns : list[k].key == key)
          return ExportPlace{found->second, static_cast<int>(k)};
    }
    refuse(load,
           format("it acts in the joint {}, which is not in the tree of the file", quote(joint)),
           "Let another joint close the loop.");
    return std::nullopt;
  }

  std::optional<ExportPlace> place_of(const LoadSpec& load) {
    const bool turns = load.type.starts_with("rotary") || load.type.starts_with("torsional");
    return place_of(load, load.joint, load.coordinate, turns);
  }

  void put_spring(const LoadSpec& load) {
    const auto acts = load.words.find("acts");
    if (!load.laws.empty() || parameter(load, "quadratic") != 0.0 ||
        (acts != load.words.end() && acts->second != "both"))
      return refuse(load, can_.name + " has no springs and dampers with a law",
                    "Give a stiffness and a damping.");
    const double k = parameter(load, "stiffness");
    if (k != 0.0 && !can_.springs)
      return refuse(load, can_.name + " has no springs", can_.elsewhere);
    const auto place = place_of(load);
    if (!place) return;
    ExportCoordinate& q = tree_.coordinate(*place);
    q.damping += parameter(load, "damping");
    if (k == 0.0) return;
    const double rest = parameter(load, q.turns ? "free_angle" : "free_displacement");
    q.rest = q.stiffness == 0.0 ? rest : (q.stiffness * q.rest + k * rest) / (q.stiffness + k);
    q.stiffness += k;
  }

  /// A straight line between points of two bodies.
  void put_line(const LoadSpec& load) {
    if (!load.laws.empty() || parameter(load, "quadratic") != 0.0)
      return refuse(load, can_.name + " has no springs and dampers with a law",
                    "Give a stiffness and a damping.");
    for (const int body : {load.a, load.b})
      if (body != kGround && tree_.at[static_cast<std::size_t>(body)] < 0) return;
    const bool steady = load.of_motion.index() == 0 && (!load.value || load.value->is_constant());
    if (!steady)
      refuse(load, "its target or effort is a function, and the file has a number",
             "Give a constant, and control it where the file is read.");
    tree_.lines.push_back({load_, load.value ? (*load.value)(0.0) : 0.0});
  }

  void put_inerter(const LoadSpec& load) {
    if (!can_.springs) return refuse(load, can_.name + " has no inerters", can_.elsewhere);
    if (const auto place = place_of(load))
      tree_.coordinate(*place).armature += parameter(load, "inertance");
  }

  /// A damper that resists the relative rotation in a spherical joint, or the motion of a free
  /// body.
  void put_vector_damper(const LoadSpec& load) {
    const double sliding = parameter(load, "damping"), turning = parameter(load, "turning_damping");
    for (ExportBody& body : tree_.bodies) {
      ExportJoint& joint = body.joint;
      const bool between = (joint.parent == load.a && body.spec == load.b) ||
                           (joint.parent == load.b && body.spec == load.a);
      if (!between) continue;
      if (joint.type == "spherical" && sliding == 0.0 && can_.turning_damping) {
        joint.damping += turning;
        return;
      }
      // One number is that of all six velocities of a free body, those of its origin.
      const Vec3& Z = body.spec == load.b ? load.Z_b : load.Z_a;
      const bool at_origin = in_own_coordinates(model_, body.spec, Z).isZero(0.0);
      if (joint.type == "free" && sliding == turning && at_origin && can_.free_damping) {
        joint.damping += sliding;
        return;
      }
    }
    refuse(load,
           can_.name + " has no dampers between two bodies but those of joints" +
               (can_.free_damping ? ", with one number for a free body, at its origin" : ""),
           "Apply it where the file is read.");
  }

  /// A constant force or moment, or a force that holds a part of a body's weight.
  void put_push(const LoadSpec& load) {
    const bool on_body = load.solid < 0 && load.a == kGround && load.b != kGround;
    const auto is_constant = [](const TimeFunctionPtr& f) { return !f || f->is_constant(); };
    if (!on_body || !load.vector || load.of_motion.index() != 0 ||
        !std::all_of(load.vector->begin(), load.vector->end(), is_constant))
      return refuse(load, "it is a function, or acts on no single body, and the file has numbers",
                    "Give a constant, and control it where the file is read.");
    const int body = tree_.at[static_cast<std::size_t>(load.b)];
    if (body < 0) return;
    ExportPush push{load_, Vec3::Zero()};
    for (std::size_t k = 0; k < 3; ++k)
      if (const TimeFunctionPtr& f = (*load.vector)[k]) push.value[static_cast<int>(k)] = (*f)(0.0);
    const Vec3 weight = model_.bodies[static_cast<std::size_t>(load.b)].mass * model_.gravity;
    const double part = weight.isZero(0.0) ? 0.0 : -push.value.dot(weight) / weight.squaredNorm();
    if (load.type == "force" && !load.body_fixed && load.Z_b.isZero(kSamePlace) && part > 0.0 &&
        (push.value + part * weight).norm() <= kOfWeight * weight.norm())
      tree_.bodies[static_cast<std::size_t>(body)].carried += part;
    else
      tree_.pushes.push_back(push);
  }

  void put_motor(const LoadSpec& load) {
    if (!can_.motors) return refuse(load, can_.name + " has no motors", can_.elsewhere);
    const bool servo = load.type.ends_with("servo");
    if (!servo && load.drive != "moment" && load.drive != "force")
      return refuse(load, can_.name + " has no motors that prescribe a motion",
                    "Use a servo, or a motor with a moment or force.");
    if (servo && (parameter(load, "integral") != 0.0 ||
                  (load.drive == "speed" && parameter(load, "stiffness") != 0.0)))
      return refuse(load, can_.name + " has no servos with an integral of the error",
                    "Use stiffness and damping.");
    const auto place = place_of(load);
    if (!place) return;
    const bool steady = load.of_motion.index() == 0 && (!load.value || load.value->is_constant());
    if (!steady)
      refuse(load, "its target or effort is a function, and the file has a number",
             "Give a constant, and control it where the file is read.");
    const double now = load.value ? (*load.value)(0.0) : 0.0;
    tree_.motors.push_back({load_, *place, now});
  }

  void put_coupling(const LoadSpec& load) {
    const auto first = place_of(load, load.joint, load.coordinate, std::nullopt);
    if (!first) return;
    ExportCoupling row{load_, *first, {}, parameter(load, "offset")};
    for (const CoordinateSpec& other : load.others) {
      const auto place = place_of(load, other.joint, other.coordinate, std::nullopt);
      if (!place) return;
      row.others.emplace_back(*place, other.factor);
    }
    add(load, std::move(row));
  }

  void put_screw(const LoadSpec& load) {
    const auto z = place_of(load, load.joint, "z", false);
    if (!z) return;
    const auto angle = place_of(load, load.joint, "rz", true);
    if (!angle) return;
    const double factor = parameter(load, "pitch") / (2.0 * std::numbers::pi);
    ExportCoupling row{load_, *z, {{*angle, factor}}, 0.0};
    row.offset = tree_.coordinate(*z).start - factor * tree_.coordinate(*angle).start;
    add(load, std::move(row));
  }

  void add(const LoadSpec& load, ExportCoupling row) {
    if (row.others.size() != 1 && !can_.rows)
      return refuse(load,
                    format("{} couples two coordinates, and this is a row of {}", can_.name,
                           row.others.size() + 1),
                    "Couple pairs of coordinates.");
    tree_.couplings.push_back(std::move(row));
  }

  const Model& model_;
  const ExportAbilities& can_;
  ExportNotes& notes_;
  ExportTree& tree_;
  int load_ = 0;
  std::map<std::string, int> body_of_;  ///< In the tree, by the name of its joint.
};

}  // namespace

void put_loads(const Model& model, const ExportAbilities& can, ExportNotes& notes,
               ExportTree& tree) {
  LoadSorter(model, can, notes, tree).sort();
}

}  // namespace polhode::io
