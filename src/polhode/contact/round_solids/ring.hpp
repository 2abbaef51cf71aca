// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/contact/round_solids/round_solid.hpp>

namespace polhode::contact {

/// A circle about the third axis, the outer rim of a tube: a part of a shape, see part_of(), and no
/// kind of shape. It is not convex: features of another shape may lie within it. Its radius is
/// the first entry of Shape::half; the third one, tiny, keeps its extreme point defined where it
/// is parallel to a plane.
[[nodiscard]] const RoundSolid& ring_solid();

[[nodiscard]] inline bool is_ring(const geometry::Shape& part) {
  return part.round_solid == &ring_solid();
}

}  // namespace polhode::contact
