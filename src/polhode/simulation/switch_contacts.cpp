// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/simulation/separate_overlaps.hpp>
#include <polhode/simulation/switch_contacts.hpp>

namespace polhode {

std::vector<std::string> switch_contacts(const System& system, contact::ContactSet& contacts,
                                         State& state, std::span<const int> on,
                                         std::span<const int> off) {
  if (on.empty() && off.empty()) return {};
  const std::vector<BodyStep> instants = instants_of(system, state);
  const double stored = contacts.stored(state, instants);
  contacts.switch_over(state, off, true);
  const double kept = contacts.stored(state, instants);
  if (!on.empty()) {
    std::vector<std::string> overlaps = contacts.overlaps_if_on(state, instants, on);
    if (!overlaps.empty()) return overlaps;
    contacts.switch_over(state, on, false);
  }
  state.ledger.dissipated.add(std::max(0.0, stored - kept));
  state.ledger.put_in.add(std::max(0.0, contacts.stored(state, instants) - kept));
  return {};
}

}  // namespace polhode
