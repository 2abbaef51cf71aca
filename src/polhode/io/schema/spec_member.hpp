// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <typeindex>
#include <utility>
#include <variant>
#include <vector>

#include <polhode/core/time_function.hpp>
#include <polhode/core/types.hpp>

namespace polhode::io {

/// Reference to a member of any enumeration. A value is the number of its word among the choices of
/// the field, which are in the order of the enumeration.
class EnumReference {
 public:
  template <class Enum>
  requires std::is_enum_v<Enum>
  explicit EnumReference(Enum& value)
      : value_(&value),
        get_([](const void* v) { return static_cast<int>(*static_cast<const Enum*>(v)); }),
        set_([](void* v, int k) { *static_cast<Enum*>(v) = static_cast<Enum>(k); }) {}

  bool operator==(const EnumReference&) const = default;
  [[nodiscard]] int get() const { return get_(value_); }
  void set(int k) const { set_(value_, k); }

 private:
  void* value_;
  int (*get_)(const void*);
  void (*set_)(void*, int);
};

/// Pointer to a value of a spec, of one of the types that a field can have there.
using SpecValue =
    std::variant<double*, std::optional<double>*, int*, std::optional<int>*, bool*,
                 std::optional<bool>*, std::string*, std::optional<std::string>*, Vec3*,
                 std::optional<Vec3>*, std::vector<double>*, std::vector<std::string>*,
                 std::optional<std::vector<std::string>>*, TimeFunctionPtr*, EnumReference>;

/// Member of a spec in which the value of a field is stored; none by default.
class SpecMember {
 public:
  SpecMember() = default;
  /// Conversion from a pointer to member, so that a table has `.member = &AnalysisSpec::rho_inf`.
  template <class Spec, class Value>
  SpecMember(Value Spec::*member)  // NOLINT(google-explicit-constructor)
      : spec_(typeid(Spec)), locate_([member](void* spec) -> SpecValue {
          Value& value = static_cast<Spec*>(spec)->*member;
          if constexpr (std::is_enum_v<Value>)
            return EnumReference(value);
          else
            return &value;
        }) {}

  explicit operator bool() const { return static_cast<bool>(locate_); }
  /// Whether it is a member of this type of spec.
  template <class Spec>
  [[nodiscard]] bool belongs_to() const {
    return locate_ && spec_ == typeid(Spec);
  }
  /// Pointer to the member's value in a spec.
  /// @throws std::logic_error if it is a member of another type of spec, or none.
  template <class Spec>
  [[nodiscard]] SpecValue in(Spec& spec) const {
    if (!belongs_to<Spec>()) throw std::logic_error("a field is bound to another type of spec");
    return locate_(&spec);
  }
  /// Calls the visitor with the member's value, that of an enumeration as its number.
  /// @throws std::logic_error likewise.
  template <class Spec, class Visitor>
  void visit(const Spec& spec, Visitor&& visitor) const {
    // The value is only read: locate_ is shared with the reader, which stores values.
    std::visit(
        [&](const auto& at) {
          if constexpr (std::is_pointer_v<std::remove_cvref_t<decltype(at)>>)
            visitor(std::as_const(*at));
          else
            visitor(at.get());
        },
        in(const_cast<Spec&>(spec)));
  }

 private:
  std::type_index spec_ = typeid(void);
  std::function<SpecValue(void*)> locate_{};
};

}  // namespace polhode::io
