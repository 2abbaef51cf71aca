// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/solids/elements/registry.hpp>

namespace polhode::solids {
namespace {

std::vector<ElementKind> make_kinds() {
  // clang-format off
  std::vector<ElementKind> kinds{
      {"hex8_standard", "displacements only", "hex8",
       hexahedron_rule(2), hexahedron_rule(2),
       "hex8_standard locks: too stiff in bending and when nearly incompressible. Use hex8_eas9 or "
       "hex8_q1p0"},
      {"hex8_eas9", "nine enhanced strains: good in bending", "hex8",
       hexahedron_rule(2), hexahedron_rule(2), "", 0.7, 0.495},
      {"hex8_q1p0", "mean dilatation: for uncoupled, nearly incompressible materials", "hex8",
       hexahedron_rule(2), hexahedron_rule(2)},
      {"hex20", "quadratic, serendipity", "hex20", hexahedron_rule(3), hexahedron_rule(3), "", 0.0,
       0.495},
      {"hex27", "quadratic, all products", "hex27", hexahedron_rule(3), hexahedron_rule(3), "", 0.0,
       0.495},
      {"tet4", "linear, constant strain", "tet4", tetrahedron_rule(1), tetrahedron_rule(7),
       "tet4 locks: too stiff in bending and when nearly incompressible. Use tet10"},
      {"tet10", "quadratic", "tet10", tetrahedron_rule(2), tetrahedron_rule(7)},
      {"tet15", "quadratic, with bubbles on the faces and inside", "tet15",
       tetrahedron_rule(5), tetrahedron_rule(8)},
      {"wedge6", "linear prism, to fill between hexahedra", "wedge6", wedge_rule(), wedge_rule(),
       "wedge6 locks: too stiff in bending and when nearly incompressible. Use it to fill between "
       "hexahedra only, or use tet10"},
      {"wedge15", "quadratic prism, serendipity", "wedge15", wedge15_rule(),
       collapsed_wedge_rule(), "", 0.0, 0.495},
  };
  // clang-format on
  for (std::size_t i = 0; i < kinds.size(); ++i) kinds[i].kernel = static_cast<int>(i);
  return kinds;
}

std::vector<std::string> names_of(const std::vector<const ElementKind*>& kinds) {
  std::vector<std::string> names;
  names.reserve(kinds.size());
  for (const ElementKind* kind : kinds) names.push_back(kind->name);
  return names;
}

}  // namespace

const std::vector<ElementKind>& element_kinds() {
  static const std::vector<ElementKind> kinds = make_kinds();
  return kinds;
}

const ElementKind& element_kind(std::string_view name) {
  std::vector<const ElementKind*> all;
  for (const ElementKind& kind : element_kinds()) {
    if (kind.name == name) return kind;
    all.push_back(&kind);
  }
  const std::vector<std::string> names = names_of(all);
  throw InputError("element", format("the type {} is not known", quote(name)),
                   did_you_mean(name, names) + "Use one of: " + name_list(names));
}

const ElementKind& choose_element(std::string_view where, std::string_view wanted,
                                  std::string_view shape, bool uncoupled) {
  std::string name(wanted.empty() ? shape : wanted);
  if (name == "hex8") name = uncoupled ? "hex8_q1p0" : "hex8_eas9";
  std::vector<const ElementKind*> fitting, all;
  const ElementKind* found = nullptr;
  for (const ElementKind& kind : element_kinds()) {
    all.push_back(&kind);
    if (kind.shape == shape) fitting.push_back(&kind);
    if (kind.name == name) found = &kind;
  }
  if (!found && wanted.empty())
    throw InputError(where, format("cells of shape '{}' are no solid elements", shape),
                     "Use " + name_list(names_of(all)));
  if (!found)
    throw InputError(
        where, format("the element {} is not known", quote(wanted)),
        did_you_mean(wanted, names_of(all)) + "Use one of: " + name_list(names_of(all)));
  if (found->shape != shape)
    throw InputError(where,
                     format("'{}' does not fit the mesh, whose cells are {}", found->name, shape),
                     fitting.empty() ? format("Mesh the solid with {}", found->shape)
                                     : "For these there are: " + name_list(names_of(fitting)));
  if (found->sizes().mean_dilatation && !uncoupled)
    throw InputError(
        where, format("'{}' averages the volume, which needs an uncoupled material", found->name),
        "Use an uncoupled material, e.g. mooney_rivlin_uncoupled, or hex8_eas9");
  return *found;
}

}  // namespace polhode::solids
