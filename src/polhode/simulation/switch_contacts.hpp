// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <polhode/contact/contact_set.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// Switches contacts at the instant of a state; velocities are unchanged. In the ledger the energy
/// stored by switched-off contacts counts as dissipated, that of new ones as input.
/// @eq{switch-loss}
/// @param on, off  Numbers of the set's switches. @returns descriptions of shapes that overlap
/// though their contact would begin; the state is then unusable.
[[nodiscard]] std::vector<std::string> switch_contacts(const System& system,
                                                       contact::ContactSet& contacts, State& state,
                                                       std::span<const int> on,
                                                       std::span<const int> off);

}  // namespace polhode
