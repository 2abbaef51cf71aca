// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace polhode::cli {

/// A folder of its own that is removed, with what is in it, at the end.
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
