// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/dynamics/generalized_alpha.hpp>
#include <polhode/system/state.hpp>

namespace polhode {

// The stored a, A, ḣ at ρ∞ < 1 belong to t_n + δΔt of the step that produced them, so a step of
// another length needs others: x + δ (Δt_new − Δt_old) ẋ. Without this correction order 2 is lost
// where the step changes all the time (measured: 1.0 to 1.3 at any ρ∞ < 1). At ρ∞ = 1, where they
// are not used, State::rates is empty and these functions do nothing. @eq{stored-rates}

/// Weight of the last step in an updated rate.
inline constexpr double kFreshRate = 0.25;

/// Allocates the rates; they are those given with set_stored_rate(), else zero.
/// @param dt  Step for which the state's a, A, ḣ hold [s]; 0 if they are those of t_n itself.
void begin_stored_rates(State& state, const GeneralizedAlpha& ga, double dt);
/// Rate of change of a body's a [m/s³], A [rad/s³], ḣ [N m/s].
void set_stored_rate(State& state, int slot, const Vec3& a, const Vec3& A, const Vec3& h_dot);

/// Adapts a, A, ḣ of the state to a step of length dt, before the step.
void adapt_stored_rates(State& state, const GeneralizedAlpha& ga, double dt);
/// Undoes adapt_stored_rates() after a rejected step.
void restore_stored_rates(State& state);
/// Updates the rates after an accepted step of length dt, with the new a, A, ḣ in the state.
void renew_stored_rates(State& state, const GeneralizedAlpha& ga, double dt);

}  // namespace polhode
