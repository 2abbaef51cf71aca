// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace polhode::io {

/// Lock on a folder of results, so that two runs do not write into it at a time. The system frees
/// it when the program ends, killed or not. File systems without locks allow everything.
class FolderLock {
 public:
  /// @param folder  Created if missing.
  /// @param model   File of the model, by which another run is refused.
  /// @throws InputError if another run has the folder; FileError
  FolderLock(const std::string& folder, const std::string& model);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  /// Whether a run is writing into a folder.
  [[nodiscard]] static bool is_held(const std::string& folder);

 private:
  std::string path_;
  int file_ = -1;
};

}  // namespace polhode::io
