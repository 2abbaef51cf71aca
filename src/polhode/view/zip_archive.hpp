// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

namespace polhode {

/// One file of an archive.
struct ZipEntry {
  std::string name;  ///< With '/' between folders; UTF-8.
  std::string bytes;
};

/// Archive of files, deflated (PKWARE, .ZIP File Format Specification 6.3). All are dated 1980, so
/// that the same files give the same bytes.
/// @throws InputError above 4 GB or 65535 files, which this form cannot hold.
[[nodiscard]] std::string zip_archive(std::span<const ZipEntry> entries);

}  // namespace polhode
