// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/engines/saddle_matrix.hpp>

namespace polhode {

/// A free motion and its description: "body 'crank' turns about z".
struct PlainMotion {
  Vec x;
  std::string text;
};

/// Another basis of a space of free motions, simple ones first: for each connected component the
/// translations along axes and rotations about axes that are in the space, then the rest. Rotations
/// are about the centre of mass if a part may also translate.
/// @param state  Positions of bodies and nodes.
/// @param motions  Independent, in the unknowns of bodies and nodes; the entries behind these are
/// ignored.
[[nodiscard]] std::vector<PlainMotion> plain_motions(const System& system, const State& state,
                                                     const SaddleMatrix& matrix,
                                                     const std::vector<Vec>& motions);

/// Translations and rotations of connected components without stiffness and without constraint.
/// They are found without the rounding of a factorisation, so that they are distinguished from
/// motions with a small stiffness. Independent, each with largest component one. @eq{statics-rigid}
/// @param without  Part of the stiffness that does not count; null: none.
[[nodiscard]] std::vector<Vec> rigid_free_motions(const System& system, const State& state,
                                                  const SaddleMatrix& matrix,
                                                  const SaddleMatrix* without = nullptr);

}  // namespace polhode
