// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include <polhode/io/results/results_reader.hpp>
#include <polhode/model/model.hpp>

namespace polhode {

/// Options of a page of results.
struct SceneOptions {
  std::size_t max_frames = 0;                      ///< 0: as many as max_bytes allows.
  std::size_t max_bytes = std::size_t{160} << 20;  ///< Of uncompressed numbers.
  std::vector<std::string> notes;                  ///< Shown on the page, e.g. warnings of a check.
  std::map<std::string, std::string> marks;  ///< By joint: a remark, e.g. that it is redundant.
  std::map<std::string, std::string> body_marks;  ///< By body: a remark, e.g. that it overlaps.
  std::string name;      ///< Name of this recording on the page, when compared with another one.
  std::string compared;  ///< Name of the recording shown as a ghost; empty: none.
};

/// Data of a page: a JSON text that describes bodies, joints, loads, solids, beams, cables,
/// contacts and channels, and compressed numbers (see pack_floats()) that it refers to by index.
struct SceneData {
  std::string manifest;
  std::vector<std::string> chunks;
  std::set<std::size_t> later;        ///< Chunks not needed for the first picture.
  std::size_t frames = 0, every = 1;  ///< Frames shown, and stride in the file.
  std::string title;
};

/// Model of the results, from the text stored in them. Mesh files are searched in `folder` and its
/// parent.
/// @throws ModelErrors, FileError, InputError
[[nodiscard]] Model model_of_results(const io::ResultsReader& results, const std::string& folder);

/// @param model  From model_of_results(); null: bodies are drawn as small cubes.
/// @throws FileError
[[nodiscard]] SceneData make_scene(const io::ResultsReader& results, const Model* model,
                                   const SceneOptions& options = {});

/// A single HTML file that needs no network and no server.
/// @param page  Text of viewer/dist/viewer.html, the player.
/// @param compared  Another recording, shown as a ghost; null: none.
/// @throws std::invalid_argument if the page has no placeholder for data.
[[nodiscard]] std::string scene_page(const std::string& page, const SceneData& scene,
                                     const SceneData* compared = nullptr);

}  // namespace polhode
