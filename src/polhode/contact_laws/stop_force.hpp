// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/contact_laws/normal_law.hpp>

namespace polhode::contact {

/// A force and its derivative by the gap at t_{n+1}.
struct ForceAndSlope {
  double value = 0.0, slope = 0.0;
};

/// A gap over a step.
struct GapStep {
  double at_n = 0.0, at_n1 = 0.0;  ///< [m] or [rad]
  double alpha_f = 0.5;
  bool conserving = true;  ///< By the quotient; else the mean of both ends' forces.
  double end_share = 0.0;  ///< Part of the force that is evaluated at t_{n+1}: dissipative.
};

/// Force of a law at t_{n+αf}. Where the barrier is infinite, which only iterates reach, it is
/// continued linearly. @eq{contact-quotient} @eq{contact-plastic}
[[nodiscard]] ForceAndSlope stop_force(const NormalLaw& law, const GapStep& gap);

}  // namespace polhode::contact
