// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/contact_laws/normal_law.hpp>

namespace polhode::contact {

/// A force and its derivative by the gap at t_{n+1}.
struct ForceAndSlope {
  double value = 0.0, slope = 0.0;
};

/// How a gap is taken over a step.
struct GapStep {
  double at_n = 0.0, at_n1 = 0.0;  ///< [m] or [rad]
  double alpha_f = 0.5;
  bool conserving = true;  ///< By the quotient; else the mean of both ends' forces.
  double end_share = 0.0;  ///< Part of the force that is that of t_{n+1}: takes energy.
};

/// The force of a law at t_{n+αf}. Where the barrier is infinite, which only iterates reach, it is
/// continued straight. @eq{contact-quotient} @eq{contact-plastic}
[[nodiscard]] ForceAndSlope stop_force(const NormalLaw& law, const GapStep& gap);

}  // namespace polhode::contact
