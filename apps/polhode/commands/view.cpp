// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "command.hpp"
#include "console.hpp"
#include "view_pages.hpp"

namespace polhode::cli {

namespace {

struct ViewOptions {
  ViewRequest request;
  std::vector<std::string> inputs;
  std::string html, zip;
  int port = 0;
  bool stay = false, quiet = false;
};

}  // namespace

Action add_view(CLI::App& command) {
  const auto options = std::make_shared<ViewOptions>();
  command
      .add_option("FILE", options->inputs,
                  "Results (results.h5 or their folder), or a model before it runs; a second one "
                  "is drawn transparent over the first")
      ->required();
  CLI::Option* html = command
                          .add_option("--html", options->html,
                                      "Write one page that opens without network or server, "
                                      "instead of serving it")
                          ->type_name("FILE");
  CLI::Option* zip = command
                         .add_option("--zip", options->zip,
                                     "Write an archive of pages, one for each FILE, that share "
                                     "the player")
                         ->type_name("FILE")
                         ->excludes(html);
  command.add_option("--frames", options->request.frames, "Show at most this many frames")
      ->type_name("N")
      ->check(CLI::PositiveNumber);
  command.add_option("--port", options->port, "Port to serve on; left out: any that is free")
      ->check(CLI::Range(1, 65535))
      ->excludes(html)
      ->excludes(zip);
  command.add_flag("--no-open", options->stay, "Do not open a browser");
  add_set_option(command, options->request.input);
  command.add_flag("--quiet", options->quiet, "Print errors only");
  return [options] {
    for (const std::string& input : options->inputs)
      if (is_results(input) && !options->request.input.overrides.empty()) {
        say("polhode view: --set changes a model, but results are given. Leave it out.");
        return static_cast<int>(kUsage);
      }
    if (!options->zip.empty()) {
      write_view_zip(options->request, options->inputs, options->zip, options->quiet);
      return static_cast<int>(kOk);
    }
    if (options->inputs.size() > 2) {
      say("polhode view: more than two recordings are given. Name two, or use --zip.");
      return static_cast<int>(kUsage);
    }
    options->request.input.file = options->inputs[0];
    if (options->inputs.size() == 2) options->request.compared = options->inputs[1];
    if (options->html.empty()) return serve_view(options->request, options->port, !options->stay);
    write_view(options->request, options->html, options->quiet);
    return static_cast<int>(kOk);
  };
}

}  // namespace polhode::cli
