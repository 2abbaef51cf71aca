// SPDX-License-Identifier: Apache-2.0
// Reader of fields that are bound to a member of a spec, by the kind of the field and the type of
// the member.
#include <algorithm>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_context.hpp>

namespace polhode::io {
namespace {

[[noreturn]] void refuse_binding(const Field& field) {
  throw std::logic_error(
      format("the field '{}' is bound to a member that cannot store its kind", field.name));
}

/// Value of a field as the type of its member; nothing if it is absent or invalid.
template <class T>
std::optional<T> bound_value(Section& section, const Field& field) {
  using enum FieldKind;
  const std::string& name = field.name;
  if constexpr (std::is_same_v<T, double>) {
    if (field.kind == kNumber) return section.number(name);
    if (field.kind == kStep) return section.step(name);
  } else if constexpr (std::is_same_v<T, int>) {
    if (field.kind == kInteger) return section.integer(name);
    if (field.kind == kChoice) {
      const auto word = section.choice(name);
      return word ? std::optional(std::stoi(*word)) : std::nullopt;
    }
  } else if constexpr (std::is_same_v<T, bool>) {
    if (field.kind == kBoolean) return section.boolean(name);
  } else if constexpr (std::is_same_v<T, std::string>) {
    if (field.kind == kText) return section.text(name);
    if (field.kind == kChoice) return section.choice(name);
  } else if constexpr (std::is_same_v<T, Vec3>) {
    if (field.kind == kVector) return section.vector(name);
    if (field.kind == kDirection) return section.direction(name);
  } else if constexpr (std::is_same_v<T, std::vector<double>>) {
    if (field.kind == kNumberList) return section.number_list(name);
  } else if constexpr (std::is_same_v<T, std::vector<std::string>>) {
    if (field.kind == kNames) return section.names(name);
  } else {
    static_assert(std::is_same_v<T, TimeFunctionPtr>);
    if (field.kind == kTimeNumber) {
      TimeFunctionPtr f = section.time_number(name);
      return f ? std::optional(std::move(f)) : std::nullopt;
    }
  }
  refuse_binding(field);
}

/// Stores the value of a field in its member, which stays as it is without a valid value.
class BoundReader {
 public:
  BoundReader(Section& section, const Field& field) : section_(section), field_(field) {}

  template <class T>
  void operator()(T* member) const {
    if (auto value = bound_value<T>(section_, field_)) *member = std::move(*value);
  }
  template <class T>
  void operator()(std::optional<T>* member) const {
    if (auto value = bound_value<T>(section_, field_)) *member = std::move(value);
  }
  void operator()(const EnumReference& member) const {
    if (field_.kind != FieldKind::kChoice) refuse_binding(field_);
    const auto word = section_.choice(field_.name);
    if (!word) return;
    const auto at = std::find(field_.choices.begin(), field_.choices.end(), *word);
    member.set(static_cast<int>(at - field_.choices.begin()));
  }

 private:
  Section& section_;
  const Field& field_;
};

}  // namespace

void Section::read_value(const Field& field, const SpecValue& member) {
  std::visit(BoundReader(*this, field), member);
}

std::optional<double> Section::step(const std::string& name) {
  const SourceNode* value = find(name);
  if (!value || (value->is_text() && value->text == "auto")) return std::nullopt;
  if (const std::string guess = value->is_text() ? closest(value->text, {"auto", "automatic"}) : "";
      !guess.empty()) {
    context_.fault(*value, path(name), quote(value->text) + " is not known",
                   "Did you mean 'auto'? Give auto or a time.");
    return std::nullopt;
  }
  return number(name);
}

}  // namespace polhode::io
