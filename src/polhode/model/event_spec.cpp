// SPDX-License-Identifier: Apache-2.0
#include <polhode/model/event_spec.hpp>

#include <algorithm>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/loads/registry.hpp>
#include <polhode/model/model.hpp>

namespace polhode {

namespace {

/// @param names  Of joints and loads.
InputError unknown_target(const Model& model, const std::string& name,
                          std::vector<std::string> names) {
  const bool contacts = model.contacts.present;
  for (const BodySpec& body : model.bodies)
    if (body.name == name)
      return {name, format("the body '{}' has no contact that could be switched", name),
              contacts ? "Give it a shape that touches" : "Add 'contacts: {}', or name a joint"};
  for (const ContactPairSpec& pair : model.contacts.pairs) names.push_back(pair.name);
  if (contacts)
    for (const BodySpec& body : model.bodies)
      if (!body.shapes.empty()) names.push_back(body.name);
  std::string what = contacts ? "joint, load, pair of contacts or body" : "joint or load";
  std::string kinds =
      contacts ? "Joints, loads, pairs and bodies that touch: " : "Joints and loads: ";
  if (!model.controllers.empty()) {
    for (const ControllerSpec& controller : model.controllers) names.push_back(controller.name);
    what = contacts ? "joint, load, controller, pair of contacts or body"
                    : "joint, load or controller";
    kinds = contacts ? "Joints, loads, controllers, pairs and bodies that touch: "
                     : "Joints, loads and controllers: ";
  }
  return {name, format("unknown {} '{}'", what, name),
          did_you_mean(name, names) + (names.empty() ? "The model has neither joints nor loads"
                                                     : kinds + name_list(names))};
}

bool is_in(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Refuses to switch a joint whose coordinate a coupling or inerter needs.
void refuse_coupled(const Model& model, const std::string& joint) {
  for (const LoadSpec& load : model.loads) {
    if (load.solid >= 0 || load_kind(load.type).switches) continue;
    const bool needs = load.joint == joint ||
                       std::any_of(load.others.begin(), load.others.end(),
                                   [&](const CoordinateSpec& o) { return o.joint == joint; });
    if (needs)
      throw InputError(joint,
                       format("'{}' is in the {} '{}', so it cannot be switched or break", joint,
                              load.type, load.name),
                       format("Leave the {} out, or let another joint break", load.type));
  }
}

/// Adds the loads in joints to the events that switch these.
void add_companions(const Model& model, std::vector<EventSpec>& events) {
  const std::vector<EventSpec> given = events;
  const auto any = [&](const auto& condition) {
    return std::any_of(given.begin(), given.end(), condition);
  };
  for (const LoadSpec& load : model.loads) {
    if (load.joint.empty() || load.words.contains("stays")) continue;
    if (load.solid < 0 && !load_kind(load.type).switches) continue;
    const bool named =
        any([&](const EventSpec& e) { return is_in(e.on, load.name) || is_in(e.off, load.name); });
    for (std::size_t k = 0; k < given.size(); ++k) {
      const EventSpec& event = given[k];
      if (is_in(event.on, load.name) || is_in(event.off, load.name)) continue;
      if (is_in(event.off, load.joint) || is_in(event.off, load.joint_2)) {
        events[k].off.push_back(load.name);
        continue;
      }
      const auto closed = [&](const std::string& joint) {  // after this event, for certain
        return joint.empty() || is_in(event.on, joint) ||
               !any([&](const EventSpec& e) { return is_in(e.off, joint); });
      };
      const bool closes = is_in(event.on, load.joint) || is_in(event.on, load.joint_2);
      if (!named && closes && closed(load.joint) && closed(load.joint_2))
        events[k].on.push_back(load.name);
    }
  }
}

}  // namespace

SwitchTarget switch_target(const Model& model, const std::string& name) {
  SwitchTarget found;
  int count = 0;
  std::vector<std::string> names;
  const auto look = [&](const auto& list, bool joint) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      names.push_back(list[i].name);
      if (list[i].name != name) continue;
      found = {joint, static_cast<int>(i)};
      ++count;
    }
  };
  look(model.joints, true);
  look(model.loads, false);
  if (count == 0) throw unknown_target(model, name, std::move(names));
  if (count > 1)
    throw InputError(name, format("'{}' is a joint and a load", name), "Rename one of them");
  if (!found.joint && model.loads[static_cast<std::size_t>(found.index)].solid < 0) {
    const LoadKind& kind = load_kind(model.loads[static_cast<std::size_t>(found.index)].type);
    if (!kind.switches)
      throw InputError(name, format("'{}' is a {}, which cannot be switched", name, kind.name),
                       kind.place == LoadPlace::row
                           ? "Use a gear, which can, where two coordinates suffice"
                           : "Let it act throughout");
  }
  if (found.joint) refuse_coupled(model, name);
  if (!found.joint && model.loads[static_cast<std::size_t>(found.index)].solid >= 0)
    throw InputError(name, format("'{}' is a load on a solid, which cannot be switched", name),
                     "Let its function of time be zero instead");
  return found;
}

std::vector<EventSpec> all_events(const Model& model) {
  std::vector<EventSpec> events = model.events;
  for (const JointSpec& joint : model.joints) {
    const auto add = [&](const char* what, const std::optional<double>& limit) {
      if (!limit) return;
      EventSpec event;
      event.name = format("{} breaks by {}", joint.name, what);
      event.place = joint.place;
      event.when = ConditionSpec{{{}, what}, *limit, true};
      event.when->channel.of.kind = "joint";
      event.when->channel.of.target = joint.name;
      event.off = {joint.name};
      events.push_back(std::move(event));
    };
    add("force", joint.breaks.force);
    add("moment", joint.breaks.moment);
  }
  add_companions(model, events);
  return events;
}

}  // namespace polhode
