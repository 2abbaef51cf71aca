// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/sdf_include.hpp>

#include <cstdlib>
#include <filesystem>

#include <tinyxml2.h>

#include <polhode/io/importers/package_paths.hpp>
#include <polhode/io/text/file_error.hpp>

namespace polhode::io {

namespace {

namespace fs = std::filesystem;

/// Bytes of a model.config, which has some lines.
constexpr std::uintmax_t kMostConfigBytes = 1 << 20;

/// File of the newest version that a model.config names; "" if it names none.
std::string file_of_config(const std::string& path) {
  std::error_code ignored;
  tinyxml2::XMLDocument document;
  if (fs::file_size(path, ignored) > kMostConfigBytes) return "";
  try {
    if (document.Parse(read_file(path).c_str()) != tinyxml2::XML_SUCCESS) return "";
  } catch (const FileError&) {
    return "";
  }
  std::string best;
  int newest = -1;
  if (document.RootElement() == nullptr) return "";
  for (const auto* e = document.RootElement()->FirstChildElement("sdf"); e != nullptr;
       e = e->NextSiblingElement("sdf")) {
    const std::string version = e->Attribute("version") == nullptr ? "" : e->Attribute("version");
    const int minor =
        version.starts_with("1.") && version.size() < 6 ? std::atoi(version.c_str() + 2) : 0;
    if (e->GetText() == nullptr || minor <= newest) continue;
    newest = minor;
    best = e->GetText();
  }
  return best;
}

}  // namespace

std::optional<std::string> find_sdf(const std::string& uri, const std::string& folder,
                                    const std::vector<std::string>& paths) {
  if (uri.ends_with(".sdf") || uri.ends_with(".world")) return find_named_file(uri, folder, paths);
  const bool has_scheme = uri.find("://") != std::string::npos;
  for (const std::string& name : has_scheme ? std::vector{uri} : std::vector{uri, "model://" + uri})
    for (const char* inside : {"model.config", "model.sdf"}) {
      const auto found = find_named_file(name + "/" + inside, folder, paths);
      if (!found) continue;
      if (found->ends_with(".sdf")) return found;
      const std::string file = file_of_config(*found);
      if (file.empty()) continue;
      return find_named_file(file, fs::path(*found).parent_path().string(), paths);
    }
  return std::nullopt;
}

}  // namespace polhode::io
