// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/loads/registry.hpp>

namespace polhode {

int LoadKind::report_size() const {
  int size = 0;
  for (const LoadChannel& channel : channels) size += channel.size;
  return size;
}

std::string LoadKind::function_key() const {
  if (place == LoadPlace::axis) return "";
  for (const TimeParameter& drive : drives)
    if (drive.name == "force" || drive.name == "moment" || drive.name == "pull") return drive.name;
  return vector;
}

const LoadKind& load_kind(std::string_view name) {
  std::string names;
  for (const LoadKind& kind : load_kinds()) {
    if (kind.name == name) return kind;
    names += (names.empty() ? "" : ", ") + kind.name;
  }
  throw InputError("loads", format("the type '{}' is not known", name),
                   format("Use one of: {}", names));
}

}  // namespace polhode
