// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/statics/modal_matrices.hpp>

namespace polhode {

/// Eigenvalues of a model with symmetric stiffness and no damping.
struct UndampedModes {
  std::vector<double> omega_squared;  ///< Ascending [rad²/s²].
  std::vector<Vec> shapes;
  std::vector<bool> free;  ///< Whether the motion is free.
  int freedoms = -1;       ///< If known.
  double shift = 0.0;      ///< ω² below which modes were counted [rad²/s²].
  int below_shift = 0;     ///< Their number.
  bool counted = false, complete = true;
  std::string warning;  ///< Set if some were missed.
};

/// Computes modes. @param count  Requested number; more may be returned. @eq{modes-saddle}
[[nodiscard]] UndampedModes undamped_modes(ModalMatrices& m, int count);

}  // namespace polhode
