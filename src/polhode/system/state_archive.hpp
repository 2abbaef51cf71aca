// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <polhode/system/system.hpp>

namespace polhode {

/// Bytes of a complete state: little endian, bodies in the order of the system, so that the bytes
/// do not depend on slots or padding.
[[nodiscard]] std::string state_bytes(const System& system, const State& state);

/// State restored from these bytes, with bodies in the slots of this system.
/// @param where  First part of the message, e.g. the name of the file.
/// @throws InputError if the bytes belong to a system of other size, end too early, or hold a
/// number that no state has: a place in a list beyond its end, or a motion that is not finite.
[[nodiscard]] State state_from_bytes(const System& system, std::string_view bytes,
                                     std::string_view where);

/// state_bytes() followed by their SHA-256, for states that leave the program.
[[nodiscard]] std::string sealed_state(const System& system, const State& state);

/// State of these bytes. @throws InputError as state_from_bytes(), and for a wrong checksum.
[[nodiscard]] State state_from_sealed(const System& system, std::string_view bytes,
                                      std::string_view where);

/// SHA-256 of state_bytes(), 64 hexadecimal digits.
[[nodiscard]] std::string state_hash(const System& system, const State& state);

}  // namespace polhode
