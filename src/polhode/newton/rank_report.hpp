// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/system/system.hpp>

namespace polhode {

/// Rank of the constraint rows at a configuration.
struct RankReport {
  int rows = 0;       ///< Exact multiplier rows (compliant ones are forces).
  int rank = 0;       ///< Of G.
  int redundant = 0;  ///< rows − rank.
  int mobility = 0;   ///< 6 n − rank: degrees of freedom, to first order at this configuration.
  std::vector<int> involved;       ///< Interactions that take part in a redundancy.
  std::vector<std::string> names;  ///< The same by name: "joint 'elbow'".
  /// Report text. At a singular position redundant rows and mobility include those that exist only
  /// there.
  [[nodiscard]] std::string text() const;
};

/// Rank of G: joint by joint along branches, by elimination of bodies in loops, see loop_rank().
/// Lengths are measured in ℓ, so that forces and moments are comparable.
/// @param tolerance  Relative size of a row's part normal to the others below which it is redundant
/// [-].
[[nodiscard]] RankReport rank_report(const System& system, const State& state,
                                     double tolerance = 1e-9);

}  // namespace polhode
