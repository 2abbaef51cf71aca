// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <polhode/io/text/diagnostics.hpp>

namespace polhode::io {

/// A value of a model file with its position: text, list or map.
struct SourceNode {
  enum class Kind : unsigned char { kEmpty, kText, kList, kMap };

  /// A key of a map, with its own position.
  struct Key {
    std::string name;
    int line = 0, column = 0;
  };

  Kind kind = Kind::kEmpty;
  bool in_quotes = false;    ///< The text was quoted or a block text.
  int line = 0, column = 0;  ///< 1-based; 0 in an override.
  int origin = 0;            ///< 0: the file; k: override k (1-based); −k: further file k.
  std::string text;
  std::vector<Key> keys;  ///< Of a map: key k belongs to child k.
  std::vector<SourceNode> children;

  [[nodiscard]] bool is_map() const { return kind == Kind::kMap; }
  [[nodiscard]] bool is_list() const { return kind == Kind::kList; }
  [[nodiscard]] bool is_text() const { return kind == Kind::kText; }
  /// The value of a key, or null.
  [[nodiscard]] const SourceNode* find(std::string_view key) const;
  [[nodiscard]] SourceNode* find(std::string_view key);
  /// Description of a value for messages: "a list", "a map", "the text 'x'", "nothing".
  [[nodiscard]] std::string description() const;
};

/// Limits of a file; larger ones are rejected rather than read for minutes.
struct SourceLimits {
  std::size_t bytes = std::size_t{1} << 29;
  std::size_t nodes = 50'000'000;
  int depth = 64;
};

/// A parsed model file: located values, and the text for excerpts.
class SourceTree {
 public:
  /// Parses strict YAML 1.2 (and so JSON). Rejects duplicate keys, anchors, aliases, tags, several
  /// documents, text that is not UTF-8, and files beyond the limits.
  /// @throws ModelErrors
  static SourceTree parse(std::string text, std::string filename, const SourceLimits& limits = {});

  [[nodiscard]] const SourceNode& root() const { return root_; }
  [[nodiscard]] SourceNode& root() { return root_; }
  [[nodiscard]] const SourceText& source() const { return *source_; }
  [[nodiscard]] std::shared_ptr<const SourceText> shared_source() const { return source_; }

  /// Replaces or adds a value like `--set path=value`.
  /// @param path  Name of a variable, or a path of keys and list indices joined by dots.
  /// @param value  As it would be written in the file.
  void apply_override(const std::string& path, const std::string& value, Diagnostics& diagnostics);

  /// Adds the values of another file below those that stand here: maps are merged, and what is
  /// given here is kept.
  void add_below(SourceNode root, std::shared_ptr<const SourceText> source);

  /// Position of a node: in the file, or "--set path=value".
  [[nodiscard]] SourceLocation place_of(const SourceNode& node) const;
  [[nodiscard]] SourceLocation place_of(const SourceNode::Key& key, const SourceNode& value) const;

 private:
  std::shared_ptr<const SourceText> source_;
  std::deque<std::string> overrides_;
  std::vector<std::shared_ptr<const SourceText>> further_;
  SourceNode root_;
};

}  // namespace polhode::io
