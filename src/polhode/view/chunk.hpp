// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace polhode {

/// Compressed numbers for the page: rows of `width` 32-bit words, each row minus the previous one
/// (modulo 2³²), the lowest bytes of all words first, then the next ones, deflated (zlib, RFC
/// 1950). It is lossless: the page sums rows up again. Slowly changing numbers have zeros in the
/// high bytes, which deflate well.
[[nodiscard]] std::string pack_floats(std::span<const double> values, std::size_t width);
[[nodiscard]] std::string pack_integers(std::span<const std::uint32_t> values, std::size_t width);
/// Inverse of pack_floats(). @throws std::runtime_error if the bytes are no such numbers.
[[nodiscard]] std::string unpack_words(std::string_view packed, std::size_t words,
                                       std::size_t width);

/// Base64 of bytes (RFC 4648).
[[nodiscard]] std::string base64(std::string_view bytes);

}  // namespace polhode
