// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <utility>

#include <polhode/loads/motor.hpp>

namespace polhode {

namespace {

/// Gauss-Legendre points and weights on (0, 1): exact for polynomials of degree 9.
constexpr std::array<std::pair<double, double>, 5> kGauss{{{0.046910077030668, 0.118463442528095},
                                                           {0.230765344947158, 0.239314335249683},
                                                           {0.5, 0.284444444444444},
                                                           {0.769234655052842, 0.239314335249683},
                                                           {0.953089922969332, 0.118463442528095}}};

/// The coordinate over a step in the form that both kinds share.
struct CoordinateStep {
  double at_n1;
  Vec6 mu_a, mu_b, at_n1_a, at_n1_b;
  Mat6 D_aa, D_ab, D_ba, D_bb;  ///< Of mu.
};

CoordinateStep coordinate_step(const FreeAngle& angle, const PairStep& step) {
  const AngleStep s = angle_step(angle, step.a, step.b, step.history[0], step.context.conserving);
  const double per_alpha = 1.0 / step.a.alpha_f;
  CoordinateStep c;
  c.at_n1 = s.at_n1;
  c.mu_a << Vec3::Zero(), -s.mu;
  c.mu_b << Vec3::Zero(), s.mu;
  c.at_n1_a << Vec3::Zero(), per_alpha * s.D_alpha_a;
  c.at_n1_b << Vec3::Zero(), per_alpha * s.D_alpha_b;
  for (Mat6* D : {&c.D_aa, &c.D_ab, &c.D_ba, &c.D_bb}) D->setZero();
  c.D_aa.bottomRightCorner<3, 3>() = -s.D_mu_a;
  c.D_ab.bottomRightCorner<3, 3>() = -s.D_mu_b;
  c.D_ba.bottomRightCorner<3, 3>() = s.D_mu_a;
  c.D_bb.bottomRightCorner<3, 3>() = s.D_mu_b;
  return c;
}

CoordinateStep coordinate_step(const FreeDisplacement& displacement, const PairStep& step) {
  const DisplacementStep s = displacement_step(displacement, step.a, step.b);
  return {s.at_n1, s.mu_a, s.mu_b, s.at_n1_a, s.at_n1_b, s.D_aa, s.D_ab, s.D_ba, s.D_bb};
}

}  // namespace

Motor::Motor(const LoadDescription& load) : function_(load.function) {
  name = load.name;
  bodies = load.bodies;
  if (load.angle)
    coordinate_ = *load.angle;
  else
    coordinate_ = load.displacement.value();
  drive_ = load.drive == "speed"                             ? Drive::speed
           : load.drive == "force" || load.drive == "moment" ? Drive::effort
                                                             : Drive::position;
}

double Motor::coordinate_at_n1(const PairStep& step) const {
  if (const auto* angle = std::get_if<FreeAngle>(&coordinate_))
    return angle->at_n1(step.a, step.b, step.history[kCoordinate]);
  return std::get<FreeDisplacement>(coordinate_).at_n1(step.a, step.b);
}

double Motor::rate_at_n1(const PairStep& step) const {
  return std::visit([&](const auto& q) { return q.rate_at_n1(step.a, step.b); }, coordinate_);
}

double Motor::target(const PairStep& step) const {
  const StepContext& c = step.context;
  if (drive_ == Drive::position) return c.load_factor * (*function_)(c.t_n1());
  double increment = 0.0;
  for (const auto& [place, weight] : kGauss)
    increment += weight * (*function_)(c.t_n + place * c.dt);
  return step.history[kTarget] + c.dt * increment;
}

double Motor::effort(const PairStep& step) const {
  return step.context.load_factor * (*function_)(step.context.t_alpha());
}

void Motor::prescribed(const PairStep& step, TimeSide side, PrescribedRows& rows) const {
  if (drive_ == Drive::effort) return;
  const TimeRates f = function_->rates(step.context.t_n1(), side);
  const bool position = drive_ == Drive::position;
  rows.increment[0] =
      target(step) - (position ? (*function_)(step.context.t_n) : step.history[kTarget]);
  rows.rate[0] = position ? f.rate : f.value;
  rows.second[0] = position ? f.second : f.rate;
}

void Motor::evaluate(const PairStep& step, PairTerms& t) const {
  const CoordinateStep q =
      std::visit([&](const auto& x) { return coordinate_step(x, step); }, coordinate_);
  const double force = rows() > 0 ? step.lambda[0] : effort(step);
  t.wrench_a = force * q.mu_a;
  t.wrench_b = force * q.mu_b;
  if (rows() > 0) {
    // Before the start is assembled a rate does not say where the coordinate stands.
    const bool known = drive_ == Drive::position || step.history[kStarted] != 0.0;
    t.g[0] = known ? q.at_n1 - target(step) : 0.0;
    t.B_a.col(0) = q.mu_a;
    t.B_b.col(0) = q.mu_b;
  }
  if (step.context.tangents) {
    t.D_aa = force * q.D_aa;
    t.D_ab = force * q.D_ab;
    t.D_ba = force * q.D_ba;
    t.D_bb = force * q.D_bb;
    if (rows() > 0) {
      t.G_a.row(0) = q.at_n1_a;
      t.G_b.row(0) = q.at_n1_b;
    }
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
  if (rows() == 0) return effort(step) * (coordinate_at_n1(step) - step.history[kCoordinate]);
  PrescribedRows rows;
  prescribed(step, TimeSide::kBefore, rows);
  return step.lambda[0] * rows.increment[0];
}

/// Nothing for a motor with a row, whose work LedgerKeeper counts.
Work Motor::work(const PairStep& step) const {
  return rows() > 0 ? Work{} : Work{.put_in = work_of_step(step)};
}

std::vector<double> Motor::report(const PairStep& step) const {
  const double force = rows() > 0 ? step.lambda[0] : effort(step), rate = rate_at_n1(step);
  const Vec6 on_b =
      force *
      std::visit([&](const auto& q) { return coordinate_step(q, step); }, coordinate_).at_n1_b;
  const bool turns = std::holds_alternative<FreeAngle>(coordinate_);
  return numbers(turns ? on_b.tail<3>() : on_b.head<3>(),
                 {coordinate_at_n1(step), rate, force * rate, step.history[kWork]});
}

void Motor::initialize(const PairStep& step, double* history) const {
  history[kCoordinate] = history[kTarget] = coordinate_at_n1(step);
  history[kWork] = 0.0;
  history[kStarted] = 1.0;
}

void Motor::commit(const PairStep& step, double* history) const {
  const double work = work_of_step(step), at = coordinate_at_n1(step);
  const double target = drive_ == Drive::speed ? this->target(step) : at;
  history[kCoordinate] = at;
  history[kTarget] = target;
  history[kWork] += work;
}

void add_rotary_motor(System& system, const LoadDescription& load) {
  system.group<RotaryMotor>().items.emplace_back(load);
}

void add_linear_motor(System& system, const LoadDescription& load) {
  system.group<LinearMotor>().items.emplace_back(load);
}

}  // namespace polhode
