// SPDX-License-Identifier: Apache-2.0
#include <polhode/dynamics/load_step.hpp>
#include <polhode/loads/motor.hpp>
#include <polhode/math/gauss_rule.hpp>
#include <polhode/system/angle_gradient.hpp>

namespace polhode {

Motor::Motor(const LoadDescription& load)
    : coordinate_(load.coordinate()), function_(load.function) {
  name = load.name;
  bodies = load.bodies;
  drive_ = load.drive == "speed"                             ? Drive::speed
           : load.drive == "force" || load.drive == "moment" ? Drive::effort
                                                             : Drive::position;
  if (const auto* f = std::get_if<CoordinateFunction>(&load.of_motion)) of_motion_ = *f;
}

CoordinateMotion Motor::coordinate(const PairStep& step) const {
  return coordinate_motion(coordinate_, step.a, step.b, step.history[kCoordinate],
                           step.context.conserving);
}

double Motor::at_n1(const PairStep& step) const {
  return coordinate_at_n1(coordinate_, step.a, step.b, step.history[kCoordinate]);
}

double Motor::target(const PairStep& step) const {
  const StepContext& c = step.context;
  if (drive_ == Drive::position) return c.load_factor * (*function_)(c.t_n1());
  double increment = 0.0;
  for (const auto& [place, weight] : kGauss)
    increment += weight * (*function_)(c.t_n + place * c.dt);
  return step.history[kTarget] + c.dt * increment;
}

CoordinateValue Motor::effort(const PairStep& step, const CoordinateMotion& q, const RateStep& rate,
                              bool tangents) const {
  const StepContext& c = step.context;
  CoordinateValue f;
  if (of_motion_)
    f = coordinate_value(*of_motion_, {c.t_alpha(), q.at_alpha, rate.value}, tangents);
  if (function_) f.value += (*function_)(c.t_alpha());
  return {c.load_factor * f.value, c.load_factor * f.by_value, c.load_factor * f.by_rate};
}

double Motor::effort(const PairStep& step) const {
  if (!of_motion_)
    return function_ ? step.context.load_factor * (*function_)(step.context.t_alpha()) : 0.0;
  const CoordinateMotion q = coordinate(step);
  return effort(step, q, rate_step(q, step.a, step.b), false).value;
}

void Motor::prescribed(const PairStep& step, TimeSide side, PrescribedRows& rows) const {
  if (drive_ == Drive::effort) return;
  const TimeRates f = function_->rates(step.context.t_n1(), side);
  const bool position = drive_ == Drive::position;
  const StepContext& c = step.context;
  rows.increment[0] = target(step) - (position ? load_factor_n(c) * (*function_)(function_time_n(c))
                                               : step.history[kTarget]);
  rows.rate[0] = position ? f.rate : f.value;
  rows.second[0] = position ? f.second : f.rate;
}

/// A moment that is no function of the motion, without terms that are zero.
void Motor::add_moment(const FreeAngle& angle, const PairStep& step, PairTerms& t) const {
  const AngleStep s =
      angle_gradient(angle, step.a, step.b, step.history[kCoordinate], step.context.conserving);
  const double moment = effort(step);
  t.wrench_a.tail<3>() -= moment * s.mu;
  t.wrench_b.tail<3>() += moment * s.mu;
  if (step.context.tangents) {
    const Mat3 by_a = moment * s.D_mu_a, by_b = moment * s.D_mu_b;
    t.D_aa.bottomRightCorner<3, 3>() -= by_a;
    t.D_ab.bottomRightCorner<3, 3>() -= by_b;
    t.D_ba.bottomRightCorner<3, 3>() += by_a;
    t.D_bb.bottomRightCorner<3, 3>() += by_b;
  }
  clear_ground_sides(step, t);
}

void Motor::evaluate(const PairStep& step, PairTerms& t) const {
  const auto* angle = std::get_if<FreeAngle>(&coordinate_);
  if (angle && rows() == 0 && !of_motion_) return add_moment(*angle, step, t);
  const CoordinateMotion q = coordinate(step);
  if (of_motion_) {
    const RateStep rate = rate_step(q, step.a, step.b);
    const CoordinateValue f = effort(step, q, rate, step.context.tangents);
    add_force(q, f.value, step, t);
    if (step.context.tangents)
      add_force_change(q, f.by_value * q.alpha_a + f.by_rate * rate.by_a,
                       f.by_value * q.alpha_b + f.by_rate * rate.by_b, t);
  } else {
    add_force(q, rows() > 0 ? step.lambda[0] : effort(step), step, t);
  }
  if (rows() > 0) {
    // Before assembly of the start a rate does not determine the coordinate.
    const bool known = drive_ == Drive::position || step.history[kStarted] != 0.0;
    t.g[0] = known ? q.at_n1 - target(step) : 0.0;
    t.B_a.col(0) = q.mu_a;
    t.B_b.col(0) = q.mu_b;
  }
  if (step.context.tangents && rows() > 0) {
    t.G_a.row(0) = q.at_n1_a;
    t.G_b.row(0) = q.at_n1_b;
  }
  clear_ground_sides(step, t);
}

void Motor::acceleration_terms(const PairStep& step, Vec6& gamma) const {
  PrescribedRows rows;
  prescribed(step, TimeSide::kAfter, rows);
  gamma[0] =
      std::visit([&](const auto& q) { return q.acceleration_at_n1(step.a, step.b); }, coordinate_) -
      rows.second[0];
}

double Motor::work_of_step(const PairStep& step) const {
  if (rows() == 0) return effort(step) * (at_n1(step) - step.history[kCoordinate]);
  PrescribedRows rows;
  prescribed(step, TimeSide::kBefore, rows);
  return step.lambda[0] * rows.increment[0];
}

/// Work of the motor; zero for one with a row, whose work is counted by EnergyLedger.
Work Motor::work(const PairStep& step) const {
  return rows() > 0 ? Work{} : Work{.put_in = work_of_step(step)};
}

std::vector<double> Motor::report(const PairStep& step) const {
  const double force = rows() > 0 ? step.lambda[0] : effort(step);
  const double rate = coordinate_rate_at_n1(coordinate_, step.a, step.b);
  return numbers(on_b(coordinate_, coordinate(step), force),
                 {at_n1(step), rate, force * rate, step.history[kWork], step.history[kImpulse]});
}

void Motor::initialize(const PairStep& step, double* history) const {
  history[kCoordinate] = history[kTarget] = at_n1(step);
  history[kWork] = history[kImpulse] = history[kForce] = 0.0;
  history[kStarted] = 1.0;
}

void Motor::commit(const PairStep& step, double* history) const {
  const double at = at_n1(step);
  const double target = drive_ == Drive::speed ? this->target(step) : at;
  const double force = rows() > 0 ? step.lambda[0] : effort(step);
  const double mean = working_force(step.context, step.history[kForce], force);
  const double work = rows() > 0 ? work_of_step(step) : mean * (at - step.history[kCoordinate]);
  history[kCoordinate] = at;
  history[kTarget] = target;
  history[kWork] += work;
  if (is_load_step(step.context)) history[kForce] = force;
  history[kImpulse] += step.context.dt * force;
}

void Motor::commit_off(const PairStep& step, double* history) const {
  history[kCoordinate] = history[kTarget] = at_n1(step);
}

void add_rotary_motor(System& system, const LoadDescription& load) {
  system.group<RotaryMotor>().add(load);
}

void add_linear_motor(System& system, const LoadDescription& load) {
  system.group<LinearMotor>().add(load);
}

}  // namespace polhode
