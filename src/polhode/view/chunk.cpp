// SPDX-License-Identifier: Apache-2.0
#include <polhode/view/chunk.hpp>

#include <bit>
#include <stdexcept>
#include <vector>

#include <zlib.h>

namespace polhode {

namespace {

std::string pack(const std::vector<std::uint32_t>& words, std::size_t width) {
  const std::size_t n = words.size();
  std::vector<unsigned char> bytes(4 * n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t delta = i < width ? words[i] : words[i] - words[i - width];
    for (std::size_t b = 0; b < 4; ++b)
      bytes[b * n + i] = static_cast<unsigned char>(delta >> (8 * b));
  }
  uLongf length = compressBound(static_cast<uLong>(bytes.size()));
  std::string packed(length, '\0');
  if (compress2(reinterpret_cast<Bytef*>(packed.data()), &length, bytes.data(),
                static_cast<uLong>(bytes.size()), 6) != Z_OK)
    throw std::runtime_error("pack_floats: no memory to deflate");
  packed.resize(length);
  return packed;
}

}  // namespace

std::string pack_floats(std::span<const double> values, std::size_t width) {
  std::vector<std::uint32_t> words;
  words.reserve(values.size());
  for (double v : values) words.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(v)));
  return pack(words, width);
}

std::string pack_integers(std::span<const std::uint32_t> values, std::size_t width) {
  return pack({values.begin(), values.end()}, width);
}

std::string unpack_words(std::string_view packed, std::size_t words, std::size_t width) {
  std::vector<unsigned char> bytes(4 * words);
  auto length = static_cast<uLongf>(bytes.size());
  if (uncompress(bytes.data(), &length, reinterpret_cast<const Bytef*>(packed.data()),
                 static_cast<uLong>(packed.size())) != Z_OK ||
      length != bytes.size())
    throw std::runtime_error("unpack_words: not that many packed words");
  std::string result(4 * words, '\0');
  std::vector<std::uint32_t> sum(width, 0);
  for (std::size_t i = 0; i < words; ++i) {
    std::uint32_t delta = 0;
    for (std::size_t b = 0; b < 4; ++b)
      delta |= static_cast<std::uint32_t>(bytes[b * words + i]) << (8 * b);
    std::uint32_t& word = sum[i % width];
    word += delta;
    for (std::size_t b = 0; b < 4; ++b) result[4 * i + b] = static_cast<char>(word >> (8 * b));
  }
  return result;
}

std::string base64(std::string_view bytes) {
  static constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = (group << 8) | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : kDigits[(group >> (18 - 6 * k)) & 63U];
  }
  return text;
}

}  // namespace polhode
