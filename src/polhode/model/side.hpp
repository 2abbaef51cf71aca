// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>

namespace polhode {

/// A side of contact: a body, the surface of a solid, or a cable.
struct Side {
  enum class Kind : unsigned char { body, solid, cable };

  Kind kind = Kind::body;
  int index = 0;  ///< Into Model::bodies, solids or cables; of a body also kGround.

  constexpr Side() = default;
  /// A body, by its index: implicit, since most sides are bodies.
  constexpr Side(int body) : index(body) {}  // NOLINT(google-explicit-constructor)
  [[nodiscard]] static constexpr Side of_solid(int solid) { return {Kind::solid, solid}; }
  [[nodiscard]] static constexpr Side of_cable(int cable) { return {Kind::cable, cable}; }

  [[nodiscard]] constexpr bool is_body() const { return kind == Kind::body; }
  [[nodiscard]] constexpr bool is_solid() const { return kind == Kind::solid; }
  [[nodiscard]] constexpr bool is_cable() const { return kind == Kind::cable; }

  auto operator<=>(const Side&) const = default;  // NOLINT(modernize-use-nullptr)

 private:
  constexpr Side(Kind of, int at) : kind(of), index(at) {}
};

}  // namespace polhode
