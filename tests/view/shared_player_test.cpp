// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/error.hpp>
#include <polhode/view/shared_player.hpp>

#include <cstdint>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <polhode/view/scene.hpp>

namespace polhode::shared_player_tests {
namespace {

using testing::HasSubstr;
using testing::Not;

std::uint32_t number_at(const std::string& bytes, std::size_t at, int count) {
  std::uint32_t value = 0;
  for (int b = 0; b < count; ++b)
    value |= static_cast<std::uint32_t>(
                 static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(b)]))
             << (8 * b);
  return value;
}

/// Bytes of the file whose entry in the directory begins there, by zlib alone.
std::string unpacked(const std::string& archive, std::size_t entry) {
  const std::size_t head = number_at(archive, entry + 42, 4),
                    size = number_at(archive, entry + 24, 4);
  const std::size_t data =
      head + 30 + number_at(archive, head + 26, 2) + number_at(archive, head + 28, 2);
  std::string bytes(size, '\0');
  z_stream stream{};
  EXPECT_EQ(inflateInit2(&stream, -MAX_WBITS), Z_OK);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(archive.data() + data));
  stream.avail_in = number_at(archive, entry + 20, 4);
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(size);
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
  inflateEnd(&stream);
  EXPECT_EQ(crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(size)),
            number_at(archive, entry + 16, 4));
  return bytes;
}

TEST(ZipArchive, RefusesMoreFilesThanItsFormHolds) {
  EXPECT_THROW((void)zip_archive(std::vector<ZipEntry>(65536)), InputError);
}

TEST(ZipArchive, ReturnsItsFiles) {
  const std::vector<ZipEntry> files = {
      {"a.txt", "one"}, {"b/c.txt", std::string(100000, 'x') + "end"}, {"empty", ""}};
  const std::string archive = zip_archive(files);
  EXPECT_EQ(archive, zip_archive(files));
  EXPECT_LT(archive.size(), 1000u);
  const std::size_t end = archive.size() - 22;
  ASSERT_EQ(number_at(archive, end, 4), 0x06054b50u);
  ASSERT_EQ(number_at(archive, end + 10, 2), files.size());
  std::size_t entry = number_at(archive, end + 16, 4);
  for (const ZipEntry& file : files) {
    ASSERT_EQ(number_at(archive, entry, 4), 0x02014b50u);
    const std::size_t length = number_at(archive, entry + 28, 2);
    EXPECT_EQ(archive.substr(entry + 46, length), file.name);
    EXPECT_EQ(unpacked(archive, entry), file.bytes);
    entry += 46 + length;
  }
  EXPECT_EQ(entry, end);
}

const std::string kPage =
    "<meta content=\"script-src 'sha256-abc='; style-src 'x'\"><!--POLHODE-DATA-->"
    "<script>play()</script>\n<!--POLHODE-LATER--></body>";

TEST(SharedPages, ShareOneScript) {
  const std::vector<ZipEntry> files =
      shared_pages({{"one", "First <b>", kPage}, {"two", "Second", kPage}});
  ASSERT_EQ(files.size(), 4u);
  EXPECT_EQ(files[0].name, "one.html");
  EXPECT_THAT(files[0].bytes, HasSubstr("<script src=\"player.js\"></script>"));
  EXPECT_THAT(files[0].bytes, HasSubstr("script-src 'self' file:; style-src 'x'"));
  EXPECT_THAT(files[0].bytes, Not(HasSubstr("play()")));
  EXPECT_EQ(files[2].name, "player.js");
  EXPECT_EQ(files[2].bytes, "play()");
  EXPECT_EQ(files[3].name, "index.html");
  EXPECT_THAT(files[3].bytes, HasSubstr("<a href=\"two.html\">two</a> Second"));
  EXPECT_THAT(files[3].bytes, HasSubstr("First &#60;b>"));
  EXPECT_THROW(static_cast<void>(shared_pages({{"one", "", "<p>no script</p>"}})),
               std::invalid_argument);
}

TEST(ScenePage, HasTheComparedSceneBeforeAndLaterChunksAfterThePlayer) {
  SceneData scene, other;
  scene.manifest = other.manifest = "{}";
  scene.chunks = {"a", "b"};
  scene.later = {1};
  other.chunks = {"c"};
  const std::string page = scene_page(kPage, scene, &other);
  const std::size_t script = page.find("<script>play()");
  EXPECT_LT(page.find("id=\"chunk-0\">YQ=="), script);
  EXPECT_LT(page.find("id=\"polhode-scene-1\">{}"), script);
  EXPECT_LT(page.find("id=\"chunk-1-0\">Yw=="), script);
  EXPECT_GT(page.find("id=\"chunk-1\">Yg=="), script);
  EXPECT_NE(page.find("id=\"chunk-1\">Yg=="), std::string::npos);
  // A player without that marker gets all data at its beginning.
  const std::string plain = scene_page("<!--POLHODE-DATA--><script>", scene);
  EXPECT_LT(plain.find("id=\"chunk-1\">Yg=="), plain.find("<script>"));
}

}  // namespace
}  // namespace polhode::shared_player_tests
