// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <polhode/core/input_file.hpp>
#include <support/scratch.hpp>

namespace polhode::input_file_tests {
namespace {

std::string fault_of(const std::string& path, std::uint64_t most = kLargestInput) {
  std::string bytes;
  const auto fault = read_input(path, bytes, most);
  return fault ? fault->what : "";
}

TEST(InputFile, IsReadByteByByte) {
  const test::Scratch scratch;
  std::string text(200'000, 'a');
  text[100'000] = '\0';
  std::ofstream(scratch / "file", std::ios::binary) << text;
  std::string bytes;
  EXPECT_FALSE(read_input(scratch / "file", bytes));
  EXPECT_EQ(bytes, text);
  EXPECT_EQ(fault_of(scratch / "none"), "cannot be opened (No such file or directory)");
  EXPECT_EQ(fault_of(scratch / "."), "is a folder");
}

TEST(InputFile, MustBeAFileAndNotEndless) {
  const test::Scratch scratch;
  ASSERT_EQ(mkfifo((scratch / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(fault_of(scratch / "pipe"), "is a pipe or a device, not a file") << "without a writer";
  EXPECT_EQ(fault_of("/dev/zero"), "is a pipe or a device, not a file");
  EXPECT_EQ(fault_of("/dev/null"), "is a pipe or a device, not a file");
}

TEST(InputFile, IsRefusedBeforeItFillsTheMemory) {
  const test::Scratch scratch;
  std::ofstream(scratch / "sparse") << "a";
  std::filesystem::resize_file(scratch / "sparse", kLargestInput + 1);
  EXPECT_EQ(fault_of(scratch / "sparse"), "has 68719476737 bytes, more than 68719476736");
  std::ofstream(scratch / "ten") << "0123456789";
  EXPECT_EQ(fault_of(scratch / "ten", 10), "");
  EXPECT_EQ(fault_of(scratch / "ten", 9), "has 10 bytes, more than 9");
}

}  // namespace
}  // namespace polhode::input_file_tests
