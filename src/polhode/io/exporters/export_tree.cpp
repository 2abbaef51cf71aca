// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/exporters/export_tree.hpp>

#include <algorithm>
#include <cctype>
#include <set>

#include <polhode/core/disjoint_sets.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/dynamics/body_motion.hpp>

namespace polhode::io {

namespace {

using Kind = ExportNote::Kind;

template <class T>
const T& item(const std::vector<T>& list, int i) {
  return list[static_cast<std::size_t>(i)];
}

/// Whether a joint can close a loop in a format with equality constraints.
bool closes(const JointSpec& joint) { return joint.type == "spherical" || joint.type == "fixed"; }

class TreeMaker {
 public:
  TreeMaker(const Simulation& simulation, const ExportAbilities& can, ExportNotes& notes)
      : simulation_(simulation), model_(simulation.model()), can_(can), notes_(notes) {}

  ExportTree make() {
    refuse_parts();
    for (const BodySpec& body : model_.bodies) written_.push_back(is_written(body));
    for (const JointSpec& joint : model_.joints) {
      const bool good = is_good(joint);
      represented_.push_back(good);
      if (good) names_.insert(joint.name);
    }
    span();
    tree_.at.assign(model_.bodies.size(), -1);
    for (std::size_t i = 0; i < model_.bodies.size(); ++i)
      if (written_[i] && model_.bodies[i].fixed) start_from(static_cast<int>(i), "fixed");
    for (const int j : joints_of_ground_)
      if (const int body = other_end(j, kGround); item(tree_.at, body) < 0) reach(j, kGround, body);
    for (std::size_t i = 0; i < model_.bodies.size(); ++i)
      if (written_[i] && tree_.at[i] < 0) start_from(static_cast<int>(i), "free");
    for (ExportBody& body : tree_.bodies) finish(body);
    put_loads(model_, can_, notes_, tree_);
    return std::move(tree_);
  }

 private:
  void refuse(const SourceLocation& place, const std::string& path, const std::string& what,
              const std::string& hint) {
    notes_.refuse(place, path, what, hint);
  }

  /// Parts of a model that no format of robots has.
  void refuse_parts() {
    for (const SolidSpec& solid : model_.solids)
      refuse(solid.place, "solids." + solid.name, can_.name + " has no deformable solids",
             "Make it a rigid body.");
    for (const BeamSpec& beam : model_.beams)
      refuse(beam.place, "beams." + beam.name, can_.name + " has no beams",
             "Make it a rigid body.");
    for (const CableLineSpec& cable : model_.cables)
      refuse(cable.place, "cables." + cable.name, can_.name + " has no cables of this kind",
             "Use springs in joints.");
    for (const EventSpec& event : model_.events)
      refuse(event.place, "events." + event.name, can_.name + " has no events", "Remove it.");
    for (const ControllerSpec& controller : model_.controllers)
      refuse(controller.place, "controllers." + controller.name,
             can_.name + " has no controllers of this kind",
             "Let the program that reads the file control the motors.");
    if (model_.contacts.present)
      refuse(model_.contacts.place, "contacts", can_.name + " has other laws of contact",
             "Remove contacts from the model.");
  }

  /// Reports a name that a file cannot have.
  void check_name(const SourceLocation& place, const std::string& group, const std::string& name) {
    if (name.empty()) {
      notes_.fault(place, group, "an entry has no name", "Give each body and joint a name.");
      return;
    }
    const bool bad = std::any_of(name.begin(), name.end(), [](char c) {
      const auto u = static_cast<unsigned char>(c);
      return std::isspace(u) || std::iscntrl(u);
    });
    if (group == "bodies" && name == kGroundName)
      notes_.add(Kind::differs, "bodies." + name,
                 format("is called {} in the file", quote(file_name(model_, name))));
    if (bad)
      notes_.fault(place, group + "." + name,
                   format("the name {} contains a space or control character", quote(name)),
                   "Rename it with an underscore.");
  }

  bool is_written(const BodySpec& body) {
    if (!body.node_of.empty()) return false;
    check_name(body.place, "bodies", body.name);
    if (!body.fixed && body.point_mass)
      refuse(body.place, "bodies." + body.name,
             can_.name + " has no point masses: bodies have an inertia", "Give it an inertia.");
    else
      return true;
    return false;
  }

  [[nodiscard]] bool is_written(int body) const {
    return body == kGround || written_[static_cast<std::size_t>(body)];
  }

  /// Whether a joint can be in the file, alone.
  bool is_good(const JointSpec& joint) {
    const std::string path = "joints." + joint.name;
    if (!is_written(joint.a) || !is_written(joint.b)) {
      notes_.add(Kind::left_out, path, "connects a body that is left out");
      return false;
    }
    const bool own = joint.motion || joint.name.ends_with(".hold");
    if (own) {
      refuse(joint.place, path, can_.name + " has no prescribed motions and no held freedoms",
             "Use a joint, or drive it by a servo.");
      return false;
    }
    check_name(joint.place, "joints", joint.name);
    if (std::find(can_.joints.begin(), can_.joints.end(), joint.type) == can_.joints.end()) {
      refuse(joint.place, path, format("{} has no joint of the type {}", can_.name, joint.type),
             can_.elsewhere);
      return false;
    }
    if (joint.enforcement && joint.enforcement->law == JointEnforcement::Law::penalty) {
      refuse(joint.place, path + ".enforcement", can_.name + " has no joints held by penalties",
             "Make it exact: remove enforcement.");
      return false;
    }
    if (joint.breaks.force || joint.breaks.moment)
      refuse(joint.place, path + ".breaks", can_.name + " has no joints that break",
             "Remove breaks.");
    return true;
  }

  /// Chooses the joints of the tree; others close loops.
  void span() {
    DisjointSets connected(model_.bodies.size() + 1);
    const auto node = [&](int body) {
      return body == kGround || item(model_.bodies, body).fixed ? 0 : body + 1;
    };
    joints_of_.resize(model_.bodies.size());
    for (const bool last : {false, true})
      for (std::size_t k = 0; k < model_.joints.size(); ++k) {
        const JointSpec& joint = model_.joints[k];
        if (!represented_[k] || closes(joint) != last) continue;
        const int j = static_cast<int>(k), a = node(joint.a), b = node(joint.b);
        if (connected.first_of(a) != connected.first_of(b)) {
          connected.join(a, b);
          for (const int body : {joint.a, joint.b})
            (body == kGround ? joints_of_ground_ : joints_of_[static_cast<std::size_t>(body)])
                .push_back(j);
          continue;
        }
        close(j);
      }
  }

  void close(int j) {
    const JointSpec& joint = item(model_.joints, j);
    const std::string path = "joints." + joint.name;
    if (!can_.loops) {
      refuse(joint.place, path, format("{} has no loops, and this joint closes one", can_.name),
             "Export an MJCF if it is spherical or fixed.");
    } else if (!closes(joint)) {
      refuse(joint.place, path,
             format("it closes a loop, and is {}: {} closes loops by points that coincide or by "
                    "welds",
                    joint.type, can_.name),
             "Make a joint of the loop spherical: in a plane that is the same.");
    } else if (joint.friction) {
      refuse(joint.place, path + ".friction", "it closes a loop, where a joint has no friction",
             "Remove it.");
    } else {
      tree_.loops.push_back(j);
      if (joint.type == "fixed" || joint.type == "spherical")
        notes_.add(Kind::differs, path,
                   "closes a loop exactly, and is soft in programs that read the file");
    }
  }

  [[nodiscard]] int other_end(int j, int body) const {
    const JointSpec& joint = item(model_.joints, j);
    return joint.a == body ? joint.b : joint.a;
  }

  /// A name for a joint of the file that no other one has.
  std::string new_name(std::string name) {
    while (!names_.insert(name).second) name += "_2";
    return name;
  }

  /// Adds a body that no joint of the model connects to the ground, and all that it carries.
  void start_from(int body, const char* type) {
    const BodySpec& spec = item(model_.bodies, body);
    const BodyMotion motion = simulation_.body(body);
    ExportBody root;
    root.spec = body;
    root.joint.type = type;
    root.joint.name = new_name(spec.name + "_" + type);
    root.joint.at_start = root.joint.at_zero = motion.Lambda();
    root.joint.on_parent = motion.r - motion.Lambda() * spec.com;
    tree_.at[static_cast<std::size_t>(body)] = static_cast<int>(tree_.bodies.size());
    tree_.bodies.push_back(std::move(root));
    reach_from(body);
  }

  /// Adds the body at the other end of a joint, and all that it carries.
  void reach(int j, int parent, int body) {
    add(j, parent, body);
    reach_from(body);
  }

  void add(int j, int parent, int body) {
    const JointSpec& spec = item(model_.joints, j);
    ExportBody next;
    next.spec = body;
    next.joint.spec = j;
    next.joint.name = spec.name;
    next.joint.type = spec.type;
    next.joint.parent = parent;
    next.joint.reversed = spec.a == body;
    tree_.at[static_cast<std::size_t>(body)] = static_cast<int>(tree_.bodies.size());
    tree_.bodies.push_back(std::move(next));
  }

  void reach_from(int root) {
    std::vector<std::pair<int, int>> open;  // Joint, and its body nearer to the root.
    const auto push_joints_of = [&](int body) {
      const std::vector<int>& list = item(joints_of_, body);
      for (auto j = list.rbegin(); j != list.rend(); ++j) open.emplace_back(*j, body);
    };
    push_joints_of(root);
    while (!open.empty()) {
      const auto [j, parent] = open.back();
      open.pop_back();
      const int body = other_end(j, parent);
      if (body == kGround || item(tree_.at, body) >= 0) continue;
      add(j, parent, body);
      push_joints_of(body);
    }
  }

  void finish(ExportBody& body) {
    const BodySpec& spec = item(model_.bodies, body.spec);
    const BodyMotion motion = simulation_.body(body.spec);
    const Mat3 A = motion.Lambda();
    const Vec3 w = motion.omega();
    body.velocity = motion.v - w.cross(A * spec.com);
    body.turning = A.transpose() * w;
    ExportJoint& joint = body.joint;
    if (joint.parent != kGround)
      body.turning -= A.transpose() * simulation_.body(joint.parent).omega();
    if (joint.spec < 0) return;
    put_coordinates(simulation_, body.spec, joint);
    for (ExportCoordinate& q : joint.coordinates)
      q.name = joint.coordinates.size() == 1 ? joint.name : new_name(joint.name + "_" + q.key);
    put_resistance(item(model_.joints, joint.spec), joint);
  }

  /// Friction and stops.
  void put_resistance(const JointSpec& spec, ExportJoint& joint) {
    const std::string path = "joints." + spec.name;
    if (const auto& friction = spec.friction) {
      if (friction->mu != 0.0 || joint.coordinates.size() != 1) {
        refuse(spec.place, path + ".friction",
               can_.name + " has no friction that depends on the joint's force",
               "Give a constant force or moment of friction.");
      } else {
        joint.coordinates[0].friction = friction->constant;
        if (friction->constant != 0.0)
          notes_.add(Kind::differs, path + ".friction",
                     "sticks here, and creeps or is left out in programs that read the file");
      }
    }
    const auto put = [&](const std::optional<JointLimitsSpec>& limits, bool turns,
                         const char* key) {
      if (!limits) return;
      for (ExportCoordinate& q : joint.coordinates) {
        if (q.turns != turns) continue;
        q.lower = limits->lower;
        q.upper = limits->upper;
        notes_.add(Kind::differs, path + key,
                   "are stops with a law of their own in programs that read the file");
        return;
      }
    };
    const bool slides = std::any_of(joint.coordinates.begin(), joint.coordinates.end(),
                                    [](const ExportCoordinate& q) { return !q.turns; });
    put(spec.limits, !slides, ".limits");
    put(spec.angle_limits, true, ".angle_limits");
  }

  const Simulation& simulation_;
  const Model& model_;
  const ExportAbilities& can_;
  ExportNotes& notes_;
  ExportTree tree_;
  std::vector<bool> written_, represented_;  ///< Bodies, joints.
  std::vector<std::vector<int>> joints_of_;  ///< In the tree, by body.
  std::vector<int> joints_of_ground_;
  std::set<std::string> names_;  ///< Of joints of the file.
};

}  // namespace

std::string file_name(const Model& model, const std::string& body) {
  if (body != kGroundName) return body;
  std::string name = body;
  const auto taken = [&](const BodySpec& other) { return other.name == name; };
  while (std::any_of(model.bodies.begin(), model.bodies.end(), taken)) name += "_body";
  return name;
}

ExportTree export_tree(const Simulation& simulation, const ExportAbilities& can,
                       ExportNotes& notes) {
  return TreeMaker(simulation, can, notes).make();
}

}  // namespace polhode::io
