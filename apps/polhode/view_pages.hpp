// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/io/results/results_reader.hpp>
#include <polhode/view/scene.hpp>

#include "console.hpp"

namespace polhode::cli {

/// Text of viewer/dist/viewer.html.
const char* viewer_text();

/// Input of `polhode view`: a results file, a folder of results, or a model.
struct ViewRequest {
  ModelArguments input;
  std::string compared;    ///< A second one, shown as a ghost; empty: none.
  std::size_t frames = 0;  ///< Largest number; 0: as many as fit into SceneOptions::max_bytes.
};

[[nodiscard]] bool is_results(const std::string& path);
/// Path of the results file; for a folder its results.h5.
[[nodiscard]] std::string results_path(const std::string& path);
/// Reader of such a file; warns of one that is cut short. @throws FileError
[[nodiscard]] io::ResultsReader open_results(const std::string& path);

/// Name of the abscissa of plots of these results: the time, or the load factor of statics.
[[nodiscard]] std::string time_label(const io::ResultsReader& results, const std::string& path);

/// Scene of results, or of a model at its assembled start with its mobility and redundant joints.
/// @throws FileError, ModelErrors, InputError
[[nodiscard]] SceneData scene_of(const ViewRequest& request);
/// Scene of the results to compare with. @throws FileError, ModelErrors, InputError
[[nodiscard]] SceneData compared_scene_of(const ViewRequest& request);

/// Writes an archive of the pages of several results, which share one player, and reports it unless
/// `quiet`. @throws FileError, InputError if two have the same name
void write_view_zip(const ViewRequest& request, const std::vector<std::string>& inputs,
                    const std::string& file, bool quiet);

/// Writes the page of results into one file, and reports it unless `quiet`. @throws FileError
void write_view(const ViewRequest& request, const std::string& file, bool quiet);

/// Opens a file or an address in a browser on a desktop. @returns whether it tried.
bool open_browser(const std::string& address);

/// Serves the page on the loopback address until Ctrl-C. @param port  0: any free one.
int serve_view(const ViewRequest& request, int port, bool open);

}  // namespace polhode::cli
