// SPDX-License-Identifier: Apache-2.0
#include "film.hpp"

#include <atomic>
#include <cctype>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <thread>

#include <unistd.h>

#include <nlohmann/json.hpp>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/text/file_error.hpp>

#include "child_process.hpp"
#include "console.hpp"
#include "served_scene.hpp"
#include "temporary_folder.hpp"

namespace polhode::cli {

namespace {

namespace fs = std::filesystem;
constexpr const char* kWhere = "polhode convert";

std::string chromium() {
  const char* named = std::getenv("CHROMIUM");
  const std::string program = find_program(
      {named == nullptr ? "" : named, "chromium", "chromium-browser", "google-chrome",
       "google-chrome-stable", "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome"});
  if (program.empty())
    throw InputError(
        kWhere, "films are drawn by Chromium, which is missing",
        "Install the Debian package chromium, or name a Chromium or Chrome with CHROMIUM");
  return program;
}

nlohmann::json how_of(const FilmRequest& request, const std::string& kind) {
  nlohmann::json how = {
      {"kind", kind},         {"width", request.width}, {"height", request.height},
      {"rate", request.rate}, {"speed", request.speed}, {"turn", request.turn},
      {"link", request.link}};
  if (request.from) how["from"] = *request.from;
  if (request.to) how["to"] = *request.to;
  return how;
}

/// Receiver of the page's messages up to the one that ends the film or reports a failure.
class Receiver {
 public:
  Receiver(const FilmRequest& request, const std::string& kind, std::string folder)
      : scene_(ViewRequest{{request.results, {}}, "", 0}),
        how_(how_of(request, kind).dump()),
        output_(request.output),
        folder_(std::move(folder)) {
    if (!scene_.error().empty()) throw InputError(kWhere, scene_.error(), "Name results of a run");
  }
  WebAnswer answer(const WebRequest& request) {
    if (request.path == "/film.json") return {200, "application/json", how_};
    if (!request.sent) return scene_.answer(request.path);
    const std::string name = fs::path(request.path).filename().string();
    if (name == "failed") error_ = request.body;
    if (name == "failed" || name == "done") {
      done = true;
    } else if (name == "film.gif") {
      io::write_file_atomically(output_, request.body, false);
    } else {
      io::write_file_atomically(folder_ + "/" + name, request.body, false);
      ++pictures;
    }
    return {200, "text/plain", "taken\n"};
  }
  [[nodiscard]] const std::string& error() const { return error_; }
  std::atomic<bool> done{false};
  std::size_t pictures = 0;

 private:
  ServedScene scene_;
  std::string how_, output_, folder_, error_;
};

/// Encodes pictures in a folder as a widely playable film: even numbers of pixels, 4:2:0, declared
/// BT.709 colours, and its index at the front, so that a browser plays it while it loads.
void encode(const std::string& ffmpeg, const std::string& folder, double rate,
            const std::string& output) {
  const std::string log = folder + "/log";
  ChildProcess child(
      {ffmpeg,
       "-y",
       "-loglevel",
       "error",
       "-framerate",
       format("{}", rate),
       "-i",
       folder + "/%05d.png",
       "-vf",
       "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv,format=yuv420p",
       "-colorspace",
       "bt709",
       "-color_primaries",
       "bt709",
       "-color_trc",
       "bt709",
       "-color_range",
       "tv",
       "-movflags",
       "+faststart",
       output},
      log);
  if (child.wait() == 0) return;
  std::string said = io::read_file(log);
  while (!said.empty() && std::isspace(static_cast<unsigned char>(said.back())) != 0)
    said.pop_back();
  throw io::FileError(output, "cannot be written by ffmpeg: " + said, "Name a .gif file");
}

/// Thread that sets `stop` when a condition is true; it ends with this object.
class Watch {
 public:
  Watch(std::function<bool()> over, std::atomic<bool>& stop)
      : thread_([this, over = std::move(over), &stop] {
          while (!quit_ && !over()) std::this_thread::sleep_for(std::chrono::milliseconds(20));
          stop = true;
        }) {}
  ~Watch() {
    quit_ = true;
    thread_.join();
  }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

 private:
  std::atomic<bool> quit_{false};
  std::thread thread_;
};

}  // namespace

void write_film(const FilmRequest& request) {
  const std::string ending = fs::path(request.output).extension().string();
  const std::string browser = chromium();
  const std::string ffmpeg = ending == ".mp4" ? find_program({"ffmpeg"}) : "";
  if (ending == ".mp4" && ffmpeg.empty())
    throw InputError(kWhere, "an .mp4 file is written by ffmpeg, which is missing",
                     "Install the Debian package ffmpeg, or write a .gif file");
  const fs::path place = fs::path(request.output).parent_path();
  if (!ending.empty() && !place.empty() && !fs::is_directory(place))
    throw io::FileError(request.output, "cannot be written: its folder does not exist",
                        "Make the folder first");
  const TemporaryFolder folder;
  const bool pictures = ending.empty();
  if (pictures) io::make_folder(request.output);
  Receiver receiver(request, ending == ".gif" ? "gif" : "png",
                    pictures ? request.output : folder.path());
  const LoopbackServer server(0);
  std::vector<std::string> words = {browser,
                                    "--headless=new",
                                    "--user-data-dir=" + folder.path() + "/profile",
                                    "--no-first-run",
                                    "--disable-extensions",
                                    "--disable-background-networking",
                                    "--ignore-gpu-blocklist",
                                    "--enable-unsafe-swiftshader",
                                    "--hide-scrollbars"};
  if (::geteuid() == 0)
    words.emplace_back("--no-sandbox");  // Chromium refuses to run as root otherwise.
  words.push_back(format("http://127.0.0.1:{}/?film", server.port()));
  ChildProcess child(words, folder.path() + "/browser.log");
  std::atomic<bool> stop{false};
  const Watch watch([&] { return receiver.done || !child.runs(); }, stop);
  server.run([&](const WebRequest& what) { return receiver.answer(what); }, stop, true);
  if (!receiver.error().empty())
    throw InputError(kWhere, "the page says: " + receiver.error(),
                     "Correct the options of the film");
  if (!receiver.done)
    throw io::FileError(browser, "ended before the film was drawn",
                        "Name another one with CHROMIUM");
  if (ending == ".mp4") encode(ffmpeg, folder.path(), request.rate, request.output);
}

}  // namespace polhode::cli
