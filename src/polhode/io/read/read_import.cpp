// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/read/read_import.hpp>

#include <algorithm>
#include <filesystem>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_context.hpp>
#include <polhode/io/text/file_error.hpp>
#include <polhode/io/text/write_yaml.hpp>

namespace polhode::io {

namespace {

namespace fs = std::filesystem;

constexpr const char* kOverlayOption = "import.overlay=";

bool is_of_import(const std::string& override_text) { return override_text.starts_with("import."); }

std::string folder_of(const std::string& file) { return fs::path(file).parent_path().string(); }

/// "robot" of "robot.urdf.xacro".
fs::path overlay_beside(const std::string& file) {
  std::string stem = file;
  for (const char* ending : {".xacro", ".urdf", ".xml", ".sdf", ".world", ".feb"})
    if (stem.ends_with(ending)) stem.resize(stem.size() - std::string_view(ending).size());
  return stem + ".overlay.yaml";
}

/// A text as it is written in an override.
std::string as_value(const std::string& text) {
  std::string out = "\"";
  for (const char c : text)
    out += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return out + "\"";
}

/// Coordinates of a joint: a number, or a list of them, with the unit of an angle or length, or
/// without one in SI.
void read_start(ReadContext& context, const SourceNode& node, const std::string& joint,
                ImportOptions& options) {
  const std::string path = "import.start." + joint;
  std::vector<double> values;
  std::string units;
  const auto add = [&](const SourceNode& one) {
    const auto expression = read_expression(context, one, path, false);
    if (!expression) return;
    Field field{.name = "start", .kind = FieldKind::kNumber, .dimension = dimensions::kNone};
    units += '-';
    if (expression->certainty() == Certainty::kKnown)
      for (const auto& [letter, dimension] :
           {std::pair{'r', dimensions::kAngle}, std::pair{'m', dimensions::kLength}})
        if (expression->dimension().name() == dimension.name()) {
          field.dimension = dimension;
          units.back() = letter;
        }
    if (const auto q = read_number(context, one, path, field)) values.push_back(*q);
  };
  if (node.is_list())
    for (const SourceNode& one : node.children) add(one);
  else
    add(node);
  if (values.empty()) return;
  options.start[joint] = std::move(values);
  options.start_units[joint] = std::move(units);
}

void read_map(ReadContext& context, const SourceNode& node, ImportOptions& options) {
  if (const SourceNode* start = node.find("start")) {
    if (!start->is_map())
      context.fault(*start, "import.start", "expects a map from joints to numbers",
                    "Write '{elbow: 0.5}'.");
    for (std::size_t k = 0; k < start->keys.size(); ++k)
      read_start(context, start->children[k], start->keys[k].name, options);
  }
  if (const SourceNode* arguments = node.find("arguments")) {
    if (!arguments->is_map())
      context.fault(*arguments, "import.arguments", "expects a map from names to texts",
                    "Write '{arm: left}'.");
    for (std::size_t k = 0; k < arguments->keys.size(); ++k)
      if (const auto text = read_text(context, arguments->children[k],
                                      "import.arguments." + arguments->keys[k].name))
        options.arguments[arguments->keys[k].name] = *text;
  }
}

ImportOptions read_options(ReadContext& context, const SourceNode& node,
                           const std::string& folder) {
  ImportOptions options;
  Section section(context, node, context.tree.place_of(node), "import", import_fields());
  if (!node.is_map()) return options;
  if (const auto file = section.text("file"))
    options.file = (fs::path(folder) / *file).lexically_normal().string();
  if (const auto word = section.choice("base")) options.base = *word;
  if (const auto word = section.choice("fixed_joints")) options.fixed_joints = *word;
  if (const auto word = section.choice("shapes")) options.shapes = *word;
  options.limits = section.boolean("limits").value_or(true);
  options.friction = section.boolean("friction").value_or(true);
  options.actuators = section.boolean("actuators").value_or(true);
  if (const auto name = section.text("keyframe")) options.keyframe = *name;
  options.allow_partial = section.boolean("allow_partial").value_or(false);
  if (const auto paths = section.names("package_paths"))
    for (const std::string& path : *paths)
      options.package_paths.push_back((fs::path(folder) / path).lexically_normal().string());
  read_map(context, node, options);
  if (!options.file.empty() && !is_importable(options.file) && context.diagnostics.empty())
    section.fault("file",
                  format("is {}, which is no file that can be imported", quote(options.file)),
                  "Name a .urdf, .xacro, .sdf, .world, MJCF .xml or FEBio .feb file.");
  return options;
}

}  // namespace

ModelText model_text_of(const std::string& file, const Overrides& overrides) {
  if (!is_importable(file)) return {read_file(file), file, file, overrides};
  ModelText result;
  std::string overlay;
  for (const std::string& text : overrides) {
    if (text.starts_with(kOverlayOption))
      overlay = text.substr(std::string_view(kOverlayOption).size());
    else
      result.overrides.push_back(text);
  }
  std::error_code ignored;
  if (const fs::path beside = overlay_beside(file);
      overlay.empty() && fs::is_regular_file(beside, ignored))
    overlay = beside.string();
  result.file = result.shown = overlay.empty() ? file : overlay;
  if (overlay.empty()) result.shown = "the import of " + file;
  result.text = overlay.empty() ? "format: 1\n" : read_file(overlay);
  const fs::path here = fs::absolute(fs::path(result.file), ignored).parent_path();
  const std::string name = overlay.empty() || fs::path(file).is_absolute()
                               ? overlay.empty() ? fs::path(file).filename().string() : file
                               : fs::absolute(file, ignored)
                                     .lexically_normal()
                                     .lexically_proximate(here.lexically_normal())
                                     .string();
  result.overrides.insert(result.overrides.begin(), "import.file=" + as_value(name));
  return result;
}

ImportReport expand_import(SourceTree& tree, const std::string& folder,
                           const std::string& mesh_folder, Overrides& overrides,
                           Diagnostics& diagnostics) {
  for (const std::string& text : overrides) {
    if (!is_of_import(text) || text.find('=') == std::string::npos) continue;
    tree.apply_override(text.substr(0, text.find('=')), text.substr(text.find('=') + 1),
                        diagnostics);
  }
  std::erase_if(overrides, is_of_import);
  SourceNode& root = tree.root();
  const SourceNode* node = root.is_map() ? root.find("import") : nullptr;
  if (node == nullptr) return {};
  diagnostics.throw_if_any();
  ReadContext context{.tree = tree, .diagnostics = diagnostics};
  ImportOptions options = read_options(context, *node, folder);
  if (const SourceNode* contacts = root.find("contacts")) {
    options.contacts = true;
    const SourceNode* standard = contacts->is_map() ? contacts->find("default") : nullptr;
    options.contact_friction =
        standard != nullptr && standard->is_map() && standard->find("friction") != nullptr;
  }
  if (const SourceNode* units = root.find("units"))
    context.fault(*units, "units", "cannot be combined with an import, which is in SI",
                  "Leave it out, and write units after numbers.");
  diagnostics.throw_if_any();
  ImportReport report;
  try {
    Imported imported = import_model(options, mesh_folder);
    diagnostics.know(imported.source);
    report = {imported.format, options.file, std::move(imported.notes)};
    const auto at = node - root.children.data();
    root.keys.erase(root.keys.begin() + at);
    root.children.erase(root.children.begin() + at);
    tree.add_below(std::move(imported.root), imported.source);
  } catch (const FileError& error) {
    context.fault(*node, "import.file", error.what(), "");
    diagnostics.throw_if_any();
  }
  return report;
}

ExpandedModel expanded_model(const std::string& file, const std::string& mesh_folder,
                             const Overrides& overrides) {
  ModelText source = model_text_of(file, overrides);
  ExpandedModel result;
  SourceTree tree = SourceTree::parse(source.text, source.shown);
  const bool imports = is_importable(file) || (tree.root().is_map() && tree.root().find("import"));
  result.text = std::move(source.text);
  result.overrides = std::move(source.overrides);
  if (!imports) return result;
  Diagnostics diagnostics(tree.source());
  result.report =
      expand_import(tree, folder_of(source.file), mesh_folder, result.overrides, diagnostics);
  result.text = yaml_text(tree.root());
  return result;
}

ExpandedModel expanded_model(const std::string& file, const Overrides& overrides) {
  return expanded_model(file, folder_of(file), overrides);
}

}  // namespace polhode::io
