// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/core/types.hpp>

namespace polhode {

/// Shape of a joint for the elimination along the tree: its free motions.
///
/// Bodies a (parent) and b (child), joint points Z_a, Z_b from the centres of mass, frames R_a,
/// R_b (columns x, y, z) in body components. The rows, and the multipliers, come in this order:
///
///   coincident:        g = x_b − x_a                                        (3 rows)
///   else slides = k:   g = d_i·(x_b − x_a), d_i = slide[i] fixed in a       (k rows, k <= 2)
///   directions = 1:    x_a·y_b                                              (1 row)
///   directions = 2:    z_a·x_b, z_a·y_b                                     (2 rows)
///   directions = 3:    z_a·x_b, z_a·y_b, x_a·y_b                            (3 rows)
///
/// where x_a is the first column of R_a rotated with body a, and so on. A joint's own evaluation
/// must give exactly these rows; the tests compare the two.
struct MotionBasis {
  bool coincident = false;
  int slides = 0;
  int directions = 0;
  Vec3 Z_a = Vec3::Zero(), Z_b = Vec3::Zero();  ///< [m]
  Mat3 R_a = Mat3::Identity(), R_b = Mat3::Identity();
  Vec3 slide[2] = {Vec3::UnitX(), Vec3::UnitY()};  ///< Body-a components, unit.

  [[nodiscard]] int translation_rows() const { return coincident ? 3 : slides; }
  [[nodiscard]] int rows() const { return translation_rows() + directions; }
  [[nodiscard]] int free_directions() const { return 6 - rows(); }
};

}  // namespace polhode
