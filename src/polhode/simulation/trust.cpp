// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/core/format.hpp>
#include <polhode/simulation/trust.hpp>
#include <polhode/stepping/ledger.hpp>
#include <polhode/stepping/step_control.hpp>

namespace polhode {

namespace {

/// Drift of a balance that is exact but for rounding and Newton's tolerance, with a margin of five
/// digits over the largest of docs/validation.md.
constexpr double kExactBalance = 1e-6;
/// Drift of a balance with errors of second order, above which its digits are not those of the
/// motion.
constexpr double kPlainBalance = 1e-3;
/// Residual of constraints, which hold to round-off at every step, relative to the mechanism's
/// size.
constexpr double kConstraints = 1e-6;

}  // namespace

double allowed_drift(const Model& model) {
  const AnalysisSpec& a = model.analysis;
  const bool exact = a.rho_inf == 1.0 && a.conserving && a.momentum_rate == "momentum" &&
                     !model.contacts.nonsmooth();
  return exact ? kExactBalance : kPlainBalance;
}

std::vector<std::string> reasons_for_distrust(const Model& model, const System& system,
                                              const Ledger& ledger, bool extrapolated) {
  std::vector<std::string> reasons;
  double allowed = allowed_drift(model);
  if (extrapolated)
    allowed =
        std::clamp(step_control::kBalanceTolerances * ledger.errors.sum, allowed, kPlainBalance);
  const Drifts drift = drifts(ledger);
  const auto balance = [&](const char* what, double value) {
    if (value <= allowed) return;
    reasons.push_back(format(
        "the balance of {} does not close: its drift is {:.2g}, and the method allows {:.2g}. "
        "Take shorter steps{}",
        what, value, allowed,
        model.analysis.rho_inf < 1.0 ? ", or rho_inf: 1, which does not dissipate" : ""));
  };
  balance("energy", drift.energy);
  // Below rho_inf = 1 a step weights the forces of its neighbours: sums of impulses and momenta
  // differ by a part of a step's impulse, which is no error of the motion.
  if (model.analysis.rho_inf == 1.0) {
    balance("linear momentum", drift.linear_momentum);
    balance("angular momentum", drift.angular_momentum);
  }
  const double size = std::min(1.0, system.length_scale());
  if (!(ledger.constraint_max <= kConstraints * size))
    reasons.push_back(
        format("joints or drives do not hold: the largest residual of their rows is {:.2g} m or "
               "rad. Look for joints and drives that contradict one another",
               ledger.constraint_max));
  if (const UnsolvedImpacts& i = ledger.impacts; i.steps > 0) {
    const auto name = [&](int body) {
      return body == kGround ? std::string("the ground")
                             : format("'{}'", system.bodies()[body].name);
    };
    const std::string where =
        i.group < 0 ? format("where {} meets {}", name(i.a), name(i.b))
                    : format("in the contact '{}'", system.nodes().group(i.group).name());
    reasons.push_back(
        format("impacts do not meet their law in {} steps: velocities differ from it by up to "
               "{:.2g} m/s, {} at t = {:.6g} s. Take shorter steps",
               i.steps, i.largest, where, i.time));
  }
  return reasons;
}

}  // namespace polhode
