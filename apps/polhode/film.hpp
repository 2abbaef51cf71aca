// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace polhode::cli {

/// Request of a film of a recording, with the path of the camera.
struct FilmRequest {
  std::string results, output;  ///< A .gif or .mp4 file, or a folder for pictures.
  int width = 640, height = 400;
  double rate = 20.0;              ///< Pictures per second.
  double speed = 1.0;              ///< Seconds of the recording per second of the film.
  std::optional<double> from, to;  ///< Part of the recording [s]; absent: all.
  double turn = 0.0;               ///< Rotation of the camera about the middle, over the film [°].
  /// Address made by "Link" on the page: initial position of the camera.
  std::string link;
};

/// Draws the film with the viewer's page in a headless Chromium ($CHROMIUM, else the installed
/// one), from a server on the loopback address. An .mp4 file also needs ffmpeg.
/// @throws FileError, InputError if a program is missing or the page fails.
void write_film(const FilmRequest& request);

}  // namespace polhode::cli
