// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/geometry/shape.hpp>

namespace polhode::geometry {

/// Surface with every triangle moved inward by `depth`, as nearly as its corners allow: each corner
/// gets the shortest displacement that moves the planes of its triangles in the least-squares
/// sense.
[[nodiscard]] TriangleSurface shrunk(const TriangleSurface& surface, double depth);

/// Stores triangles, their planes and edges in a shape. Edges get an outward direction; flat and
/// concave edges are marked.
void take_triangles(Shape& shape, const TriangleSurface& surface);

/// Activates the corners of a shape at which a convex edge starts.
void take_convex_corners(Shape& shape);

/// Smallest distance of the mean of the corners from a face [m].
[[nodiscard]] double inner_size(const TriangleSurface& hull);

[[nodiscard]] double median_edge(const TriangleSurface& surface);  ///< [m]

}  // namespace polhode::geometry
