// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/view/zip_archive.hpp>

namespace polhode {

/// A recording among others that share a player.
struct SharedRecording {
  std::string name;   ///< Of its page, without `.html`; the list shows it.
  std::string title;  ///< What the list says of it.
  std::string page;   ///< As scene_page() gives it.
};

/// Files of recordings whose pages share one script: player.js, a page of each, and index.html,
/// which lists them. They open from a disk, without network or server.
/// @throws std::invalid_argument if a page has no script of its own or its policy.
[[nodiscard]] std::vector<ZipEntry> shared_pages(const std::vector<SharedRecording>& recordings);

}  // namespace polhode
