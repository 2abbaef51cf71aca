// SPDX-License-Identifier: Apache-2.0
// Feeds damaged results files to the reader of results: a good file in which bytes are replaced.
// The only accepted outcomes are numbers and a FileError: no crash, no other exception.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

#include <polhode/io/results/results_reader.hpp>
#include <polhode/io/results/write_results.hpp>
#include <polhode/io/text/file_error.hpp>

namespace {

using namespace polhode;

std::string good_file(const std::string& path) {
  io::ResultsLayout layout;
  layout.title = "Fuzz";
  for (int i = 0; i < 3; ++i) layout.bodies.push_back("b" + std::to_string(i));
  {
    io::ResultsFile file(path, layout,
                         {.version = "1.2.3", .model_text = "format: 1\n", .overrides = {"L=2"}});
    for (int k = 0; k < 20; ++k) {
      io::ResultsFrame f;
      f.t = 0.5 * k;
      for (int i = 0; i < 3; ++i) {
        f.position.emplace_back(k, i, 0.25);
        f.velocity.emplace_back(-k, 1.0, 2.0);
        f.angular_velocity.emplace_back(k, 2.0 * k, 3.0 * k);
        f.orientation.emplace_back(1.0, 0.0, 0.0, 0.0);
      }
      file.append(f);
    }
    file.close();
  }
  std::string bytes(std::filesystem::file_size(path), '\0');
  std::ifstream(path, std::ios::binary)
      .read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string path =
      (std::filesystem::temp_directory_path() / ("fuzz-" + std::to_string(getpid()) + ".h5"))
          .string();
  static const std::string good = good_file(path);
  // Each six bytes: a place, and what stands there instead; the rest cuts the file.
  std::string bytes = good;
  for (; size >= 6; data += 6, size -= 6) {
    std::uint32_t at = 0;
    std::memcpy(&at, data, 3);
    const std::size_t place = at % bytes.size();
    for (std::size_t k = 0; k < 3 && place + k < bytes.size(); ++k)
      bytes[place + k] = static_cast<char>(data[3 + k]);
  }
  if (size >= 3) bytes.resize((data[0] + 256U * data[1] + 65536U * data[2]) % bytes.size());
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
  try {
    const io::ResultsReader reader(path);
    for (const io::ResultsReader::DataSet& set : reader.data_sets()) {
      try {
        if (reader.read(set.path).size() != reader.frames() * set.size()) std::abort();
        (void)reader.read(set.path, 7);
      } catch (const io::FileError&) {
      }
    }
    (void)reader.names("/packed/bodies/names");
    (void)reader.names("/provenance/model");
    (void)reader.groups("/bodies");
    (void)reader.attribute("/", "title");
  } catch (const io::FileError&) {
  }
  return 0;
}
