// SPDX-License-Identifier: Apache-2.0
// Unilateral rows at the end of a step: its faults, their wrenches and losses.
#include <algorithm>
#include <cmath>

#include <polhode/core/format.hpp>
#include <polhode/engines/unilateral_rows.hpp>
#include <polhode/system/history_record.hpp>

namespace polhode {

void UnilateralRows::add_to(ConstraintCheck& check, const State& state, const Trial& trial) {
  take_steps(state, trial);
  take_stops(state, trial);
  for (const Stop& stop : stops_) {
    const double force = stop.exists ? stop.impulse / std::abs(dt_) : 0.0;
    check.work_defect += force * std::abs(stop.row.gap_n1);
    check.work_scale += force * system_->length_scale();
  }
  for (const ImpulsePoint& p : points_) {
    const double force = std::max(0.0, p.normal.dot(p.impulse)) / std::abs(dt_);
    if (force == 0.0) continue;
    check.work_defect += force * std::abs(impulsive_->gap_after(steps_, p) - p.kept);
    check.work_scale += force * (system_->length_scale() + p.place.lpNorm<1>());
  }
  check.broken = broken();
}

/// Message about a fault of the step, empty without one: bodies that overlap at its end, at a point
/// without a row, or a gain of energy by rows whose direction at the middle of the step differs
/// from the gradient of the gap. Both vanish with the length of the step.
std::string UnilateralRows::broken() const {
  const double accuracy = kOverlapGaps * touching_;
  for (const Stop& stop : stops_)
    if (stop.exists && stop.row.gap_n1 < -accuracy)
      return format("{} would be passed", stop_name(*system_, stop.interaction));
  if (!contacts_) return {};
  if (const auto pair = impulsive_->passed(steps_))
    return format("{} would overlap or pass through each other",
                  pair_name(*system_, pair->first, pair->second));
  double gained = 0.0, forces = 0.0, most = 0.0;
  const ImpulsePoint* worst = nullptr;
  for (const ImpulsePoint& p : points_) {
    const double force = p.normal.dot(p.impulse) / dt_, gain = force * p.normal.dot(slip_of(p));
    gained += gain;
    forces += std::abs(force);
    if (gain <= most) continue;
    most = gain;
    worst = &p;
  }
  if (!worst || gained <= accuracy * forces) return {};
  return format("the contact of {} would gain energy", pair_name(*system_, worst->a, worst->b));
}

void UnilateralRows::add_ground_wrench(double* force, double* moment) const {
  for (const ImpulsePoint& p : points_) {
    if (p.a != kGround && p.b != kGround) continue;
    const double sign = (p.b == kGround ? 1.0 : -1.0) / dt_;
    const Vec3 f = sign * p.impulse, m = p.place.cross(f) + sign * p.turning;
    for (int i = 0; i < 3; ++i) {
      force[i] += f[i];
      moment[i] += m[i];
    }
  }
  for (const Stop& stop : stops_) {
    if (!stop.exists || stop.impulse == 0.0 || (stop.a != kGround && stop.b != kGround)) continue;
    const Vec6 w = stop.impulse / dt_ * (stop.a == kGround ? stop.row.on_b : stop.row.on_a);
    const BodyStep& s = step_of(stop.a == kGround ? stop.b : stop.a);
    const Vec3 m = (s.r_n + 0.5 * s.u).cross(w.head<3>()) + w.tail<3>();
    for (int i = 0; i < 3; ++i) {
      force[i] += w[i];
      moment[i] += m[i];
    }
  }
}

/// Losses from the motion of the step: −½ p·y. Forces of stops are stored in their records.
/// @eq{contact-rows}
Work UnilateralRows::commit(State& state, const Trial& trial) {
  take_steps(state, trial);
  take_stops(state, trial);
  Work work;
  for (const Stop& stop : stops_) {
    double* const memory = state.history.data() + stop.memory;
    auto record = read_record<UnilateralMemory>(memory);
    record.force = stop.exists ? stop.impulse / dt_ : 0.0;
    write_record(record, memory);
    if (stop.exists)
      work.dissipated -= record.force * change_of_gap(stop.row, step_of(stop.a), step_of(stop.b));
  }
  if (!contacts_) return work;
  losses_.assign(points_.size(), {});
  for (std::size_t k = 0; k < points_.size(); ++k) {
    ImpulsePoint& p = points_[k];
    const Vec3 slip = slip_of(p);
    const double normal = p.normal.dot(p.impulse);
    p.slip = (slip - p.normal.dot(slip) * p.normal).norm();
    losses_[k].normal = -normal * p.normal.dot(slip) / dt_;
    losses_[k].friction = -((p.impulse - normal * p.normal).dot(slip) +
                            p.turning.dot(step_of(p.a).theta - step_of(p.b).theta)) /
                          dt_;
  }
  ImpulseSearch search;
  search.converged = true;
  work += impulsive_->commit_impulses(state, steps_, trial.context, points_, losses_, search);
  return work;
}

}  // namespace polhode
