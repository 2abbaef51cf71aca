// SPDX-License-Identifier: Apache-2.0
#include "temporary_folder.hpp"

#include <cstdlib>
#include <filesystem>

#include <polhode/io/text/file_error.hpp>

namespace polhode::cli {

TemporaryFolder::TemporaryFolder() {
  path_ = (std::filesystem::temp_directory_path() / "polhode-XXXXXX").string();
  if (mkdtemp(path_.data()) == nullptr) throw io::FileError::from_errno(path_, "cannot be made");
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace polhode::cli
