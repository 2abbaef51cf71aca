// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include <polhode/io/results/results_reader.hpp>
#include <polhode/model/model.hpp>

namespace polhode {

/// Choices about a page of results.
struct SceneOptions {
  std::size_t max_frames = 0;                      ///< 0: as many as max_bytes allows.
  std::size_t max_bytes = std::size_t{160} << 20;  ///< Of numbers before they are deflated.
  std::vector<std::string> notes;                  ///< Shown on the page, e.g. warnings of a check.
  std::map<std::string, std::string> marks;  ///< By joint: a remark, e.g. that it is redundant.
  std::map<std::string, std::string> body_marks;  ///< By body: a remark, e.g. that it overlaps.
  std::string name;      ///< What the page calls this recording, beside another one.
  std::string compared;  ///< Name of the recording that the page shows as a ghost; empty: none.
};

/// Everything that a page shows: a JSON text that describes bodies, joints, loads, solids, beams,
/// cables, contacts and channels, and packed numbers (see pack_floats()) that it refers to by
/// index.
struct SceneData {
  std::string manifest;
  std::vector<std::string> chunks;
  std::set<std::size_t> later;        ///< Chunks that the first picture does without.
  std::size_t frames = 0, every = 1;  ///< Frames shown; every so-manyth one of the file.
  std::string title;
};

/// The model that results came from, by the text that they keep. Mesh files are looked for in
/// `folder` and the one above it.
/// @throws ModelErrors, FileError, InputError
[[nodiscard]] Model model_of_results(const ResultsReader& results, const std::string& folder);

/// @param model  As model_of_results() gives it; null: bodies are drawn as small cubes.
/// @throws FileError
[[nodiscard]] SceneData make_scene(const ResultsReader& results, const Model* model,
                                   const SceneOptions& options = {});

/// One HTML file that needs no network and no server.
/// @param page  Text of viewer/dist/viewer.html, the player.
/// @param compared  Another recording, shown as a ghost; null: none.
/// @throws std::invalid_argument if the page has no place for data.
[[nodiscard]] std::string scene_page(const std::string& page, const SceneData& scene,
                                     const SceneData* compared = nullptr);

}  // namespace polhode
