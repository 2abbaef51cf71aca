// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/results/folder_lock.hpp>

#include <filesystem>
#include <fstream>
#include <optional>

#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <support/scratch.hpp>

namespace polhode::folder_lock_tests {
namespace {

using testing::HasSubstr;

TEST(FolderLock, RefusesASecondRunByTheNameOfTheFirst) {
  const test::Scratch scratch;
  std::optional<io::FolderLock> first(std::in_place, scratch / "out", "crank.yaml");
  try {
    const io::FolderLock second(scratch / "out", "other.yaml");
    FAIL() << "locked twice";
  } catch (const InputError& error) {
    EXPECT_EQ(error.where(), scratch / "out");
    EXPECT_THAT(error.what(), HasSubstr(format("another run (process {}, model 'crank.yaml') is "
                                               "writing into it. Wait for its end, or name "
                                               "another folder for the results with -o.",
                                               ::getpid())));
  }
  EXPECT_TRUE(io::FolderLock::is_held(scratch / "out"));
  const io::FolderLock elsewhere(scratch / "out2", "other.yaml");
  first.reset();
  EXPECT_FALSE(io::FolderLock::is_held(scratch / "out"));
  EXPECT_TRUE(std::filesystem::is_empty(scratch / "out"));
  const io::FolderLock next(scratch / "out", "other.yaml");
}

// A file without a lock is what a killed run leaves.
TEST(FolderLock, IsFreeAfterAKill) {
  const test::Scratch scratch;
  std::filesystem::create_directory(scratch / "out");
  std::ofstream(scratch / "out/.polhode.lock") << "process 1, model 'gone.yaml'";
  EXPECT_FALSE(io::FolderLock::is_held(scratch / "out"));
  const io::FolderLock lock(scratch / "out", "crank.yaml");
}

}  // namespace
}  // namespace polhode::folder_lock_tests
