// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace polhode::cli {

/// A temporary folder that is removed with its contents at the end.
class TemporaryFolder {
 public:
  TemporaryFolder();  ///< @throws FileError
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace polhode::cli
