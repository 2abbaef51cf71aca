// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <filesystem>

#include <polhode/core/format.hpp>
#include <polhode/io/text/diagnostics.hpp>

#include "command.hpp"
#include "loopback_server.hpp"
#include "stop_signal.hpp"
#include "view_pages.hpp"

namespace polhode::cli {

namespace {

namespace fs = std::filesystem;

/// The scene of a file, made anew when the file has changed.
class ServedScene {
 public:
  explicit ServedScene(const ViewRequest& request) : request_(request) { load(); }

  WebAnswer answer(const std::string& path) {
    if (path == "/") return {200, "text/html; charset=utf-8", viewer_text()};
    if (path == "/stamp") return {200, "text/plain", stamp()};
    if (path == "/scene.json") {
      if (stamp() != stamp_) load();
      if (!error_.empty()) return {422, "text/plain; charset=utf-8", error_};
      return {200, "application/json", scene_.manifest};
    }
    if (path == "/scene-1.json" && !request_.compared.empty())
      return {200, "application/json", compared_.manifest};
    for (const auto& [prefix, scene] :
         {std::pair<std::string, const SceneData*>{"/chunk/", &scene_},
          {"/chunk-1/", &compared_}}) {
      if (path.rfind(prefix, 0) != 0) continue;
      std::size_t index = 0;
      const char* begin = path.data() + prefix.size();
      const char* end = path.data() + path.size();
      const auto [stop, fault] = std::from_chars(begin, end, index);
      if (fault == std::errc() && stop == end && index < scene->chunks.size())
        return {200, "application/octet-stream", scene->chunks[index]};
    }
    return {404, "text/plain", "There is no such page.\n"};
  }
  [[nodiscard]] const std::string& error() const { return error_; }

 private:
  /// Changes when a file is saved.
  [[nodiscard]] std::string stamp() const {
    std::string text;
    for (const std::string& file : {request_.input.file, request_.compared}) {
      if (file.empty()) continue;
      std::error_code gone;
      const auto when = fs::last_write_time(is_results(file) ? results_path(file) : file, gone);
      if (gone) return "gone";
      text += format("{} ", when.time_since_epoch().count());
    }
    return text;
  }
  void load() {
    stamp_ = stamp();
    error_.clear();
    try {
      scene_ = scene_of(request_);
      if (!request_.compared.empty()) compared_ = compared_scene_of(request_);
    } catch (const std::exception& error) {
      error_ = error.what();
    }
  }

  ViewRequest request_;
  SceneData scene_, compared_;
  std::string stamp_, error_;
};

}  // namespace

int serve_view(const ViewRequest& request, int port, bool open) {
  ServedScene scene(request);
  // Results that cannot be read end the command; a model that is wrong is shown as such, since its
  // file can be saved again.
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
  server.run([&](const std::string& path) { return scene.answer(path); }, stop_wanted);
  return kOk;
}

}  // namespace polhode::cli
