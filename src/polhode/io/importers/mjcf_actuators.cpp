// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/mjcf_actuators.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/mjcf_inertia.hpp>

namespace polhode::io {

namespace {

const std::vector<std::string> kActuatorKinds{"general",  "motor",       "position", "velocity",
                                              "damper",   "intvelocity", "cylinder", "muscle",
                                              "adhesion", "plugin"};

/// Whether an actuator has an activation, a state of its own.
bool has_activation(const MjcfTag& tag) {
  const std::string_view kind = tag.e.Name();
  if (kind == "intvelocity" || kind == "muscle") return true;
  if (kind == "cylinder") return tag.number("timeconst", 1.0) > 0.0;
  if (kind == "position") return tag.number("timeconst", 0.0) > 0.0;
  return kind == "general" && tag.text("dyntype", "none") != "none";
}

class ActuatorReader {
 public:
  ActuatorReader(MjcfFile& file, MjcfRefusals& refusals, const MjcfBodies& bodies,
                 MjcfTendons& tendons, Robot& robot)
      : file_(file), refusals_(refusals), bodies_(bodies), tendons_(tendons), robot_(robot) {}

  /// @param control, activation  Its own at the start.
  void read(const MjcfTag& tag, double control, double activation) {
    const std::string kind = tag.e.Name();
    joint_ = tag.text("joint", tag.text("jointinparent", ""));
    tendon_ = tag.text("tendon", "");
    site_ = tag.text("site", "");
    name_ = tag.text("name", (!joint_.empty()    ? joint_
                              : !tendon_.empty() ? tendon_
                                                 : site_) +
                                 "_" + kind);
    at_ = &tag.e;
    law_ = {};
    range_.clear();
    if (kind == "muscle")
      return refuse("is a muscle with curves of its own", "Add a cable with a 'muscle'.");
    if (joint_.empty() && tendon_.empty() && site_.empty())
      return refuse("does not act on a joint, tendon or site");
    gears_ = tag.numbers("gear", 1, 6);
    gears_.resize(6, 0.0);
    if (!tag.has("gear")) gears_[0] = 1.0;
    const bool bounded = file_.compiler.auto_limits;
    if (const auto range = tag.numbers("ctrlrange", 2, 2);
        !range.empty() && range[0] <= range[1] && tag.boolean("ctrllimited", bounded))
      control = std::clamp(control, range[0], range[1]);
    if (tag.boolean("forcelimited", bounded)) range_ = tag.numbers("forcerange", 2, 2);
    if (range_.size() == 2 && range_[0] > range_[1]) range_.clear();
    if (!read_input(tag, kind, control, activation) || !read_law(tag, kind, control)) return;
    act(tag);
  }

  /// Bounds of joints on the effort of their actuators.
  void finish() {
    for (const RobotJoint& joint : robot_.joints) {
      if (!joint.least_effort) continue;
      std::vector<RobotActuator*> own;
      for (RobotActuator& actuator : robot_.actuators)
        if (actuator.joint == joint.name) own.push_back(&actuator);
      if (own.size() == 1)
        own[0]->bound(*joint.least_effort, *joint.most_effort);
      else if (own.size() > 1)
        file_.ignored.add(*joint.at, "'actuatorfrcrange' of a joint with several actuators",
                          "limits nothing");
    }
  }

 private:
  /// The force as a signal less stiffness times length less damping times its rate.
  struct Law {
    RobotSignal signal;
    double stiffness = 0.0, damping = 0.0, ratio = 0.0;
    [[nodiscard]] bool is_servo() const { return stiffness != 0.0 || damping != 0.0; }
  };

  void refuse(const std::string& what, const char* hint = "Import without actuators.") {
    refusals_.add(*at_, format("the actuator {} {}", quote(name_), what), hint);
  }

  /// The input of the gain: the control, or an activation that follows it.
  bool read_input(const MjcfTag& tag, const std::string& kind, double control, double activation) {
    input_ = {};
    input_.constant = control;
    if (!has_activation(tag)) return true;
    const std::string type = kind == "intvelocity" ? "integrator"
                             : kind == "general"   ? tag.text("dyntype", "none")
                                                   : "filter";
    if (type == "integrator") {
      input_.constant = activation;
      input_.ramp = control;
    } else if (type == "filter" || type == "filterexact") {
      const std::vector<double> given = tag.numbers("dynprm", 1, 10);
      const double time = kind == "cylinder"   ? tag.number("timeconst", 1.0)
                          : kind == "position" ? tag.number("timeconst", 0.0)
                          : given.empty()      ? 1.0
                                               : given[0];
      if (!(time > 0.0)) {
        file_.xml.fault(tag.e, format("the time constant of {} is {}", quote(name_), time),
                        "Give one above 0.");
        return false;
      }
      input_.decay = activation - control;
      input_.time = time;
    } else {
      refuse(format("has the dynamics {}", quote(type)));
      return false;
    }
    const std::vector<double> range = tag.numbers("actrange", 2, 2);
    if (range.size() == 2 && range[0] < range[1] &&
        tag.boolean("actlimited", file_.compiler.auto_limits))
      input_ = input_.within(range[0], range[1]);
    if (!said_) {
      file_.notes.push_back({ImportNote::Kind::approximated, file_.xml.place(tag.e),
                             "activations of actuators are functions of time, as their controls "
                             "are constant"});
      said_ = true;
    }
    return true;
  }

  bool read_law(const MjcfTag& tag, const std::string& kind, double control) {
    const auto no = [&](const std::string& what) {
      refuse(what);
      return false;
    };
    const auto prm = [&](const char* attribute, std::vector<double> standard) {
      const std::vector<double> given = tag.numbers(attribute, 1, 10);
      if (!given.empty()) standard = given;
      standard.resize(std::max<std::size_t>(3, standard.size()), 0.0);
      return standard;
    };
    std::vector<double> gain{1.0, 0.0, 0.0}, bias{0.0, 0.0, 0.0};
    if (kind == "position" || kind == "intvelocity") {
      gain[0] = tag.number("kp", 1.0);
      bias[1] = -gain[0];
      bias[2] = -tag.number("kv", 0.0);
      law_.ratio = tag.number("dampratio", 0.0);
    } else if (kind == "velocity") {
      gain[0] = tag.number("kv", 1.0);
      bias[2] = -gain[0];
    } else if (kind == "damper") {
      gain = {0.0, 0.0, -tag.number("kv", 1.0)};
    } else if (kind == "cylinder") {
      gain[0] = tag.number("area", 1.0);
      if (tag.has("diameter"))
        gain[0] = std::numbers::pi / 4.0 * std::pow(tag.number("diameter", 0.0), 2);
      bias = prm("bias", bias);
    } else if (kind == "general") {
      const std::string of_gain = tag.text("gaintype", "fixed"),
                        of_bias = tag.text("biastype", "none");
      if ((of_gain != "fixed" && of_gain != "affine") || (of_bias != "none" && of_bias != "affine"))
        return no("has a gain or bias that is not affine");
      gain = prm("gainprm", gain);
      if (of_gain == "fixed") gain[1] = gain[2] = 0.0;
      if (of_bias == "affine") bias = prm("biasprm", bias);
    } else if (kind != "motor") {
      return no(format("is a {}", kind));
    }
    if ((gain[1] != 0.0 || gain[2] != 0.0) && !input_.is_constant())
      return no("has a gain that depends on its length, and dynamics of its own");
    law_.signal = input_.times(gain[0]).plus(bias[0]);
    law_.stiffness = -bias[1] - gain[1] * control;
    law_.damping = -bias[2] - gain[2] * control;
    // A positive entry is the damping ratio of a position servo.
    if (kind == "general" && law_.damping < 0.0 && law_.stiffness == gain[0] && gain[0] > 0.0) {
      law_.ratio = -law_.damping;
      law_.damping = 0.0;
    }
    if (law_.stiffness < 0.0 || law_.damping < 0.0)
      return no("has a bias that is no spring and damper");
    return true;
  }

  void act(const MjcfTag& tag) {
    if (!site_.empty()) return act_on_site(tag);
    if (!joint_.empty()) {
      if (single_joint(file_.xml, robot_, tag.e, joint_) != nullptr)
        add(tag, name_, joint_, gears_[0]);
      return;
    }
    const auto sum = tendons_.sums().find(tendon_);
    if (sum != tendons_.sums().end()) {
      std::vector<std::pair<std::string, double>> joints = sum->second;
      std::erase_if(joints, [](const auto& j) { return j.second == 0.0; });
      if ((law_.is_servo() || law_.ratio > 0.0) && joints.size() > 1)
        return add(tag, name_, tendons_.length_joint(tendon_), gears_[0]);
      for (const auto& [joint, factor] : joints)
        add(tag, joints.size() > 1 ? name_ + "_" + joint : name_, joint, gears_[0] * factor);
    } else if (tendons_.spatial(tendon_) != nullptr) {
      pull(tag, *tendons_.spatial(tendon_));
    } else {
      file_.xml.fault(tag.e, format("there is no tendon {}", quote(tendon_)),
                      "Name one of <tendon>.");
    }
  }

  /// The force along a line through sites: a tension, and for a servo a spring of the same path.
  void pull(const MjcfTag& tag, RobotCable& cable) {
    const double gear = gears_[0];
    if (law_.ratio > 0.0)
      return refuse(format("has a damping ratio along the tendon {}", quote(tendon_)),
                    "Give 'kv'.");
    if (!law_.is_servo()) {
      cable.tension.push_back(limited(law_.signal).times(-gear));
      file_.notes.push_back(
          {ImportNote::Kind::approximated, file_.xml.place(tag.e),
           format("the actuator {} is the pull of the tendon {}", quote(name_), quote(tendon_))});
      return;
    }
    if (!range_.empty())
      return refuse(format("is a servo of the length of {} with a 'forcerange'", quote(tendon_)),
                    "Leave the 'forcerange' out, or give the cable a 'tension' with a controller.");
    RobotCable spring;
    spring.at = &tag.e;
    spring.name = name_;
    spring.through = cable.through;
    spring.around = cable.around;
    spring.stiffness = gear * gear * law_.stiffness;
    spring.damping = gear * gear * law_.damping;
    const RobotSignal push = law_.signal.times(gear);
    const bool plain = spring.through.size() == 2 && spring.around.empty();
    double rest =
        spring.stiffness > 0.0 && push.is_constant() ? push.at_start() / spring.stiffness : 0.0;
    if (!(rest > 0.0)) rest = plain || spring.stiffness == 0.0 ? 0.0 : 1.0;
    spring.shortest = spring.longest = rest;
    const RobotSignal rest_of_push = push.plus(-rest * spring.stiffness);
    if (!push.is_constant() ||
        std::abs(rest_of_push.at_start()) > 1e-14 * std::abs(push.at_start()))
      spring.tension.push_back(rest_of_push.times(-1.0));
    robot_.cables.push_back(std::move(spring));
  }

  /// A force and a moment along the axes of a site, or of a site of the world.
  void act_on_site(const MjcfTag& tag) {
    const auto find = [&](const std::string& name) {
      const auto site = bodies_.sites().find(name);
      if (site == bodies_.sites().end())
        file_.xml.fault(tag.e, format("there is no site {}", quote(name)),
                        "Name a site of a body.");
      return site;
    };
    const std::string reference = tag.text("refsite", "");
    const auto site = find(site_);
    if (site == bodies_.sites().end()) return;
    // The length along a single site is always zero, so that a stiffness has no effect.
    if (law_.damping != 0.0 || law_.ratio > 0.0 || (law_.stiffness != 0.0 && !reference.empty()))
      return refuse("is a servo of a site", "Use a motor, or add a bushing.");
    RobotPush push;
    push.at = &tag.e;
    push.name = name_;
    push.point = {site->second.link, site->second.frame.p};
    push.signal = limited(law_.signal);
    Mat3 axes = site->second.frame.R;
    if (!reference.empty()) {
      const auto other = find(reference);
      if (other == bodies_.sites().end()) return;
      if (!is_still(other->second.link))
        return refuse(format("acts between the sites {} and {}, which both may move", quote(site_),
                             quote(reference)),
                      "Let 'refsite' be on the world, or leave it out.");
      push.in_world = true;
      axes = bodies_.frames().at(other->second.link).R * other->second.frame.R;
    }
    push.force = axes * Vec3(gears_[0], gears_[1], gears_[2]);
    push.moment = axes * Vec3(gears_[3], gears_[4], gears_[5]);
    robot_.pushes.push_back(std::move(push));
  }

  /// Whether a link is welded to the world.
  [[nodiscard]] bool is_still(const std::string& link) const {
    for (const RobotJoint& joint : robot_.joints)
      if (joint.child == link) return joint.type == "fixed" && is_still(joint.parent);
    return true;
  }

  [[nodiscard]] RobotSignal limited(const RobotSignal& force) const {
    return range_.empty() ? force : force.within(range_[0], range_[1]);
  }

  void add(const MjcfTag& tag, const std::string& name, const std::string& joint, double gear) {
    RobotActuator actuator;
    actuator.at = &tag.e;
    actuator.joint = joint;
    actuator.name = name == joint ? name + "_motor" : name;
    const double squared = gear * gear;
    actuator.stiffness = squared * law_.stiffness;
    actuator.damping = squared * law_.damping;
    if (law_.ratio > 0.0 && !put_ratio(joint, gear, actuator)) return;
    const RobotSignal effort = law_.signal.times(gear);
    const bool bounded = !range_.empty();
    if (bounded) actuator.bound(gear * range_[0], gear * range_[1]);
    if (actuator.stiffness > 0.0 && put_target(effort, actuator)) {
      actuator.kind = RobotActuator::Kind::place;
    } else if (actuator.stiffness > 0.0) {
      if (bounded)
        return refuse("is a servo whose activation and force are limited",
                      "Leave 'forcerange' or 'actrange' out.");
      // The force of the activation beside that of spring and damper about zero.
      actuator.kind = RobotActuator::Kind::place;
      RobotActuator more;
      more.at = &tag.e;
      more.joint = joint;
      more.name = actuator.name + "_activation";
      more.target = effort;
      robot_.actuators.push_back(std::move(more));
    } else if (actuator.damping > 0.0) {
      actuator.kind = RobotActuator::Kind::velocity;
      actuator.target = effort.times(1.0 / actuator.damping);
    } else {
      actuator.target = effort;
    }
    robot_.actuators.push_back(std::move(actuator));
  }

  /// The coordinate c(t) of a servo, whose force is k (c - q) + d (c' - q'), of a given force where
  /// the joint rests. @returns whether there is one
  static bool put_target(const RobotSignal& effort, RobotActuator& actuator) {
    const double k = actuator.stiffness, d = actuator.damping;
    if (effort.is_constant() || d == 0.0) {
      actuator.target = effort.times(1.0 / k);
      return true;
    }
    const double by_decay = k - d / effort.time;
    if (effort.is_bounded() || (effort.decay != 0.0 && std::abs(by_decay) < 1e-6 * k)) return false;
    RobotSignal c = effort;
    c.ramp = effort.ramp / k;
    c.constant = (effort.constant - d * c.ramp) / k;
    if (c.decay != 0.0) c.decay = effort.decay / by_decay;
    actuator.target = c;
    return true;
  }

  /// Damping by the inertia that the actuator moves in the model's configuration.
  bool put_ratio(const std::string& joint, double gear, RobotActuator& actuator) {
    const MjcfInertia& inertia = tendons_.inertia();
    double J = 0.0;
    const auto sum = tendons_.sums().find(tendon_);
    if (sum != tendons_.sums().end() && sum->second.size() > 1)
      J = tendons_.inertia_of(tendon_);
    else
      for (std::size_t j = 0; inertia.is_there() && j < robot_.joints.size(); ++j)
        if (robot_.joints[j].name == joint) J = inertia.effective(j);
    actuator.damping = 2.0 * law_.ratio * std::abs(gear) * std::sqrt(law_.stiffness * J);
    if (J > 0.0) return true;
    refuse(inertia.is_there()
               ? "has a damping ratio in a tree that has no inertia at one of its joints"
               : format("has a damping ratio in a model with more than {} joint velocities",
                        MjcfInertia::kMost),
           "Give 'kv'.");
    return false;
  }

  MjcfFile& file_;
  MjcfRefusals& refusals_;
  const MjcfBodies& bodies_;
  MjcfTendons& tendons_;
  Robot& robot_;
  bool said_ = false;

  // The actuator that is read.
  const XmlFile::Element* at_ = nullptr;
  std::string name_, joint_, tendon_, site_;
  std::vector<double> gears_;
  RobotSignal input_;
  Law law_;
  std::vector<double> range_;  ///< Of the force; empty: without bounds.
};

}  // namespace

std::vector<bool> activations_of(MjcfFile& file) {
  std::vector<bool> list;
  for (const XmlFile::Element* e : actuators_of(file))
    list.push_back(has_activation({file, *e, kActuatorKinds, ""}));
  return list;
}

std::vector<const XmlFile::Element*> actuators_of(MjcfFile& file) {
  std::vector<const XmlFile::Element*> list;
  for (const XmlFile::Element* section : file.sections("actuator"))
    for (const XmlFile::Element* e = section->FirstChildElement(); e != nullptr;
         e = e->NextSiblingElement()) {
      static_cast<void>(file.xml.children(*section, e->Name()));
      list.push_back(e);
    }
  return list;
}

void read_actuators(MjcfFile& file, MjcfRefusals& refusals, const MjcfBodies& bodies,
                    const ImportOptions& options, const MjcfControls& controls,
                    MjcfTendons& tendons, Robot& robot) {
  const auto list = actuators_of(file);
  const auto at = [](const std::vector<double>& values, std::size_t k) {
    return k < values.size() ? values[k] : 0.0;
  };
  ActuatorReader reader(file, refusals, bodies, tendons, robot);
  for (std::size_t k = 0; k < list.size(); ++k) {
    if (options.actuators)
      reader.read({file, *list[k], kActuatorKinds, ""}, at(controls.controls, k),
                  at(controls.activations, k));
    file.xml.skip(*list[k]);
  }
  reader.finish();
}

}  // namespace polhode::io
