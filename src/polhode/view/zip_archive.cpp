// SPDX-License-Identifier: Apache-2.0
#include <polhode/view/zip_archive.hpp>

#include <cstdint>
#include <limits>
#include <stdexcept>

#include <zlib.h>

#include <polhode/core/error.hpp>

namespace polhode {

namespace {

constexpr std::uint16_t kVersion = 20;       // deflated, folders
constexpr std::uint16_t kUtf8 = 0x0800;      // names
constexpr std::uint16_t kFirstDay = 0x0021;  // 1 January 1980
constexpr std::uint16_t kDeflated = 8;

/// Numbers in the byte order of the format.
class LittleEndian {
 public:
  LittleEndian& u16(std::size_t v) { return put(v, 2); }
  LittleEndian& u32(std::size_t v) { return put(v, 4); }
  LittleEndian& text(const std::string& s) {
    bytes_ += s;
    return *this;
  }
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  std::string take() { return std::move(bytes_); }

 private:
  LittleEndian& put(std::size_t v, int count) {
    for (int b = 0; b < count; ++b) bytes_ += static_cast<char>(v >> (8 * b));
    return *this;
  }
  std::string bytes_;
};

/// Raw deflate stream, without zlib's header and checksum.
std::string deflated(const std::string& bytes) {
  z_stream stream{};
  if (deflateInit2(&stream, 6, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::runtime_error("zip_archive: no memory to deflate");
  std::string packed(deflateBound(&stream, static_cast<uLong>(bytes.size())), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  const int state = deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  if (state != Z_STREAM_END) throw std::runtime_error("zip_archive: deflate has not ended");
  return packed;
}

/// Common data of the header of a file and its entry in the directory.
void add_description(LittleEndian& out, const ZipEntry& entry, std::size_t packed) {
  const uLong sum = crc32(0, reinterpret_cast<const Bytef*>(entry.bytes.data()),
                          static_cast<uInt>(entry.bytes.size()));
  out.u16(kVersion).u16(kUtf8).u16(kDeflated).u16(0).u16(kFirstDay).u32(sum).u32(packed);
  out.u32(entry.bytes.size()).u16(entry.name.size()).u16(0);
}

}  // namespace

std::string zip_archive(std::span<const ZipEntry> entries) {
  constexpr std::size_t kMax = std::numeric_limits<std::uint32_t>::max();
  const InputError too_large("the results", "exceed the 4 GB or 65535 files of a zip archive",
                             "Name fewer results, or show fewer frames with --frames");
  if (entries.size() > std::numeric_limits<std::uint16_t>::max()) throw too_large;
  LittleEndian archive, directory;
  for (const ZipEntry& entry : entries) {
    if (entry.bytes.size() > kMax) throw too_large;
    const std::string packed = deflated(entry.bytes);
    const std::size_t at = archive.size();
    if (at + packed.size() > kMax) throw too_large;
    archive.u32(0x04034b50);
    add_description(archive, entry, packed.size());
    archive.text(entry.name).text(packed);
    directory.u32(0x02014b50).u16(kVersion);
    add_description(directory, entry, packed.size());
    directory.u16(0).u16(0).u16(0).u32(0).u32(at).text(entry.name);
  }
  const std::size_t at = archive.size(), size = directory.size();
  archive.text(directory.take());
  archive.u32(0x06054b50).u16(0).u16(0).u16(entries.size()).u16(entries.size());
  archive.u32(size).u32(at).u16(0);
  return archive.take();
}

}  // namespace polhode
