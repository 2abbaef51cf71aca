// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/dynamics/body_step.hpp>

namespace polhode {

/// A row of an interaction that only pushes, over a step: the gap between a coordinate of two
/// bodies and an end that it cannot pass, such as a stop. Gaps of angles are those at a radius, so
/// that every row is in metres and newtons. @eq{contact-rows}
struct UnilateralRow {
  Vec6 on_a, on_b;  ///< Discrete gradient of the gap: wrench of a unit force in the step.
  Vec6 by_a, by_b;  ///< Its derivative at t_{n+1}.
  double gap_n = 0.0, gap_n1 = 0.0;  ///< [m]
  double restitution = 0.0;          ///< [-]
};

/// Change of the gap of a row over a step, by the displacements: the difference of two gaps loses
/// accuracy in short steps.
[[nodiscard]] inline double change_of_gap(const UnilateralRow& row, const BodyStep& a,
                                          const BodyStep& b) {
  const auto along = [](const Vec6& on, const BodyStep& s) {
    return on.head<3>().dot(s.u) + on.tail<3>().dot(s.theta);
  };
  return along(row.on_a, a) + along(row.on_b, b);
}

/// History of such a row.
struct UnilateralMemory {
  double force;   ///< Mean of the last step, with the impulses at its end [N].
  double closed;  ///< 1: in contact.
};

/// Gap up to which a row is closed, as a part of the model's size: the accuracy of positions of
/// accepted Newton iterations.
inline constexpr double kTouchingGap = 1e-11;
/// Overlap that rows which are solved cannot leave, in gaps that count as touching.
inline constexpr double kOverlapGaps = 100.0;

/// Gap of which a row does not fall short: zero, or that of the start of the run, of bodies that
/// overlapped then by more than rows leave. To push these apart would give them energy.
[[nodiscard]] inline double kept_gap(double at_start, double touching) {
  return at_start < -kOverlapGaps * touching ? at_start : 0.0;
}

}  // namespace polhode
