// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/text/diagnostics.hpp>

#include <algorithm>
#include <cctype>
#include <limits>
#include <tuple>

#include <polhode/core/format.hpp>

namespace polhode::io {
namespace {

constexpr std::size_t kMaxDiagnostics = 200;
constexpr std::size_t kLongestExcerpt = 160;

std::string joined_text(const std::vector<Diagnostic>& diagnostics) {
  std::string text;
  for (std::size_t k = 0; k < diagnostics.size() && k < kMaxDiagnostics; ++k) {
    if (k > 0) text += '\n';
    text += diagnostics[k].text();
  }
  if (diagnostics.size() > kMaxDiagnostics)
    text += format("\n... and {} more errors", diagnostics.size() - kMaxDiagnostics);
  return text;
}

bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

/// Displayed characters, not bytes.
std::size_t display_width(std::string_view s) {
  return static_cast<std::size_t>(
      std::count_if(s.begin(), s.end(), [](char c) { return !is_continuation(c); }));
}

/// Length of the bracketed, quoted or plain value that starts a text.
std::size_t value_length(std::string_view s) {
  if (s.empty()) return 1;
  if (s[0] == '"' || s[0] == '\'') {
    const std::size_t end = s.find(s[0], 1);
    return end == std::string_view::npos ? s.size() : end + 1;
  }
  int depth = 0;
  const bool bracketed = s[0] == '[' || s[0] == '{';
  for (std::size_t k = 0; k < s.size(); ++k) {
    const char c = s[k];
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') {
      --depth;
      if (bracketed && depth == 0) return k + 1;
      if (depth < 0) return std::max<std::size_t>(k, 1);
    }
    if (bracketed) continue;
    if (depth == 0 && c == ',') return std::max<std::size_t>(k, 1);
    if (c == ':' && (k + 1 == s.size() || s[k + 1] == ' ')) return std::max<std::size_t>(k, 1);
    if (c == '#' && k > 0 && s[k - 1] == ' ') {
      s = s.substr(0, k);
      break;
    }
  }
  if (bracketed) return 1;
  while (!s.empty() && std::isspace(static_cast<unsigned char>(s.back()))) s.remove_suffix(1);
  return std::max<std::size_t>(s.size(), 1);
}

}  // namespace

std::string Diagnostic::text() const {
  std::string head = place.file;
  if (place.line > 0) head += format(":{}:{}", place.line, place.column);
  std::string message = head + ": error: ";
  if (!path.empty()) message += path + ": ";
  message += what + ".";
  if (!hint.empty()) message += " " + hint;
  if (!excerpt.empty()) message += "\n" + excerpt;
  return message;
}

ModelErrors::ModelErrors(std::vector<Diagnostic> diagnostics)
    : std::invalid_argument(joined_text(diagnostics)), diagnostics_(std::move(diagnostics)) {}

SourceText::SourceText(std::string name, std::string text)
    : name_(std::move(name)), text_(std::move(text)) {
  line_starts_.push_back(0);
  for (std::size_t k = 0; k < text_.size(); ++k)
    if (text_[k] == '\n') line_starts_.push_back(k + 1);
}

std::size_t SourceText::offset(int line_number) const {
  if (line_number < 1 || static_cast<std::size_t>(line_number) > line_starts_.size())
    return text_.size();
  return line_starts_[static_cast<std::size_t>(line_number) - 1];
}

std::string_view SourceText::line(int number) const {
  const std::size_t start = offset(number);
  const auto next = static_cast<std::size_t>(std::max(number, 0));
  const std::size_t end =
      next < line_starts_.size() && number > 0 ? line_starts_[next] - 1 : text_.size();
  return std::string_view(text_).substr(start, end - start);
}

std::string SourceText::excerpt(int line_number, int column, int length) const {
  const std::string_view whole = line(line_number);
  if (column < 1 || whole.empty()) return {};
  std::size_t at = std::min(static_cast<std::size_t>(column) - 1, whole.size());
  const std::size_t reach =
      length > 0 ? static_cast<std::size_t>(length) : value_length(whole.substr(at));
  // A long line is cut around the error, between characters.
  std::size_t first = 0;
  std::string_view shown = whole;
  std::string_view before_cut, after_cut;
  if (shown.size() > kLongestExcerpt) {
    if (at > kLongestExcerpt / 2) {
      first = at - kLongestExcerpt / 2;
      while (first < at && is_continuation(whole[first])) ++first;
      before_cut = "...";
    }
    std::size_t last = std::min(first + kLongestExcerpt, whole.size());
    while (last < whole.size() && is_continuation(whole[last])) ++last;
    shown = whole.substr(first, last - first);
    if (last < whole.size()) after_cut = "...";
    at -= first;
  }
  std::string clean(shown);
  for (char& c : clean)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = ' ';
  if (!is_utf8(clean))
    for (char& c : clean)
      if (static_cast<unsigned char>(c) >= 0x80) c = '?';
  const std::size_t end = std::min(at + reach, shown.size());
  const std::size_t wide = end > at ? display_width(shown.substr(at, end - at)) : 1;
  const std::string margin(before_cut.size() + display_width(shown.substr(0, at)), ' ');
  return format("{:5} | {}{}{}\n      | {}^{}", line_number, before_cut, clean, after_cut, margin,
                std::string(wide > 0 ? wide - 1 : 0, '~'));
}

void Diagnostics::add(const SourceLocation& place, std::string path, std::string what,
                      std::string hint, int length) {
  if (!hint.empty() && hint.back() != '.') hint += '.';
  Diagnostic d{place, std::move(path), std::move(what), std::move(hint), ""};
  const std::size_t file = file_number(place.file);
  const SourceText& source = file == 0 || file > of_parts_.size() ? *source_ : *of_parts_[file - 1];
  if (place.line > 0) d.excerpt = source.excerpt(place.line, place.column, length);
  list_.push_back(std::move(d));
}

std::size_t Diagnostics::file_number(const std::string& name) const {
  if (name == source_->name()) return 0;
  std::size_t k = 0;
  while (k < of_parts_.size() && of_parts_[k]->name() != name) ++k;
  return k + 1;
}

void Diagnostics::take(const std::vector<Diagnostic>& faults) {
  list_.insert(list_.end(), faults.begin(), faults.end());
}

void Diagnostics::throw_if_any() {
  if (list_.empty()) return;
  const auto file = [&](const Diagnostic& d) {
    return d.place.line == 0 ? 0 : file_number(d.place.file);
  };
  std::stable_sort(list_.begin(), list_.end(), [&](const Diagnostic& a, const Diagnostic& b) {
    return std::tuple(file(a), a.place.line, a.place.column) <
           std::tuple(file(b), b.place.line, b.place.column);
  });
  // Errors of a file that is used as a part twice are reported once.
  const auto same = [](const Diagnostic& a, const Diagnostic& b) {
    return a.place.file == b.place.file && a.place.line == b.place.line &&
           a.place.column == b.place.column && a.path == b.path && a.what == b.what;
  };
  list_.erase(std::unique(list_.begin(), list_.end(), same), list_.end());
  throw ModelErrors(std::move(list_));
}

}  // namespace polhode::io
