// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/mjcf_actuators.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/mjcf_inertia.hpp>

namespace polhode::io {

namespace {

const std::vector<std::string> kActuatorKinds{"general",  "motor",       "position", "velocity",
                                              "damper",   "intvelocity", "cylinder", "muscle",
                                              "adhesion", "plugin"};

class ActuatorReader {
 public:
  ActuatorReader(MjcfFile& file, MjcfRefusals& refusals, const MjcfBodies& bodies,
                 MjcfTendons& tendons, Robot& robot)
      : file_(file), refusals_(refusals), bodies_(bodies), tendons_(tendons), robot_(robot) {}

  /// @param control  Its control at the start.
  void read(const MjcfTag& tag, double control) {
    const std::string kind = tag.e.Name();
    joint_ = tag.text("joint", tag.text("jointinparent", ""));
    tendon_ = tag.text("tendon", "");
    name_ = tag.text("name", (joint_.empty() ? tendon_ : joint_) + "_" + kind);
    at_ = &tag.e;
    gear_ = gain_ = 1.0;
    stiffness_ = damping_ = ratio_ = 0.0;
    range_.clear();
    if (kind == "muscle")
      return refuse("is a muscle with curves of its own", "Add a cable with a 'muscle'.");
    if (joint_.empty() && tendon_.empty()) return refuse("does not act on a joint or tendon");
    const std::vector<double> gears = tag.numbers("gear", 1, 6);
    gear_ = gears.empty() ? 1.0 : gears[0];
    if (tag.number("timeconst", 0.0) != 0.0 || tag.text("dyntype", "none") != "none")
      return refuse("has dynamics of its own");
    const bool bounded = file_.compiler.auto_limits;
    if (const auto range = tag.numbers("ctrlrange", 2, 2);
        !range.empty() && range[0] <= range[1] && tag.boolean("ctrllimited", bounded))
      control = std::clamp(control, range[0], range[1]);
    if (tag.boolean("forcelimited", bounded)) range_ = tag.numbers("forcerange", 2, 2);
    if (!read_law(tag, kind)) return;
    act(tag, control);
  }

 private:
  void refuse(const std::string& what, const char* hint = "Import without actuators.") {
    refusals_.add(*at_, format("the actuator {} {}", quote(name_), what), hint);
  }

  /// The force as gain times control less stiffness times length less damping times its rate.
  bool read_law(const MjcfTag& tag, const std::string& kind) {
    const auto no = [&](const std::string& what) {
      refuse(what);
      return false;
    };
    gain_ = 1.0;
    if (kind == "position") {
      gain_ = stiffness_ = tag.number("kp", 1.0);
      damping_ = tag.number("kv", 0.0);
      ratio_ = tag.number("dampratio", 0.0);
    } else if (kind == "velocity") {
      gain_ = damping_ = tag.number("kv", 1.0);
    } else if (kind == "general") {
      const std::vector<double> bias = tag.numbers("biasprm", 1, 10);
      const std::vector<double> gain = tag.numbers("gainprm", 1, 10);
      const std::string type = tag.text("biastype", "none");
      if (!gain.empty()) gain_ = gain[0];
      if (tag.text("gaintype", "fixed") != "fixed" || (type != "none" && type != "affine"))
        return no("has a gain or bias that is not affine");
      const auto entry = [&](std::size_t k) {
        return type == "none" || k >= bias.size() ? 0.0 : bias[k];
      };
      stiffness_ = -entry(1);
      damping_ = -entry(2);
      // A positive entry is the damping ratio of a position servo.
      if (damping_ < 0.0 && stiffness_ == gain_ && gain_ > 0.0) {
        ratio_ = -damping_;
        damping_ = 0.0;
      }
      if (entry(0) != 0.0 || stiffness_ < 0.0 || damping_ < 0.0)
        return no("has a bias that is no spring and damper");
    } else if (kind != "motor") {
      return no(format("is a {}", kind));
    }
    return true;
  }

  void act(const MjcfTag& tag, double control) {
    if (!joint_.empty()) {
      if (single_joint(file_.xml, robot_, tag.e, joint_) != nullptr)
        add(tag, name_, joint_, gear_, control);
      return;
    }
    const auto sum = tendons_.sums().find(tendon_);
    RobotCable* const cable = tendons_.spatial(tendon_);
    const bool servo = stiffness_ != 0.0 || damping_ != 0.0;
    if (sum != tendons_.sums().end()) {
      std::vector<std::pair<std::string, double>> joints = sum->second;
      std::erase_if(joints, [](const auto& j) { return j.second == 0.0; });
      if (servo && joints.size() > 1)
        return refuse(format("is a servo of the sum of {} coordinates", joints.size()));
      for (const auto& [joint, factor] : joints)
        add(tag, joints.size() > 1 ? name_ + "_" + joint : name_, joint, gear_ * factor, control);
    } else if (cable != nullptr) {
      if (servo)
        return refuse(format("is a servo of the length of {}", quote(tendon_)),
                      "Use a motor, or give the cable a 'tension' with a controller.");
      cable->tension = cable->tension.value_or(0.0) - gear_ * limited(gain_ * control);
      file_.notes.push_back(
          {ImportNote::Kind::approximated, file_.xml.place(tag.e),
           format("the actuator {} is the pull of the tendon {}", quote(name_), quote(tendon_))});
    } else {
      file_.xml.fault(tag.e, format("there is no tendon {}", quote(tendon_)),
                      "Name one of <tendon>.");
    }
  }

  [[nodiscard]] double limited(double force) const {
    return range_.empty() || range_[0] > range_[1] ? force
                                                   : std::clamp(force, range_[0], range_[1]);
  }

  void add(const MjcfTag& tag, const std::string& name, const std::string& joint, double gear,
           double control) {
    RobotActuator actuator;
    actuator.at = &tag.e;
    actuator.joint = joint;
    actuator.name = name == joint ? name + "_motor" : name;
    const double squared = gear * gear;
    actuator.stiffness = squared * stiffness_;
    actuator.damping = squared * damping_;
    if (ratio_ > 0.0 && !put_ratio(joint, gear, actuator)) return;
    const double effort = gear * gain_ * control;
    if (actuator.stiffness > 0.0) {
      actuator.kind = RobotActuator::Kind::place;
      actuator.target = effort / actuator.stiffness;
    } else if (actuator.damping > 0.0) {
      actuator.kind = RobotActuator::Kind::velocity;
      actuator.target = effort / actuator.damping;
    } else {
      actuator.target = gear * limited(gain_ * control);
    }
    if (!range_.empty() && actuator.kind != RobotActuator::Kind::effort) {
      if (range_[0] == -range_[1] && range_[1] > 0.0)
        actuator.most = std::abs(gear) * range_[1];
      else
        file_.ignored.add(tag.e, "'forcerange' that is not symmetric", "limits nothing");
    }
    robot_.actuators.push_back(std::move(actuator));
  }

  /// Damping by the inertia that the actuator moves in the model's configuration.
  bool put_ratio(const std::string& joint, double gear, RobotActuator& actuator) {
    if (!inertia_) inertia_.emplace(robot_, bodies_.frames());
    double J = 0.0;
    for (std::size_t j = 0; inertia_->is_there() && j < robot_.joints.size(); ++j)
      if (robot_.joints[j].name == joint) J = inertia_->effective(j);
    actuator.damping = 2.0 * ratio_ * std::abs(gear) * std::sqrt(stiffness_ * J);
    if (J > 0.0) return true;
    refuse(inertia_->is_there()
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
  std::optional<MjcfInertia> inertia_;

  // The actuator that is read.
  const XmlFile::Element* at_ = nullptr;
  std::string name_, joint_, tendon_;
  double gear_ = 1.0, gain_ = 1.0, stiffness_ = 0.0, damping_ = 0.0, ratio_ = 0.0;
  std::vector<double> range_;  ///< Of the force; empty: without bounds.
};

}  // namespace

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
                    const ImportOptions& options, const std::vector<double>& controls,
                    MjcfTendons& tendons, Robot& robot) {
  const auto list = actuators_of(file);
  ActuatorReader reader(file, refusals, bodies, tendons, robot);
  for (std::size_t k = 0; k < list.size(); ++k) {
    if (options.actuators)
      reader.read({file, *list[k], kActuatorKinds, ""}, k < controls.size() ? controls[k] : 0.0);
    file.xml.skip(*list[k]);
  }
}

}  // namespace polhode::io
