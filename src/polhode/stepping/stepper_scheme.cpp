// SPDX-License-Identifier: Apache-2.0
// Changes between extrapolated steps and steps of order 2, for automatic steps.
#include <polhode/core/format.hpp>
#include <polhode/stepping/column_choice.hpp>
#include <polhode/stepping/stepper_impl.hpp>

namespace polhode {

namespace {

/// Whether interactions of a kind are springs of some sort.
bool is_elastic(const std::string& kind) {
  return kind.ends_with("spring") || kind == "spring_damper" || kind == "bushing" ||
         kind == "beam" || kind == "cable";
}

}  // namespace

/// Decides whether the coming step is extrapolated. One that follows steps of order 2 begins as
/// long as they are at equal work, where there is room for it.
/// @param room  Time to the next limit [s].
void Stepper::Impl::choose_scheme(State& state, double room) {
  by_two = false;
  tried_from = 0.0;
  if (!table || !automatic()) return;
  const int first = control.varies ? first_columns(control.tolerance, table->most_columns())
                                   : table->most_columns();
  if (state.columns == 0) {
    state.columns = first;
    state.steps_to_compare = state.steps_compared = kFirstComparison;
  }
  by_two = state.columns == 1;
  if (!by_two || state.steps_to_compare > 0 || state.dt_next <= 0.0) return;
  const double length = ExtrapolationTable::substeps(first) * state.dt_next;
  if (state.easy_steps == kFindAnew || length > std::min(room, most_step())) return;
  by_two = false;
  tried_from = state.dt_next;
  state.columns = first;
  state.error_last = 0.0;
  state.dt_next = length;
}

/// Goes on with steps of order 2. @param dt  Their length [s]. @param steps  Their number beyond
/// stops until extrapolation is tried again.
void Stepper::Impl::take_order_two(State& state, double dt, int steps) const {
  state.columns = 1;
  state.dt_next = dt;
  state.steps_to_compare = state.steps_compared = steps;
}

/// Whether steps of order 2 need clearly less work than extrapolated ones of this length: where
/// extrapolated steps must resolve an undamped vibration that others pass over.
bool Stepper::Impl::suits_order_two(State& state, double H, int columns) {
  by_two = true;
  const double dt = kWorthTwo * H / ExtrapolationTable::substeps(columns);
  const std::optional<double> error = error_of_two(state, dt);
  const bool suits = error && *error <= requested_error(dt) && least_error <= requested_error(dt);
  by_two = false;
  state.ledger.iterations += companion_iterations;
  if (!suits) return false;
  begin_anew(state);
  take_order_two(state, dt, kFirstComparison);
  return true;
}

/// Whether an extrapolated step that was refused gives way to steps of order 2 from its start: at a
/// stop, after steps of order 2 that suited, and where it would be short for its work.
/// @param H  Length of the next trial [s].
bool Stepper::Impl::gives_way(State& state, double H, int refusals) {
  if (tried_from > 0.0) {
    take_order_two(state, tried_from, std::min(kLastComparison, kLaterBy * state.steps_compared));
    return true;
  }
  const int used = columns(state);
  if (table->met_stop()) {
    begin_anew(state);
    take_order_two(state, H / ExtrapolationTable::substeps(used), kBeyondStop);
    return true;
  }
  if (refusals < kTrialsOfTable) return false;
  if (!shortened && state.ledger.steps > 0) shortened = {state.t, table->worst_body(H)};
  return suits_order_two(state, H, used);
}

/// Counts an accepted step towards the next comparison. @param used  Members of the step.
void Stepper::Impl::count_scheme(State& state, double H, int used) {
  int& left = state.steps_to_compare;
  if (by_two) {
    left = single.stopped() ? std::max(left, kBeyondStop) : std::max(0, left - 1);
    return;
  }
  if (tried_from > 0.0) {
    left = state.steps_compared = kFirstComparison;
    return;
  }
  if (--left > 0 || suits_order_two(state, H, used)) return;
  left = state.steps_compared = std::min(kLastComparison, kLaterBy * state.steps_compared);
}

/// What shortens extrapolated steps, if it is an undamped vibration: springs that nothing damps of
/// the body with the largest error.
std::vector<std::string> Stepper::Impl::vibration_warning() const {
  if (!shortened || shortened->second < 0) return {};
  const auto [t, body] = *shortened;
  std::string springs;
  for (const InteractionRef& ref : system.interactions()) {
    const InteractionTraits& traits = system.traits(ref);
    if (ref.rows > 0 || (ref.a != body && ref.b != body)) continue;
    if (!traits.conservative || traits.dissipates || !is_elastic(system.group(ref.group).kind()))
      continue;
    springs += format("{}'{}'", springs.empty() ? "" : ", ", traits.name);
  }
  if (springs.empty()) return {};
  return {
      format("extrapolated steps had to be much shorter at t = {:.6g} s, probably to resolve a "
             "vibration of body '{}' on {}, which nothing damps. Give it damping, or set order: 2, "
             "which passes over it",
             t, system.bodies()[static_cast<std::size_t>(body)].name, springs)};
}

}  // namespace polhode
