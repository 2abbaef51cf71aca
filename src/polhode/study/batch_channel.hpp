// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/model/model.hpp>

namespace polhode {

/// Channel of a batch, recorded of every run: columns of a body, a joint, a load or a probe.
struct BatchChannel {
  std::string text;                    ///< As asked: "bodies.rod.position", "probes.tip.x".
  std::string unit;                    ///< Of its first number; "-" for none.
  ProbeSpec of{};                      ///< The object; only a probe of the model has a name.
  std::vector<std::size_t> columns{};  ///< Among those of probe_columns(), without the time.
  bool one = false;                    ///< A single number, not a list of one.
};

/// Channel from its text: bodies.NAME.QUANTITY of the centre of mass (position, velocity,
/// acceleration, orientation, angular_velocity, angular_acceleration; world axes, orientation as a
/// quaternion w x y z), joints.NAME.QUANTITY (coordinates, rates, force, moment),
/// probes.NAME for all its columns, or any column of these and of loads by its name, such as
/// joints.A.rz, loads.spring.length or probes.tip.x. One number of a vector is named by .x, .y, .z,
/// .w, or by its number from 0.
/// @throws InputError if the model has no such object, or that no such quantity.
[[nodiscard]] BatchChannel batch_channel(const Model& model, const std::string& text);

/// Default channels of a model: its probes, or, without any, positions and
/// orientations of its moving bodies.
[[nodiscard]] std::vector<std::string> usual_channels(const Model& model);

}  // namespace polhode
