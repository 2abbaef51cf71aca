// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/view/zip_archive.hpp>

namespace polhode {

/// A recording in a set with a common player.
struct SharedRecording {
  std::string name;   ///< Of its page, without `.html`; shown in the list.
  std::string title;  ///< Description in the list.
  std::string page;   ///< From scene_page().
};

/// Files of recordings whose pages share one script: player.js, a page for each, and index.html,
/// which lists them. They can be opened from a disk, without network or server.
/// @throws std::invalid_argument if a page has no script of its own or no security policy.
[[nodiscard]] std::vector<ZipEntry> shared_pages(const std::vector<SharedRecording>& recordings);

}  // namespace polhode
