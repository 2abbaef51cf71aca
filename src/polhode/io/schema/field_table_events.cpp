// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/schema/field_table.hpp>
#include <polhode/model/event_spec.hpp>

namespace polhode::io {

using namespace dimensions;
using enum FieldKind;

const FieldTable& event_fields() {
  static const FieldTable table{
      "event",
      "Switches joints, loads, contacts and controllers off and on, at a time or when a channel "
      "crosses a value. An event at time 0 sets the initial state. Positions are continuous; "
      "velocities, too, unless a joint closes or a drive begins.",
      {
          {.name = "at",
           .kind = kNumber,
           .dimension = kTime,
           .meaning = "The time; or 'when'.",
           .range = kNotNegative},
          {.name = "when",
           .kind = kSection,
           .meaning = "The condition: the event occurs when it becomes true.",
           .table = "condition"},
          {.name = "after",
           .kind = kText,
           .meaning = "Name of an event before which this one cannot occur.",
           .standard = "it may occur from the start"},
          {.name = "off",
           .kind = kNames,
           .meaning = "Names to switch off: joints, loads, pairs and sensors of contacts, "
                      "bodies (all their contacts), and controllers. Loads in a joint go with it."},
          {.name = "on",
           .kind = kNames,
           .meaning = "Names to switch on. A controller begins anew, also if it is on."},
          {.name = "repeat",
           .kind = kBoolean,
           .meaning =
               "The event occurs each time the condition becomes true, not only the first time.",
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
                  .meaning = "The channel, named as the column of such a probe: z, vz, 'rate rz', "
                             "fx, tension, gap; also the magnitudes speed, force and moment.",
                  .required = true});
  return list;
}

const FieldTable& condition_fields() {
  static const FieldTable table = [] {
    FieldTable t{"condition",
                 "A channel above or below a value. Give one of body, joint, load, solid, beam, "
                 "cable, contact and momentum, and one of above and below.",
                 channel_fields()};
    t.fields.insert(
        t.fields.end(),
        {
            {.name = "above",
             .kind = kNumber,
             .meaning = "The condition holds above this value, in the unit of the channel."},
            {.name = "below",
             .kind = kNumber,
             .meaning = "The condition holds below this value, in the unit of the channel."},
        });
    return t;
  }();
  return table;
}

const FieldTable& strength_fields() {
  static const FieldTable table{
      "strength",
      "Reaction at which a joint breaks and is removed. Give one of them or both.",
      {
          {.name = "force",
           .kind = kNumber,
           .dimension = kForce,
           .meaning = "Magnitude of the force.",
           .range = kPositive,
           .member = &JointStrengthSpec::force},
          {.name = "moment",
           .kind = kNumber,
           .dimension = kMoment,
           .meaning = "Magnitude of the moment at the joint's point.",
           .range = kPositive,
           .member = &JointStrengthSpec::moment},
      }};
  return table;
}

}  // namespace polhode::io
