// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/solids/mesh/mesh_cursor.hpp>

namespace polhode::solids {
namespace {

constexpr std::string_view kBlanks = " \t\r\n\v\f";

}  // namespace

std::string_view MeshCursor::word() {
  const std::size_t begin = bytes_.find_first_not_of(kBlanks, at_);
  if (begin == std::string_view::npos) {
    at_ = token_ = bytes_.size();
    return {};
  }
  std::size_t end = bytes_.find_first_of(kBlanks, begin);
  if (end == std::string_view::npos) end = bytes_.size();
  token_ = begin;
  at_ = end;
  return bytes_.substr(begin, end - begin);
}

std::string_view MeshCursor::line() {
  std::size_t end = bytes_.find('\n', at_);
  if (end == std::string_view::npos) end = bytes_.size();
  const std::string_view text = bytes_.substr(at_, end - at_);
  const std::size_t blanks = text.find_first_not_of(kBlanks);
  token_ = at_ + (blanks == std::string_view::npos ? 0 : blanks);
  at_ = std::min(end + 1, bytes_.size());
  return trimmed(text);
}

std::int64_t MeshCursor::integer(std::string_view what) {
  const std::string_view text = word();
  std::int64_t value = 0;
  if (text.empty()) refuse_end(what, false);
  if (!parse_integer(text, value))
    refuse(format("{} is expected here, but {} is no whole number", what, quote(text)),
           kExportMeshAgain);
  return value;
}

double MeshCursor::number(std::string_view what) {
  const std::string_view text = word();
  double value = 0.0;
  if (text.empty()) refuse_end(what, false);
  if (!parse_number(text, value))
    refuse(format("{} is expected here, but {} is no finite number", what, quote(text)),
           kExportMeshAgain);
  return value;
}

Vec3 MeshCursor::point(std::string_view what) {
  Vec3 x;
  for (double& coordinate : x) coordinate = number(what);
  return x;
}

std::size_t MeshCursor::count(std::int64_t announced, std::size_t bytes_each,
                              std::string_view things, bool in_binary) const {
  if (announced < 0)
    refuse(format("{} {} cannot be", announced, things), kExportMeshAgain, in_binary);
  const std::uint64_t most = left() / bytes_each + 1;
  if (static_cast<std::uint64_t>(announced) > most)
    refuse(format("{} {} are announced, but the {} bytes that follow cannot hold them", announced,
                  things, left()),
           "The file is cut short or damaged. Export the mesh again", in_binary);
  return static_cast<std::size_t>(announced);
}

std::string MeshCursor::text_place(std::size_t at) const {
  const std::string_view before = bytes_.substr(0, at);
  const auto line = std::count(before.begin(), before.end(), '\n') + 1;
  const std::size_t last = before.rfind('\n');
  return format("{}:{}:{}", name_, line, last == std::string_view::npos ? at + 1 : at - last);
}

std::string MeshCursor::binary_place(std::size_t at) const {
  return format("{}: byte {}", name_, at);
}

void MeshCursor::refuse(const std::string& what, const std::string& hint, bool in_binary) const {
  throw InputError(in_binary ? binary_place(token_) : text_place(token_), what, hint);
}

void MeshCursor::refuse_end(std::string_view expected, bool in_binary) const {
  throw InputError(in_binary ? binary_place(bytes_.size()) : text_place(bytes_.size()),
                   format("the file is cut short: it ends where {} is expected", expected),
                   kExportMeshAgain);
}

bool parse_integer(std::string_view text, std::int64_t& value) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && !text.empty();
}

bool parse_number(std::string_view text, double& value) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  if (text.empty()) return false;
  if (error == std::errc() && end == last) return std::isfinite(value);
  if (error == std::errc::result_out_of_range && end == last) {  // such as 1e-320 or 1e999
    value = std::strtod(std::string(text).c_str(), nullptr);
    return std::isfinite(value);
  }
  // Fortran writes 1.5D-3.
  std::string other(text);
  const std::size_t d = other.find_first_of("dD");
  if (d == std::string::npos) return false;
  other[d] = 'e';
  return other.find_first_of("dD") == std::string::npos && parse_number(other, value);
}

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return result;
}

std::string upper_case(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return result;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

}  // namespace polhode::solids
