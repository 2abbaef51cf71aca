// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace polhode {

/// Largest input file [bytes]: longer ones are refused rather than read until memory ends.
inline constexpr std::uint64_t kLargestInput = std::uint64_t{1} << 36;

/// Cause that prevents the reading of a file, and a hint.
struct InputFault {
  std::string what, hint;
};

/// Bytes of a regular file. A pipe or a device is a fault, since neither has to end.
/// @param bytes  Receives them.
/// @param most  Longest file that is read [bytes].
/// @returns a fault, or nothing.
[[nodiscard]] std::optional<InputFault> read_input(const std::string& path, std::string& bytes,
                                                   std::uint64_t most = kLargestInput);

}  // namespace polhode
