// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/dynamics/load_step.hpp>
#include <polhode/loads/force_law.hpp>
#include <polhode/loads/servo.hpp>

namespace polhode {

Servo::Servo(const LoadDescription& load, const char* limit)
    : coordinate_(load.coordinate()),
      function_(load.function),
      of_speed_(load.drive == "speed"),
      k_(load.value("stiffness", 0.0)),
      d_(load.value("damping", 0.0)),
      k_i_(load.value("integral", 0.0)),
      limit_(load.value(limit, 0.0)) {
  name = load.name;
  bodies = load.bodies;
  of_limit_ = load.at_rest && k_i_ != 0.0 && !of_speed_;
}

CoordinateMotion Servo::coordinate(const PairStep& step) const {
  return coordinate_motion(coordinate_, step.a, step.b, step.history[kCoordinate],
                           step.context.conserving);
}

Servo::Command Servo::command(const PairStep& step, const CoordinateMotion& q) const {
  const StepContext& c = step.context;
  const double af = step.a.alpha_f;
  const RateStep rate = rate_step(q, step.a, step.b);
  // A target can jump only between steps.
  const bool still = c.dt == 0.0;
  const TimeRates from = function_->rates(c.t_n, TimeSide::kAfter);
  const TimeRates to = still ? from : function_->rates(c.t_n1(), TimeSide::kBefore);
  Command u;
  double wanted_rate = 0.0;
  if (of_speed_) {
    const double way = still ? 0.0
                             : c.dt * mean_value(*function_, beside(c.t_n, TimeSide::kAfter),
                                                 beside(c.t_n1(), TimeSide::kBefore));
    wanted_rate = still ? from.value : way / c.dt;
    u.error_n1 = step.history[kError] + way - (q.at_n1 - q.at_n);
    u.error = step.history[kError] + af * way - (q.at_alpha - q.at_n);
  } else {
    if (!is_load_step(c))
      wanted_rate = c.load_factor * (still ? from.rate : (to.value - from.value) / c.dt);
    u.error_n1 = c.load_factor * to.value - q.at_n1;
    u.error = c.load_factor * ((1.0 - af) * from.value + af * to.value) - q.at_alpha;
  }
  // the integral up to t_{n+αf} contains the present error
  const double gain = of_limit_ ? k_ : k_ + k_i_ * af * c.dt;
  const double integral = of_limit_ ? step.lambda[0] : k_i_ * step.history[kIntegral];
  u.force = gain * u.error + d_ * (wanted_rate - rate.value) + integral;
  u.by_a = -gain * q.alpha_a - d_ * rate.by_a;
  u.by_b = -gain * q.alpha_b - d_ * rate.by_b;
  u.limited = limit_ > 0.0 && std::abs(u.force) > limit_;
  if (u.limited) {
    u.force = std::clamp(u.force, -limit_, limit_);
    u.by_a.setZero();
    u.by_b.setZero();
  }
  return u;
}

void Servo::evaluate(const PairStep& step, PairTerms& t) const {
  const CoordinateMotion q = coordinate(step);
  const Command u = command(step, q);
  add_force(q, u.force, step, t);
  if (step.context.tangents) add_force_change(q, u.by_a, u.by_b, t);
  if (of_limit_) put_row(step, q, u, t);
  clear_ground_sides(step, t);
}

/// The row −e + (λ/k_i) μ = 0; at the limit of the force μ = ±F_max and the row has no error.
/// @eq{servo-at-rest}
void Servo::put_row(const PairStep& step, const CoordinateMotion& q, const Command& u,
                    PairTerms& t) const {
  const StepContext& c = step.context;
  t.B_a.col(0) = q.mu_a;
  t.B_b.col(0) = q.mu_b;
  if (u.limited) {
    const double per_force = 1.0 / (k_ > 0.0 ? k_ : std::abs(k_i_));
    t.g[0] = -per_force * u.force;
    t.compliance[0] = per_force;
    t.B_a.col(0).setZero();
    t.B_b.col(0).setZero();
    if (step.context.tangents) {
      t.G_a.row(0).setZero();
      t.G_b.row(0).setZero();
    }
    return;
  }
  t.g[0] = -u.error_n1;
  // Zero but in the assembly that measures rates, where c/Δt is λ.
  t.compliance[0] = c.dt != 0.0 ? c.ga.c / c.dt / k_i_ : 0.0;
  if (step.context.tangents) {
    t.G_a.row(0) = q.at_n1_a;
    t.G_b.row(0) = q.at_n1_b;
  }
}

void Servo::acceleration_terms(const PairStep& step, Vec6& gamma) const {
  if (!of_limit_) return;
  gamma[0] =
      std::visit([&](const auto& q) { return q.acceleration_at_n1(step.a, step.b); }, coordinate_) -
      function_->rates(step.context.t_n1(), TimeSide::kAfter).second;
}

void Servo::pieces(const PairStep& step, ForcePieces& pieces) const {
  const Command u = command(step, coordinate(step));
  pieces.add(u.limited ? u.force : 0.0);
}

Work Servo::work(const PairStep& step) const {
  const CoordinateMotion q = coordinate(step);
  return {.put_in = command(step, q).force * (q.at_n1 - q.at_n)};
}

std::vector<double> Servo::report(const PairStep& step) const {
  const CoordinateMotion q = coordinate(step);
  const Command u = command(step, q);
  const double rate = coordinate_rate_at_n1(coordinate_, step.a, step.b);
  return numbers(on_b(coordinate_, q, u.force),
                 {q.at_n1, rate, u.error_n1, u.force * rate, step.history[kWork]});
}

void Servo::initialize(const PairStep& step, double* history) const {
  history[kCoordinate] = coordinate_at_n1(coordinate_, step.a, step.b, 0.0);
  history[kError] = history[kIntegral] = history[kWork] = history[kForce] = 0.0;
}

void Servo::commit(const PairStep& step, double* history) const {
  const CoordinateMotion q = coordinate(step);
  const Command u = command(step, q);
  const double mean = working_force(step.context, step.history[kForce], u.force);
  const double work = mean * (q.at_n1 - q.at_n);
  if (is_load_step(step.context)) history[kForce] = u.force;
  history[kCoordinate] = q.at_n1;
  if (!u.limited) {
    history[kIntegral] += step.context.dt * u.error;
    history[kError] = u.error_n1;
  }
  history[kWork] += work;
}

void Servo::commit_off(const PairStep& step, double* history) const {
  history[kCoordinate] = coordinate_at_n1(coordinate_, step.a, step.b, step.history[kCoordinate]);
}

void Servo::switch_on(const PairStep& step, double* history) const {
  commit_off(step, history);
  history[kError] = history[kIntegral] = 0.0;
}

void add_rotary_servo(System& system, const LoadDescription& load) {
  system.group<RotaryServo>().add(load);
}

void add_linear_servo(System& system, const LoadDescription& load) {
  system.group<LinearServo>().add(load);
}

}  // namespace polhode
