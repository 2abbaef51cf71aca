// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <polhode/contact/contact_set.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// Switches contacts at the instant of a state, where velocities stay. The ledger books what they
/// stored as dissipated, what those store that begin as put in. @eq{switch-loss}
/// @param on, off  Numbers of the set's switches.
/// @returns shapes that overlap though their contact would begin, in words; the state is of no use
/// then.
[[nodiscard]] std::vector<std::string> switch_contacts(const System& system,
                                                       contact::ContactSet& contacts, State& state,
                                                       std::span<const int> on,
                                                       std::span<const int> off);

}  // namespace polhode
