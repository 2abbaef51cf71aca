// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <optional>

#include <polhode/core/format.hpp>
#include <polhode/io/text/surrogate_pairs.hpp>

namespace polhode::io {
namespace {

/// Lengths of the escapes \ud83d\ude00 and \U0001F600.
constexpr int kOfJson = 12, kOfYaml = 10;

/// Lower ten bits of half a pair \uXXXX whose halves begin at `first`; nothing if it is none.
std::optional<unsigned> half_of_pair(std::string_view text, unsigned first) {
  if (text.size() < 6 || text[0] != '\\' || text[1] != 'u') return std::nullopt;
  unsigned code = 0;
  const auto [end, error] = std::from_chars(text.data() + 2, text.data() + 6, code, 16);
  if (error != std::errc() || end != text.data() + 6 || code < first || code >= first + 0x400)
    return std::nullopt;
  return code - first;
}

/// The character of a pair at the start of the text; nothing if there is none.
std::optional<unsigned> pair_at_start(std::string_view text) {
  const auto high = half_of_pair(text, 0xD800);
  const auto low = high ? half_of_pair(text.substr(6), 0xDC00) : std::nullopt;
  return low ? std::optional((0x10000u + (*high << 10)) | *low) : std::nullopt;
}

}  // namespace

SurrogatePairs::SurrogatePairs(std::string_view text) {
  if (text.find("\\ud") == text.npos && text.find("\\uD") == text.npos) {
    text_ = text;
    return;
  }
  text_.reserve(text.size());
  int line = 0, column = 0;
  bool quoted = false;  // in double quotes that were opened on this line, as JSON's are
  for (std::size_t k = 0; k < text.size();) {
    if (quoted && text[k] == '\\') {
      if (const auto code = pair_at_start(text.substr(k))) {
        text_ += format("\\U{:08X}", *code);
        column += kOfYaml;
        ends_.emplace_back(line, column);
        k += kOfJson;
        continue;
      }
      text_ += text[k++];  // with what it escapes, below
      ++column;
      if (k == text.size()) break;
    } else if (text[k] == '"') {
      quoted = !quoted;
    }
    if (text[k] == '\n') {
      ++line;
      column = 0;
      quoted = false;
    } else if ((text[k] & 0xC0) != 0x80) {
      ++column;  // the parser counts characters, not bytes
    }
    text_ += text[k++];
  }
}

int SurrogatePairs::column(int line, int column) const {
  const auto of_line = std::lower_bound(ends_.begin(), ends_.end(), std::pair(line, 0));
  const auto behind = std::upper_bound(of_line, ends_.end(), std::pair(line, column));
  return column + (kOfJson - kOfYaml) * static_cast<int>(behind - of_line);
}

}  // namespace polhode::io
