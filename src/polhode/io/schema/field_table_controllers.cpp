// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/schema/field_table.hpp>
#include <polhode/model/controller_spec.hpp>

namespace polhode::io {

using namespace dimensions;
using enum FieldKind;

const FieldTable& controller_fields() {
  static const FieldTable table = [] {
    FieldTable t{
        "controller",
        "Computes a value from the error setpoint - channel, for loads and cables that name it. "
        "Give one of body, joint, load, solid, beam, cable and contact, and gains or a transfer "
        "function. Gains and limits are in SI and radians, whatever 'units' says.",
        channel_fields()};
    t.fields.insert(
        t.fields.end(),
        {
            {.name = "setpoint",
             .kind = kTimeNumber,
             .meaning = "Setpoint, in the unit of the channel.",
             .standard = "0"},
            {.name = "sample",
             .kind = kNumber,
             .dimension = kTime,
             .meaning = "Sample time; the output is constant between samples.",
             .standard = "it is continuous",
             .range = kPositive,
             .member = &ControllerSpec::sample},
            {.name = "proportional",
             .kind = kNumber,
             .meaning = "Proportional gain, of the error.",
             .standard = "0",
             .member = &ControllerSpec::proportional},
            {.name = "integral",
             .kind = kNumber,
             .meaning = "Integral gain, of the error's integral.",
             .standard = "0",
             .member = &ControllerSpec::integral},
            {.name = "derivative",
             .kind = kNumber,
             .meaning =
                 "Derivative gain, of the error's rate; for channels whose rate is available.",
             .standard = "0",
             .member = &ControllerSpec::derivative},
            {.name = "filter",
             .kind = kNumber,
             .dimension = kTime,
             .meaning = "Time constant of a first-order filter of that rate.",
             .standard = "0",
             .range = kNotNegative,
             .member = &ControllerSpec::filter},
            {.name = "numerator",
             .kind = kNumberList,
             .meaning = "Numerator of a transfer function instead of gains: polynomial in s, the "
                        "highest power first.",
             .member = &ControllerSpec::numerator},
            {.name = "denominator",
             .kind = kNumberList,
             .meaning = "Denominator of the transfer function, of the same order or higher.",
             .member = &ControllerSpec::denominator},
            {.name = "minimum",
             .kind = kNumber,
             .meaning = "Limits of the output. The integral stops there.",
             .standard = "none",
             .member = &ControllerSpec::least},
            {.name = "maximum",
             .kind = kNumber,
             .meaning = "Likewise.",
             .standard = "none",
             .member = &ControllerSpec::most},
        });
    return t;
  }();
  return table;
}

const FieldTable& controlled_value_fields() {
  static const FieldTable table{"controlled value",
                                "The output of a controller, as a value over time.",
                                {
                                    {.name = "controller",
                                     .kind = kText,
                                     .meaning = "Name of the controller.",
                                     .required = true},
                                }};
  return table;
}

}  // namespace polhode::io
