// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/stepping/instant.hpp>
#include <polhode/stepping/switching.hpp>
#include <polhode/stepping/velocity_jump.hpp>

namespace polhode {

namespace {

/// Largest violation of rows when they are switched on, over the mechanism's size, or in radians;
/// it is kept.
constexpr double kOpen = 1e-4;

double* history_of(State& state, const InteractionRef& ref) {
  return state.history.data() + ref.first_history;
}

}  // namespace

SwitchReport switch_interactions(const System& system, State& state, std::span<const int> on,
                                 std::span<const int> off, EnergyLedger& ledger) {
  SwitchReport report;
  const State before = state;
  const BodySums sums = ledger.sums(state);
  const double potential = ledger.potential(state);
  for (const int i : off) {
    const InteractionRef& ref = system.interactions()[static_cast<std::size_t>(i)];
    if (system.is_off(state, i)) continue;
    system.group(ref.group).switch_off(ref.item, history_of(state, ref));
    std::fill_n(state.lambda.begin() + ref.first_row, ref.rows, 0.0);
  }
  const double kept = ledger.potential(state);
  report.released = potential - kept;
  std::vector<char> closed(static_cast<std::size_t>(system.rows()), 0);
  bool closes = false;
  for (const int i : on) {
    const InteractionRef& ref = system.interactions()[static_cast<std::size_t>(i)];
    if (!system.is_off(state, i)) continue;
    const PairView view = system.instant(state, ref, nullptr);
    const double gap =
        system.group(ref.group).switch_on(ref.item, view.step(), history_of(state, ref));
    if (!(gap <= kOpen * std::min(1.0, system.length_scale())) && !(gap <= report.gap)) {
      report.worst = i;
      report.gap = gap;
    }
    std::fill_n(closed.begin() + ref.first_row, ref.rows, 1);
    closes = closes || ref.rows > 0;
  }
  if (report.worst >= 0) {
    state = before;
    return report;
  }
  if (closes) {
    InstantSolver solver(system);
    std::vector<Vec6> bodies;
    std::vector<double> nodes;
    VelocityJump jump{.rows = {}, .more = {}, .rate = VelocityJump::Rate::after};
    const auto lost = solver.jumps_onto(state, closed, bodies, nodes, jump.rows);
    report.solved = lost.has_value();
    if (!lost) {
      state = before;
      return report;
    }
    report.lost = *lost;
    add_jumps(system, bodies, nodes, state);
    take_jump(system, state, jump);
    for (std::size_t k = 0; k < closed.size(); ++k)
      if (closed[k] != 0) report.impulse = std::max(report.impulse, std::abs(jump.rows[k]));
  }
  // Lost and new potential energy are separate: they do not compensate each other.
  ledger.add_switch(state, sums, report.lost, kept - potential);
  ledger.add_switch(state, ledger.sums(state), 0.0, ledger.potential(state) - kept);
  return report;
}

}  // namespace polhode
