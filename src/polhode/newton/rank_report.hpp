// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/system/system.hpp>

namespace polhode {

/// How many of the constraint rows count at a configuration.
struct RankReport {
  int rows = 0;       ///< Exact multiplier rows (compliant ones are forces).
  int rank = 0;       ///< Of G.
  int redundant = 0;  ///< rows − rank.
  int mobility = 0;   ///< 6 n − rank: motions that the constraints allow to first order here.
  std::vector<int> involved;       ///< Interactions with a part in a redundancy.
  std::vector<std::string> names;  ///< The same by name: "joint 'elbow'".
  /// Redundant rows and mobility of a singular position count what holds only there.
  [[nodiscard]] std::string text() const;
};

/// Rank of G: joint by joint along branches, by elimination of bodies in what loops tie together,
/// see loop_rank(). Lengths are measured in ℓ, so that forces and moments compare.
/// @param tolerance  Rows whose part normal to the others is smaller than this are redundant [-].
[[nodiscard]] RankReport rank_report(const System& system, const State& state,
                                     double tolerance = 1e-9);

}  // namespace polhode
