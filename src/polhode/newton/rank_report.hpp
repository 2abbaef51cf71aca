// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <polhode/system/system.hpp>

namespace polhode {

/// Kind and name of an interaction, "joint 'elbow'".
[[nodiscard]] std::string interaction_name(const System& system, int interaction);

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

/// Rows whose right-hand sides no motion satisfies.
struct Contradiction {
  double part = 0.0;  ///< Largest component of r outside the range of G, rows normalised in ℓ.
  double of = 0.0;    ///< Largest component of r.
  std::vector<std::string> names;  ///< Interactions that take part: "joint 'elbow'".
};

/// Part of the right-hand sides r of G x = r that no motion x produces. The vector of left null
/// vectors of G times r names the rows that contradict each other. @eq{row-contradiction}
/// @param right_side  By row.
/// @param tolerance  As that of rank_report(). A larger one finds rows that are nearly dependent,
/// as shortly before a limit position.
[[nodiscard]] Contradiction find_contradiction(const System& system, const State& state,
                                               std::span<const double> right_side,
                                               double tolerance = 1e-9);

}  // namespace polhode
