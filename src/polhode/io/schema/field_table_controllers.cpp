// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/schema/field_table.hpp>

namespace polhode {

using namespace dimensions;
using enum FieldKind;

const FieldTable& controller_fields() {
  static const FieldTable table = [] {
    FieldTable t{
        "controller",
        "Sets a number by the error setpoint - channel, for loads and cables that name it. Give "
        "one of body, joint, load, solid, beam, cable and contact, and gains or a transfer "
        "function. Gains and limits are in SI and radians, whatever 'units' says.",
        channel_fields()};
    t.fields.insert(
        t.fields.end(),
        {
            {.name = "setpoint",
             .kind = kTimeNumber,
             .meaning = "What the number should be. In the unit of the channel.",
             .standard = "0"},
            {.name = "sample",
             .kind = kNumber,
             .dimension = kTime,
             .meaning = "Time between samples; between them what it sets stands still.",
             .standard = "it is continuous",
             .range = kPositive},
            {.name = "proportional",
             .kind = kNumber,
             .meaning = "Gain of the error.",
             .standard = "0"},
            {.name = "integral",
             .kind = kNumber,
             .meaning = "Gain of its integral.",
             .standard = "0"},
            {.name = "derivative",
             .kind = kNumber,
             .meaning = "Gain of its rate, of a channel whose rate is reported too.",
             .standard = "0"},
            {.name = "filter",
             .kind = kNumber,
             .dimension = kTime,
             .meaning = "Time constant of a lag of that rate.",
             .standard = "0",
             .range = kNotNegative},
            {.name = "numerator",
             .kind = kNumberList,
             .meaning = "Instead of gains: polynomial in s, the highest power first."},
            {.name = "denominator", .kind = kNumberList, .meaning = "Likewise, of no lower order."},
            {.name = "minimum",
             .kind = kNumber,
             .meaning = "Of what it sets. The integral stands still there.",
             .standard = "none"},
            {.name = "maximum", .kind = kNumber, .meaning = "Likewise.", .standard = "none"},
        });
    return t;
  }();
  return table;
}

const FieldTable& controlled_value_fields() {
  static const FieldTable table{"controlled value",
                                "What a controller sets, where a number over time may stand.",
                                {
                                    {.name = "controller",
                                     .kind = kText,
                                     .meaning = "Name of the controller.",
                                     .required = true},
                                }};
  return table;
}

}  // namespace polhode
