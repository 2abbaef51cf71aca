// SPDX-License-Identifier: Apache-2.0
// Loads of a model as properties of the joints of a tree.
#include <numbers>
#include <optional>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/exporters/export_tree.hpp>

namespace polhode::io {

namespace {

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
        put_ball_damper(load);
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

  /// A damper that resists the relative rotation in a spherical joint.
  void put_ball_damper(const LoadSpec& load) {
    for (ExportBody& body : tree_.bodies) {
      ExportJoint& joint = body.joint;
      if (joint.type != "spherical") continue;
      const bool between = (joint.parent == load.a && body.spec == load.b) ||
                           (joint.parent == load.b && body.spec == load.a);
      if (!between || parameter(load, "damping") != 0.0 || !can_.turning_damping) continue;
      joint.damping += parameter(load, "turning_damping");
      return;
    }
    refuse(load, can_.name + " has no dampers between two bodies but those of joints",
           "Apply it where the file is read.");
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
    if (row.others.size() != 1)
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
