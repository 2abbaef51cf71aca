// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/engines/saddle_matrix.hpp>

namespace polhode {

/// A free motion and what it is in words: "body 'crank' turns about z".
struct PlainMotion {
  Vec x;
  std::string text;
};

/// Other motions of the same space, plain ones first: of each part of the model that hangs together
/// shifts along axes and turns about axes, as far as it is free to make them; then what is left.
/// Turns are about the centre of mass where a part may also shift.
/// @param state    Where bodies and nodes are.
/// @param motions  Independent, in the unknowns of bodies and nodes; what follows is left out.
[[nodiscard]] std::vector<PlainMotion> plain_motions(const System& system, const State& state,
                                                     const SaddleMatrix& matrix,
                                                     const std::vector<Vec>& motions);

/// Shifts and turns of parts of the model that hang together, as far as they meet no stiffness and
/// no constraint: found without the rounding of a factorisation, so that they are told from motions
/// that meet little. Independent, each of largest component one. @eq{statics-rigid}
[[nodiscard]] std::vector<Vec> rigid_free_motions(const System& system, const State& state,
                                                  const SaddleMatrix& matrix);

}  // namespace polhode
