// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/contact/contact_point.hpp>

namespace polhode::contact {

/// Weight below which a neighbouring point acts by impulses instead.
inline constexpr double kMinWeight = 0.5;

/// Active part of a point's potential at the present placements, less than 1 where its distance
/// has no unique direction.
[[nodiscard]] double weight_at(const PointData& data, const Placement<double>& at_a,
                               const Placement<double>& at_b);

/// Whether the gap of a feature pair is that of a row at these placements. Where its direction is
/// not unique, neighbours are rows instead. The extreme point of a rim over a plane is one at any
/// angle, as it is the lowest of all.
[[nodiscard]] bool is_row_at(const PointData& data, const Placement<double>& at_a,
                             const Placement<double>& at_b);

}  // namespace polhode::contact
