// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/text/output_file.hpp>

#include <filesystem>
#include <fstream>
#include <thread>

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <polhode/io/text/file_error.hpp>
#include <support/program.hpp>
#include <support/scratch.hpp>

namespace polhode::output_file_tests {
namespace {

namespace fs = std::filesystem;
using test::text_of;
using testing::HasSubstr;

std::size_t files_in(const std::string& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(OutputFile, IsWrittenWholeAndLeavesNothingBeside) {
  const test::Scratch scratch;
  io::write_file_atomically(scratch / "a.csv", "one");
  io::write_file_atomically(scratch / "a.csv", "two", false);
  EXPECT_EQ(text_of(scratch / "a.csv"), "two");
  EXPECT_EQ(files_in(scratch / ""), 1U);
}

TEST(OutputFile, IsTheTargetOfLinksWhichStay) {
  const test::Scratch scratch;
  fs::create_directory(scratch / "far");
  fs::create_symlink("far/second", scratch / "first");
  fs::create_symlink("target.csv", scratch / "far/second");
  for (const char* text : {"new", "replaced"}) {  // at first the last link leads to nothing
    io::write_file_atomically(scratch / "first", text);
    EXPECT_EQ(text_of(scratch / "far/target.csv"), text);
    EXPECT_TRUE(fs::is_symlink(scratch / "first"));
    EXPECT_TRUE(fs::is_symlink(scratch / "far/second"));
  }
  fs::create_symlink("round", scratch / "round");
  EXPECT_THROW(io::write_file_atomically(scratch / "round", "x"), io::FileError);
}

TEST(OutputFile, DoesNotFollowALinkAtATemporaryName) {
  const test::Scratch scratch;
  std::ofstream(scratch / "victim") << "untouched";
  for (int k = 0; k < 3; ++k)
    fs::create_symlink("victim", scratch / ("a.csv." + std::to_string(::getpid()) + "-" +
                                            std::to_string(k) + ".unfinished"));
  io::write_file_atomically(scratch / "a.csv", "mine");
  EXPECT_EQ(text_of(scratch / "a.csv"), "mine");
  EXPECT_EQ(text_of(scratch / "victim"), "untouched");
}

TEST(OutputFile, KeepsTheAccessRightsOfTheOneItReplaces) {
  const test::Scratch scratch;
  io::write_file_atomically(scratch / "a.csv", "one");
  fs::permissions(scratch / "a.csv", fs::perms::owner_read | fs::perms::owner_write);
  io::write_file_atomically(scratch / "a.csv", "two");
  EXPECT_EQ(fs::status(scratch / "a.csv").permissions(),
            fs::perms::owner_read | fs::perms::owner_write);
}

TEST(OutputFile, OfAFifoIsReadAtItsOtherEnd) {
  const test::Scratch scratch;
  const std::string fifo = scratch / "fifo";
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  std::string got;
  std::thread reader([&] { got = text_of(fifo); });
  io::write_file_atomically(fifo, "through it");
  reader.join();
  EXPECT_EQ(got, "through it");
  EXPECT_TRUE(fs::is_fifo(fifo));
  std::thread second([&] { got = text_of(fifo); });
  {
    io::UnfinishedFile file(fifo);
    file.write("as a library writes it");
    file.keep(false);
  }
  second.join();
  EXPECT_EQ(got, "as a library writes it");
  EXPECT_EQ(files_in(scratch / ""), 1U);
}

TEST(OutputFile, OfADeviceLeavesItADevice) {
  const test::Scratch scratch;
  const std::string null = scratch / "null", link = scratch / "link";
  // The number of the null device, under a name of its own.
  if (::mknod(null.c_str(), S_IFCHR | 0600, makedev(1, 3)) != 0)
    GTEST_SKIP() << "only the administrator can make devices";
  fs::create_symlink("null", link);
  for (const std::string& path : {null, link}) {
    if (const int file = ::open(path.c_str(), O_WRONLY); file >= 0)
      ::close(file);
    else
      GTEST_SKIP() << "devices cannot be opened in this folder";
    io::write_file_atomically(path, "gone");
    EXPECT_TRUE(fs::is_character_file(fs::symlink_status(null)));
    EXPECT_TRUE(fs::is_symlink(link));
  }
  EXPECT_EQ(files_in(scratch / ""), 2U);
}

TEST(OutputFile, OfAnOpenFileIsAddedToIt) {
  const test::Scratch scratch;
  const int file = ::open((scratch / "log").c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
  ASSERT_GE(file, 0);
  ASSERT_EQ(::write(file, "before ", 7), 7);
  const std::string name = "/proc/self/fd/" + std::to_string(file);
  if (!fs::exists(name)) GTEST_SKIP() << "there is no /proc";
  io::write_file_atomically(name, "after");
  ::close(file);
  EXPECT_EQ(text_of(scratch / "log"), "before after");
}

TEST(OutputFile, IsNoFolderAndNeedsOne) {
  const test::Scratch scratch;
  try {
    io::write_file_atomically(scratch / "", "x");
    FAIL() << "written";
  } catch (const io::FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr("is a folder. Name a file."));
  }
  EXPECT_THROW(io::write_file_atomically(scratch / "no/such/file", "x"), io::FileError);
}

TEST(OutputFile, ThatAKilledProgramLeftIsRemovedAndNothingElse) {
  const test::Scratch scratch;
  for (const char* name : {"checkpoint.pst.1234-0.unfinished", "x.pvd.1-12.unfinished",
                           "mine.unfinished", "notes.a-b.unfinished", "results.h5"})
    std::ofstream(scratch / name) << "x";
  io::remove_unfinished_files(scratch / "");
  EXPECT_EQ(files_in(scratch / ""), 3U);
  io::remove_unfinished_files(scratch / "missing");
}

}  // namespace
}  // namespace polhode::output_file_tests
