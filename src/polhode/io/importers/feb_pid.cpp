// SPDX-License-Identifier: Apache-2.0
// PID controllers of an FEBio file.
#include <algorithm>
#include <charconv>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/feb_curves.hpp>

namespace polhode::io {

namespace {

/// A coordinate of a rigid body, as `fem.rigidbody('name').position.x` or with `[0]` as the body.
struct BodyParameter {
  std::string body;  ///< Its name; "" if a number is given.
  int number = -1;
  std::string channel;  ///< "" if the parameter is another one.
};

BodyParameter body_parameter(std::string text) {
  std::erase(text, ' ');
  BodyParameter result;
  std::string_view rest = text;
  const auto takes = [&](std::string_view start) {
    if (!rest.starts_with(start)) return false;
    rest.remove_prefix(start.size());
    return true;
  };
  takes("fem.");
  if (!takes("rigidbody")) return result;
  const bool by_name = rest.starts_with("(");
  const std::size_t end = rest.find(by_name ? ')' : ']');
  if (end == std::string_view::npos || (!by_name && !rest.starts_with("["))) return result;
  std::string_view inside = rest.substr(1, end - 1);
  rest.remove_prefix(end + 1);
  if (by_name) {
    if (inside.size() < 3 || inside.front() != inside.back() ||
        (inside.front() != '\'' && inside.front() != '"'))
      return result;
    result.body = inside.substr(1, inside.size() - 2);
  } else {
    const char* last = inside.data() + inside.size();
    if (const auto read = std::from_chars(inside.data(), last, result.number);
        read.ec != std::errc() || read.ptr != last || result.number < 0)
      return result;
  }
  if (takes(".position.") && (rest == "x" || rest == "y" || rest == "z")) result.channel = rest;
  return result;
}

}  // namespace

void FebCurves::read_pid(const XmlFile::Element& e, Controller& controller) {
  controller.channel = file_.text(e, "var");
  controller.target = file_.number(e, "target").value_or(0.0);
  const char* const gains[] = {"Kp", "Ki", "Kd"};
  for (std::size_t k = 0; k < 3; ++k) controller.gains[k] = file_.number(e, gains[k]).value_or(0.0);
  controller.usable = !body_parameter(controller.channel).channel.empty();
  if (!controller.usable)
    file_.refuse(e, format("a PID controller of {} is not read", quote(controller.channel)),
                 "Let it read fem.rigidbody('name').position.x, y or z, or add a controller to the "
                 "model.");
}

SourceNode FebCurves::pid_node(const NodeBuilder& make, const FebValue& value, double factor) {
  if (window || !dynamic) {
    file_.refuse(
        *value.at,
        format("a PID controller in {} is not read", dynamic ? "one of several steps" : "statics"),
        "Use it in dynamics, in all steps, or add a controller to the model.");
    return make.number(0.0);
  }
  auto found = std::find_if(controlled_.begin(), controlled_.end(), [&](const Controlled& c) {
    return c.id == *value.controller && c.factor == factor;
  });
  if (found == controlled_.end()) {
    const auto same = std::count_if(controlled_.begin(), controlled_.end(),
                                    [&](const Controlled& c) { return c.id == *value.controller; });
    std::string name = format("pid{}", *value.controller);
    if (same > 0) name += format("_{}", same + 1);
    controlled_.push_back({*value.controller, factor, std::move(name), value.at});
    found = controlled_.end() - 1;
  }
  SourceNode node = make.map();
  make.put(node, "controller", make.text(found->name));
  return node;
}

void FebCurves::write_controllers(const std::map<std::string, std::string>& bodies,
                                  const std::vector<std::string>& order, SourceNode& root) {
  if (controlled_.empty()) return;
  SourceNode section;
  for (const Controlled& c : controlled_) {
    const Controller& pid = controllers_.at(c.id);
    const NodeBuilder make = file_.make(*pid.at);
    if (section.keys.empty()) section = make.map();
    const BodyParameter parameter = body_parameter(pid.channel);
    const auto named = bodies.find(parameter.body);
    const auto number = static_cast<std::size_t>(std::max(0, parameter.number));
    const bool known = parameter.body.empty() ? number < order.size() : named != bodies.end();
    if (!known) {
      file_.xml.fault(*pid.at, format("there is no rigid body as in {}", quote(pid.channel)),
                      "Give the name of a material of type \"rigid body\", or its number from 0.");
      continue;
    }
    SourceNode node = make.map();
    make.put(node, "body", make.text(parameter.body.empty() ? order[number] : named->second));
    make.put(node, "channel", make.text(parameter.channel));
    make.put(node, "setpoint", make.number(pid.target));
    const char* const keys[] = {"proportional", "integral", "derivative"};
    for (std::size_t k = 0; k < 3; ++k)
      if (pid.gains[k] != 0.0) make.put(node, keys[k], make.number(c.factor * pid.gains[k]));
    if (node.keys.size() == 3) make.put(node, "proportional", make.number(0.0));
    make.put(section, c.name, std::move(node));
    file_.approximated(*pid.at,
                       format("the PID controller {} is continuous, where FEBio evaluates it once "
                              "a step",
                              quote(c.name)));
  }
  NodeBuilder{}.put(root, "controllers", std::move(section));
}

}  // namespace polhode::io
