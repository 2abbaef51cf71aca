// SPDX-License-Identifier: Apache-2.0
// Endless, damaged and hostile input of the program, and disks without space.
#include <cstring>

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <polhode/core/sha256.hpp>

#include "command_line.hpp"

namespace polhode::damage_cli_tests {
namespace {

using test::CommandLine;
using testing::HasSubstr;

TEST_F(CommandLine, RefusesPipesAndDevicesAsInput) {
  ASSERT_EQ(mkfifo((folder_ / "pipe.yaml").c_str(), 0600), 0);
  ASSERT_EQ(mkfifo((folder_ / "pipe.h5").c_str(), 0600), 0);
  for (const char* command : {"run", "check", "info"}) {
    const auto result = run({command, "pipe.yaml"});
    EXPECT_EQ(result.code, 5) << command;
    EXPECT_EQ(result.err,
              "pipe.yaml: is a pipe or a device, not a file. Write its content into a file, and "
              "name that.\n");
  }
  EXPECT_EQ(run({"check", "/dev/zero"}).code, 5);
  EXPECT_EQ(run({"convert", "pipe.h5", "a.csv"}).code, 5);
  const auto restart = run({"run", "model.yaml", "--restart", "/dev/zero"});
  EXPECT_EQ(restart.code, 5);
  EXPECT_THAT(restart.err, HasSubstr("/dev/zero: is a pipe or a device, not a file."));
}

TEST_F(CommandLine, RefusesAForgedCheckpoint) {
  ASSERT_EQ(run({"run", "model.yaml", "-o", "r", "--quiet"}).code, 0);
  std::string bytes = read("r/checkpoint.pst");
  bytes.resize(bytes.size() - 64);
  // Every number of the state in turn, with a valid checksum: refused, or a run that ends.
  int tried = 0;
  for (std::size_t at = 88; at + 8 <= bytes.size(); at += 8 * 11) {
    std::string forged = bytes;
    const std::int64_t place = 992;
    std::memcpy(forged.data() + at, &place, 8);
    write("forged.pst", forged + sha256_hex(forged));
    const auto result = run({"run", "model.yaml", "-o", "again", "--restart", "forged.pst",
                             "--quiet", "--set", "analysis.duration=1.1"});
    EXPECT_GE(result.code, 0) << "byte " << at << ": " << result.err;
    EXPECT_NE(result.code, 1) << "byte " << at << ": " << result.err;
    ++tried;
  }
  EXPECT_GT(tried, 10);
}

TEST_F(CommandLine, ReadsTheEscapesThatPythonWritesForAnEmoji) {
  write(
      "emoji.json",
      R"({"format": 1, "title": "\ud83d\ude00", "bodies": {"a": {"mass": 1, "inertia": [1, 1, 1]}},
            "analysis": {"duration": 1, "step": 0.1}})");
  const auto result = run({"run", "emoji.json", "-o", "r"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.err + result.out, HasSubstr("\xF0\x9F\x98\x80"));
}

// A limit of the size of files, whose signal is ignored, fails as a full disk does.
TEST_F(CommandLine, EndsWithAMessageWhenTheDiskIsFullAtTheStart) {
  for (const char* kilobytes : {"1", "4", "16", "40"}) {
    const std::string command = std::string("trap '' XFSZ; ulimit -f ") + kilobytes + "; exec '" +
                                test::cli_program() + "' run model.yaml -o full --quiet";
    const auto result = test::Program({"/bin/bash", "-c", command}, folder_ / "").wait();
    EXPECT_EQ(result.code, 5) << kilobytes << ": " << result.err;
    EXPECT_THAT(result.err, HasSubstr("written")) << kilobytes;
  }
}

TEST_F(CommandLine, ReportsDamagedResults) {
  ASSERT_EQ(run({"run", "model.yaml", "-o", "r", "--quiet"}).code, 0);
  const std::string good = read("r/results.h5");
  for (int part = 1; part < 8; ++part) {
    write("bad.h5", good.substr(0, good.size() * static_cast<std::size_t>(part) / 8));
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"convert", "bad.h5", "a.csv"},
          {"plot", "bad.h5", "energy"},
          {"view", "bad.h5", "--html", "a.html", "--quiet"}}) {
      const auto result = run(command);
      EXPECT_TRUE(result.code == 0 || result.code == 3 || result.code == 5)
          << command[0] << " " << part << "/8: " << result.code << " " << result.err;
      if (result.code == 0) {
        EXPECT_THAT(result.err, HasSubstr("bad.h5 is cut short: only ")) << command[0];
      }
    }
  }
}

}  // namespace
}  // namespace polhode::damage_cli_tests
