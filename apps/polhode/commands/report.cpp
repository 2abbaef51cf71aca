// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <filesystem>
#include <memory>

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
    const ProbeTables probes(path);
    for (const std::string& name : probes.names()) request.probes.push_back(probes.read(name));
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
