// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/xml_parts.hpp>

#include <algorithm>
#include <string_view>

#include <polhode/core/format.hpp>

namespace polhode::io {

namespace {

/// Depth of each part: below the 100 of the parser.
constexpr int kPartDepth = 80;

/// End of what begins with '<' at a place: after its '>', outside of quotes.
std::size_t end_of_tag(std::string_view text, std::size_t at) {
  const auto after = [&](std::string_view end) {
    const std::size_t found = text.find(end, at);
    return found == std::string_view::npos ? text.size() : found + end.size();
  };
  const std::string_view rest = text.substr(at);
  if (rest.starts_with("<!--")) return after("-->");
  if (rest.starts_with("<![CDATA[")) return after("]]>");
  if (rest.starts_with("<?")) return after("?>");
  char quote = '\0';
  for (std::size_t k = at; k < text.size(); ++k) {
    const char c = text[k];
    if (quote != '\0') {
      if (c == quote) quote = '\0';
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '>') {
      return k + 1;
    }
  }
  return text.size();
}

/// Cuts a text.
class Cutter {
 public:
  explicit Cutter(std::string_view text) : text_(text), parts_(1), open_{0} {}

  std::optional<std::vector<std::string>> cut() {
    std::size_t at = 0;
    while (at < text_.size()) {
      const std::size_t tag = std::min(text_.find('<', at), text_.size());
      take(text_.substr(at, tag - at));
      if (tag == text_.size()) break;
      at = end_of_tag(text_, tag);
      const std::string_view whole = text_.substr(tag, at - tag);
      const char kind = whole.size() > 1 ? whole[1] : '\0';
      const bool closing = kind == '/', plain = kind == '!' || kind == '?';
      if (!closing && !plain && !whole.ends_with("/>")) {
        if (++depth_ > kDeepestXml) return std::nullopt;
        if (depth_ % kPartDepth == 0) begin_part();
      }
      take(whole);
      if (closing && depth_ > 0) {
        if (depth_ % kPartDepth == 0 && open_.size() > 1) end_part();
        --depth_;
      }
    }
    while (open_.size() > 1) end_part();  // Tags that are not closed.
    return std::move(parts_);
  }

 private:
  void take(std::string_view piece) {
    parts_[open_.back()] += piece;
    line_ += std::count(piece.begin(), piece.end(), '\n');
  }
  void begin_part() {
    parts_[open_.back()] += format("<{} number=\"{}\"", kPartTag, parts_.size());
    began_.push_back(line_);
    open_.push_back(parts_.size());
    parts_.emplace_back(static_cast<std::size_t>(line_), '\n');
  }
  void end_part() {
    open_.pop_back();
    parts_[open_.back()].append(static_cast<std::size_t>(line_ - began_.back()), '\n');
    parts_[open_.back()] += "/>";
    began_.pop_back();
  }

  std::string_view text_;
  std::vector<std::string> parts_;
  std::vector<std::size_t> open_;  ///< Numbers of the parts that contain the place.
  std::vector<std::ptrdiff_t> began_;
  std::ptrdiff_t line_ = 0;  ///< Ends of lines so far.
  int depth_ = 0;
};

}  // namespace

std::optional<std::vector<std::string>> xml_parts(const std::string& text) {
  return Cutter(text).cut();
}

}  // namespace polhode::io
