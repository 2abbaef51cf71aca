// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/read/model_places.hpp>

#include <algorithm>
#include <filesystem>

#include <polhode/io/read/read_context.hpp>
#include <polhode/io/text/file_error.hpp>

namespace polhode::io {

namespace {

/// The child of a map whose name is at that position; null if there is none.
const SourceNode* node_at(const SourceNode& node, int line, int column) {
  for (std::size_t k = 0; k < node.children.size(); ++k) {
    const bool here = node.is_map() && node.keys[k].line == line && node.keys[k].column == column;
    if (here) return &node.children[k];
    if (const SourceNode* found = node_at(node.children[k], line, column)) return found;
  }
  return nullptr;
}

/// A file of the model, read again for an error in it.
struct FileAgain {
  SourceTree tree;
  Diagnostics diagnostics;

  FileAgain(const std::string& file, const Overrides& overrides)
      : tree(SourceTree::parse(read_file(file), file)), diagnostics(tree.source()) {
    for (const std::string& text : overrides) {
      const std::size_t equals = std::min(text.find('='), text.size() - 1);
      tree.apply_override(text.substr(0, equals), text.substr(equals + 1), diagnostics);
    }
  }
  /// Position of the deepest value of a path below a node; nothing if it has none of it.
  std::optional<SourceLocation> place(const SourceNode& root, const std::string& path) {
    const ReadContext context{.tree = tree, .diagnostics = diagnostics};
    const SourceLocation place = place_of_path(context, root, path);
    const SourceLocation start = tree.place_of(root);
    const bool same =
        place.file == start.file && place.line == start.line && place.column == start.column;
    return same ? std::nullopt : std::optional(place);
  }
};

/// "joints.B" of "joints.B.motion"; the whole if it is short.
std::string thing_of_path(const std::string& path) {
  const std::size_t first = path.find('.');
  return path.substr(0, first == std::string::npos ? first : path.find('.', first + 1));
}

bool is_file_or_option(const std::string& where) {
  std::error_code ignored;
  return where.starts_with("-") || where.starts_with("polhode") ||
         where.find('/') != std::string::npos || std::filesystem::exists(where, ignored);
}

}  // namespace

ModelPlaces::ModelPlaces(const Model& model, Overrides overrides)
    : file_(model.source_file), overrides_(std::move(overrides)) {
  if (file_.empty()) return;
  const auto add = [&](const std::string& kind, const auto& list) {
    for (const auto& thing : list) {
      if (thing.place.file.empty()) continue;
      things_.emplace(kind + "." + thing.name, thing.place);
      names_.emplace(thing.name, thing.place);
    }
  };
  add("joints", model.joints);
  add("loads", model.loads);
  add("solids", model.solids);
  add("beams", model.beams);
  add("cables", model.cables);
  add("bodies", model.bodies);
  add("controllers", model.controllers);
  add("events", model.events);
  add("materials", model.materials);
  add("output.probes", model.output.probes);
  for (const auto& [section, place] :
       {std::pair("contacts", &model.contacts.place), {"analysis", &model.analysis.place}})
    if (!place->file.empty()) things_.emplace(section, *place);
}

std::optional<SourceLocation> ModelPlaces::place_of(const std::string& path) const {
  const std::string thing = thing_of_path(path);
  const auto known = [&](const std::string& name) -> std::optional<SourceLocation> {
    const auto found = things_.find(name);
    return found == things_.end() ? std::nullopt : std::optional(found->second);
  };
  const std::optional<SourceLocation> whole =
      thing.find('.') == std::string::npos ? std::nullopt : known(thing);
  if (whole && whole->line == 0) return whole;  // of --set
  try {
    // Names and values below the thing are found in its file, which may be that of a part.
    const bool main = !whole || whole->file == file_;
    FileAgain again(main ? file_ : whole->file, main ? overrides_ : Overrides{});
    const SourceNode* node =
        whole ? node_at(again.tree.root(), whole->line, whole->column) : &again.tree.root();
    const std::string rest = whole ? path.substr(std::min(path.size(), thing.size() + 1)) : path;
    if (node != nullptr && !rest.empty())
      if (const auto place = again.place(*node, rest)) return place;
  } catch (const std::exception&) {  // The file is gone or has changed.
  }
  return whole ? whole : known(path.substr(0, path.find('.')));
}

std::optional<SourceLocation> ModelPlaces::named_in(const std::string& text) const {
  for (std::size_t begin = text.find('\''); begin != std::string::npos;) {
    const std::size_t end = text.find('\'', begin + 1);
    if (end == std::string::npos) break;
    const auto found = names_.find(text.substr(begin + 1, end - begin - 1));
    if (found != names_.end()) return found->second;
    begin = end;  // A closing quote may open the next name.
  }
  return std::nullopt;
}

Diagnostic ModelPlaces::at(const SourceLocation& place, std::string path, std::string what,
                           std::string hint) const {
  if (!hint.empty() && hint.back() != '.') hint += '.';
  Diagnostic d{place, std::move(path), std::move(what), std::move(hint), ""};
  if (place.line <= 0) return d;
  try {
    d.excerpt = SourceText(place.file, read_file(place.file)).excerpt(place.line, place.column);
  } catch (const FileError&) {  // The position alone has to do.
  }
  return d;
}

std::optional<Diagnostic> ModelPlaces::located(const InputError& error) const {
  if (file_.empty()) return std::nullopt;
  std::optional<SourceLocation> place = place_of(error.where());
  if (!place && is_file_or_option(error.where())) return std::nullopt;
  if (!place) place = named_in(error.where() + " " + error.what_is_wrong());
  return at(place.value_or(SourceLocation{file_, 1, 1}), error.where(), error.what_is_wrong(),
            error.hint());
}

std::optional<Diagnostic> ModelPlaces::located(const SolveError& error) const {
  if (file_.empty()) return std::nullopt;
  std::string what = error.what();
  if (what.ends_with('.')) what.pop_back();
  std::optional<SourceLocation> place = named_in(what);
  if (!place) place = place_of("analysis");
  return at(place.value_or(SourceLocation{file_, 1, 1}), "", what, "");
}

}  // namespace polhode::io
