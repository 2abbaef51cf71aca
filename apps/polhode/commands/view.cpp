// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "command.hpp"
#include "console.hpp"
#include "view_pages.hpp"

namespace polhode::cli {

namespace {

struct Options {
  ViewRequest request;
  std::string html;
  int port = 0;
  bool stay = false, quiet = false;
};

}  // namespace

Action add_view(CLI::App& command) {
  const auto options = std::make_shared<Options>();
  command
      .add_option("FILE", options->request.input.file,
                  "Results (results.h5 or their folder), or a model before it runs")
      ->required();
  CLI::Option* html = command
                          .add_option("--html", options->html,
                                      "Write one page that opens without network or server, "
                                      "instead of serving it")
                          ->type_name("FILE");
  command.add_option("--frames", options->request.frames, "Show at most this many frames")
      ->type_name("N")
      ->check(CLI::PositiveNumber);
  command.add_option("--port", options->port, "Port to serve on; left out: any that is free")
      ->check(CLI::Range(1, 65535))
      ->excludes(html);
  command.add_flag("--no-open", options->stay, "Do not open a browser");
  add_set_option(command, options->request.input);
  command.add_flag("--quiet", options->quiet, "Say nothing but errors");
  return [options] {
    if (is_results(options->request.input.file) && !options->request.input.overrides.empty()) {
      say("polhode view: --set changes models, and this names results. Leave it out.");
      return static_cast<int>(kUsage);
    }
    if (options->html.empty()) return serve_view(options->request, options->port, !options->stay);
    write_view(options->request, options->html, options->quiet);
    return static_cast<int>(kOk);
  };
}

}  // namespace polhode::cli
