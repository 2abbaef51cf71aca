// SPDX-License-Identifier: Apache-2.0
// Every file in tests/corpus/broken is refused with the message in the file beside it, and every
// file in tests/corpus/good is read. A broken file NAME.yaml may have overrides in NAME.set, one a
// line.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include <polhode/io/read/read_model.hpp>
#include <support/paths.hpp>

namespace polhode::corpus_tests {
namespace {

namespace fs = std::filesystem;

const fs::path kCorpus = fs::path(test::source_dir()) / "tests" / "corpus";

std::string content(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return std::move(text).str();
}

std::vector<fs::path> models(const char* folder) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(kCorpus / folder))
    if (entry.path().extension() == ".yaml" || entry.path().extension() == ".json")
      paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  return paths;
}

fs::path beside(fs::path path, const char* extension) { return path.replace_extension(extension); }

io::Overrides overrides_of(const fs::path& path) {
  io::Overrides overrides;
  std::istringstream lines(content(beside(path, ".set")));
  for (std::string line; std::getline(lines, line);) overrides.push_back(line);
  return overrides;
}

TEST(Corpus, ContainsAtLeastSixtyInvalidModels) { EXPECT_GE(models("broken").size(), 60U); }

/// Mesh files are named as seen from the model's folder.
class WorkingFolder {
 public:
  explicit WorkingFolder(const fs::path& folder) : before_(fs::current_path()) {
    fs::current_path(folder);
  }
  ~WorkingFolder() { fs::current_path(before_); }
  WorkingFolder(const WorkingFolder&) = delete;
  WorkingFolder& operator=(const WorkingFolder&) = delete;

 private:
  fs::path before_;
};

TEST(Corpus, InvalidModelsAreRefusedWithTheirMessages) {
  const WorkingFolder folder(kCorpus / "broken");
  for (const fs::path& path : models("broken")) {
    SCOPED_TRACE(path.filename().string());
    try {
      const Model model =
          io::read_model_text(content(path), path.filename().string(), overrides_of(path));
      ADD_FAILURE() << "was read without an error";
    } catch (const io::ModelErrors& errors) {
      EXPECT_EQ(errors.text() + "\n", content(beside(path, ".txt")));
    }
  }
}

TEST(Corpus, GoodModelsAreRead) {
  for (const fs::path& path : models("good")) {
    SCOPED_TRACE(path.filename().string());
    EXPECT_NO_THROW(EXPECT_FALSE(io::read_model(path).bodies.empty()));
  }
}

/// A short run of what the fuzzer does: cuts, repetitions and exchanges in good models give a model
/// or located errors.
TEST(Corpus, DamagedModelsAreReadOrRefused) {
  unsigned seed = 20250101;
  const auto random = [&](std::size_t below) {
    seed = seed * 1664525U + 1013904223U;  // (Press et al. 2007, ranqd1)
    return static_cast<std::size_t>(seed >> 8) % below;
  };
  const std::string marks = "[]{}:,-?!&*#|>'\"%@ \n\t\x01\xC3/^()t0e.";
  for (const fs::path& path : models("good")) {
    const std::string good = content(path);
    for (int round = 0; round < 150; ++round) {
      std::string text = good;
      for (std::size_t change = 0; change <= random(4) && !text.empty(); ++change) {
        const std::size_t at = random(text.size()), n = random(30);
        switch (random(4)) {
          case 0:
            text.erase(at, n);
            break;
          case 1:
            text.insert(at, text.substr(random(text.size()), n));
            break;
          case 2:
            text[at] = marks[random(marks.size())];
            break;
          default:
            text.resize(at + 1);
            break;
        }
      }
      try {
        static_cast<void>(io::read_model_text(text, "damaged.yaml"));
      } catch (const io::ModelErrors& errors) {
        EXPECT_FALSE(errors.diagnostics().empty());
      }
    }
  }
}

}  // namespace
}  // namespace polhode::corpus_tests
