// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include <zlib.h>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/solids/mesh/vtk_array.hpp>

namespace polhode::solids {
namespace {

struct NumberType {
  const char* name;
  std::size_t size;
  bool whole;
  bool has_sign;
};

constexpr std::array<NumberType, 10> kTypes{{{"Int8", 1, true, true},
                                             {"UInt8", 1, true, false},
                                             {"Int16", 2, true, true},
                                             {"UInt16", 2, true, false},
                                             {"Int32", 4, true, true},
                                             {"UInt32", 4, true, false},
                                             {"Int64", 8, true, true},
                                             {"UInt64", 8, true, false},
                                             {"Float32", 4, false, true},
                                             {"Float64", 8, false, true}}};

/// Position of an array, for messages.
struct Site {
  MeshCursor& in;
  const XmlTag& tag;
  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(in.text_place(tag.at), format("array '{}': {}", tag["Name"], what),
                     kExportMeshAgain);
  }
};

std::uint64_t bits_at(std::string_view bytes, std::size_t at, std::size_t size, bool big_endian) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t place = big_endian ? size - 1 - i : i;
    value |= std::uint64_t(static_cast<unsigned char>(bytes[at + place])) << (8 * i);
  }
  return value;
}

int sextet(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+') return 62;
  return c == '/' ? 63 : -1;
}

/// Byte sequence, raw or from base64. Separately encoded parts, with padding in between, are
/// concatenated.
class Bytes {
 public:
  Bytes(std::string_view text, bool base64) : text_(text), base64_(base64) {}

  /// The next n bytes; nothing if there are fewer.
  std::optional<std::string> take(std::size_t n) {
    if (!base64_) {
      if (text_.size() - at_ < n) return std::nullopt;
      at_ += n;
      return std::string(text_.substr(at_ - n, n));
    }
    if (n / 3 * 4 > text_.size() - at_ + 4) return std::nullopt;
    while (ready_.size() < n)
      if (!decode_four()) return std::nullopt;
    std::string result = ready_.substr(0, n);
    ready_.erase(0, n);
    return result;
  }
  /// Drops the rest of the last four characters decoded: a new part starts a new group.
  void next_part() { ready_.clear(); }
  [[nodiscard]] std::size_t left() const { return text_.size() - at_; }

 private:
  bool decode_four() {
    int count = 0;
    std::uint32_t bits = 0;
    int padding = 0;
    while (count < 4) {
      if (at_ >= text_.size()) return false;
      const char c = text_[at_++];
      if (c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
      const int value = c == '=' ? 0 : sextet(c);
      if (value < 0 || (padding > 0 && c != '=')) return false;
      if (c == '=') ++padding;
      bits = bits << 6 | static_cast<std::uint32_t>(value);
      ++count;
    }
    for (int i = 0; i < 3 - padding; ++i) ready_ += static_cast<char>(bits >> (16 - 8 * i) & 0xFF);
    return padding < 3;
  }

  std::string_view text_;
  bool base64_;
  std::size_t at_ = 0;
  std::string ready_;
};

/// The bytes of an array of a known length.
std::string payload(const Site& site, Bytes bytes, const VtkEncoding& encoding,
                    std::size_t wanted) {
  const std::size_t h = encoding.wide_header ? 8 : 4;
  const auto header = [&](std::size_t n) {
    const auto raw = bytes.take(n * h);
    if (!raw) site.refuse("the data are cut short in their header, or are no base64");
    std::vector<std::uint64_t> values;
    for (std::size_t i = 0; i < n; ++i)
      values.push_back(bits_at(*raw, i * h, h, encoding.big_endian));
    return values;
  };
  const auto check_size = [&](std::uint64_t present) {
    if (present != wanted)
      site.refuse(format("{} bytes are expected, but {} are announced", wanted, present));
  };
  if (!encoding.compressed) {
    check_size(header(1)[0]);
    auto data = bytes.take(wanted);
    if (!data) site.refuse(format("the data are cut short: {} bytes are expected", wanted));
    return *data;
  }
  const std::vector<std::uint64_t> first = header(3);
  const std::uint64_t blocks = first[0], block_size = first[1], last_size = first[2];
  if (blocks == 0) {
    check_size(0);
    return {};
  }
  // Deflate compresses by less than 1100, so these limits keep memory in proportion to the file's
  // size.
  if (blocks > bytes.left() / h + 1 || wanted / 1100 > bytes.left())
    site.refuse(format("{} compressed blocks of {} bytes cannot fit the file", blocks, block_size));
  const std::uint64_t whole = last_size == 0 ? blocks : blocks - 1;
  // This order avoids overflow.
  if ((whole > 0 && block_size > wanted / whole) || last_size > wanted ||
      whole * block_size + last_size != wanted)
    site.refuse(format("{} bytes are expected, but {} blocks of {} and {} bytes are announced",
                       wanted, blocks, block_size, last_size));
  const std::vector<std::uint64_t> packed = header(blocks);
  bytes.next_part();
  std::string result;
  for (std::size_t b = 0; b < blocks; ++b) {
    if (packed[b] > bytes.left()) site.refuse("the data are cut short in a compressed block");
    const auto block = bytes.take(packed[b]);
    if (!block) site.refuse("the data are cut short in a compressed block");
    const std::uint64_t size = b + 1 == blocks && last_size > 0 ? last_size : block_size;
    const std::size_t begin = result.size();
    result.resize(begin + size);
    auto length = static_cast<uLongf>(size);
    const int status =
        uncompress(reinterpret_cast<Bytef*>(result.data() + begin), &length,
                   reinterpret_cast<const Bytef*>(block->data()), static_cast<uLong>(packed[b]));
    if (status != Z_OK || length != size)
      site.refuse(format("compressed block {} cannot be expanded", b + 1));
  }
  return result;
}

void decode(const Site& site, const std::string& bytes, const NumberType& type, bool big_endian,
            VtkArray& array) {
  for (std::size_t at = 0; at < bytes.size(); at += type.size) {
    const std::uint64_t bits = bits_at(bytes, at, type.size, big_endian);
    if (!type.whole) {
      array.reals.push_back(type.size == 4 ? std::bit_cast<float>(static_cast<std::uint32_t>(bits))
                                           : std::bit_cast<double>(bits));
      continue;
    }
    const std::size_t unused = 8 * (8 - type.size);
    if (type.has_sign)
      array.integers.push_back(static_cast<std::int64_t>(bits << unused) >> unused);
    else if (bits > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
      site.refuse(format("{} is too large a number", bits));
    else
      array.integers.push_back(static_cast<std::int64_t>(bits));
  }
}

void read_text(MeshCursor& in, const Site& site, std::size_t end, std::size_t count,
               VtkArray& array) {
  if (count > (end - in.at()) / 2 + 1)
    site.refuse(format("{} numbers are expected, but the text is too short for them", count));
  for (std::size_t i = 0; i < count; ++i) {
    const std::string_view word = in.word();
    if (word.empty() || in.token() >= end)
      site.refuse(format("{} numbers are expected, but {} are given", count, i));
    // The last number may touch the closing tag.
    const std::string_view text = word.substr(0, std::min(word.size(), end - in.token()));
    std::int64_t integer = 0;
    double real = 0.0;
    if (array.whole ? !parse_integer(text, integer) : !parse_number(text, real))
      in.refuse(format("array '{}': {} is no {} number", array.name, quote(text),
                       array.whole ? "whole" : "finite"),
                kExportMeshAgain);
    if (array.whole)
      array.integers.push_back(integer);
    else
      array.reals.push_back(real);
  }
  if (in.at() < end && in.word().size() > 0 && in.token() < end)
    in.refuse(format("array '{}' has more than the {} numbers expected", array.name, count),
              kExportMeshAgain);
  in.go_to(end);
}

}  // namespace

VtkArray read_vtk_array(MeshCursor& in, XmlTags& xml, const XmlTag& tag,
                        const VtkEncoding& encoding, std::size_t count) {
  const Site site{in, tag};
  const NumberType* type = nullptr;
  for (const NumberType& one : kTypes)
    if (tag["type"] == one.name) type = &one;
  if (!type) site.refuse(format("numbers of type {} are not supported", quote(tag["type"])));
  VtkArray array;
  array.name = tag["Name"];
  array.whole = type->whole;
  const std::string& form = tag["format"];
  const std::size_t begin = in.at();
  const std::size_t wanted = count * type->size;
  if (form == "ascii" || form == "binary") {
    if (tag.empty && count > 0)
      site.refuse(format("{} numbers are expected, but none given", count));
    const std::string_view text = tag.empty ? std::string_view{} : xml.text();
    const std::size_t end = tag.empty ? begin : in.at();
    if (form == "ascii") {
      in.go_to(begin);
      read_text(in, site, end, count, array);
    } else if (count > 0) {
      decode(site, payload(site, {text, true}, encoding, wanted), *type, encoding.big_endian,
             array);
    }
  } else if (form == "appended") {
    if (encoding.appended == 0) site.refuse("the file has no appended data");
    std::int64_t offset = 0;
    const std::string_view data = in.bytes().substr(encoding.appended);
    if (!parse_integer(tag["offset"], offset) || offset < 0 ||
        static_cast<std::uint64_t>(offset) > data.size())
      site.refuse(format("the offset {} lies outside of the appended data", quote(tag["offset"])));
    const Bytes bytes(data.substr(static_cast<std::size_t>(offset)), encoding.appended_base64);
    if (count > 0)
      decode(site, payload(site, bytes, encoding, wanted), *type, encoding.big_endian, array);
  } else {
    site.refuse(format("the format {} is not supported", quote(form)));
  }
  xml.skip(tag);
  return array;
}

}  // namespace polhode::solids
