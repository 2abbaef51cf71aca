// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/geometry/shape.hpp>
#include <polhode/model/model.hpp>

namespace polhode {

/// Number of sides of a tube's polygon, for shapes without contact with its round faces.
inline constexpr int kTubeSegments = 48;

/// Contact shape of a shape of the model file.
/// @param place  Of the shape, see shape_place().
/// @param rounding  Of edges and corners of boxes, cones, hulls and triangles [m]; 0: the default.
/// @throws InputError if the shape is rejected.
[[nodiscard]] geometry::Shape contact_shape(const std::string& where,
                                            const geometry::ShapePlace& place,
                                            const ShapeSpec& shape, double rounding = 0.0);

}  // namespace polhode
