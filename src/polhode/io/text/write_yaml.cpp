// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/text/write_yaml.hpp>

#include <algorithm>
#include <cctype>

#include <polhode/core/format.hpp>

namespace polhode::io {

namespace {

/// Longest line that a map or list is written on [characters].
constexpr std::size_t kLine = 110;

/// Whether a text is the same without quotes in any place: a number, a name or a word.
bool is_plain(const std::string& text) {
  if (text.empty() || text == "-" || text == "~" || text == "null") return false;
  return std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return c < 0x80 && (std::isalnum(c) || c == '_' || c == '-' || c == '+' || c == '.');
  });
}

std::string in_quotes(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto u = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      out += std::string("\\") + c;
    else if (c == '\n')
      out += "\\n";
    else if (c == '\t')
      out += "\\t";
    else if (u < 0x20)
      out += format("\\x{:02x}", u);
    else
      out += c;
  }
  return out + "\"";
}

std::string scalar(const SourceNode& node) {
  if (node.kind == SourceNode::Kind::kEmpty) return "~";
  return !node.in_quotes && is_plain(node.text) ? node.text : in_quotes(node.text);
}

/// A value on one line.
std::string flow(const SourceNode& node) {
  if (!node.is_list() && !node.is_map()) return scalar(node);
  std::string out = node.is_map() ? "{" : "[";
  for (std::size_t k = 0; k < node.children.size(); ++k) {
    if (k > 0) out += ", ";
    if (node.is_map()) {
      const std::string& key = node.keys[k].name;
      out += (is_plain(key) ? key : in_quotes(key)) + ": ";
    }
    out += flow(node.children[k]);
  }
  return out + (node.is_map() ? "}" : "]");
}

void write(const SourceNode& node, std::size_t indent, bool root, std::string& out) {
  const std::string margin(indent, ' ');
  for (std::size_t k = 0; k < node.children.size(); ++k) {
    const SourceNode& child = node.children[k];
    std::string head = "-";
    if (node.is_map()) {
      const std::string& key = node.keys[k].name;
      head = (is_plain(key) ? key : in_quotes(key)) + ":";
    }
    const std::string line = flow(child);
    const bool holds = (child.is_map() || child.is_list()) && !child.children.empty();
    const bool open = root && child.is_map() && holds &&
                      std::all_of(child.children.begin(), child.children.end(),
                                  [](const SourceNode& c) { return c.is_map(); });
    out += margin + head;
    if (holds && (open || margin.size() + head.size() + 1 + line.size() > kLine)) {
      out += "\n";
      write(child, indent + 2, false, out);
    } else {
      out += " " + line + "\n";
    }
  }
}

}  // namespace

std::string yaml_text(const SourceNode& root) {
  std::string out;
  if (root.is_map() || root.is_list()) write(root, 0, true, out);
  return out;
}

}  // namespace polhode::io
