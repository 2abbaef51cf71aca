// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/joints/resistance.hpp>
#include <polhode/joints/stop.hpp>

namespace polhode {

using contact::ContactPhase;

namespace {

/// Share of the force of resting contact that is evaluated at the end of the step.
constexpr double kRestShare = 0.5;
/// Number of steps of acceleration whose speed increment is the smallest impact speed.
constexpr double kSlowSteps = 2.0;
/// k d̂²/(m w²) with which a barrier stops a mass within a twentieth of its band.
constexpr double kImpactStiffness = 1.14e4;
/// Approach within a step, as a part of the tolerance, below which there is no impact.
constexpr double kStillOfTolerance = 1e-6;
/// Smallest distance between a gap and the floor of its barrier, as a part of the tolerance.
constexpr double kMinBand = 0.1;

}  // namespace

Stop::Stop(const JointLimits& limits, const double* history, const CoordinateStep& step)
    : limits_(limits), step_(step), law_(limits.law) {
  const auto memory = read_record<StopMemory>(history);
  acceleration_ = memory.acceleration;
  closed_ = memory.side != 0.0;
  const double x = step.dt == 0.0 ? step.at_n1 : step.at_n;
  sign_ = closed_ ? memory.side : x - limits.lower <= limits.upper - x ? 1.0 : -1.0;
  const double end = sign_ > 0.0 ? limits.lower : limits.upper;
  gap_n_ = sign_ * (x - end);
  gap_n1_ = sign_ * (step.at_n1 - end);
  const double tolerance = limits.law.tolerance, w = sign_ * step.rate_n;
  double slow = kSlowSteps * std::abs(acceleration_ * step.dt);
  if (step.dt > 0.0) slow = std::max(slow, kStillOfTolerance * tolerance / step.dt);
  was_pressed_ = memory.pressed != 0.0;
  const auto impact_stiffness = [&] {
    return std::max(limits.law.stiffness,
                    kImpactStiffness * limits.inertia * w * w / (tolerance * tolerance));
  };
  const auto begin_impact = [&] {
    phase_ = ContactPhase::compression;
    restitution_ =
        limits.restitution < 1.0 && -limits.restitution * w < slow ? 0.0 : limits.restitution;
  };
  if (closed_) {
    phase_ = static_cast<ContactPhase>(static_cast<int>(memory.phase));
    restitution_ = memory.restitution;
    law_.stiffness = memory.stiffness;
    law_.upper = memory.upper;
    law_.lower = memory.lower;
    const bool lasts = phase_ == ContactPhase::rest || phase_ == ContactPhase::landing;
    if (limits.inertia > 0.0) {
      // Speed of the coordinate when pressed into its band from rest, from its depth under load.
      const double a = std::abs(acceleration_);
      const double depth = limits.law.depth_under(limits.inertia * a);
      slow = std::max(slow, kSlowSteps * std::sqrt(a * depth));
    }
    if (!lasts || limits.restitution == 1.0 || !(-w > slow) || step.dt == 0.0) return;
    const double energy = law_.energy(gap_n_);
    begin_impact();
    if (const double k = impact_stiffness(); k > law_.stiffness) {
      law_.stiffness = k;
      law_.upper = law_.reach_for(gap_n_, energy);
    }
    return;
  }
  law_.upper = 0.0;
  law_.lower = -tolerance;
  phase_ = ContactPhase::landing;
  if (-w > slow) {
    begin_impact();
    law_.stiffness = impact_stiffness();
  }
  if (!(gap_n_ < 0.0)) return;
  // Within the band although no force acted on the path there: no energy is stored.
  closed_ = true;
  law_.lower = std::min(-tolerance, gap_n_ - kMinBand * tolerance);
  law_.stiffness *= tolerance / std::min(tolerance, gap_n_ - *law_.lower);
  law_.upper = gap_n_;
}

double Stop::end_share() const {
  if (phase_ == ContactPhase::compression) return restitution_ == 0.0 ? 1.0 : 0.0;
  if (phase_ == ContactPhase::restitution || limits_.restitution == 1.0) return 0.0;
  return kRestShare;
}

bool Stop::touched() const { return std::min(gap_n_, gap_n1_) < law_.reach(); }

bool Stop::turns() const {
  return touched() && sign_ * step_.rate_n < 0.0 && sign_ * step_.rate_n1 >= 0.0;
}

bool Stop::pressed() const {
  if (phase_ != ContactPhase::rest || !closed_ || !(limits_.inertia > 0.0)) return false;
  if (limits_.restitution == 1.0 || !(step_.dt > 0.0)) return false;
  const double before = law_.force_and_slope(gap_n_).value;
  const double a = std::max(std::abs(acceleration_), before / limits_.inertia);
  const double depth = limits_.law.depth_under(limits_.inertia * a);
  const double slow = kSlowSteps * std::max(a * step_.dt, std::sqrt(a * depth));
  const double force = law_.quotient_and_slope(gap_n_, gap_n1_).value;
  return (force - before) * step_.dt > limits_.inertia * slow;
}

bool Stop::carries() const {
  const bool lasts = phase_ == ContactPhase::rest || phase_ == ContactPhase::landing;
  return lasts && touched() && !jumps() && limits_.restitution < 1.0 && step_.dt > 0.0;
}

bool Stop::jumps() const {
  return pressed() || (limits_.restitution < 1.0 && turns() &&
                       (phase_ == ContactPhase::compression || phase_ == ContactPhase::landing));
}

/// @eq{joint-stop-exit}
double Stop::exit_rate() const {
  const double w = sign_ * step_.rate_n1, e = restitution_;
  if (phase_ == ContactPhase::landing || phase_ == ContactPhase::rest) return 0.0;
  const double h = std::max(0.0, gap_n1_ - law_.reach()), a = -sign_ * acceleration_;
  const double at_stop = std::max(w * w + 2.0 * a * h, 0.0);
  return std::min(w, std::sqrt(std::max(e * e * at_stop - 2.0 * a * h, 0.0)));
}

ContactPhase Stop::phase_after() const {
  switch (phase_) {
    case ContactPhase::landing:
      return turns() ? ContactPhase::rest : phase_;
    case ContactPhase::compression:
      if (!turns()) return phase_;
      return restitution_ > 0.0 ? ContactPhase::restitution : ContactPhase::rest;
    case ContactPhase::restitution:
      return sign_ * step_.rate_n1 > 0.0 ? phase_ : ContactPhase::rest;
    case ContactPhase::rest:
      return phase_;
  }
  return phase_;
}

contact::NormalLaw Stop::law_after() const {
  contact::NormalLaw law = law_;
  if (!(gap_n1_ < law.reach()) || limits_.restitution == 1.0) return law;
  const double energy = law.energy(gap_n1_), k = limits_.law.stiffness;
  const auto leave_room = [&] {
    law.lower = std::min(law.floor(), gap_n1_ - kMinBand * law.tolerance);
  };
  if (phase_ == ContactPhase::compression && turns()) {
    const double e = restitution_;
    law.stiffness = std::max(e * e * law.stiffness, k);
    leave_room();
    law.upper = law.reach_for(gap_n1_, e * e * energy);
  } else if (pressed()) {
    const double kept = std::min(energy, law.energy(gap_n_));
    leave_room();
    law.upper = law.reach_for(gap_n1_, kept);
  } else if (phase_ == ContactPhase::restitution && phase_after() == ContactPhase::rest) {
    law.stiffness = k;
    law.upper = law.reach_for(gap_n1_, energy);
    if (*law.upper > 0.0) law = law_;
  }
  return law;
}

void Stop::remember(double force, double* history) const {
  auto memory = read_record<StopMemory>(history);
  const bool closed = gap_n1_ < law_.reach();
  const bool lasts = phase_ == ContactPhase::rest || phase_ == ContactPhase::landing;
  const double change = step_.dt > 0.0 ? (step_.rate_n1 - step_.rate_n) / step_.dt : 0.0;
  if (!touched())
    memory.acceleration = change;
  else if (lasts && limits_.inertia > 0.0 && (was_pressed_ || !pressed()))
    // An impact elsewhere is no acceleration; what presses in two steps in turn is.
    memory.acceleration = change - sign_ * force / limits_.inertia;
  const contact::NormalLaw law = law_after();
  memory.phase = static_cast<double>(phase_after());
  memory.restitution = pressed() ? 0.0 : restitution_;
  memory.stiffness = law.stiffness;
  memory.upper = law.reach();
  memory.lower = law.floor();
  memory.side = closed ? sign_ : 0.0;
  memory.pressed = pressed() ? 1.0 : 0.0;
  write_record(memory, history);
}

}  // namespace polhode
