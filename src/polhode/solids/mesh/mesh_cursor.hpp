// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include <polhode/core/types.hpp>

namespace polhode::solids {

/// A position in the bytes of a mesh file, which may mix text and binary numbers.
///
/// Unreadable contents are rejected with their position: file:line:column in text, "file: byte n"
/// in binary parts.
class MeshCursor {
 public:
  MeshCursor(std::string name, std::string_view bytes) : name_(std::move(name)), bytes_(bytes) {}

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::string_view bytes() const { return bytes_; }
  [[nodiscard]] std::size_t at() const { return at_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }
  void go_to(std::size_t at) { at_ = token_ = at < bytes_.size() ? at : bytes_.size(); }

  /// Next word, after blanks and ends of lines; empty at the end of the file.
  std::string_view word();
  /// Rest of the line, without blanks at its ends; moves to the next line.
  std::string_view line();
  /// The next words as numbers. @param what  What is expected, for the message.
  std::int64_t integer(std::string_view what);
  double number(std::string_view what);
  Vec3 point(std::string_view what);

  /// Binary numbers; bytes are swapped if swap is set.
  template <class T>
  T binary(std::string_view what) {
    token_ = at_;
    if (left() < sizeof(T)) refuse_end(what, true);
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes_.data() + at_, sizeof(T));
    if (swap)
      for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(raw[i], raw[sizeof(T) - 1 - i]);
    at_ += sizeof(T);
    return std::bit_cast<T>(raw);
  }
  bool swap = false;

  /// Rejects an impossible count: each object takes some bytes of the remaining file.
  /// @param things  "nodes", for the message.
  std::size_t count(std::int64_t announced, std::size_t bytes_each, std::string_view things,
                    bool in_binary) const;

  /// Position of a byte in text, "name:line:column", or in binary, "name: byte n".
  [[nodiscard]] std::string text_place(std::size_t at) const;
  [[nodiscard]] std::string binary_place(std::size_t at) const;

  /// Rejects the last word or number.
  [[noreturn]] void refuse(const std::string& what, const std::string& hint,
                           bool in_binary = false) const;
  [[noreturn]] void refuse_end(std::string_view expected, bool in_binary) const;
  /// Start of the last word or number.
  [[nodiscard]] std::size_t token() const { return token_; }

 private:
  std::string name_;
  std::string_view bytes_;
  std::size_t at_ = 0;
  std::size_t token_ = 0;
};

/// Number of a complete text; false if it is none, or is not finite.
[[nodiscard]] bool parse_integer(std::string_view text, std::int64_t& value);
[[nodiscard]] bool parse_number(std::string_view text, double& value);

/// In lower or upper case, letters of ASCII only.
[[nodiscard]] std::string lower_case(std::string_view text);
[[nodiscard]] std::string upper_case(std::string_view text);
/// Text without blanks at its ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

inline constexpr const char* kExportMeshAgain =
    "Export the mesh again from the program that made it";

/// Largest accepted coordinate [file's unit].
inline constexpr double kLargestCoordinate = 1e30;

}  // namespace polhode::solids
