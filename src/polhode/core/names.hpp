// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace polhode {

/// Candidate closest to a mistyped word, or "" if none is close: at most a third of the letters
/// (and at least one) inserted, left out, replaced or swapped with a neighbour.
[[nodiscard]] std::string closest(std::string_view word,
                                  const std::vector<std::string>& candidates);

/// "Did you mean 'x'? " or nothing.
[[nodiscard]] std::string did_you_mean(std::string_view word,
                                       const std::vector<std::string>& candidates);

/// "a, b, c" with at most that many names, then "and 12 more".
[[nodiscard]] std::string name_list(const std::vector<std::string>& names, std::size_t most = 24);

/// A value quoted for a message: control characters shown, cut when long.
[[nodiscard]] std::string quote(std::string_view value);

/// Length of the UTF-8 sequence at the start of a text that is not empty; 0 if it is not one.
[[nodiscard]] std::size_t utf8_length(std::string_view text);
[[nodiscard]] bool is_utf8(std::string_view text);

}  // namespace polhode
