// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_context.hpp>

namespace polhode::io {

bool check_name(ReadContext& context, const SourceNode::Key& key, const SourceNode& value,
                const std::string& collection) {
  const SourceLocation place = context.tree.place_of(key, value);
  const std::string path = collection.empty() ? key.name : collection + "." + key.name;
  if (key.name == "ground") {
    context.diagnostics.add(place, path, "the name 'ground' is taken", "Choose another name.");
    return false;
  }
  bool sound = !key.name.empty();
  for (const char c : key.name)
    sound = sound && (std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-') &&
            static_cast<unsigned char>(c) < 0x80;
  if (!sound)
    context.diagnostics.add(place, collection, quote(key.name) + " is not allowed as a name",
                            "Use letters, digits, '_' and '-'.");
  else if (key.name.size() > kLongestName)
    context.diagnostics.add(place, collection,
                            format("the name {} has {} characters, more than {}", quote(key.name),
                                   key.name.size(), kLongestName),
                            "Choose a shorter one; results have files of this name.");
  return sound && key.name.size() <= kLongestName;
}

const FieldTable* read_kind(ReadContext& context, const SourceNode& node,
                            const SourceLocation& place, const std::string& path,
                            const std::vector<KindTable>& kinds, std::string& type,
                            const char* key) {
  std::vector<std::string> names;
  names.reserve(kinds.size());
  for (const KindTable& kind : kinds) names.push_back(kind.name);
  if (!node.is_map()) {
    context.fault(node, path, "expects a map of keys and values, but is " + node.description(),
                  format("Start with '{}', one of: {}.", key, name_list(names)));
    return nullptr;
  }
  const SourceNode* value = node.find(key);
  if (!value) {
    context.diagnostics.add(place, path, format("'{}' is missing", key),
                            "Use one of: " + name_list(names) + ".");
    return nullptr;
  }
  const auto word = read_choice(context, *value, path + "." + key, names);
  if (!word) return nullptr;
  type = *word;
  for (const KindTable& kind : kinds)
    if (kind.name == type) return &kind.table;
  return nullptr;
}

Section::Section(ReadContext& context, const SourceNode& node, SourceLocation place,
                 std::string path, const FieldTable& table)
    : context_(context),
      node_(node),
      place_(std::move(place)),
      path_(std::move(path)),
      table_(table) {
  if (!node.is_map()) {
    context.fault(node, path_, "expects a map of keys and values, but is " + node.description(),
                  "Keys: " + name_list(table.names(), 40) + ".");
    return;
  }
  for (std::size_t k = 0; k < node.keys.size(); ++k) {
    const SourceNode::Key& key = node.keys[k];
    const std::string key_path = path_.empty() ? key.name : path_ + "." + key.name;
    const SourceLocation key_place = context.tree.place_of(key, node.children[k]);
    if (table.find(key.name)) continue;
    has_unknown_key_ = true;
    likely_meant_.push_back(closest(key.name, table.names()));
    context.diagnostics.add(
        key_place, path_, "unknown key " + quote(key.name),
        did_you_mean(key.name, table.names()) + "Keys: " + name_list(table.names(), 40) + ".");
  }
  for (const Field& field : table.fields)
    if (field.required && misses(field.name))
      fault(format("'{}' is missing", field.name), field.meaning);
}

const SourceNode* Section::find(const std::string& name) const {
  static_cast<void>(table_.at(name));  // A reader uses only keys of the table.
  return node_.is_map() ? node_.find(name) : nullptr;
}

bool Section::misses(const std::string& name) const {
  return !has(name) &&
         std::find(likely_meant_.begin(), likely_meant_.end(), name) == likely_meant_.end();
}

void Section::fault(const std::string& name, std::string what, std::string hint) {
  if (const SourceNode* node = node_.find(name)) {
    context_.fault(*node, path(name), std::move(what), std::move(hint));
  } else {
    fault(std::move(what), std::move(hint));
  }
}

void Section::fault(std::string what, std::string hint) {
  context_.diagnostics.add(place_, path_, std::move(what), std::move(hint));
}

bool Section::refuse_both(const std::string& one, const std::string& other,
                          const std::string& hint) {
  if (!has(one) || !has(other)) return false;
  fault(other, format("cannot be combined with '{}'", one), hint);
  return true;
}

std::optional<double> Section::number(const std::string& name) {
  const SourceNode* node = find(name);
  return node ? read_number(context_, *node, path(name), table_.at(name)) : std::nullopt;
}

std::optional<std::vector<double>> Section::number_list(const std::string& name) {
  const SourceNode* node = find(name);
  if (!node) return std::nullopt;
  return read_number_list(context_, *node, path(name), table_.at(name));
}

std::optional<int> Section::integer(const std::string& name) {
  const std::optional<double> value = number(name);
  if (!value) return std::nullopt;
  if (*value == std::floor(*value) && std::abs(*value) < 1e9) return static_cast<int>(*value);
  fault(name, "must be a whole number, but is " + shown(*value), table_.at(name).meaning);
  return std::nullopt;
}

std::optional<bool> Section::boolean(const std::string& name) {
  const SourceNode* node = find(name);
  return node ? read_boolean(context_, *node, path(name)) : std::nullopt;
}

std::optional<std::string> Section::text(const std::string& name) {
  const SourceNode* node = find(name);
  return node ? read_text(context_, *node, path(name)) : std::nullopt;
}

std::optional<std::string> Section::choice(const std::string& name) {
  const SourceNode* node = find(name);
  return node ? read_choice(context_, *node, path(name), table_.at(name).choices) : std::nullopt;
}

std::optional<std::vector<std::string>> Section::choices(const std::string& name) {
  const SourceNode* node = find(name);
  if (!node) return std::nullopt;
  return read_choices(context_, *node, path(name), table_.at(name));
}

std::optional<Vec3> Section::vector(const std::string& name) {
  const SourceNode* node = find(name);
  if (!node) return std::nullopt;
  return read_vector(context_, *node, path(name), table_.at(name));
}

TimeFunctionPtr Section::time_number(const std::string& name) {
  const SourceNode* node = find(name);
  return node ? read_time_number(context_, *node, path(name), table_.at(name)) : nullptr;
}

TimeFunctionPtr Section::law(const std::string& name) {
  const SourceNode* node = find(name);
  return node ? read_law(context_, *node, path(name), table_.at(name)) : nullptr;
}

std::optional<TimeVector> Section::time_vector(const std::string& name) {
  const SourceNode* node = find(name);
  if (!node) return std::nullopt;
  return read_time_vector(context_, *node, path(name), table_.at(name));
}

std::optional<std::array<Vec3, 2>> Section::vector_pair(const std::string& name) {
  const SourceNode* node = find(name);
  if (!node) return std::nullopt;
  return read_vector_pair(context_, *node, path(name), table_.at(name));
}

std::optional<Vec3> Section::direction(const std::string& name) {
  const SourceNode* node = find(name);
  if (!node) return std::nullopt;
  return read_direction(context_, *node, path(name));
}

std::optional<std::array<Vec3, 2>> Section::direction_pair(const std::string& name) {
  const SourceNode* node = find(name);
  if (!node) return std::nullopt;
  return read_direction_pair(context_, *node, path(name));
}

std::optional<std::vector<std::string>> Section::names(const std::string& name) {
  const SourceNode* node = find(name);
  if (!node) return std::nullopt;
  return read_names(context_, *node, path(name));
}

std::optional<int> Section::body(const std::string& name) {
  const SourceNode* node = find(name);
  return node ? read_body(context_, *node, path(name)) : std::nullopt;
}

std::optional<std::array<int, 2>> Section::body_pair(const std::string& name) {
  const SourceNode* node = find(name);
  if (!node) return std::nullopt;
  return read_body_pair(context_, *node, path(name));
}

}  // namespace polhode::io
