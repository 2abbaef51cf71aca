// SPDX-License-Identifier: Apache-2.0
#include "parquet.hpp"

#include <cstdlib>
#include <fstream>

#include <fcntl.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/results/results_format.hpp>
#include <polhode/io/text/file_error.hpp>
#include <polhode/io/text/output_file.hpp>
#include <polhode/view/channels.hpp>

#include "child_process.hpp"
#include "temporary_folder.hpp"

namespace polhode::cli {

namespace {

constexpr int kNoLibrary = 64;  ///< Exit code of the script if pyarrow is missing.

/// Script that reads a line of JSON and then the columns, eight bytes per number, and writes them.
constexpr const char* kScript = R"(
import json, sys
try:
    import pyarrow as pa, pyarrow.parquet as pq
except ImportError:
    sys.exit(64)
head = json.loads(sys.stdin.buffer.readline())
n = head["rows"]
columns = [pa.Array.from_buffers(pa.float64(), n, [None, pa.py_buffer(sys.stdin.buffer.read(8 * n))]) for _ in head["columns"]]
fields = [pa.field(name, pa.float64(), metadata={"unit": unit}) for name, unit in head["columns"]]
pq.write_table(pa.Table.from_arrays(columns, schema=pa.schema(fields, metadata=head["about"])), head["file"])
)";

std::string last_line(const std::string& file) {
  std::ifstream in(file);
  std::string line, last;
  while (std::getline(in, line))
    if (!line.empty()) last = line;
  return last;
}

}  // namespace

void write_parquet(const io::ResultsReader& results, const ProbeTables& probes,
                   const std::vector<std::string>& names, const std::string& file) {
  const char* wanted = std::getenv("POLHODE_PYTHON");
  const std::string python = find_program({wanted == nullptr ? "python3" : wanted});
  const InputError missing(
      "polhode convert", "a .parquet file is written by Python's pyarrow, which is missing",
      format("Install it, '{} -m pip install pyarrow', name another Python with "
             "POLHODE_PYTHON, or write a .csv file",
             python.empty() ? "python3" : python));
  if (python.empty()) throw missing;
  const auto [none, time, columns] = table_of(results, probes, names);
  io::UnfinishedFile unfinished(file);
  nlohmann::ordered_json head = {
      {"rows", time.size()},
      {"file", unfinished.path()},
      {"columns", nlohmann::ordered_json::array()},
      {"about",
       {{"title", results.attribute("/", "title")},
        {"polhode", results.attribute(io::results::kProvenance, "version")}}}};
  head["columns"].push_back({"t", "s"});
  for (const ChannelColumn& c : columns) head["columns"].push_back({c.name, c.unit});
  const TemporaryFolder folder;
  const std::string data = folder.path() + "/columns", log = folder.path() + "/log";
  {
    std::ofstream out(data, std::ios::binary);
    out << head.dump() << '\n';
    const auto put = [&](const std::vector<double>& values) {
      out.write(reinterpret_cast<const char*>(values.data()),
                static_cast<std::streamsize>(values.size() * sizeof(double)));
    };
    put(time);
    for (const ChannelColumn& c : columns) put(c.values);
    out.close();
    if (!out) throw io::FileError(data, "cannot be written", "Free disk space");
  }
  const int input = ::open(data.c_str(), O_RDONLY | O_CLOEXEC);
  ChildProcess child({python, "-c", kScript}, log, input);
  ::close(input);
  const int status = child.wait();
  if (status == kNoLibrary) throw missing;
  if (status != 0)
    throw io::FileError(file, format("cannot be written: {}", last_line(log)), "Name another file");
  unfinished.keep(false);
}

}  // namespace polhode::cli
