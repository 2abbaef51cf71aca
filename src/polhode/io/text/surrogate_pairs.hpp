// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace polhode::io {

/// Text in which the escapes of JSON for characters beyond U+FFFF are those of YAML.
///
/// JSON, and so Python, writes such a character in quotes as two escapes, \ud83d\ude00; YAML knows
/// only the single escape \U0001F600, which is two columns shorter.
class SurrogatePairs {
 public:
  explicit SurrogatePairs(std::string_view text);

  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] bool none() const { return ends_.empty(); }
  /// Column in the given text of a column in text(); lines and columns count from 0.
  [[nodiscard]] int column(int line, int column) const;

 private:
  std::string text_;
  std::vector<std::pair<int, int>> ends_;  ///< Lines and columns behind the escapes in text_.
};

}  // namespace polhode::io
