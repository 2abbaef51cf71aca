// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_context.hpp>
#include <polhode/io/text/file_error.hpp>
#include <polhode/model/part_placement.hpp>

namespace polhode::io {

namespace {

/// Bounds of a model made of parts, which multiply when they contain each other: numbers far beyond
/// what a file of a person has, reached in seconds.
constexpr std::size_t kMostParts = 100'000;
constexpr std::size_t kDeepestPart = 64;

/// Reader of one part, which is added to the model; errors go to the context.
class PartReader {
 public:
  PartReader(ReadContext& context, const SourceNode& node, const SourceLocation& place,
             const std::string& name)
      : context_(context),
        node_(node),
        name_(name),
        section_(context, node, place, "parts." + name, part_fields()) {}

  void read() {
    if (!node_.is_map() || section_.has_unknown_key() || !has_room()) return;
    if (section_.refuse_both("file", "model", "Give one of them.")) return;
    if (section_.has("model")) {
      read_from(context_.tree, *section_.find("model"), context_.source_file, context_.folder);
    } else if (section_.has("file")) {
      if (const SourceTree* tree = open())
        read_from(*tree, tree->root(), file_, std::filesystem::path(file_).parent_path().string());
    } else {
      section_.fault("'file' is missing", "Give file, or model for a part written here.");
    }
  }

 private:
  /// Parsed file; null after an error.
  const SourceTree* open() {
    const auto text = section_.text("file");
    if (!text) return nullptr;
    file_ = (std::filesystem::path(context_.folder) / *text).lexically_normal().string();
    const std::string real = full_path(file_);
    const auto& above = context_.files_above;
    if (std::find(above.begin(), above.end(), real) != above.end()) {
      section_.fault("file", format("'{}' is part of itself", *text),
                     "Leave out the part that leads back to it.");
      return nullptr;
    }
    files_above_ = above;
    files_above_.push_back(real);
    std::shared_ptr<const SourceTree>& tree = context_.parts_read->trees[real];
    try {
      if (!tree) {
        tree = std::make_shared<SourceTree>(SourceTree::parse(read_file(file_), file_));
        context_.diagnostics.know(tree->shared_source());
      }
      PartsRead& all = *context_.parts_read;
      all.bytes += tree->source().text().size();
      if (all.bytes <= SourceLimits{}.bytes) return tree.get();
      section_.fault("file", format("the parts have more than {} bytes", SourceLimits{}.bytes),
                     "Parts within parts multiply; build a model of this size in code.");
    } catch (const FileError& error) {
      section_.fault("file", error.what(), "Paths are relative to the folder of this file.");
    } catch (const ModelErrors& errors) {
      context_.diagnostics.take(errors.diagnostics());
    }
    return nullptr;
  }

  /// Whether the model still has room for a part; adds an error, once, if not.
  bool has_room() {
    PartsRead& all = *context_.parts_read;
    if (all.count > kMostParts || all.bytes > SourceLimits{}.bytes) return false;
    ++all.count;
    const bool too_deep = context_.files_above.size() > kDeepestPart;
    if (too_deep)
      section_.fault("", format("parts are nested more than {} deep", kDeepestPart),
                     "Leave out the part that leads here.");
    else if (all.count > kMostParts)
      section_.fault("", format("the model has more than {} parts", kMostParts),
                     "Parts within parts multiply; build a model of this size in code.");
    return !too_deep && all.count <= kMostParts;
  }

  void read_from(const SourceTree& tree, const SourceNode& root, const std::string& file,
                 const std::string& folder) {
    const std::size_t before = context_.diagnostics.size();
    ReadContext part{.tree = tree, .diagnostics = context_.diagnostics};
    part.folder = folder;
    part.source_file = file;
    part.files_above = files_above_.empty() ? context_.files_above : files_above_;
    part.parts_read = context_.parts_read;
    read_given(part);
    read_things(part, root, &tree == &context_.tree ? section_.path() + ".model" : "");
    check_given(part, root);
    const PartPlacement placement = read_placement();
    const auto prefix = section_.text("prefix");
    if (context_.diagnostics.size() != before) return;
    try {
      place_part(part.model, placement);
    } catch (const InputError& error) {
      part.diagnostics.add(place_of_path(part, root, error.where()), error.where(),
                           error.what_is_wrong(), sentence(error.hint()));
      return;
    }
    add(std::move(part), root, prefix.value_or(name_ + "_"));
  }

  /// Variables passed to the part, in the units of the part if they have none.
  void read_given(ReadContext& part) {
    const SourceNode* node = section_.find("variables");
    if (!node || !node->is_map()) {
      if (node && node->kind != SourceNode::Kind::kEmpty)
        section_.fault("variables", "expects a map from names to numbers", "Write '{L: 1.0}'.");
      return;
    }
    for (std::size_t k = 0; k < node->keys.size(); ++k)
      part.given_variables[node->keys[k].name] = read_variable(
          context_, node->children[k], section_.path("variables") + "." + node->keys[k].name);
  }

  void check_given(const ReadContext& part, const SourceNode& root) {
    std::vector<std::string> names;
    const SourceNode* own = root.find("variables");
    if (own)
      for (const auto& key : own->keys) names.push_back(key.name);
    const SourceNode* node = section_.find("variables");
    for (const auto& [given, value] : part.given_variables) {
      if (std::find(names.begin(), names.end(), given) != names.end()) continue;
      const SourceNode* at = node->find(given);
      context_.fault(*at, section_.path("variables"),
                     format("the part has no variable {}", quote(given)),
                     did_you_mean(given, names) +
                         (names.empty() ? "It has none." : "Variables: " + name_list(names) + "."));
    }
  }

  PartPlacement read_placement() {
    PartPlacement placement;
    if (const auto position = section_.vector("position")) placement.position = *position;
    if (const SourceNode* node = section_.find("orientation"))
      if (const auto q = read_orientation(context_, *node, section_.path("orientation")))
        placement.orientation = *q;
    if (const auto mirror = section_.choice("mirror")) placement.mirror = mirror->front() - 'x';
    return placement;
  }

  void add(ReadContext part, const SourceNode& root, const std::string& prefix) {
    if (!check_names(part, prefix)) return;
    const auto take = [&](auto& whole, const auto& names, std::size_t first) {
      for (const auto& [name, index] : names)
        whole.emplace(prefix + name, index + static_cast<int>(first));
    };
    const Model& whole = context_.model;
    take(context_.bodies, part.bodies, whole.bodies.size());
    take(context_.joints, part.joints, whole.joints.size());
    take(context_.loads, part.loads, whole.loads.size());
    take(context_.materials, part.materials, whole.materials.size());
    take(context_.solids, part.solids, whole.solids.size());
    for (const auto& [name, index] : part.cables)
      context_.cables.emplace(
          prefix + name,
          index ? std::optional(*index + static_cast<int>(whole.cables.size())) : std::nullopt);
    for (const auto& [name, section] : part.sections)
      context_.sections.emplace(prefix + name, section);
    context_.body_is_sound.resize(whole.bodies.size() + part.model.bodies.size(), true);
    context_.material_is_sound.resize(whole.materials.size() + part.model.materials.size(), true);
    context_.solid_is_sound.resize(whole.solids.size() + part.model.solids.size(), true);
    append_part(context_.model, std::move(part.model), prefix);
    context_.parts.push_back({prefix, &part.tree, &root});
    for (PartSource& inner : part.parts)
      context_.parts.push_back({prefix + inner.prefix, inner.tree, inner.root});
  }

  /// Checks for names of the part that are already used; false after an error.
  bool check_names(const ReadContext& part, const std::string& prefix) {
    for (const char c : prefix) {
      if (std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-') continue;
      section_.fault("prefix", quote(prefix) + " is not allowed as the start of names",
                     "Use letters, digits, '_' and '-'.");
      return false;
    }
    const auto free = [&](const auto& whole, const auto& names) {
      for (const auto& [name, index] : names) {
        if (prefix.size() + name.size() > kLongestName) {
          section_.fault(section_.has("prefix") ? "prefix" : "",
                         format("the name {} would have {} characters, more than {}",
                                quote(prefix + name), prefix.size() + name.size(), kLongestName),
                         "Choose a shorter prefix; results have files of this name.");
          return false;
        }
        if (whole.find(prefix + name) == whole.end() && prefix + name != "ground") continue;
        section_.fault(section_.has("prefix") ? "prefix" : "",
                       format("the name '{}' is taken", prefix + name), "Choose another prefix.");
        return false;
      }
      return true;
    };
    return free(context_.bodies, part.bodies) && free(context_.joints, part.joints) &&
           free(context_.loads, part.loads) && free(context_.materials, part.materials) &&
           free(context_.solids, part.solids) && free(context_.cables, part.cables) &&
           free(context_.sections, part.sections);
  }

  ReadContext& context_;
  const SourceNode& node_;
  std::string name_, file_;
  Section section_;
  std::vector<std::string> files_above_;
};

}  // namespace

std::string full_path(const std::string& file) {
  std::error_code fault;  // Names may be longer than the file system allows.
  const std::filesystem::path path = std::filesystem::weakly_canonical(file, fault);
  return fault ? std::filesystem::path(file).lexically_normal().string() : path.string();
}

void read_parts(ReadContext& context, const SourceNode& node) {
  for (std::size_t k = 0; k < node.keys.size(); ++k) {
    const SourceNode::Key& key = node.keys[k];
    if (!check_name(context, key, node.children[k], "parts")) continue;
    PartReader(context, node.children[k], context.tree.place_of(key, node.children[k]), key.name)
        .read();
  }
}

}  // namespace polhode::io
