// SPDX-License-Identifier: Apache-2.0
#include <polhode/model/event_spec.hpp>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
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
  const std::string what = contacts ? "joint, load, pair of contacts or body" : "joint or load";
  const char* kinds =
      contacts ? "Joints, loads, pairs and bodies that touch: " : "Joints and loads: ";
  return {name, format("unknown {} '{}'", what, name),
          did_you_mean(name, names) + (names.empty() ? "The model has neither joints nor loads"
                                                     : kinds + name_list(names))};
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
  return events;
}

}  // namespace polhode
