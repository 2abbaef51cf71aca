// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/solids/loads/body_force.hpp>
#include <polhode/solids/loads/nodal_force.hpp>
#include <polhode/solids/loads/pressure.hpp>
#include <polhode/solids/loads/registry.hpp>
#include <polhode/solids/loads/traction.hpp>

namespace polhode::solids {

const std::vector<SolidLoadKind>& solid_load_kinds() {
  static const std::vector<SolidLoadKind> kinds{
      pressure_kind(),
      traction_kind(),
      body_force_kind(),
      nodal_force_kind(),
  };
  return kinds;
}

const SolidLoadKind& solid_load_kind(std::string_view where, std::string_view name) {
  std::vector<std::string> names;
  for (const SolidLoadKind& kind : solid_load_kinds()) {
    if (kind.name == name) return kind;
    names.push_back(kind.name);
  }
  throw InputError(where, format("'{}' does not act on solids", name),
                   format("Use one of: {}", name_list(names)));
}

}  // namespace polhode::solids
