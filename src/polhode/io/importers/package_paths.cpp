// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/package_paths.hpp>

#include <cstdlib>
#include <filesystem>
#include <string_view>

namespace polhode::io {

namespace {

namespace fs = std::filesystem;

std::optional<std::string> existing(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return std::nullopt;
  return path.lexically_normal().string();
}

/// The file of a package whose folder is below one of these, or is itself one of these.
std::optional<std::string> within(const fs::path& folder, const std::string& package,
                                  const std::string& rest) {
  if (auto found = existing(folder / package / rest)) return found;
  if (folder.filename() == package) return existing(folder / rest);
  return std::nullopt;
}

}  // namespace

std::optional<std::string> find_named_file(const std::string& name, const std::string& folder,
                                           const std::vector<std::string>& paths) {
  constexpr std::string_view kFile = "file://", kPackage = "package://", kModel = "model://";
  if (name.starts_with(kFile)) return existing(name.substr(kFile.size()));
  const bool package = name.starts_with(kPackage);
  if (!package && !name.starts_with(kModel)) return existing(fs::path(folder) / name);
  const std::string inside = name.substr(package ? kPackage.size() : kModel.size());
  const std::size_t slash = inside.find('/');
  if (slash == std::string::npos) return std::nullopt;
  const std::string owner = inside.substr(0, slash), rest = inside.substr(slash + 1);
  for (const std::string& path : paths)
    if (auto found = within(path, owner, rest)) return found;
  for (const char* variable : {"ROS_PACKAGE_PATH", "GZ_SIM_RESOURCE_PATH", "GAZEBO_MODEL_PATH"}) {
    const char* listed = std::getenv(variable);
    std::string_view all = listed == nullptr ? "" : listed;
    while (!all.empty()) {
      const std::size_t end = std::min(all.find(':'), all.size());
      if (auto found = within(std::string(all.substr(0, end)), owner, rest)) return found;
      all.remove_prefix(std::min(end + 1, all.size()));
    }
  }
  std::error_code ignored;
  for (fs::path above = fs::absolute(fs::path(folder), ignored).lexically_normal();;
       above = above.parent_path()) {
    if (auto found = within(above, owner, rest)) return found;
    if (!above.has_relative_path()) return std::nullopt;
  }
}

}  // namespace polhode::io
