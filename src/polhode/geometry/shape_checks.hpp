// SPDX-License-Identifier: Apache-2.0
// Checks and bounds for functions that make shapes.
#pragma once

#include <string_view>

#include <polhode/geometry/shape.hpp>

namespace polhode::geometry {

/// Default radius of edges, as a part of the size.
inline constexpr double kRounding = 1e-3;

/// @param what  Name of the length in the message.
/// @throws InputError if the length is not positive and finite.
void check_positive(std::string_view where, std::string_view what, double value);

/// @throws InputError if a radius of edges is negative or more than `most` [m].
void check_rounding(std::string_view where, double rounding, double most);

/// Stores the bounding ball of a shape, and what follows from it.
void set_bounds(Shape& s, const Vec3& centre, double radius);

}  // namespace polhode::geometry
