// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/mjcf_actuators.hpp>

#include <algorithm>
#include <cmath>
#include <map>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/mjcf_inertia.hpp>

namespace polhode::io {

namespace {

class ActuatorReader {
 public:
  ActuatorReader(MjcfFile& file, MjcfRefusals& refusals, const MjcfBodies& bodies,
                 MjcfTendons& tendons, Robot& robot)
      : file_(file), refusals_(refusals), bodies_(bodies), tendons_(tendons), robot_(robot) {
    for (const MjcfActuator& a : actuators_of(file)) ++tendon_uses_[a.tendon];
  }

  /// @param control, activation  Its own at the start.
  void read(const MjcfActuator& a, double control, double activation) {
    of_ = &a;
    at_ = a.at;
    name_ = a.name.empty() ? (!a.joint.empty()    ? a.joint
                              : !a.tendon.empty() ? a.tendon
                                                  : a.site) +
                                 "_" + a.kind
                           : a.name;
    law_ = {};
    if (a.kind == "muscle")
      return refuse("is a muscle with curves of its own", "Add a cable with a 'muscle'.");
    if (a.kind == "adhesion") return refuse("pulls a body to what it touches");
    if (a.joint.empty() && a.tendon.empty() && a.site.empty())
      return refuse("does not act on a joint, tendon or site");
    if (a.delay > 0.0) return refuse("has a delay", "Leave it out.");
    const bool bounded = file_.compiler.auto_limits;
    std::vector<double> bounds = a.control.active(bounded),
                        activations = a.activation.active(bounded);
    if (a.inherited > 0.0 && !inherit(a.kind == "intvelocity" ? activations : bounds)) return;
    if (bounds.size() == 2 && bounds[0] <= bounds[1] && file_.flags.control_bounds)
      control = std::clamp(control, bounds[0], bounds[1]);
    range_ = a.force.active(bounded);
    if (range_.size() == 2 && range_[0] > range_[1]) range_.clear();
    if (!a.tendon.empty() && !bound_by_tendon()) return;
    if (!read_input(control, activation, activations) || !read_law(control)) return;
    act();
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
        refusals_.add(*joint.at,
                      format("the 'actuatorfrcrange' of {} bounds the sum of several actuators",
                             quote(joint.name)),
                      "Give each a 'forcerange'.");
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

  /// Bounds as a part of the range of the actuator's joint, about the same middle.
  bool inherit(std::vector<double>& bounds) {
    for (const RobotJoint& joint : robot_.joints)
      if (joint.name == of_->joint && joint.is_single() && joint.lower && joint.upper) {
        const double middle = 0.5 * (*joint.lower + *joint.upper);
        const double radius = 0.5 * of_->inherited * (*joint.upper - *joint.lower);
        bounds = {middle - radius, middle + radius};
        return true;
      }
    refuse("inherits its range from something that is no joint with a range",
           "Give 'ctrlrange' or 'actrange'.");
    return false;
  }

  /// Bounds of the tendon on the force of its only actuator.
  bool bound_by_tendon() {
    const std::vector<double> bounds = tendons_.force_range(of_->tendon);
    if (bounds.empty()) return true;
    if (tendon_uses_[of_->tendon] > 1) {
      refuse(format("is one of several on the tendon {}, which bounds their sum by "
                    "'actuatorfrcrange'",
                    quote(of_->tendon)),
             "Give each a 'forcerange'.");
      return false;
    }
    if (range_.empty())
      range_ = bounds;
    else
      range_ = {std::clamp(range_[0], bounds[0], bounds[1]),
                std::clamp(range_[1], bounds[0], bounds[1])};
    return true;
  }

  /// The input of the gain: the control, or an activation that follows it.
  bool read_input(double control, double activation, const std::vector<double>& bounds) {
    input_ = {};
    input_.constant = control;
    if (!of_->has_activation()) return true;
    if (of_->dynamics == "integrator") {
      input_.constant = activation;
      input_.ramp = control;
    } else if (of_->dynamics == "filter" || of_->dynamics == "filterexact") {
      if (!(of_->time > 0.0)) {
        file_.xml.fault(*at_, format("the time constant of {} is {}", quote(name_), of_->time),
                        "Give one above 0.");
        return false;
      }
      input_.decay = activation - control;
      input_.time = of_->time;
    } else {
      refuse(format("has the dynamics {}", quote(of_->dynamics)));
      return false;
    }
    if (bounds.size() == 2 && bounds[0] < bounds[1]) input_ = input_.within(bounds[0], bounds[1]);
    if (!said_) {
      file_.notes.push_back({ImportNote::Kind::approximated, file_.xml.place(*at_),
                             "activations of actuators are functions of time, as their controls "
                             "are constant"});
      said_ = true;
    }
    return true;
  }

  bool read_law(double control) {
    const auto no = [&](const std::string& what) {
      refuse(what);
      return false;
    };
    static const std::vector<std::string> read{"general", "motor",       "position", "velocity",
                                               "damper",  "intvelocity", "cylinder"};
    if (std::find(read.begin(), read.end(), of_->kind) == read.end())
      return no(format("is a {}", of_->kind));
    if ((of_->gain_type != "fixed" && of_->gain_type != "affine") ||
        (of_->bias_type != "none" && of_->bias_type != "affine"))
      return no("has a gain or bias that is not affine");
    std::vector<double> gain = of_->gain, bias = of_->bias;
    if (of_->gain_type == "fixed") gain[1] = gain[2] = 0.0;
    if (of_->bias_type == "none") bias.assign(3, 0.0);
    if ((gain[1] != 0.0 || gain[2] != 0.0) && !input_.is_constant())
      return no("has a gain that depends on its length, and dynamics of its own");
    law_.signal = input_.times(gain[0]).plus(bias[0]);
    law_.stiffness = -bias[1] - gain[1] * control;
    law_.damping = -bias[2] - gain[2] * control;
    // A positive entry is the damping ratio of a position servo.
    if (law_.damping < 0.0 && gain[1] == 0.0 && gain[2] == 0.0 && law_.stiffness == gain[0] &&
        gain[0] > 0.0) {
      law_.ratio = -law_.damping;
      law_.damping = 0.0;
    }
    if (law_.stiffness < 0.0 || law_.damping < 0.0)
      return no("has a bias that is no spring and damper");
    return true;
  }

  void act() {
    if (!of_->site.empty()) return act_on_site();
    if (!of_->joint.empty()) {
      for (const RobotJoint& joint : robot_.joints)
        if (joint.name == of_->joint && (joint.type == "spherical" || joint.type == "floating"))
          return act_on_ball(joint);
      if (single_joint(file_.xml, robot_, *at_, of_->joint) != nullptr)
        add(name_, of_->joint, of_->gear[0]);
      return;
    }
    const auto sum = tendons_.sums().find(of_->tendon);
    if (sum != tendons_.sums().end()) {
      std::vector<std::pair<std::string, double>> joints = sum->second;
      std::erase_if(joints, [](const auto& j) { return j.second == 0.0; });
      if ((law_.is_servo() || law_.ratio > 0.0) && joints.size() > 1)
        return add(name_, tendons_.length_joint(of_->tendon), of_->gear[0]);
      for (const auto& [joint, factor] : joints)
        add(joints.size() > 1 ? name_ + "_" + joint : name_, joint, of_->gear[0] * factor);
    } else if (tendons_.spatial(of_->tendon) != nullptr) {
      pull(*tendons_.spatial(of_->tendon));
    } else {
      file_.xml.fault(*at_, format("there is no tendon {}", quote(of_->tendon)),
                      "Name one of <tendon>.");
    }
  }

  /// The force along a line through sites: a tension, and for a servo a spring of the same path.
  void pull(RobotCable& cable) {
    const double gear = of_->gear[0];
    if (law_.ratio > 0.0)
      return refuse(format("has a damping ratio along the tendon {}", quote(of_->tendon)),
                    "Give 'kv'.");
    if (!law_.is_servo()) {
      cable.tension.push_back(limited(law_.signal).times(-gear));
      file_.notes.push_back({ImportNote::Kind::approximated, file_.xml.place(*at_),
                             format("the actuator {} is the pull of the tendon {}", quote(name_),
                                    quote(of_->tendon))});
      return;
    }
    if (!range_.empty())
      return refuse(
          format("is a servo of the length of {} with a 'forcerange'", quote(of_->tendon)),
          "Leave the 'forcerange' out, or give the cable a 'tension' with a controller.");
    RobotCable spring;
    spring.at = at_;
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
  void act_on_site() {
    const auto find = [&](const std::string& name) {
      const auto site = bodies_.sites().find(name);
      if (site == bodies_.sites().end())
        file_.xml.fault(*at_, format("there is no site {}", quote(name)), "Name a site of a body.");
      return site;
    };
    const std::string& reference = of_->reference;
    const auto site = find(of_->site);
    if (site == bodies_.sites().end()) return;
    // The length along a single site is always zero, so that a stiffness has no effect.
    if (law_.damping != 0.0 || law_.ratio > 0.0 || (law_.stiffness != 0.0 && !reference.empty()))
      return refuse("is a servo of a site", "Use a motor, or add a bushing.");
    RobotPush push;
    push.at = at_;
    push.name = name_;
    push.point = {site->second.link, site->second.frame.p};
    push.signal = limited(law_.signal);
    Mat3 axes = site->second.frame.R;
    if (!reference.empty()) {
      const auto other = find(reference);
      if (other == bodies_.sites().end()) return;
      if (!is_still(other->second.link))
        return refuse(format("acts between the sites {} and {}, which both may move",
                             quote(of_->site), quote(reference)),
                      "Let 'refsite' be on the world, or leave it out.");
      push.in_world = true;
      axes = bodies_.frames().at(other->second.link).R * other->second.frame.R;
    }
    push.force = axes * Vec3(of_->gear[0], of_->gear[1], of_->gear[2]);
    push.moment = axes * Vec3(of_->gear[3], of_->gear[4], of_->gear[5]);
    robot_.pushes.push_back(std::move(push));
  }

  /// A moment in a ball joint of a body that does not move, in the axes of either body; likewise in
  /// a free one, with a force at the child's origin in the axes of the world.
  void act_on_ball(const RobotJoint& joint) {
    const bool free = joint.type == "floating";
    // The length of a free joint is always zero, so that a stiffness has no effect.
    if (law_.damping != 0.0 || law_.ratio > 0.0 || (law_.stiffness != 0.0 && !free))
      return refuse(format("is a servo of {}, which has several coordinates", quote(joint.name)),
                    "Use a motor, or add a bushing.");
    if (!is_still(joint.parent))
      return refuse(format("turns the ball {} between two bodies that move", quote(joint.name)),
                    "Use hinges one after the other.");
    const std::vector<double>& gear = of_->gear;
    RobotPush push;
    push.at = at_;
    push.name = name_;
    push.point = {joint.child, Vec3::Zero()};
    push.signal = limited(law_.signal);
    push.in_world = true;
    if (free) push.force = Vec3(gear[0], gear[1], gear[2]);
    const Vec3 moment = free ? Vec3(gear[3], gear[4], gear[5]) : Vec3(gear[0], gear[1], gear[2]);
    if (of_->in_parent) push.moment = bodies_.frames().at(joint.parent).R * moment;
    if (of_->in_parent || !push.force.isZero(0.0)) robot_.pushes.push_back(push);
    if (of_->in_parent || moment.isZero(0.0)) return;
    push.in_world = false;
    push.force.setZero();
    push.moment = moment;
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

  void add(const std::string& name, const std::string& joint, double gear) {
    RobotActuator actuator;
    actuator.at = at_;
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
      more.at = at_;
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
    const auto sum = tendons_.sums().find(of_->tendon);
    if (sum != tendons_.sums().end() && sum->second.size() > 1)
      J = tendons_.inertia_of(of_->tendon);
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
  std::map<std::string, int> tendon_uses_;  ///< Actuators of each tendon.

  // The actuator that is read.
  const XmlFile::Element* at_ = nullptr;
  const MjcfActuator* of_ = nullptr;
  std::string name_;
  RobotSignal input_;
  Law law_;
  std::vector<double> range_;  ///< Of the force; empty: without bounds.
};

}  // namespace

void add_actuator_armatures(MjcfFile& file, MjcfRefusals& refusals, MjcfTendons& tendons,
                            Robot& robot) {
  for (const MjcfActuator& a : actuators_of(file)) {
    const double damping = file.flags.dampers ? a.damping : 0.0;
    if (file.flags.dampers && a.damping_is_polynomial)
      refusals.add(*a.at, format("'damping' of <{}> is a polynomial", a.kind), "Give one number.");
    if (damping < 0.0 || a.armature < 0.0)
      file.xml.fault(*a.at, format("<{}> has a negative damping or armature", a.kind),
                     "Give a value that is not negative.");
    if (damping == 0.0 && a.armature == 0.0) continue;
    const double squared = a.gear[0] * a.gear[0];
    if (!a.tendon.empty()) {
      tendons.add_of_actuator(a.tendon, squared * damping, squared * a.armature);
      continue;
    }
    const auto joint = std::find_if(robot.joints.begin(), robot.joints.end(),
                                    [&](const RobotJoint& j) { return j.name == a.joint; });
    if (joint == robot.joints.end() || !joint->is_single()) {
      refusals.add(*a.at, format("<{}> has a damping or armature without a hinge or slide", a.kind),
                   "Give it to the joint.");
      continue;
    }
    joint->damping += squared * damping;
    joint->armature += squared * a.armature;
  }
}

void read_actuators(MjcfFile& file, MjcfRefusals& refusals, const MjcfBodies& bodies,
                    const ImportOptions& options, const MjcfControls& controls,
                    MjcfTendons& tendons, Robot& robot) {
  const std::vector<MjcfActuator> list = actuators_of(file);
  const auto at = [](const std::vector<double>& values, std::size_t k) {
    return k < values.size() ? values[k] : 0.0;
  };
  const std::vector<double>& off = file.flags.actuator_groups_off;
  ActuatorReader reader(file, refusals, bodies, tendons, robot);
  for (std::size_t k = 0; k < list.size(); ++k) {
    const MjcfActuator& a = list[k];
    if (!file.flags.actuation || std::find(off.begin(), off.end(), a.group) != off.end())
      file.ignored.add(*a.at, "an actuator that <option> switches off", "exerts no force");
    else if (options.actuators)
      reader.read(a, at(controls.controls, k), at(controls.activations, k));
    file.skip(*a.at);
  }
  reader.finish();
}

}  // namespace polhode::io
