// SPDX-License-Identifier: Apache-2.0
// Feeds arbitrary bytes to the readers of what a restarted run continues: the list of times of
// ParaView and tables of probes. The only accepted outcomes are a list and errors with messages.
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

#include <polhode/core/error.hpp>
#include <polhode/io/results/csv_probes.hpp>
#include <polhode/io/results/paraview_series.hpp>
#include <polhode/io/text/file_error.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace polhode;
  static const std::string folder =
      (std::filesystem::temp_directory_path() / ("fuzz-" + std::to_string(getpid()))).string();
  std::filesystem::create_directories(folder);
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const std::string header = "t [s],x [m]";
  std::ofstream(folder + "/series.pvd", std::ios::binary | std::ios::trunc) << bytes;
  std::ofstream(folder + "/probe.csv", std::ios::binary | std::ios::trunc) << header << '\n'
                                                                           << bytes;
  try {
    const io::ParaviewSeries series(folder, "series", "vtp", 1.0);
  } catch (const io::FileError&) {
  }
  try {
    io::CsvTable table(folder + "/probe.csv", {"t [s]", "x [m]"}, 1.0);
    table.append({2.0, 3.0});
  } catch (const io::FileError&) {
  } catch (const InputError&) {
  }
  return 0;
}
