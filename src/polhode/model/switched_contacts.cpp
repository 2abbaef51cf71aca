// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/model/switched_contacts.hpp>

namespace polhode {

namespace {

/// Reason why a pair cannot be switched; empty if it can.
std::string not_of_bodies(const ContactPairSpec& pair) {
  if (pair.of_materials) return "is a pair of materials";
  for (const Side& side : {pair.a, pair.b})
    if (!side.is_body())
      return side.is_cable() ? "is the contact of a cable" : "is the contact of a solid";
  return {};
}

/// Whether a shape of a body takes part in contact.
bool touches(const BodySpec& body) {
  return std::any_of(body.shapes.begin(), body.shapes.end(), [&](const ShapeSpec& shape) {
    return shape.contact.touches.value_or(body.contact.touches.value_or(true));
  });
}

}  // namespace

std::optional<std::array<int, 2>> switched_contact(const Model& model, const std::string& name) {
  const auto named = [&](const auto& thing) { return thing.name == name; };
  const auto is_there = [&](const auto& list) {
    return std::any_of(list.begin(), list.end(), named);
  };
  const bool joint = is_there(model.joints), other = joint || is_there(model.loads);
  const std::vector<ContactPairSpec>& pairs = model.contacts.pairs;
  const auto found = std::find_if(pairs.begin(), pairs.end(), named);
  if (found == pairs.end()) {
    if (other || !model.contacts.present) return std::nullopt;
    const auto body = std::find_if(model.bodies.begin(), model.bodies.end(), named);
    if (body == model.bodies.end() || !touches(*body)) return std::nullopt;
    return std::array{static_cast<int>(body - model.bodies.begin()), kEverySide};
  }
  if (other)
    throw InputError(name,
                     format("'{}' is a pair of contacts and a {}", name, joint ? "joint" : "load"),
                     "Rename one of them");
  const std::string no_bodies = not_of_bodies(*found);
  if (!no_bodies.empty())
    throw InputError(name, format("'{}' {}, which cannot be switched", name, no_bodies),
                     "Name a pair of bodies in contacts.pairs");
  return std::array{found->a.index, found->b.index};
}

int switched_controller(const Model& model, const std::string& name) {
  const auto named = [&](const auto& thing) { return thing.name == name; };
  if (std::any_of(model.joints.begin(), model.joints.end(), named) ||
      std::any_of(model.loads.begin(), model.loads.end(), named) || switched_contact(model, name))
    return -1;
  const auto found = std::find_if(model.controllers.begin(), model.controllers.end(), named);
  return found == model.controllers.end() ? -1
                                          : static_cast<int>(found - model.controllers.begin());
}

}  // namespace polhode
