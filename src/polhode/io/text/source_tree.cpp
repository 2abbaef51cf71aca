// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/text/source_tree.hpp>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <sstream>
#include <unordered_set>

#include <polhode/core/format.hpp>
#include <polhode/io/text/surrogate_pairs.hpp>

namespace polhode::io {
namespace {

constexpr const char* kNoAliases = "aliases (*name) are not allowed";
constexpr const char* kWriteOut = "Write the value out, or use a variable.";

/// Stops the parser at the first unrecoverable error.
struct SourceStop {
  int line, column;
  std::string what, hint;
};

/// Builds our tree from the parser's events.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(const SourceText& source, const SourceLimits& limits, SourceNode& root)
      : source_(source), limits_(limits), root_(root) {}

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { add(make(mark)); }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    refuse(mark, kNoAliases, kWriteOut);
  }

  void OnAnchor(const YAML::Mark& mark, const std::string&) override {
    refuse(mark, "anchors (&name) are not allowed", kWriteOut);
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                const std::string& value) override {
    refuse_tag(mark, tag);
    if (tag == "!") check_closing_quote(mark);
    SourceNode node = make(mark);
    node.kind = SourceNode::Kind::kText;
    node.in_quotes = tag == "!";
    node.text = value;
    add(std::move(node));
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    refuse_tag(mark, tag);
    open(mark, SourceNode::Kind::kList);
  }
  void OnSequenceEnd() override { close(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    refuse_tag(mark, tag);
    open(mark, SourceNode::Kind::kMap);
  }
  void OnMapEnd() override { close(); }

 private:
  /// A list or map being filled.
  struct Level {
    SourceNode node;
    std::unordered_set<std::string> names;
    bool has_key = false;
  };

  [[noreturn]] static void refuse(const YAML::Mark& mark, std::string what, std::string hint) {
    throw SourceStop{mark.line + 1, mark.column + 1, std::move(what), std::move(hint)};
  }

  void refuse_tag(const YAML::Mark& mark, const std::string& tag) const {
    const std::string_view line = source_.line(mark.line + 1);
    const auto column = static_cast<std::size_t>(mark.column);
    const bool starts_with_tag = column < line.size() && line[column] == '!';
    if (starts_with_tag || (!tag.empty() && tag != "?" && tag != "!"))
      refuse(mark, "tags (!name) are not allowed", "Leave the tag out.");
  }

  /// Checks for a quote that is never closed, which the parser reads as a text up to the end of the
  /// file.
  void check_closing_quote(const YAML::Mark& mark) const {
    const std::string_view text = source_.text();
    std::size_t k = source_.offset(mark.line + 1) + static_cast<std::size_t>(mark.column);
    const char quote_mark = k < text.size() ? text[k] : ' ';
    if (quote_mark != '"' && quote_mark != '\'') return;  // A block text.
    for (++k; k < text.size(); ++k) {
      if (text[k] == '\\' && quote_mark == '"') {
        ++k;
      } else if (text[k] == quote_mark) {
        const bool doubled = quote_mark == '\'' && k + 1 < text.size() && text[k + 1] == '\'';
        if (!doubled) return;
        ++k;
      }
    }
    refuse(mark, "the quote is not closed", format("Add {} where the text ends.", quote_mark));
  }

  SourceNode make(const YAML::Mark& mark) {
    if (++nodes_ > limits_.nodes)
      refuse(mark, format("the file has more than {} values", limits_.nodes),
             "Build a model of this size in code.");
    SourceNode node;
    node.line = mark.line + 1;
    node.column = mark.column + 1;
    return node;
  }

  void open(const YAML::Mark& mark, SourceNode::Kind kind) {
    if (static_cast<int>(levels_.size()) >= limits_.depth)
      refuse(mark, format("values are nested more than {} deep", limits_.depth),
             "No entry of a model needs that; look for a missing closing bracket.");
    Level level{make(mark), {}, false};
    level.node.kind = kind;
    levels_.push_back(std::move(level));
  }

  void close() {
    SourceNode node = std::move(levels_.back().node);
    levels_.pop_back();
    add(std::move(node));
  }

  void add(SourceNode node) {
    if (levels_.empty()) {
      root_ = std::move(node);
      return;
    }
    Level& level = levels_.back();
    if (level.node.kind == SourceNode::Kind::kMap && !level.has_key) {
      add_key(level, node);
      return;
    }
    level.has_key = false;
    if (node.kind == SourceNode::Kind::kEmpty && !level.node.keys.empty()) {
      // The parser gives no useful position for an empty value.
      node.line = level.node.keys.back().line;
      node.column = level.node.keys.back().column;
    }
    level.node.children.push_back(std::move(node));
  }

  static void add_key(Level& level, const SourceNode& node) {
    const auto stop = [&](std::string what, std::string hint) {
      throw SourceStop{node.line, node.column, std::move(what), std::move(hint)};
    };
    if (node.kind != SourceNode::Kind::kText)
      stop("a key must be a name, but is " + node.description(), "Write 'name: value'.");
    if (node.text == "<<") stop("merge keys (<<) are not allowed", "Write the values out.");
    if (!level.names.insert(node.text).second)
      stop("the key " + quote(node.text) + " stands twice", "Keep one of them.");
    level.node.keys.push_back({node.text, node.line, node.column});
    level.has_key = true;
  }

  const SourceText& source_;
  const SourceLimits& limits_;
  SourceNode& root_;
  std::vector<Level> levels_;
  std::size_t nodes_ = 0;
};

/// Hands events on with their columns in the user's text.
class PlacedEvents : public YAML::EventHandler {
 public:
  PlacedEvents(const SurrogatePairs& pairs, YAML::EventHandler& next)
      : pairs_(pairs), next_(next) {}

  void OnDocumentStart(const YAML::Mark& mark) override { next_.OnDocumentStart(placed(mark)); }
  void OnDocumentEnd() override { next_.OnDocumentEnd(); }
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    next_.OnNull(placed(mark), anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    next_.OnAlias(placed(mark), anchor);
  }
  void OnAnchor(const YAML::Mark& mark, const std::string& name) override {
    next_.OnAnchor(placed(mark), name);
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    next_.OnScalar(placed(mark), tag, anchor, value);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value style) override {
    next_.OnSequenceStart(placed(mark), tag, anchor, style);
  }
  void OnSequenceEnd() override { next_.OnSequenceEnd(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value style) override {
    next_.OnMapStart(placed(mark), tag, anchor, style);
  }
  void OnMapEnd() override { next_.OnMapEnd(); }

  [[nodiscard]] YAML::Mark placed(YAML::Mark mark) const {
    mark.column = pairs_.column(mark.line, mark.column);
    return mark;
  }

 private:
  const SurrogatePairs& pairs_;
  YAML::EventHandler& next_;
};

/// Byte-order mark and carriage returns of Windows removed.
std::string normalised(std::string text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  std::size_t kept = 0;
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (text[k] == '\r' && k + 1 < text.size() && text[k + 1] == '\n') continue;
    text[kept++] = text[k];
  }
  text.resize(kept);
  return text;
}

/// Rejects bytes that are invalid in text files, before parsing.
void check_characters(const SourceText& source) {
  const std::string_view text = source.text();
  int line = 1, column = 1;
  for (std::size_t k = 0; k < text.size();) {
    const std::size_t n = utf8_length(text.substr(k));
    if (n == 0) throw SourceStop{line, column, "the text is not UTF-8", "Save the file as UTF-8."};
    const auto c = static_cast<unsigned char>(text[k]);
    if ((c < 0x20 && c != '\n' && c != '\t') || c == 0x7F)
      throw SourceStop{line, column, format("the character with code {} is not allowed", c),
                       "Remove it; a model file is plain text."};
    // YAML's two further line ends, which editors do not count.
    if (n == 3 && (text.substr(k, 3) == "\xE2\x80\xA8" || text.substr(k, 3) == "\xE2\x80\xA9"))
      throw SourceStop{line, column, "a Unicode line separator is not allowed",
                       "End lines as usual."};
    if (c == '\n') {
      ++line;
      column = 1;
    } else {
      column += static_cast<int>(n);
    }
    k += n;
  }
}

/// Sentence from the parser's message.
SourceStop parser_complaint(const SourceText& source, const YAML::Exception& error) {
  const int line = error.mark.line + 1, column = error.mark.column + 1;
  const std::string_view text = source.line(line);
  const std::size_t indent = text.find_first_not_of(" \t");
  if (text.substr(0, indent).find('\t') != std::string_view::npos)
    return {line, 1, "a tab cannot indent", "Indent with spaces."};
  if (error.msg.find("anchor") != std::string::npos) return {line, column, kNoAliases, kWriteOut};
  return {line, column, "the text is not YAML: " + error.msg,
          "Check indentation, brackets and quotes here and in the line above."};
}

void parse_into(const SourceText& source, const SourceLimits& limits, SourceNode& root) {
  check_characters(source);
  const SurrogatePairs pairs(source.text());
  std::istringstream stream(pairs.text());
  try {
    YAML::Parser parser(stream);
    TreeBuilder builder(source, limits, root);
    PlacedEvents events(pairs, builder);
    if (!parser.HandleNextDocument(events)) return;
    struct Refuser : TreeBuilder {
      using TreeBuilder::TreeBuilder;
      void OnDocumentStart(const YAML::Mark& mark) override {
        throw SourceStop{mark.line + 1, mark.column + 1, "a second document starts here",
                         "Keep one document in a file."};
      }
    };
    SourceNode ignored;
    Refuser refuser(source, limits, ignored);
    PlacedEvents further(pairs, refuser);
    parser.HandleNextDocument(further);
  } catch (YAML::Exception& error) {
    error.mark.column = pairs.column(error.mark.line, error.mark.column);
    throw parser_complaint(source, error);
  }
}

}  // namespace

const SourceNode* SourceNode::find(std::string_view key) const {
  for (std::size_t k = 0; k < keys.size(); ++k)
    if (keys[k].name == key) return &children[k];
  return nullptr;
}

SourceNode* SourceNode::find(std::string_view key) {
  return const_cast<SourceNode*>(static_cast<const SourceNode*>(this)->find(key));
}

std::string SourceNode::description() const {
  switch (kind) {
    case Kind::kList:
      return children.empty() ? "an empty list" : "a list";
    case Kind::kMap:
      return "a map";
    case Kind::kText:
      return quote(text);
    case Kind::kEmpty:
      break;
  }
  return "empty";
}

SourceTree SourceTree::parse(std::string text, std::string filename, const SourceLimits& limits) {
  SourceTree tree;
  const auto refuse = [&](int line, int column, std::string what, std::string hint) {
    Diagnostics diagnostics(*tree.source_);
    const SourceLocation place{tree.source_->name(), line, column};
    diagnostics.add(place, "", std::move(what), std::move(hint));
    diagnostics.throw_if_any();
  };
  const std::size_t size = text.size();
  tree.source_ = std::make_shared<SourceText>(
      std::move(filename), size > limits.bytes ? "" : normalised(std::move(text)));
  if (size > limits.bytes)
    refuse(1, 1, format("the file has {} bytes, more than {}", size, limits.bytes),
           "Build a model of this size in code.");
  try {
    parse_into(*tree.source_, limits, tree.root_);
  } catch (const SourceStop& stop) {
    refuse(stop.line, stop.column, stop.what, stop.hint);
  }
  return tree;
}

SourceLocation SourceTree::place_of(const SourceNode& node) const {
  if (node.origin < 0)
    return {further_[static_cast<std::size_t>(-node.origin) - 1]->name(), node.line, node.column};
  if (node.origin > 0) return {overrides_[static_cast<std::size_t>(node.origin) - 1], 0, 0};
  return {source_->name(), node.line, node.column};
}

SourceLocation SourceTree::place_of(const SourceNode::Key& key, const SourceNode& value) const {
  if (key.line == 0 || value.origin < 0) return place_of(value);
  return {source_->name(), key.line, key.column};
}

namespace {

void mark_origin(SourceNode& node, int origin) {
  node.origin = origin;
  node.line = node.column = 0;
  for (auto& key : node.keys) key.line = key.column = 0;
  for (SourceNode& child : node.children) mark_origin(child, origin);
}

/// Whether a value is a number without a unit, for which YAML has nothing but its text.
bool is_bare_number(const std::string& value) {
  const std::size_t first = value.starts_with('-') ? 1 : 0;
  return first < value.size() && value[first] >= '0' && value[first] <= '9' &&
         value.find_first_not_of("0123456789.eE+-") == std::string::npos;
}

std::vector<std::string> split_path(const std::string& path) {
  std::vector<std::string> parts(1);
  for (const char c : path) {
    if (c == '.') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

std::vector<std::string> key_names(const SourceNode& node) {
  std::vector<std::string> names;
  for (const auto& key : node.keys) names.push_back(key.name);
  return names;
}

}  // namespace

void SourceTree::apply_override(const std::string& path, const std::string& value,
                                Diagnostics& diagnostics) {
  overrides_.push_back("--set " + path + "=" + value);
  const int origin = static_cast<int>(overrides_.size());
  const SourceLocation place{overrides_.back(), 0, 0};
  SourceNode replacement;
  if (is_bare_number(value)) {  // as most are, in studies of thousands of runs
    replacement.kind = SourceNode::Kind::kText;
    replacement.text = value;
  } else {
    try {
      const SourceText text("", value);
      parse_into(text, {}, replacement);
    } catch (const SourceStop& stop) {
      diagnostics.add(place, path, stop.what, stop.hint);
      return;
    }
  }
  mark_origin(replacement, origin);

  std::vector<std::string> parts = split_path(path);
  const SourceNode* variables = root_.find("variables");
  const bool is_variable = parts.size() == 1 && variables && variables->find(parts[0]);
  if (is_variable) parts.insert(parts.begin(), "variables");
  if (parts.size() == 1 && root_.is_map() && !root_.find(parts[0]) && parts[0] != "title" &&
      parts[0] != "gravity") {
    std::vector<std::string> names = variables ? key_names(*variables) : std::vector<std::string>{};
    const std::string known =
        names.empty() ? "The model has no variables." : "Variables: " + name_list(names) + ".";
    for (const std::string& name : key_names(root_)) names.push_back(name);
    diagnostics.add(place, path, "there is no variable " + quote(parts[0]),
                    did_you_mean(parts[0], names) + known);
    return;
  }

  SourceNode* node = &root_;
  std::string walked;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const std::string& part = parts[k];
    const bool last = k + 1 == parts.size();
    const std::string here = walked.empty() ? "the model" : quote(walked);
    SourceNode* next = nullptr;
    if (node->is_list()) {
      const bool is_index = !part.empty() && part.size() < 9 &&
                            part.find_first_not_of("0123456789") == std::string::npos;
      const std::size_t index = is_index ? std::stoul(part) : node->children.size();
      if (index >= node->children.size()) {
        diagnostics.add(place, path, format("{} has no entry {}", here, quote(part)),
                        node->children.empty()
                            ? "The list is empty."
                            : format("Entries count from 0 to {}.", node->children.size() - 1));
        return;
      }
      next = &node->children[index];
    } else if (node->is_map()) {
      next = node->find(part);
      // Keys of an object may be added; objects, and likely misspellings of objects, may not.
      const bool holds_names = k == 1 && (parts[0] == "bodies" || parts[0] == "joints" ||
                                          parts[0] == "loads" || parts[0] == "variables");
      const bool holds_keys =
          k == 1 && (parts[0] == "contacts" || parts[0] == "analysis" || parts[0] == "output");
      const bool may_add = !holds_names && (last || k == 0 || holds_keys || parts[0] == "import");
      if (!next && !may_add) {
        const std::vector<std::string> names = key_names(*node);
        diagnostics.add(place, path, format("{} has no entry {}", here, quote(part)),
                        names.empty()
                            ? "It is empty."
                            : did_you_mean(part, names) + "Entries: " + name_list(names) + ".");
        return;
      }
      if (!next) {
        node->keys.push_back({part, 0, 0});
        node->children.emplace_back();
        next = &node->children.back();
        next->origin = origin;
        if (!last) next->kind = SourceNode::Kind::kMap;
      }
    } else {
      diagnostics.add(
          place, path,
          format("{} is {} and has no entry {}", here, node->description(), quote(part)),
          "Shorten the path.");
      return;
    }
    walked += (walked.empty() ? "" : ".") + part;
    node = next;
  }
  *node = std::move(replacement);
}

}  // namespace polhode::io
