// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <sstream>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/results/results_format.hpp>
#include <polhode/io/text/file_error.hpp>
#include <polhode/view/report.hpp>

#include "command.hpp"
#include "console.hpp"
#include "film.hpp"
#include "temporary_folder.hpp"
#include "view_pages.hpp"

namespace polhode::cli {

namespace {

namespace fs = std::filesystem;

struct ReportOptions {
  std::string results, output;
  bool no_picture = false;
};

/// Cells of a line of a table that a run wrote; quotes around a cell are left out.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    if (line[k] == '"' && quoted && k + 1 < line.size() && line[k + 1] == '"') {
      cells.back() += line[++k];
    } else if (line[k] == '"') {
      quoted = !quoted;
    } else if (line[k] == ',' && !quoted) {
      cells.emplace_back();
    } else if (line[k] != '\r') {
      cells.back() += line[k];
    }
  }
  return cells;
}

/// Table of a probe. A last line that is cut short is left out.
ReportTable probe_table(const fs::path& file) {
  ReportTable table{file.stem().string(), {}, {}};
  std::istringstream lines(io::read_file(file.string()));
  std::string line;
  std::getline(lines, line);
  for (const std::string& head : cells_of(line)) {
    const std::size_t unit = head.rfind(" [");
    const bool has_unit = unit != std::string::npos && head.ends_with(']');
    table.columns.push_back({has_unit ? head.substr(0, unit) : head,
                             has_unit ? head.substr(unit + 2, head.size() - unit - 3) : "",
                             {}});
  }
  while (std::getline(lines, line)) {
    const std::vector<std::string> cells = cells_of(line);
    if (cells.size() != table.columns.size()) continue;
    for (std::size_t k = 0; k < cells.size(); ++k)
      table.columns[k].values.push_back(std::strtod(cells[k].c_str(), nullptr));
  }
  table.t = table.columns.front().values;
  table.columns.erase(table.columns.begin());
  return table;
}

/// Probes beside the results, by name.
std::vector<ReportTable> probes_beside(const std::string& results) {
  std::vector<ReportTable> probes;
  const fs::path folder = fs::absolute(results).parent_path() / "probes";
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none))
    if (entry.path().extension() == ".csv") probes.push_back(probe_table(entry.path()));
  std::sort(probes.begin(), probes.end(),
            [](const ReportTable& a, const ReportTable& b) { return a.name < b.name; });
  return probes;
}

/// Picture of the model at its start; empty, with a warning, where it cannot be drawn.
std::string picture_of(const std::string& results, double start) {
  const TemporaryFolder folder;
  FilmRequest request;
  request.results = results;
  request.output = folder.path() + "/pictures";
  request.width = 960;
  request.height = 540;
  request.from = request.to = start;
  try {
    write_film(request);
    return io::read_file(request.output + "/00000.png");
  } catch (const std::exception& error) {
    say(format("warning: the report has no picture of the model: {}", error.what()));
    return "";
  }
}

}  // namespace

Action add_report(CLI::App& command) {
  const auto options = std::make_shared<ReportOptions>();
  command.add_option("RESULTS", options->results, "Results (results.h5 or their folder)")
      ->required();
  command
      .add_option("-o,--output", options->output,
                  "Page (.html) or Markdown (.md, with a folder of pictures beside it); left out: "
                  "report.html in the folder of the results")
      ->type_name("FILE");
  command.add_flag("--no-picture", options->no_picture, "Leave out the picture of the model");
  return [options] {
    const std::string path = results_path(options->results);
    const io::ResultsReader results = open_results(path);
    const std::string file =
        options->output.empty()
            ? (fs::absolute(path).parent_path() / "report.html").lexically_normal().string()
            : options->output;
    const std::string kind = fs::path(file).extension().string();
    if (kind != ".html" && kind != ".md")
      throw InputError("polhode report", format("'{}' is no kind of report", kind),
                       "Name a file that ends with .html or .md");
    ReportRequest request;
    request.probes = probes_beside(path);
    request.time_label = time_label(results, path);
    if (!options->no_picture && results.frames() > 0)
      request.picture = picture_of(path, results.read(io::results::kTime).front());
    if (kind == ".html") {
      io::write_file_atomically(file, report_page(results, request), false);
    } else {
      const fs::path folder = fs::path(file).replace_extension().string() + "_pictures";
      const MarkdownReport report = report_markdown(results, request, folder.filename().string());
      io::make_folder(folder.string());
      for (const auto& [name, bytes] : report.pictures)
        io::write_file_atomically((folder / name).string(), bytes, false);
      io::write_file_atomically(file, report.text, false);
    }
    say(format("{}: {} frames, {} probes.", file, results.frames(), request.probes.size()));
    return static_cast<int>(kOk);
  };
}

}  // namespace polhode::cli
