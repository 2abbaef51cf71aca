// SPDX-License-Identifier: Apache-2.0
#include <polhode/statics/static_newton.hpp>
#include <polhode/statics/static_reach.hpp>

namespace polhode {

namespace {

/// Parts of the load that are followed, and parts of one of them that does not succeed: rows that
/// turn by a radian and more may otherwise end where they are only least.
constexpr int kParts = 10, kSmallParts = 10;

}  // namespace

std::optional<ReachEnd> end_of_reach(const System& system, const State& start) {
  if (system.drives().empty()) return {};
  StaticNewton newton(system, {});
  State at = start;
  RowGap gap;
  const auto reaches = [&](double factor) {
    gap = newton.least_gap(at, factor);
    if (!gap.names.empty()) return false;
    at = newton.nearest();
    at.t = factor;
    return true;
  };
  at.t = 0.0;
  for (int part = 1; part <= kParts; ++part) {
    if (reaches(static_cast<double>(part) / kParts)) continue;
    const double from = at.t;
    for (int small = 1; small <= kSmallParts; ++small) {
      if (reaches(from + static_cast<double>(small) / (kParts * kSmallParts))) continue;
      ReachEnd end{.load_factor = at.t, .gap = gap, .whole = false};
      if (RowGap whole = newton.least_gap(at, 1.0); !whole.names.empty())
        end.gap = std::move(whole), end.whole = true;
      return end;
    }
  }
  return {};
}

}  // namespace polhode
