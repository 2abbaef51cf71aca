// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/model/switched_contacts.hpp>

namespace polhode {

namespace {

/// What keeps a pair from being switched; empty if nothing does.
std::string not_of_bodies(const ContactPairSpec& pair) {
  if (pair.of_materials) return "is a pair of materials";
  for (const int side : {pair.a, pair.b})
    if (is_surface_side(side))
      return is_cable_side(side) ? "is the contact of a cable" : "is the contact of a solid";
  return {};
}

}  // namespace

std::optional<int> switched_contact(const Model& model, const std::string& name) {
  const auto named = [&](const auto& thing) { return thing.name == name; };
  const auto is_there = [&](const auto& list) {
    return std::any_of(list.begin(), list.end(), named);
  };
  const std::vector<ContactPairSpec>& pairs = model.contacts.pairs;
  const auto found = std::find_if(pairs.begin(), pairs.end(), named);
  if (found == pairs.end()) return std::nullopt;
  if (is_there(model.joints) || is_there(model.loads))
    throw InputError(name,
                     format("'{}' is a pair of contacts and a {}", name,
                            is_there(model.joints) ? "joint" : "load"),
                     "Rename one of them");
  const std::string other = not_of_bodies(*found);
  if (!other.empty())
    throw InputError(name, format("'{}' {}, which is not switched", name, other),
                     "Name a pair of bodies in contacts.pairs");
  return static_cast<int>(found - pairs.begin());
}

}  // namespace polhode
