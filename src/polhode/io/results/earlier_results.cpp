// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/results/earlier_results.hpp>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <vector>

#include <polhode/io/results/results_format.hpp>
#include <polhode/io/text/file_error.hpp>

namespace polhode::io {

namespace {

namespace fs = std::filesystem;

void remove_file(const fs::path& path) {
  std::error_code error;
  if (fs::remove(path, error); error)
    throw FileError(path.string(), "is of an earlier run and cannot be removed: " + error.message(),
                    "Name another folder for the results with -o");
}

std::vector<fs::path> files_of(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code missing;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, missing))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

/// Whether a table is one of ours: its first column is the time.
bool is_our_table(const fs::path& path) {
  std::string head(5, '\0');
  std::ifstream(path).read(head.data(), static_cast<std::streamsize>(head.size()));
  return path.extension() == ".csv" && head == "t [s]";
}

}  // namespace

void remove_numbered_files(const std::string& folder, const std::string& extension,
                           std::size_t first) {
  for (const fs::path& path : files_of(folder)) {
    const std::string stem = path.stem().string();
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(stem.data(), stem.data() + stem.size(), number);
    const bool numbered = error == std::errc() && end == stem.data() + stem.size();
    if (numbered && stem.size() >= 6 && number >= first && path.extension() == "." + extension)
      remove_file(path);
  }
}

void clear_earlier_results(const std::string& folder) {
  const fs::path root(folder);
  // A checkpoint of the earlier run would be newer than the frames of this one.
  for (const char* name : {results::kFileName, "checkpoint.pst", "certificate.svg",
                           "certificate.json", "view.html", "report.html"})
    remove_file(root / name);
  for (const fs::path& path : {root / "probes", root / "certificate", root})
    for (const fs::path& file : files_of(path))
      if (is_our_table(file) && (path != root || file.filename() == "events.csv"))
        remove_file(file);
  for (const char* series : {"results", "solids", "lines", "contacts"}) {
    remove_file(root / "paraview" / (std::string(series) + ".pvd"));
    for (const char* extension : {"vtp", "vtu"})
      remove_numbered_files((root / "paraview" / series).string(), extension, 0);
  }
}

}  // namespace polhode::io
