// SPDX-License-Identifier: Apache-2.0
#include "served_scene.hpp"

#include <charconv>
#include <filesystem>

#include <polhode/core/format.hpp>

#include "console.hpp"

namespace polhode::cli {

WebAnswer ServedScene::answer(const std::string& path) {
  if (path == "/") return {200, "text/html; charset=utf-8", viewer_text()};
  if (path == "/stamp") return {200, "text/plain", stamp()};
  if (path == "/scene.json") {
    if (stamp() != stamp_) load();
    if (!error_.empty()) return {200, "text/plain; charset=utf-8", error_};
    return {200, "application/json", scene_.manifest};
  }
  if (path == "/scene-1.json" && !request_.compared.empty())
    return {200, "application/json", compared_.manifest};
  for (const auto& [prefix, scene] :
       {std::pair<std::string, const SceneData*>{"/chunk/", &scene_}, {"/chunk-1/", &compared_}}) {
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

/// Stamp that changes when a file is saved.
std::string ServedScene::stamp() const {
  std::string text;
  for (const std::string& file : {request_.input.file, request_.compared}) {
    if (file.empty()) continue;
    std::error_code gone;
    const auto when =
        std::filesystem::last_write_time(is_results(file) ? results_path(file) : file, gone);
    if (gone) return "gone";
    text += format("{} ", when.time_since_epoch().count());
  }
  return text;
}

void ServedScene::load() {
  stamp_ = stamp();
  error_.clear();
  try {
    scene_ = scene_of(request_);
    if (!request_.compared.empty()) compared_ = compared_scene_of(request_);
  } catch (const InputError& error) {
    error_ = located_text(error);
  } catch (const std::exception& error) {
    error_ = error.what();
  }
}

}  // namespace polhode::cli
