// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/read/read_model.hpp>

#include <algorithm>

#include <polhode/compile/contact_sides.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/read/parsed_model.hpp>
#include <polhode/io/read/read_context.hpp>
#include <polhode/io/text/file_error.hpp>

namespace polhode::io {

void read_units(ReadContext& context, const SourceNode& node) {
  const FieldTable& table = units_fields();
  Section section(context, node, context.tree.place_of(node), "units", table);
  const auto set = [&](const char* name, double& target) {
    const auto text = section.text(name);
    if (!text) return;
    const UnitReading reading = read_unit(*text);
    if (!reading.unit) {
      section.fault(name, reading.what, reading.hint);
      return;
    }
    const Dimension& wanted = table.at(name).dimension;
    const Dimension& given = reading.unit->dimension;
    if (!given.matches(wanted) || given.angle != wanted.angle) {
      section.fault(
          name, format("{} is a unit of {}, not of {}", quote(*text), given.name(), wanted.name()),
          format("Give a unit such as {}.", wanted.si_unit()));
      return;
    }
    target = reading.unit->factor;
  };
  set("length", context.units.length);
  set("mass", context.units.mass);
  set("time", context.units.time);
  set("angle", context.units.angle);
}

Quantity read_variable(ReadContext& context, const SourceNode& node, const std::string& path) {
  const auto expression = read_expression(context, node, path, false);
  if (!expression) return {1.0, Certainty::kBare, {}};  // Its uses then cause no further errors.
  Quantity value{(*expression)(0.0), expression->certainty(), expression->dimension()};
  // A number without a unit gets the dimension of its use.
  if (value.certainty == Certainty::kPure) value.certainty = Certainty::kBare;
  return value;
}

void read_variables(ReadContext& context, const SourceNode& node) {
  if (node.kind == SourceNode::Kind::kEmpty) return;
  if (!node.is_map()) {
    context.fault(node, "variables",
                  "expects a map from names to numbers, but is " + node.description(),
                  "Write 'L: 1.0'.");
    return;
  }
  const std::vector<std::string> reserved = reserved_names();
  for (std::size_t k = 0; k < node.keys.size(); ++k) {
    const std::string& name = node.keys[k].name;
    const SourceLocation place = context.tree.place_of(node.keys[k], node.children[k]);
    const auto is_word = [](unsigned char c) { return c < 0x80 && (std::isalnum(c) || c == '_'); };
    if (name.empty() || std::isdigit(static_cast<unsigned char>(name[0])) ||
        !std::all_of(name.begin(), name.end(), is_word)) {
      context.diagnostics.add(place, "variables",
                              quote(name) + " is not allowed as the name of a variable",
                              "Use letters, digits and '_', a letter first.");
      continue;
    }
    if (std::find(reserved.begin(), reserved.end(), name) != reserved.end()) {
      context.diagnostics.add(place, "variables", format("the name '{}' is taken", name),
                              "Choose another name.");
      continue;
    }
    const auto given = context.given_variables.find(name);
    // First the value: the name is not known before it.
    const auto value = given != context.given_variables.end()
                           ? given->second
                           : read_variable(context, node.children[k], "variables." + name);
    context.variables[name] = value;
  }
}

namespace {

/// Map from names to objects; an empty value means none.
const SourceNode* named_things(ReadContext& context, const SourceNode& root,
                               const std::string& name) {
  const SourceNode* node = root.find(name);
  if (!node || node->kind == SourceNode::Kind::kEmpty) return nullptr;
  if (node->is_map()) return node;
  context.fault(*node, name,
                format("expects a map from names to {}, but is {}", name, node->description()),
                "Write 'name: {...}'.");
  return nullptr;
}

void read_root(ReadContext& context, const SourceNode& root) {
  const SourceLocation start{context.tree.source().name(), 1, 1};
  if (root.kind == SourceNode::Kind::kEmpty) {
    context.diagnostics.add({start.file, 0, 0}, "", "the file is empty",
                            "A model starts with 'format: 1'.");
    return;
  }
  // Their outputs are referred to by objects read before them.
  if (const SourceNode* node = root.is_map() ? root.find("controllers") : nullptr)
    for (const SourceNode::Key& key : node->keys) context.controllers.push_back(key.name);
  read_things(context, root, "");
  if (!root.is_map()) return;
  Model& model = context.model;
  if (const SourceNode* node = root.find("contacts")) read_contacts(context, *node);
  if (const SourceNode* node = named_things(context, root, "controllers"))
    read_controllers(context, *node);
  if (const SourceNode* node = named_things(context, root, "events")) read_events(context, *node);
  if (const SourceNode* node = root.find("analysis"))
    read_analysis(context, *node, context.tree.place_of(*node));
  if (const SourceNode* node = root.find("output"))
    read_output(context, *node, context.tree.place_of(*node));
  if (const SourceNode* node = root.find("contacts")) choose_law(context, *node);
  if (model.bodies.empty() && model.solids.empty() && context.diagnostics.empty())
    context.diagnostics.add(start, "bodies", "the model has no bodies",
                            "Add 'bodies: {name: {...}}'.");
  check_solids(context, root);
  check_contacts(context, root);
  check_model(context, root);
}

void apply_overrides(SourceTree& tree, const Overrides& overrides, Diagnostics& diagnostics) {
  for (const std::string& text : overrides) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0) {
      diagnostics.add({"--set " + text, 0, 0}, "", "expects 'name=value'",
                      "Write --set L=1.2 or --set bodies.crank.mass=2.");
      continue;
    }
    tree.apply_override(text.substr(0, equals), text.substr(equals + 1), diagnostics);
  }
}

}  // namespace

void read_things(ReadContext& context, const SourceNode& root, const std::string& path) {
  Section section(context, root,
                  path.empty() ? SourceLocation{context.tree.source().name(), 1, 1}
                               : context.tree.place_of(root),
                  path, model_fields());
  if (!root.is_map()) return;
  Model& model = context.model;
  if (const SourceNode* node = section.find("import"))
    context.fault(*node, section.path("import"), "is allowed at the top of a model only",
                  "Convert the file to a model file, and name that.");
  section.integer("format");
  if (const auto title = section.text("title")) model.title = *title;
  if (const SourceNode* node = section.find("units")) read_units(context, *node);
  if (const SourceNode* node = section.find("variables")) read_variables(context, *node);
  if (const auto gravity = section.vector("gravity")) model.gravity = *gravity;
  if (const SourceNode* node = named_things(context, root, "bodies")) read_bodies(context, *node);
  if (const SourceNode* node = named_things(context, root, "parts")) {
    const std::size_t before = context.diagnostics.size();
    read_parts(context, *node);
    // References to their names would be unknown.
    if (context.diagnostics.size() != before) return;
  }
  const auto read = [&](const char* name, void (*reader)(ReadContext&, const SourceNode&)) {
    if (const SourceNode* node = named_things(context, root, name)) reader(context, *node);
  };
  read("materials", read_materials);
  read("sections", read_sections);
  read("beams", read_beams);
  read("cables", read_cables);
  read("joints", read_joints);
  read("solids", read_solids);
  read("loads", read_loads);
  place_starts(context);
}

void check_model(ReadContext& context, const SourceNode& root) {
  const Model& model = context.model;
  const int order = model.analysis.order.value_or(2);
  const bool surfaces =
      model.analysis.type == "statics" && (!model.solids.empty() || has_touching_cables(model));
  if (model.contacts.present && model.analysis.type != "dynamics" && !surfaces &&
      !model.contacts.rigid())
    context.fault(*root.find("contacts"), "contacts",
                  format("cannot be combined with an analysis of type {}", model.analysis.type),
                  "Contact of bodies needs contacts.default law: rigid, or type: dynamics: let the "
                  "model come to rest there.");
  if (model.analysis.method == "extrapolation") return;  // choose_order() checks it
  if (order > 2 && model.contacts.present)
    context.fault(*root.find("analysis")->find("order"), "analysis.order",
                  format("order {} cannot be combined with contacts", order),
                  "Orders above 2 contain stages backward in time, where friction and impacts "
                  "would add energy: use order 2.");
  if (order <= 2 || model.analysis.method != "composition") return;
  const auto refuse = [&](const std::string& what, const char* named) {
    context.fault(*root.find("analysis")->find("order"), "analysis.order",
                  format("order {} cannot be combined with {}", order, what),
                  format("Orders above 2 contain stages backward in time, where {} would add "
                         "energy: use order 2, or method: extrapolation.",
                         named));
  };
  for (const SolidSpec& solid : model.solids) {
    std::vector<std::string> names{solid.material};
    for (const RegionSpec& region : solid.regions) names.push_back(region.material);
    const auto any_of_them = [&](auto&& holds) {
      return std::find_if(names.begin(), names.end(), [&](const std::string& name) {
        const auto material = context.materials.find(name);
        return material != context.materials.end() &&
               holds(model.materials[static_cast<std::size_t>(material->second)]);
      });
    };
    if (const auto relaxing =
            any_of_them([](const MaterialSpec& m) { return !m.relaxation.empty(); });
        relaxing != names.end()) {
      context.fault(
          *root.find("analysis")->find("order"), "analysis.order",
          format("order {} cannot be combined with the relaxation of {}", order, quote(*relaxing)),
          "Stress that relaxes has steps of order 2: use order 2.");
      break;
    }
    const auto viscous = any_of_them([](const MaterialSpec& m) { return m.viscosity.any(); });
    if (viscous == names.end()) continue;
    refuse("the viscosity of " + quote(*viscous), "viscosity");
    break;
  }
  for (const BeamSpec& beam : model.beams) {
    if (!(beam.section.relaxation_time > 0.0)) continue;
    refuse("the viscosity of the beam " + quote(beam.name), "viscosity");
    break;
  }
  for (const CableLineSpec& cable : model.cables) {
    if (!(cable.damping > 0.0)) continue;
    refuse("the damping of the cable " + quote(cable.name), "a damper");
    break;
  }
  for (const LoadSpec& load : model.loads) {
    const auto damping = load.parameters.find("damping");
    if (damping == load.parameters.end() || damping->second <= 0.0) continue;
    refuse("the damper in " + quote(load.name), "a damper");
    break;
  }
}

struct ParsedModel::Parsed {
  std::string file, folder;
  Overrides overrides;  ///< That are still to be applied.
  SourceTree tree;
};

ParsedModel::ParsedModel(std::string text, const std::string& filename, Overrides overrides)
    : ParsedModel(ModelText{std::move(text), filename, filename, std::move(overrides)}) {}

ParsedModel::ParsedModel(ModelText source)
    : parsed_(std::make_unique<Parsed>(
          Parsed{.file = source.file,
                 .folder = std::filesystem::path(source.file).parent_path().string(),
                 .overrides = std::move(source.overrides),
                 .tree = SourceTree::parse(std::move(source.text), std::move(source.shown))})) {
  Parsed& p = *parsed_;
  Diagnostics diagnostics(p.tree.source());
  static_cast<void>(expand_import(p.tree, p.folder, p.folder, p.overrides, diagnostics));
  apply_overrides(p.tree, p.overrides, diagnostics);
  diagnostics.throw_if_any();
}

ParsedModel::~ParsedModel() = default;
ParsedModel::ParsedModel(ParsedModel&&) noexcept = default;

Model ParsedModel::read(const Overrides& further) const {
  SourceTree tree = parsed_->tree;
  Diagnostics diagnostics(tree.source());
  apply_overrides(tree, further, diagnostics);
  diagnostics.throw_if_any();
  ReadContext context{.tree = tree, .diagnostics = diagnostics};
  context.folder = parsed_->folder;
  context.model.source_file = parsed_->file;
  context.source_file = parsed_->file;
  context.files_above = {full_path(parsed_->file)};
  read_root(context, tree.root());
  diagnostics.throw_if_any();
  return std::move(context.model);
}

Model read_model_text(std::string text, const std::string& filename, const Overrides& overrides) {
  return ParsedModel(std::move(text), filename, overrides).read();
}

Model read_model(const std::filesystem::path& file, const Overrides& overrides) {
  return ParsedModel(model_text_of(file.string(), overrides)).read();
}

}  // namespace polhode::io
