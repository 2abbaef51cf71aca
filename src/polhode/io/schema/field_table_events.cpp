// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/schema/field_table.hpp>

namespace polhode {

using namespace dimensions;
using enum FieldKind;

const FieldTable& event_fields() {
  static const FieldTable table{
      "event",
      "Switches joints, loads and contacts off and on: at a time, or when a reported number "
      "crosses a value. "
      "An event at time 0 tells how the model starts. Positions are continuous, velocities too "
      "unless a joint closes or a drive begins.",
      {
          {.name = "at",
           .kind = kNumber,
           .dimension = kTime,
           .meaning = "The time. Or when.",
           .range = kNotNegative},
          {.name = "when",
           .kind = kSection,
           .meaning = "The condition: the event comes when it begins to hold.",
           .table = "condition"},
          {.name = "after",
           .kind = kText,
           .meaning = "Name of an event before which this one does not come.",
           .standard = "it may come from the start"},
          {.name = "off",
           .kind = kNames,
           .meaning = "Joints, loads, pairs and sensors of contacts, and bodies whose contacts all "
                      "cease to act."},
          {.name = "on", .kind = kNames, .meaning = "Likewise what begins to act."},
          {.name = "repeat",
           .kind = kBoolean,
           .meaning = "Comes each time the condition begins to hold, not only the first time.",
           .standard = "false"},
          {.name = "stop", .kind = kBoolean, .meaning = "Ends the run.", .standard = "false"},
      }};
  return table;
}

std::vector<Field> channel_fields() {
  std::vector<Field> list;
  for (Field field : probe_fields().fields) {
    if (field.name == "every" || field.name == "controller") continue;
    if (field.meaning.starts_with("Record ")) field.meaning.replace(0, 6, "Read");
    list.push_back(std::move(field));
  }
  list.push_back({.name = "channel",
                  .kind = kText,
                  .meaning = "The number, named as the column of such a probe: z, vz, 'rate rz', "
                             "fx, tension, gap; also the magnitudes speed, force and moment.",
                  .required = true});
  return list;
}

const FieldTable& condition_fields() {
  static const FieldTable table = [] {
    FieldTable t{
        "condition",
        "A reported number beyond a value. Give one of body, joint, load, solid, beam, cable "
        "and contact, and one of above and below.",
        channel_fields()};
    t.fields.insert(
        t.fields.end(),
        {
            {.name = "above",
             .kind = kNumber,
             .meaning = "The condition holds from here up. In the unit of the channel."},
            {.name = "below",
             .kind = kNumber,
             .meaning = "The condition holds from here down. In the unit of the channel."},
        });
    return t;
  }();
  return table;
}

const FieldTable& strength_fields() {
  static const FieldTable table{
      "strength",
      "Reaction at which a joint breaks: from then on it is gone. Give one of them or both.",
      {
          {.name = "force",
           .kind = kNumber,
           .dimension = kForce,
           .meaning = "Magnitude of the force.",
           .range = kPositive},
          {.name = "moment",
           .kind = kNumber,
           .dimension = kMoment,
           .meaning = "Magnitude of the moment at the joint's point.",
           .range = kPositive},
      }};
  return table;
}

}  // namespace polhode
