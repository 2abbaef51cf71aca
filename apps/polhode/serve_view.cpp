// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/format.hpp>

#include "command.hpp"
#include "served_scene.hpp"
#include "stop_signal.hpp"
#include "view_pages.hpp"

namespace polhode::cli {

int serve_view(const ViewRequest& request, int port, bool open) {
  ServedScene scene(request);
  // Unreadable results end the command; an erroneous model is shown as such, since its file can be
  // saved again.
  if (!scene.error().empty() && is_results(request.input.file)) {
    say(scene.error());
    return kInputOutput;
  }
  if (!scene.error().empty()) say(scene.error());
  const LoopbackServer server(port);
  const std::string address = format("http://127.0.0.1:{}/", server.port());
  catch_stop_signals();
  print(address + "\n");
  if (open) open_browser(address);
  say("Stop with Ctrl-C.");
  server.run([&](const WebRequest& what) { return scene.answer(what.path); }, stop_wanted);
  return kOk;
}

}  // namespace polhode::cli
