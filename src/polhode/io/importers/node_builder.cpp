// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/node_builder.hpp>

#include <cctype>

#include <polhode/core/format.hpp>

namespace polhode::io {

SourceNode NodeBuilder::text(const std::string& value) const {
  SourceNode node;
  node.kind = SourceNode::Kind::kText;
  node.line = line;
  node.text = value;
  return node;
}

SourceNode NodeBuilder::number(double value) const {
  return text(format("{}", value == 0.0 ? 0.0 : value));  // No minus zero.
}

SourceNode NodeBuilder::boolean(bool value) const { return text(value ? "true" : "false"); }

SourceNode NodeBuilder::vector(const Vec3& value) const {
  return list({number(value.x()), number(value.y()), number(value.z())});
}

SourceNode NodeBuilder::direction(const Vec3& value) const {
  for (int k = 0; k < 3; ++k)
    for (const double sign : {1.0, -1.0})
      if (value == sign * Vec3::Unit(k)) return text(std::string(sign < 0.0 ? "-" : "") + "xyz"[k]);
  return vector(value);
}

SourceNode NodeBuilder::list(std::vector<SourceNode> values) const {
  SourceNode node;
  node.kind = SourceNode::Kind::kList;
  node.line = line;
  node.children = std::move(values);
  return node;
}

SourceNode NodeBuilder::map() const {
  SourceNode node;
  node.kind = SourceNode::Kind::kMap;
  node.line = line;
  return node;
}

SourceNode NodeBuilder::orientation(const Quat& value) const {
  SourceNode node = map();
  put(node, "quaternion",
      list({number(value.w()), number(value.x()), number(value.y()), number(value.z())}));
  return node;
}

SourceNode NodeBuilder::inertia(const Mat3& value) const {
  SourceNode node = map();
  put(node, "xx", number(value(0, 0)));
  put(node, "yy", number(value(1, 1)));
  put(node, "zz", number(value(2, 2)));
  if (value(0, 1) != 0.0) put(node, "xy", number(value(0, 1)));
  if (value(0, 2) != 0.0) put(node, "xz", number(value(0, 2)));
  if (value(1, 2) != 0.0) put(node, "yz", number(value(1, 2)));
  return node;
}

SourceNode& NodeBuilder::put(SourceNode& map, const std::string& key, SourceNode value) const {
  map.keys.push_back({key, line, 1});
  map.children.push_back(std::move(value));
  return map.children.back();
}

std::string allowed_name(const std::string& name) {
  std::string allowed = name;
  for (char& c : allowed) {
    const auto u = static_cast<unsigned char>(c);
    if (u >= 0x80 || (!std::isalnum(u) && c != '_' && c != '-')) c = '_';
  }
  return allowed;
}

}  // namespace polhode::io
