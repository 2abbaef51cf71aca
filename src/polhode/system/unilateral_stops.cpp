// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/format.hpp>
#include <polhode/system/history_record.hpp>
#include <polhode/system/impulsive_contacts.hpp>
#include <polhode/system/unilateral_stops.hpp>

namespace polhode {

std::vector<UnilateralStop> unilateral_stops(const System& system) {
  std::vector<UnilateralStop> stops;
  for (const int i : system.unilateral()) {
    const InteractionRef& ref = system.interactions()[static_cast<std::size_t>(i)];
    const InteractionTraits& traits = system.traits(ref);
    for (int k = 0; k < traits.unilateral; ++k) {
      UnilateralStop& stop = stops.emplace_back();
      stop.interaction = i;
      stop.a = ref.a;
      stop.b = ref.b;
      stop.number = k;
      stop.memory = ref.first_history + traits.unilateral_entry +
                    k * static_cast<int>(kNumbersOf<UnilateralMemory>);
    }
  }
  return stops;
}

bool has_unilateral_rows(const System& system) {
  return !system.unilateral().empty() || are_rows(system.contacts().get());
}

std::string stop_name(const System& system, int interaction) {
  const InteractionRef& ref = system.interactions()[static_cast<std::size_t>(interaction)];
  return format("the stop of {} '{}'", system.group(ref.group).kind(), system.name(ref));
}

std::string pair_name(const System& system, int a, int b) {
  const auto name = [&](int body) {
    return body == kGround
               ? std::string("the ground")
               : format("body '{}'", system.bodies()[static_cast<std::size_t>(body)].name);
  };
  return format("{} and {}", name(a), name(b));
}

}  // namespace polhode
