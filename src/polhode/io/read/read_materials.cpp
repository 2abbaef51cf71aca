// SPDX-License-Identifier: Apache-2.0
#include <polhode/compile/solid_parts.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_context.hpp>
#include <polhode/solids/materials/registry.hpp>

namespace polhode::io {
namespace {

/// Reader of one material; errors go to the context.
class MaterialReader {
 public:
  MaterialReader(ReadContext& context, const SourceNode& node, MaterialSpec& material,
                 const FieldTable& table)
      : context_(context),
        material_(material),
        table_(table),
        section_(context, node, material.place, "materials." + material.name, table) {}

  void read() {
    const std::size_t before = context_.diagnostics.size();
    for (const Field& field : table_.fields) {
      if (field.kind != FieldKind::kNumber) continue;
      const auto value = section_.number(field.name);
      if (!value) continue;
      if (field.name == "density")
        material_.density = *value;
      else if (field.name == "long_term_ratio")
        material_.long_term_ratio = *value;
      else
        material_.parameters[field.name] = *value;
    }
    if (const SourceNode* value = section_.find("viscosity")) read_viscosity(*value);
    if (const SourceNode* value = section_.find("relaxation")) read_relaxation(*value);
    if (const SourceNode* value = section_.find("fibre")) read_fibres(*value);
    if (context_.diagnostics.size() == before) check();
  }

 private:
  void read_viscosity(const SourceNode& node) {
    Section section(context_, node, context_.tree.place_of(node), section_.path("viscosity"),
                    viscosity_fields());
    if (!node.is_map()) return;
    ViscositySpec& v = material_.viscosity;
    if (section.refuse_both("relaxation_time", "shear", "Give one of them.") ||
        section.refuse_both("relaxation_time", "lame", "Give one of them."))
      return;
    if (!section.has("relaxation_time") && section.misses("shear"))
      section.fault("'shear' is missing", "Give relaxation_time, or shear and lame.");
    section.read_into(v);
  }

  void read_relaxation(const SourceNode& node) {
    const std::string path = section_.path("relaxation");
    if (!node.is_list()) {
      read_term(node, path);
      return;
    }
    if (node.children.empty())
      context_.fault(node, path, "is an empty list", "Leave it out, or list the terms.");
    for (std::size_t k = 0; k < node.children.size(); ++k)
      read_term(node.children[k], format("{}.{}", path, k));
  }

  void read_term(const SourceNode& node, const std::string& path) {
    Section section(context_, node, context_.tree.place_of(node), path, relaxation_fields());
    if (!node.is_map()) return;
    section.read_into(material_.relaxation.emplace_back());
  }

  void read_fibres(const SourceNode& node) {
    const std::string path = section_.path("fibre");
    if (!node.is_list()) {
      read_fibre(node, path);
      return;
    }
    if (node.children.empty())
      context_.fault(node, path, "is an empty list", "Leave it out, or list a family of fibres.");
    for (std::size_t k = 0; k < node.children.size(); ++k)
      read_fibre(node.children[k], format("{}.{}", path, k));
  }

  void read_fibre(const SourceNode& node, const std::string& path) {
    FibreSpec fibre;
    const FieldTable* table = read_kind(context_, node, context_.tree.place_of(node), path,
                                        fibre_tables(), fibre.law, "law");
    if (!table) return;
    Section section(context_, node, context_.tree.place_of(node), path, *table);
    for (const Field& field : table->fields)
      if (field.kind == FieldKind::kNumber)
        if (const auto value = section.number(field.name)) fibre.parameters[field.name] = *value;
    if (const auto direction = section.direction("direction")) fibre.direction = *direction;
    material_.fibres.push_back(std::move(fibre));
  }

  /// Checks by the law itself, such as incompatible moduli.
  void check() {
    try {
      static_cast<void>(solids::make_material(section_.path(), material_description(material_)));
    } catch (const InputError& e) {
      section_.fault(e.what_is_wrong(), sentence(e.hint()));
    }
  }

  ReadContext& context_;
  MaterialSpec& material_;
  const FieldTable& table_;
  Section section_;
};

}  // namespace

void read_materials(ReadContext& context, const SourceNode& node) {
  for (std::size_t k = 0; k < node.keys.size(); ++k) {
    const SourceNode::Key& key = node.keys[k];
    if (!check_name(context, key, node.children[k], "materials")) continue;
    MaterialSpec material;
    material.name = key.name;
    material.place = context.tree.place_of(key, node.children[k]);
    const std::size_t before = context.diagnostics.size();
    if (const FieldTable* table =
            read_kind(context, node.children[k], material.place, "materials." + key.name,
                      material_tables(), material.type))
      MaterialReader(context, node.children[k], material, *table).read();
    context.material_is_sound.push_back(context.diagnostics.size() == before);
    context.materials.emplace(material.name, static_cast<int>(context.model.materials.size()));
    context.model.materials.push_back(std::move(material));
  }
}

}  // namespace polhode::io
