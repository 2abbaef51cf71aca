// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <polhode/statics/static_report.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// End of the reach of drives whose motions grow with the load factor.
struct ReachEnd {
  double load_factor = 0.0;  ///< Last one at which all rows could hold.
  RowGap gap;                ///< At the whole load, or else just beyond.
  bool whole = true;         ///< The gap is that of the whole load.
};

/// Follows the rows alone, without forces, over the load factor from a start at rest, so that a
/// drive that leaves the reach of the joints is known before a static run. A search that goes from
/// one place to the next: it may miss the end of a reach, and forces may lead elsewhere.
/// @eq{statics-gap}
/// @returns nothing without drives, or if all rows can hold.
[[nodiscard]] std::optional<ReachEnd> end_of_reach(const System& system, const State& start);

}  // namespace polhode
