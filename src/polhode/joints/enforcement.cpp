// SPDX-License-Identifier: Apache-2.0
#include <type_traits>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/joints/joint.hpp>

namespace polhode {

namespace {

/// Derivative of g of EqualTurns by a twist about the mean shaft: −4z, the sine of half of it.
constexpr double kEqualTurnsByTwist = 2.0;
/// Largest ratio of stiffnesses of augmented joints: ε times it must stay small compared with the
/// masses.
constexpr double kMaxWeight = 1e6;

/// Derivative of the part's rows by the rotation that they measure; 0 for displacements.
template <class Part>
constexpr double by_rotation() {
  return std::is_same_v<Part, EqualTurns> || std::is_same_v<Part, EqualTurnsSprings>
             ? kEqualTurnsByTwist
         : std::is_same_v<Part, OrthogonalAxes> ? 1.0
                                                : 0.0;
}

}  // namespace

StiffnessDemand stiffness_demand(const JointParts& parts) {
  StiffnessDemand demand;
  parts.for_each([&](const auto& part, int) {
    (by_rotation<std::decay_t<decltype(part)>>() > 0.0 ? demand.rotations : demand.displacements) =
        true;
  });
  return demand;
}

Vec6 row_compliances(const JointParts& parts, const JointEnforcement& enforcement) {
  Vec6 compliance = Vec6::Zero();
  parts.for_each([&](const auto& part, int row) {
    using Part = std::decay_t<decltype(part)>;
    constexpr double turn = by_rotation<Part>();
    const double k = turn > 0.0 ? enforcement.turning_stiffness : enforcement.stiffness;
    if (!(k > 0.0))
      throw InputError(turn > 0.0 ? "turning_stiffness" : "stiffness", "is missing or not positive",
                       "Give a positive number");
    compliance.segment(row, Part::kRows).setConstant((turn > 0.0 ? turn * turn : 1.0) / k);
  });
  return compliance;
}

void Joint::set_enforcement(const JointEnforcement& e, double stiffest) {
  if (rows_ == 0)
    throw InputError("type", format("a {} has no constraint but its limits", type_),
                     "Leave the enforcement out");
  if (e.law == JointEnforcement::Law::penalty) {
    parts_.turn_springs = parts_.equal_turns;
    rows_ = parts_.rows();
  }
  const Vec6 compliance = row_compliances(parts_, e);
  if (e.law == JointEnforcement::Law::penalty) {
    held_by_ = std::make_shared<const Held>(Held{compliance, Vec6::Ones()});
    return;
  }
  Vec6 weight = Vec6::Ones();
  weight.head(rows_) = (stiffest * compliance.head(rows_)).cwiseMax(1.0);
  if (weight.maxCoeff() > kMaxWeight)
    throw InputError("type",
                     format("augmented joints have stiffnesses from {:.3g} to {:.3g}",
                            stiffest / weight.maxCoeff(), stiffest),
                     format("Bring them within {:.0e} of each other", kMaxWeight));
  held_by_ = std::make_shared<const Held>(Held{Vec6::Zero(), weight});
}

/// Replaces rows by springs. A spring's force is computed from the mean of its deflection at both
/// ends of the step: the work of G at the mean configuration then equals the energy of the springs
/// exactly. @eq{compliance-row}
void Joint::soften(const PairStep& step, PairTerms& t) const {
  t.compliance = held_by_->compliance;
  t.weight = held_by_->weight;
  if (!penalised()) return;
  const double af = step.a.alpha_f;
  const Vec6 before = residual(at_n(step));
  t.g.head(rows_) = (1.0 - af) * before.head(rows_) + af * t.g.head(rows_);
  if (!step.context.tangents) return;
  t.G_a.topRows(rows_) *= af;
  t.G_b.topRows(rows_) *= af;
}

double Joint::spring_energy(const PairStep& step) const {
  if (!penalised()) return 0.0;
  Vec6 g = residual(step);
  double energy = 0.0;
  for (int k = 0; k < rows_; ++k) {
    // A joint that was switched on keeps the values that its rows had then.
    if (switching != Switching::never)
      g[k] -= step.history[history_size() + SwitchMemory::kHeld + k];
    energy += 0.5 * g[k] * g[k] / held_by_->compliance[k];
  }
  return energy;
}

}  // namespace polhode
