// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/contact/contact_point.hpp>

namespace polhode::contact {

/// Closed forms of the frequent points: a point of a against a ball or a half space, friction by a
/// round cone, ρ∞ = 1. They give what the general formulas give, in a fraction of the time.
[[nodiscard]] bool is_plain(const PointData& data);

/// Gap of a plain point at t_{n+1} [m].
[[nodiscard]] double plain_gap_n1(const PointData& data, const BodyStep& a, const BodyStep& b);

/// Force and spring of a plain point. @param gap_n  At t_n [m]. @param gap_n1  At t_{n+1} [m].
[[nodiscard]] PointForce plain_force(const PointData& data, double gap_n, double gap_n1,
                                     const BodyStep& a, const BodyStep& b,
                                     const StepContext& context, PointReport* report = nullptr);

}  // namespace polhode::contact
