// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/read/read_context.hpp>
#include <polhode/simulation/probe_columns.hpp>

namespace polhode::io {

namespace {

void check_transfer_function(Section& section, const ControllerSpec& controller) {
  if (controller.numerator.empty() || controller.denominator.empty()) {
    if (!section.has("numerator") || !section.has("denominator"))
      section.fault("is an incomplete transfer function", "Give numerator and denominator.");
    return;
  }
  if (controller.denominator.front() == 0.0)
    section.fault("denominator", "begins with 0", "Leave the 0 out.");
  if (controller.numerator.size() > controller.denominator.size())
    section.fault("numerator", "is of higher order than the denominator",
                  "Give a denominator of the same order or above.");
}

void read_controller(ReadContext& context, const SourceNode& node, ControllerSpec& controller) {
  Section section(context, node, controller.place, "controllers." + controller.name,
                  controller_fields());
  if (!node.is_map()) return;
  const auto channel = read_channel(context, section);
  if (channel) controller.channel = channel->spec;
  if (const SourceNode* setpoint = channel ? section.find("setpoint") : nullptr) {
    Field field = controller_fields().at("setpoint");
    field.dimension = channel->dimension;
    controller.setpoint = read_time_number(context, *setpoint, section.path("setpoint"), field);
    const int outer = controller.setpoint ? controller.setpoint->controller() : -1;
    if (outer >= static_cast<int>(context.model.controllers.size()))
      section.fault("setpoint", "uses a controller that is listed later",
                    "List that controller first.");
  }
  section.read_into(controller);
  if (channel && !controller.sample && is_mean_of_step(channel->spec))
    section.fault("sample",
                  format("is missing: {} of a contact is a mean over the step, which a continuous "
                         "controller cannot use",
                         quote(channel->spec.name)),
                  "Give a sample time.");
  if (!(controller.least <= controller.most))
    section.fault("maximum", "is below the minimum", "Exchange them.");
  bool gains = false;
  for (const char* gain : {"proportional", "integral", "derivative"}) {
    gains = gains || section.has(gain);
    section.refuse_both(gain, "numerator", "Give gains or a transfer function.");
  }
  if (section.has("filter") && !section.has("derivative"))
    section.fault("filter", "requires a derivative gain", "Add derivative, or leave it out.");
  if (section.has("numerator") || section.has("denominator")) {
    check_transfer_function(section, controller);
  } else if (!gains && !section.has_unknown_key()) {
    section.fault("has no gains",
                  "Give proportional, integral or derivative, or numerator and denominator.");
  }
}

bool is_controlled(const TimeFunctionPtr& f) { return f && f->controller() >= 0; }

/// Rejects controllers of prescribed positions and velocities, which must not jump as controller
/// outputs do.
void refuse_controlled_motion(ReadContext& context) {
  const auto refuse = [&](const SourceLocation& place, const std::string& path) {
    context.diagnostics.add(place, path, "is prescribed, but the output of a controller may jump",
                            "Let the controller set a force or moment.");
  };
  const auto any = [](const auto& functions) {
    return std::any_of(functions.begin(), functions.end(), is_controlled);
  };
  for (const LoadSpec& load : context.model.loads)
    if ((load.type.ends_with("motor") || load.type == "rotor") && load.drive != "moment" &&
        load.drive != "force" && is_controlled(load.value))
      refuse(load.place, format("loads.{}.{}", load.name, load.drive));
  for (const JointSpec& joint : context.model.joints)
    if (joint.motion && (any(joint.motion->displacement) || any(joint.motion->parameters)))
      refuse(joint.place, format("joints.{}", joint.name));
  for (const SolidSpec& solid : context.model.solids)
    for (const PrescribedSpec& p : solid.prescribed)
      if (any(p.displacement))
        refuse(solid.place, format("solids.{}.prescribed.{}", solid.name, p.name));
}

}  // namespace

TimeFunctionPtr read_controlled_value(ReadContext& context, const SourceNode& node,
                                      const std::string& path) {
  Section section(context, node, context.tree.place_of(node), path, controlled_value_fields());
  const auto name = section.text("controller");
  if (!name) return nullptr;
  const std::vector<std::string>& names = context.controllers;
  const auto found = std::find(names.begin(), names.end(), *name);
  if (found == names.end()) {
    section.fault(
        "controller", "unknown controller " + quote(*name),
        did_you_mean(*name, names) + (names.empty() ? "A part has no controllers of its own."
                                                    : "Controllers: " + name_list(names) + "."));
    return nullptr;
  }
  return std::make_shared<ControlledValue>(static_cast<int>(found - names.begin()));
}

void read_controllers(ReadContext& context, const SourceNode& node) {
  for (std::size_t k = 0; k < node.keys.size(); ++k) {
    const SourceNode::Key& key = node.keys[k];
    ControllerSpec controller;
    controller.name = key.name;
    controller.place = context.tree.place_of(key, node.children[k]);
    if (check_name(context, key, node.children[k], "controllers"))
      read_controller(context, node.children[k], controller);
    context.model.controllers.push_back(std::move(controller));
  }
  refuse_controlled_motion(context);
}

}  // namespace polhode::io
