// SPDX-License-Identifier: Apache-2.0
// Values of a further file in a source tree.
#include <polhode/io/text/source_tree.hpp>

namespace polhode::io {

namespace {

/// Marks values as those of a further file, each at the first word of its line.
void mark_further(SourceNode& node, int origin, const SourceText& source) {
  const auto column = [&](int line) {
    const std::size_t first = source.line(line).find_first_not_of(" \t");
    return first == std::string_view::npos ? 1 : static_cast<int>(first) + 1;
  };
  node.origin = origin;
  node.column = column(node.line);
  for (auto& key : node.keys) key.column = column(key.line);
  for (SourceNode& child : node.children) mark_further(child, origin, source);
}

/// Adds what a map does not have.
void merge_below(SourceNode& above, SourceNode below) {
  SourceNode merged = std::move(above);
  above = SourceNode{};
  above.kind = SourceNode::Kind::kMap;
  above.line = merged.line;
  above.column = merged.column;
  above.origin = merged.origin;
  std::vector<bool> used(merged.keys.size(), false);
  for (std::size_t k = 0; k < below.keys.size(); ++k) {
    std::size_t own = 0;
    while (own < merged.keys.size() && merged.keys[own].name != below.keys[k].name) ++own;
    above.keys.push_back(own < merged.keys.size() ? merged.keys[own] : below.keys[k]);
    above.children.push_back(std::move(below.children[k]));
    if (own == merged.keys.size()) continue;
    used[own] = true;
    SourceNode& value = above.children.back();
    if (merged.children[own].is_map() && value.is_map()) {
      SourceNode inner = std::move(value);
      value = std::move(merged.children[own]);
      merge_below(value, std::move(inner));
    } else {
      value = std::move(merged.children[own]);
    }
  }
  for (std::size_t k = 0; k < merged.keys.size(); ++k) {
    if (used[k]) continue;
    above.keys.push_back(std::move(merged.keys[k]));
    above.children.push_back(std::move(merged.children[k]));
  }
}

}  // namespace

void SourceTree::add_below(SourceNode root, std::shared_ptr<const SourceText> source) {
  further_.push_back(std::move(source));
  mark_further(root, -static_cast<int>(further_.size()), *further_.back());
  merge_below(root_, std::move(root));
}

}  // namespace polhode::io
