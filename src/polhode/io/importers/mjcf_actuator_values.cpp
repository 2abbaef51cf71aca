// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/mjcf_actuator_values.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>

namespace polhode::io {

namespace {

/// Most numbers of parameters.
constexpr std::size_t kMostParameters = 10;

constexpr std::array<std::string_view, 13> kActuatorTags{
    "general", "motor",    "position", "velocity", "damper",  "intvelocity", "cylinder",
    "muscle",  "adhesion", "plugin",   "pid",      "dcmotor", "orientation"};

/// The sum of the tags of a class, and of an actuator's own.
class ActuatorSum {
 public:
  explicit ActuatorSum(MjcfFile& file) : xml_(file.xml) {}

  void add(const XmlFile::Element& e) {
    e_ = &e;
    const std::string_view tag = e.Name();
    for (const auto& [attribute, value] :
         {std::pair{"name", &a_.name}, std::pair{"joint", &a_.joint},
          std::pair{"jointinparent", &a_.joint}, std::pair{"tendon", &a_.tendon},
          std::pair{"site", &a_.site}, std::pair{"refsite", &a_.reference}})
      if (auto given = xml_.text(e, attribute)) *value = std::move(*given);
    if (e.Attribute("joint") != nullptr || e.Attribute("jointinparent") != nullptr)
      a_.in_parent = e.Attribute("jointinparent") != nullptr;
    number("group", a_.group);
    partial("gear", a_.gear, 6);
    range("ctrlrange", "ctrllimited", a_.control);
    range("forcerange", "forcelimited", a_.force);
    range("actrange", "actlimited", a_.activation);
    number("inheritrange", a_.inherited);
    number("armature", a_.armature);
    number("delay", a_.delay);
    if (const auto list = xml_.numbers(e, "damping", 1, kMostParameters)) {
      a_.damping = (*list)[0];
      for (std::size_t k = 1; k < list->size(); ++k)
        a_.damping_is_polynomial = a_.damping_is_polynomial || (*list)[k] != 0.0;
    }
    if (tag == "general" || tag == "plugin")
      add_general();
    else
      add_shortcut(tag);
    kind_ = tag;
  }

  MjcfActuator take(const XmlFile::Element& own) {
    a_.at = &own;
    a_.kind = own.Name();
    return std::move(a_);
  }

 private:
  void number(const char* attribute, double& value) {
    value = xml_.number(*e_, attribute).value_or(value);
  }
  /// Numbers of which only those that are given change.
  void partial(const char* attribute, std::vector<double>& values, std::size_t most) {
    const auto given = xml_.numbers(*e_, attribute, 1, most);
    if (!given) return;
    values.resize(std::max(values.size(), given->size()), 0.0);
    std::copy(given->begin(), given->end(), values.begin());
  }
  void range(const char* attribute, const char* limited, MjcfActuator::Range& range) {
    if (const auto given = xml_.numbers(*e_, attribute, 2, 2)) range.bounds = *given;
    const auto word = xml_.text(*e_, limited);
    if (!word) return;
    range.limited = *word;
    if (*word != "auto" && *word != "true" && *word != "false")
      xml_.fault(*e_, format("'{}' of <{}> is {}", limited, e_->Name(), quote(*word)),
                 "Write true, false or auto.");
  }

  void add_general() {
    a_.gain_type = xml_.text(*e_, "gaintype").value_or(a_.gain_type);
    a_.bias_type = xml_.text(*e_, "biastype").value_or(a_.bias_type);
    a_.dynamics = xml_.text(*e_, "dyntype").value_or(a_.dynamics);
    partial("gainprm", a_.gain, kMostParameters);
    partial("biasprm", a_.bias, kMostParameters);
    if (const auto given = xml_.numbers(*e_, "dynprm", 1, kMostParameters)) a_.time = (*given)[0];
  }

  void reset() {
    const MjcfActuator plain;
    a_.gain = plain.gain;
    a_.bias = plain.bias;
    a_.gain_type = plain.gain_type;
    a_.bias_type = plain.bias_type;
    a_.dynamics = plain.dynamics;
    a_.time = plain.time;
  }

  void add_shortcut(std::string_view tag) {
    const char* gain_type = tag == "damper" ? "affine" : "fixed";
    if (tag == "motor" || (kind_ == "general" ? a_.gain_type != gain_type : kind_ != tag)) reset();
    a_.gain_type = gain_type;
    a_.bias_type = tag == "motor" || tag == "damper" ? "none" : "affine";
    if (tag == "position" || tag == "intvelocity") {
      add_servo(tag);
    } else if (tag == "velocity") {
      const double kv = xml_.number(*e_, "kv").value_or(a_.gain[0]);
      set_law({kv, 0.0, 0.0}, {0.0, 0.0, -kv});
    } else if (tag == "damper") {
      const double kv = not_negative("kv", -a_.gain[2]);
      set_law({0.0, 0.0, -kv}, {0.0, 0.0, 0.0});
      a_.control.limited = "true";
    } else if (tag == "cylinder") {
      double area = xml_.number(*e_, "area").value_or(a_.gain[0]);
      if (const auto diameter = xml_.number(*e_, "diameter"))
        area = std::numbers::pi / 4.0 * *diameter * *diameter;
      const auto bias = xml_.numbers(*e_, "bias", 3, 3);
      set_law({area, 0.0, 0.0}, bias ? *bias : a_.bias);
      number("timeconst", a_.time);
      a_.dynamics = a_.time > 0.0 ? "filter" : "none";
    }
  }

  void add_servo(std::string_view tag) {
    const double kp = xml_.number(*e_, "kp").value_or(a_.gain[0]);
    double last = a_.bias[2];
    const bool by_ratio = e_->Attribute("dampratio") != nullptr;
    if (by_ratio && e_->Attribute("kv") != nullptr)
      xml_.fault(*e_, format("<{}> has both 'kv' and 'dampratio'", tag), "Leave one of them out.");
    if (e_->Attribute("kv") != nullptr) last = -not_negative("kv", 0.0);
    if (by_ratio) last = not_negative("dampratio", 0.0);
    set_law({kp, 0.0, 0.0}, {0.0, -kp, last});
    if (tag == "intvelocity") {
      a_.dynamics = "integrator";
      return;
    }
    if (a_.dynamics != "filterexact") {
      a_.dynamics = "none";
      a_.time = 1.0;
    }
    if (e_->Attribute("timeconst") == nullptr) return;
    number("timeconst", a_.time);
    a_.dynamics = a_.time != 0.0 ? "filterexact" : "none";
  }

  void set_law(std::vector<double> gain, std::vector<double> bias) {
    a_.gain = std::move(gain);
    a_.bias = std::move(bias);
    a_.bias.resize(3, 0.0);
  }

  double not_negative(const char* attribute, double standard) {
    const double value = xml_.number(*e_, attribute).value_or(standard);
    if (value >= 0.0) return value;
    xml_.fault(*e_, format("'{}' of <{}> is {}", attribute, e_->Name(), value),
               "Give a value that is not negative.");
    return 0.0;
  }

  XmlFile& xml_;
  MjcfActuator a_;
  std::string kind_ = "general";  ///< Of the tag before.
  const XmlFile::Element* e_ = nullptr;
};

}  // namespace

std::vector<double> MjcfActuator::Range::active(bool automatic) const {
  const bool is =
      limited == "auto" ? automatic && !bounds.empty() && bounds[0] < bounds[1] : limited == "true";
  return is ? bounds : std::vector<double>();
}

bool is_actuator(std::string_view tag) {
  return std::find(kActuatorTags.begin(), kActuatorTags.end(), tag) != kActuatorTags.end();
}

MjcfActuator actuator_values(MjcfFile& file, const XmlFile::Element& e) {
  ActuatorSum sum(file);
  const std::vector<const XmlFile::Element*> blocks = file.blocks_of(e, "");
  for (auto block = blocks.rbegin(); block != blocks.rend(); ++block)
    for (const XmlFile::Element* d = (*block)->FirstChildElement(); d != nullptr;
         d = d->NextSiblingElement())
      if (is_actuator(d->Name())) sum.add(*d);
  sum.add(e);
  return sum.take(e);
}

std::vector<MjcfActuator> actuators_of(MjcfFile& file) {
  std::vector<MjcfActuator> list;
  for (const XmlFile::Element* section : file.sections("actuator"))
    for (const XmlFile::Element* e = section->FirstChildElement(); e != nullptr;
         e = e->NextSiblingElement()) {
      file.xml.mark_read(*e);
      list.push_back(actuator_values(file, *e));
    }
  return list;
}

}  // namespace polhode::io
