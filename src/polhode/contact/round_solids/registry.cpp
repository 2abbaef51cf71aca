// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <polhode/contact/round_solids/cone.hpp>
#include <polhode/contact/round_solids/cylinder.hpp>
#include <polhode/contact/round_solids/ellipsoid.hpp>
#include <polhode/contact/round_solids/round_solid.hpp>

namespace polhode::contact {

std::span<const RoundSolid* const> round_solids() {
  static const std::array all{&cylinder_solid(), &cone_solid(), &ellipsoid_solid()};
  return all;
}

const RoundSolid* find_round_solid(std::string_view name) {
  const auto all = round_solids();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const RoundSolid* s) { return s->name == name; });
  return found == all.end() ? nullptr : *found;
}

}  // namespace polhode::contact
