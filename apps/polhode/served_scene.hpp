// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "loopback_server.hpp"
#include "view_pages.hpp"

namespace polhode::cli {

/// Scene of a file for a page, rebuilt when the file has changed.
class ServedScene {
 public:
  explicit ServedScene(const ViewRequest& request) : request_(request) { load(); }
  [[nodiscard]] WebAnswer answer(const std::string& path);
  /// Reason why there is no scene; empty if there is one.
  [[nodiscard]] const std::string& error() const { return error_; }

 private:
  [[nodiscard]] std::string stamp() const;
  void load();

  ViewRequest request_;
  SceneData scene_, compared_;
  std::string stamp_, error_;
};

}  // namespace polhode::cli
