// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/geometry/shape.hpp>
#include <polhode/model/model.hpp>

namespace polhode {

/// Sides of a tube to what its round faces do not meet.
inline constexpr int kTubeSegments = 48;

/// A shape of the model file as contact knows it.
/// @param place  Of the shape, see shape_place().
/// @param rounding  Of edges and corners of boxes, cones, hulls and triangles [m]; 0: contact's
/// own.
/// @throws InputError if contact refuses it.
[[nodiscard]] contact::Shape contact_shape(const std::string& where, contact::ShapePlace place,
                                           const ShapeSpec& shape, double rounding = 0.0);

}  // namespace polhode
