// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/dynamics/generalized_alpha.hpp>
#include <polhode/system/state.hpp>

namespace polhode {

// At ρ∞ < 1 the stored a, A, ḣ belong to t_n + δΔt of the step that made them, so a step of another
// length wants others: x + δ (Δt_new − Δt_old) ẋ. Without that, order 2 is lost where the step
// changes all the time (measured: 1.0 to 1.3 at any ρ∞ < 1). At ρ∞ = 1, where nothing of that is
// read, State::rates is empty and these functions do nothing. @eq{stored-rates}

/// Makes room; the rates of change are those given with set_stored_rate(), else zero.
/// @param dt  Step for which the state's a, A, ḣ hold [s]; 0 if they are those of t_n itself.
void begin_stored_rates(State& state, const GeneralizedAlpha& ga, double dt);
/// Rate of change of a body's a [m/s³], A [rad/s³], ḣ [N m/s].
void set_stored_rate(State& state, int slot, const Vec3& a, const Vec3& A, const Vec3& h_dot);

/// Before a step: a, A, ḣ of the state become those that a step of length dt wants.
void adapt_stored_rates(State& state, const GeneralizedAlpha& ga, double dt);
/// After a step that was refused: what adapt_stored_rates() changed is as it was.
void restore_stored_rates(State& state);
/// After a step of length dt that was accepted, with the new a, A, ḣ in the state.
void renew_stored_rates(State& state, const GeneralizedAlpha& ga, double dt);

}  // namespace polhode
