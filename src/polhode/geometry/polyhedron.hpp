// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/geometry/shape.hpp>

namespace polhode::contact {

/// The surface with every triangle moved inward by `depth`, as nearly as its corners allow: each
/// corner takes the shortest move that moves the planes of its triangles in the mean-square sense.
[[nodiscard]] TriangleSurface shrunk(const TriangleSurface& surface, double depth);

/// Puts triangles, their planes and edges into a shape. Edges get an outward direction; those
/// where the surface is flat or bends inward are marked.
void take_triangles(Shape& shape, const TriangleSurface& surface);

/// Lets those corners of a shape meet others from which a convex edge starts.
void take_convex_corners(Shape& shape);

/// Smallest distance of the mean of the corners from a face [m].
[[nodiscard]] double inner_size(const TriangleSurface& hull);

[[nodiscard]] double median_edge(const TriangleSurface& surface);  ///< [m]

}  // namespace polhode::contact
