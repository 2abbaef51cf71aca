// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/model/model.hpp>

namespace polhode {

/// Reason why runs of a model cannot be side by side in one system, a phrase such as "its steps
/// are automatic"; empty if they can. A step of one run must not depend on another run: no
/// contacts, stops, friction, events, controllers or automatic steps; and solids, beams and cables
/// have no gain by it.
[[nodiscard]] std::string why_alone(const Model& model);

/// Whether two models have the same bodies, joints and loads with other numbers, in the same
/// gravity, and the same steps and output times: the condition for runs side by side.
[[nodiscard]] bool same_mechanism(const Model& a, const Model& b);

/// Name that an object of the model of this number has in side_by_side().
[[nodiscard]] std::string name_side_by_side(std::size_t number, const std::string& name);

/// Models side by side in one: a forest, whose trees do not interact. Bodies, joints and loads of
/// each follow those of the one before. @param models  Not empty, each the same_mechanism().
[[nodiscard]] Model side_by_side(std::vector<Model> models);

}  // namespace polhode
