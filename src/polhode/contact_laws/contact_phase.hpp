// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace polhode::contact {

/// Phases of a contact, from closing to opening.
enum class ContactPhase : unsigned char {
  rest,         ///< Resting contact.
  landing,      ///< Resting contact that has closed slowly and has not turned yet.
  compression,  ///< An impact before its turn.
  restitution,  ///< An impact after its turn.
};

}  // namespace polhode::contact
