// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include <polhode/solids/mesh/mesh.hpp>

namespace polhode {

/// A material point of a solid: fields at it are weighted sums of nodal values.
struct SolidPoint {
  std::vector<int> nodes;
  std::vector<double> weights;  ///< Their sum is 1.

  /// Value at the point of a field given at nodes.
  template <class T>
  [[nodiscard]] T value(const std::vector<T>& field) const {
    T sum = T::Zero();
    for (std::size_t k = 0; k < nodes.size(); ++k)
      sum += weights[k] * field[static_cast<std::size_t>(nodes[k])];
    return sum;
  }
};

/// Point of a mesh at X, by the shape functions of the element containing it.
/// @param X  In the mesh's own coordinates [m].
/// @throws InputError, at `where`, if it lies in no element; the message names the nearest node.
[[nodiscard]] SolidPoint solid_point(std::string_view where, const solids::Mesh& mesh,
                                     const Vec3& X);

}  // namespace polhode
