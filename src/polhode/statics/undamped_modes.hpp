// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/statics/modal_matrices.hpp>

namespace polhode {

/// Eigenvalues of a model whose stiffness is symmetric and that nothing damps.
struct UndampedModes {
  std::vector<double> omega_squared;  ///< Ascending [rad²/s²].
  std::vector<Vec> shapes;
  std::vector<bool> free;  ///< Nothing resists the motion.
  int freedoms = -1;       ///< If known.
  double shift = 0.0;      ///< ω² below which modes were counted [rad²/s²].
  int below_shift = 0;     ///< That many.
  bool counted = false, complete = true;
  std::string warning;  ///< If some were missed.
};

/// @param count  Modes wanted; some more may be given. @eq{modes-saddle}
[[nodiscard]] UndampedModes undamped_modes(ModalMatrices& m, int count);

}  // namespace polhode
