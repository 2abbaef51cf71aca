// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/results/results_reader.hpp>

#include <filesystem>
#include <fstream>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <polhode/io/results/write_results.hpp>
#include <polhode/io/text/file_error.hpp>
#include <support/scratch.hpp>

namespace polhode::results_reader_tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr int kBodies = 40;

/// Frame k, whose numbers are functions of k and their place.
io::ResultsFrame frame(int k) {
  io::ResultsFrame f;
  f.t = 0.5 * k;
  for (int i = 0; i < kBodies; ++i) {
    f.position.emplace_back(k, i, 0.25);
    f.velocity.emplace_back(-k, 1.0, 2.0);
    f.angular_velocity.emplace_back(k, 2.0 * k, 3.0 * k);
    f.orientation.emplace_back(1.0, 0.0, 0.0, 0.0);
  }
  f.balance.kinetic = k;
  return f;
}

void write(const std::string& path, int frames) {
  io::ResultsLayout layout;
  layout.title = "Test";
  for (int i = 0; i < kBodies; ++i) layout.bodies.push_back("b" + std::to_string(i));
  io::ResultsFile file(path, layout,
                       {.version = "1.2.3", .model_text = "format: 1\n", .overrides = {"L=2"}});
  for (int k = 0; k < frames; ++k) file.append(frame(k));
  file.conclude({"a reason", "and another"}, {"a warning"});
  file.close();
}

std::string message_of(const std::string& path) {
  try {
    const io::ResultsReader reader(path);
  } catch (const io::FileError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ResultsReader, ReadsWhatWasWritten) {
  const test::Scratch scratch;
  write(scratch / "results.h5", 7);
  const io::ResultsReader reader(scratch / "results.h5");
  EXPECT_EQ(reader.frames(), 7U);
  EXPECT_FALSE(reader.cut_short());
  EXPECT_THAT(reader.read("/time"), ElementsAre(0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0));
  EXPECT_THAT(reader.read("/time", 3), ElementsAre(0.0, 1.5, 3.0));
  EXPECT_EQ(reader.read("/packed/bodies/position")[3 * (2 * kBodies + 5)], 2.0);
  EXPECT_EQ(reader.read("/packed/bodies/position")[3 * (2 * kBodies + 5) + 1], 5.0);
  EXPECT_EQ(reader.names("/packed/bodies/names")[3], "b3");
  EXPECT_EQ(reader.attribute("/", "title"), "Test");
  EXPECT_EQ(reader.attribute("/provenance", "overrides"), "L=2");
  EXPECT_THAT(reader.names("/provenance/model"), ElementsAre("format: 1\n"));
  EXPECT_EQ(reader.find("/packed/bodies/position")->unit, "m");
  EXPECT_EQ(reader.find("/bodies/b0/position"), nullptr) << "views are not stored quantities";
}

/// Reads all of a file whose frames are those of frame(). @returns whether it holds frames.
bool frames_are_right(const std::string& path, std::size_t& frames) {
  std::string message;
  try {
    const io::ResultsReader reader(path);
    frames = reader.frames();
    EXPECT_GT(frames, 0U) << "an empty file is refused";
    EXPECT_THAT(reader.names("/provenance/model"), ElementsAre("format: 1\n"));
    EXPECT_EQ(reader.attribute("/provenance", "version"), "1.2.3");
    for (const auto& set : reader.data_sets())  // compared with their checksums
      EXPECT_EQ(reader.read(set.path).size(), frames * set.size()) << set.path;
    const std::vector<double> t = reader.read("/time"), r = reader.read("/packed/bodies/position");
    const std::vector<double> omega = reader.read("/packed/bodies/angular_velocity");
    for (std::size_t k = 0; k < t.size(); ++k) {
      EXPECT_EQ(t[k], 0.5 * static_cast<double>(k));
      EXPECT_EQ(r[3 * k * kBodies], static_cast<double>(k)) << "an incomplete frame";
      EXPECT_EQ(omega[3 * (k * kBodies + kBodies - 1) + 2], 3.0 * static_cast<double>(k));
    }
    return true;
  } catch (const io::FileError& error) {
    message = error.what();
  }
  EXPECT_THAT(message, testing::AnyOf(HasSubstr("is cut short, and has no complete frame"),
                                      HasSubstr("is damaged: its")));
  frames = 0;
  return false;
}

// A chunk is stored no later than its first frame, so that a cut takes frames from the end only.
TEST(ResultsReader, ReadsAFileCutShortUpToItsLastWholeFrame) {
  const test::Scratch scratch;
  constexpr std::size_t kFrames = 600;
  write(scratch / "results.h5", kFrames);
  const auto whole = std::filesystem::file_size(scratch / "results.h5");
  std::filesystem::copy_file(scratch / "results.h5", scratch / "cut.h5");
  std::size_t before = kFrames, readable = 0;
  constexpr std::size_t kCuts = 16;
  for (std::size_t cut = 0; cut < kCuts; ++cut) {
    const std::size_t length = cut == 0 ? whole - 1 : whole * (kCuts - cut) / kCuts;
    std::filesystem::resize_file(scratch / "cut.h5", length);
    std::size_t frames = 0;
    if (frames_are_right(scratch / "cut.h5", frames)) ++readable;
    EXPECT_LE(frames, before) << "a shorter file has no more frames";
    before = frames;
  }
  EXPECT_GE(readable, kCuts / 4) << "the first frames lie before the last quarter";
}

TEST(ResultsReader, ReportsErrorsInAFile) {
  const test::Scratch scratch;
  EXPECT_THAT(message_of(scratch / "missing.h5"), HasSubstr("cannot be read"));
  std::ofstream(scratch / "text.h5")
      << "format: 1, and no results at all, in a file with that ending\n";
  EXPECT_THAT(message_of(scratch / "text.h5"), HasSubstr("is no HDF5 file"));
  write(scratch / "results.h5", 2);
  const io::ResultsReader reader(scratch / "results.h5");
  try {
    (void)reader.read("/bodies/nobody");
    FAIL();
  } catch (const io::FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr("has no data set '/bodies/nobody'"));
  }
  std::filesystem::resize_file(scratch / "results.h5", 600);
  EXPECT_THAT(message_of(scratch / "results.h5"), HasSubstr("is damaged"));
}

/// Reads all of a file. @returns whether all numbers were those written; an error is none.
bool reads_all(const std::string& path, int& errors) {
  try {
    const io::ResultsReader reader(path);
    for (const io::ResultsReader::DataSet& set : reader.data_sets()) {
      const std::vector<double> values = reader.read(set.path);
      if (values.size() != reader.frames() * set.size()) return false;
      if (set.path != "/packed/bodies/position") continue;
      for (std::size_t k = 0; k < reader.frames(); ++k)
        for (std::size_t i = 0; i < kBodies; ++i)
          if (values[3 * (k * kBodies + i)] != static_cast<double>(k)) return false;
    }
    (void)reader.names("/packed/bodies/names");
    (void)reader.groups("/");
  } catch (const io::FileError&) {
    ++errors;
  }
  return true;
}

// Damage of a file ends in a message or in numbers that are right: never in a crash of the library
// that reads it, never in wrong numbers.
TEST(ResultsReader, SurvivesDamage) {
  const test::Scratch scratch;
  constexpr int kFrames = 40;
  write(scratch / "results.h5", kFrames);
  std::string good(std::filesystem::file_size(scratch / "results.h5"), '\0');
  std::ifstream(scratch / "results.h5", std::ios::binary)
      .read(good.data(), static_cast<std::streamsize>(good.size()));
  std::mt19937_64 random(39);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  int errors = 0, files = 0;
  const auto attack = [&](const std::string& bytes) {
    std::ofstream(scratch / "bad.h5", std::ios::binary | std::ios::trunc) << bytes;
    EXPECT_TRUE(reads_all(scratch / "bad.h5", errors)) << "file " << files;
    ++files;
  };
  for (int k = 0; k < 10; ++k) attack(good.substr(0, below(good.size())));
  for (int k = 0; k < 40; ++k) {
    std::string bad = good;
    for (std::size_t n = 0; n < (k % 2 == 0 ? 1 : 8); ++n) {
      char& byte = bad[below(k % 4 < 2 ? good.size() : 20000)];
      byte = static_cast<char>(byte ^ (1 << below(8)));
    }
    attack(bad);
  }
  EXPECT_GT(errors, files / 4);
}

TEST(ResultsReader, NamesTheFrameWhoseNumbersHaveChanged) {
  const test::Scratch scratch;
  write(scratch / "results.h5", 7);
  std::string bytes(std::filesystem::file_size(scratch / "results.h5"), '\0');
  std::ifstream(scratch / "results.h5", std::ios::binary)
      .read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  // Positions of frame 5: the body with number 17 has x = 5, y = 17, z = 0.25.
  const double wanted[] = {5.0, 17.0, 0.25};
  const std::size_t at =
      bytes.find(std::string(reinterpret_cast<const char*>(wanted), sizeof wanted));
  ASSERT_NE(at, std::string::npos);
  bytes[at + 6] = static_cast<char>(bytes[at + 6] ^ 1);
  std::ofstream(scratch / "bad.h5", std::ios::binary) << bytes;
  const io::ResultsReader reader(scratch / "bad.h5");
  EXPECT_EQ(reader.read("/packed/bodies/velocity").size(), 7U * kBodies * 3U);
  EXPECT_EQ(reader.read("/packed/bodies/position", 2).size(), 4U * kBodies * 3U);
  try {
    (void)reader.read("/packed/bodies/position");
    FAIL();
  } catch (const io::FileError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("is damaged: '/packed/bodies/position' differs from its checksum in "
                          "frame 5. Copy the file again, or run the model again."));
  }
}

}  // namespace
}  // namespace polhode::results_reader_tests
