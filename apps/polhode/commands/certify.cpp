// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>

#include <polhode/core/format.hpp>
#include <polhode/io/results/recorder.hpp>

#include "certify_report.hpp"
#include "command.hpp"
#include "console.hpp"
#include "run_report.hpp"

namespace polhode::cli {

namespace {

struct CertifyOptions {
  ModelArguments model;
  std::string folder, isa;
  CertifyRequest request;
  bool json = false;
};

int certify_file(CertifyOptions& options) {
  const Model model = load_model(options.model);
  CertifyRequest& request = options.request;
  const bool keep = !options.folder.empty();
  request.folder =
      keep ? options.folder
           : std::filesystem::path(options.model.file).replace_extension(".certificate").string();
  // With -o the results of the finest run are stored as by `run`.
  std::optional<io::Recorder> recorder;
  if (keep) {
    request.begin = [&](Simulation& s) {
      recorder.emplace(s, options.folder, provenance_of(options.model, s.summary()));
      recorder->step(s);
    };
    request.frame = [&](Simulation& s) { recorder->frame(s); };
    request.step = [&](Simulation& s) { recorder->step(s); };
    request.end = [&](Simulation& s) {
      recorder->frame(s);
      recorder->close();
      recorder.reset();
    };
  }
  const CertifyOutcome outcome = certify_model(model, request);
  if (options.json)
    print(outcome.json.dump(2) + "\n");
  else if (!request.quiet && !outcome.certificate.quantities.empty())
    print(certificate_table(outcome.certificate) +
          format("  Picture and tables: {}\n", request.folder));
  return outcome.exit_code;
}

}  // namespace

void add_within_option(CLI::App& command, CertifyRequest& request) {
  command
      .add_option("--within", request.within,
                  "Exit with 6 if an error bar is more than this part of its quantity's size")
      ->type_name("PART")
      ->check(CLI::Validator(
          [](const std::string& text) {
            return std::strtod(text.c_str(), nullptr) > 0.0 ? std::string()
                                                            : "must be above 0, but is " + text;
          },
          ""));
}

Action add_certify(CLI::App& command) {
  const auto options = std::make_shared<CertifyOptions>();
  command.add_option("MODEL", options->model.file, "Model file (YAML or JSON)")->required();
  command
      .add_option("-o,--output", options->folder,
                  "Folder for the certificate and the results of the finest run; left out: the "
                  "model's name with .certificate, and no results")
      ->type_name("DIR");
  add_set_option(command, options->model);
  add_isa_option(command, options->isa);
  add_within_option(command, options->request);
  add_wall_limit(command, options->request.wall_limit, "with exit code 75");
  command.add_flag("--json", options->json, "Print the certificate as one JSON object");
  command.add_flag("--quiet", options->request.quiet, "Print errors and warnings only");
  return [options] {
    if (!options->isa.empty()) options->model.overrides.push_back("analysis.isa=" + options->isa);
    return certify_file(*options);
  };
}

}  // namespace polhode::cli
