// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace polhode::cli {

/// A film of a recording: what it shows, and the way of the camera.
struct FilmRequest {
  std::string results, output;  ///< A .gif or .mp4 file, or a folder for pictures.
  int width = 640, height = 400;
  double rate = 20.0;              ///< Pictures a second.
  double speed = 1.0;              ///< Seconds of the recording in one of the film.
  std::optional<double> from, to;  ///< Part of the recording [s]; left out: all.
  double turn = 0.0;               ///< Of the camera about the middle, over the film [°].
  std::string link;                ///< What "Link" puts into the address: where the camera begins.
};

/// Draws the film with the viewer's page in a Chromium without window ($CHROMIUM, else the one that
/// is installed), from a server on the loopback address. An .mp4 file takes ffmpeg, too.
/// @throws FileError, InputError if a program is missing or the page fails.
void write_film(const FilmRequest& request);

}  // namespace polhode::cli
