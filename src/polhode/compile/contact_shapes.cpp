// SPDX-License-Identifier: Apache-2.0
#include <polhode/compile/contact_shapes.hpp>
#include <polhode/compile/shape_surface.hpp>
#include <polhode/contact/round_solids/round_solid.hpp>
#include <polhode/contact/tube.hpp>

namespace polhode {

geometry::Shape contact_shape(const std::string& where, const geometry::ShapePlace& place,
                              const ShapeSpec& shape, double rounding) {
  const std::vector<double>& size = shape.sizes;
  const std::string& type = shape.type;
  if (type == "sphere") return geometry::sphere(where, size[0], place);
  if (type == "capsule") {
    const double straight = size[1] - size[0];
    return straight > 1e-12 * size[1] ? geometry::capsule(where, size[0], straight, place)
                                      : geometry::sphere(where, size[0], place);
  }
  if (type == "box") return geometry::box(where, {size[0], size[1], size[2]}, place, rounding);
  if (const contact::RoundSolid* round = contact::find_round_solid(type))
    return round->shape(where, size, place, rounding);
  if (type == "plane") return geometry::plane(place);
  if (type == "hull") return geometry::hull(where, hull_points(shape), place, rounding);
  if (type == "height_field")
    return geometry::height_field(where, shape.columns, shape.spacing, shape.heights, place,
                                  rounding);
  if (type == "tube")
    return contact::tube(where, size[0], size[1], size[2],
                         shape_surface(where, shape, kTubeSegments), place, rounding);
  return geometry::mesh(where, shape_surface(where, shape, kTubeSegments), place, rounding);
}

}  // namespace polhode
