// SPDX-License-Identifier: Apache-2.0
#include <polhode/loads/joint_spring.hpp>

namespace polhode {

JointSpring::JointSpring(const LoadDescription& load, const char* free_value)
    : coordinate_(load.coordinate()),
      free_(load.value(free_value, 0.0)),
      spring_(load, load.angle ? "spring_moment" : "spring_force"),
      damper_(load, load.angle ? "damper_moment" : "damper_force") {
  name = load.name;
  bodies = load.bodies;
}

CoordinateMotion JointSpring::coordinate(const PairStep& step) const {
  return coordinate_motion(coordinate_, step.a, step.b, step.history[kCoordinate],
                           step.context.conserving);
}

double JointSpring::rate_now(const PairStep& step) const {
  return coordinate_rate_at_n1(coordinate_, step.a, step.b);
}

StepRates JointSpring::rates(const PairStep& step, double at_alpha) const {
  const bool needed = damper_.jumps() && step.context.dt != 0.0;
  const double now =
      needed ? coordinate_rate_at_n1(coordinate_, body_at_start(step.a), body_at_start(step.b))
             : 0.0;
  return damper_.rates(step, now, at_alpha, step.history + kDamper);
}

void JointSpring::evaluate(const PairStep& step, PairTerms& t) const {
  const CoordinateMotion q = coordinate(step);
  const bool mean = step.context.conserving;
  const LawValue f = mean ? spring_.over_step(q.at_n - free_, q.at_n1 - free_, step.a.alpha_f)
                          : spring_.at(q.at_alpha - free_);
  double force = f.value;
  Vec6 by_a = f.slope * (mean ? q.at_n1_a : q.alpha_a);
  Vec6 by_b = f.slope * (mean ? q.at_n1_b : q.alpha_b);
  if (!damper_.is_zero()) {
    const RateStep rate = rate_step(q, step.a, step.b);
    const StepRates v = rates(step, rate.value);
    const LawValue d = damper_.smooth(v);
    force += d.value;
    by_a += d.slope * rate.by_a;
    by_b += d.slope * rate.by_b;
    force += damper_.of_rows(v, step.lambda, step.history + kDamper);
    const Vec6 by_rate = damper_.put_rows(v, step.lambda, t);
    for (int k = 0; k < rows(); ++k) {
      t.B_a.col(k) = q.mu_a;
      t.B_b.col(k) = q.mu_b;
      if (!step.context.tangents) continue;
      t.G_a.row(k) = by_rate[k] * rate.by_a;
      t.G_b.row(k) = by_rate[k] * rate.by_b;
    }
  }
  add_force(q, -force, step, t);
  if (step.context.tangents) add_force_change(q, -by_a, -by_b, t);
  clear_ground_sides(step, t);
}

void JointSpring::pieces(const PairStep& step, ForcePieces& pieces) const {
  spring_.piece(coordinate(step).at_n1 - free_, pieces);
  damper_.piece(rate_now(step), step.history + kDamper, pieces);
}

Work JointSpring::work(const PairStep& step) const {
  const CoordinateMotion q = coordinate(step);
  Work work{.stored = spring_.energy(q.at_n1 - free_)};
  if (!damper_.is_zero()) {
    const StepRates v = rates(step, rate_step(q, step.a, step.b).value);
    work.dissipated =
        damper_.force(v, step.lambda, step.history + kDamper) * v.at_alpha * step.context.dt;
  }
  return work;
}

std::vector<double> JointSpring::report(const PairStep& step) const {
  const CoordinateMotion q = coordinate(step);
  const double x = q.at_n1 - free_, rate = rate_now(step);
  double force = spring_.at(x).value;
  if (!damper_.is_zero())
    force += damper_.force(rates(step, rate), step.lambda, step.history + kDamper);
  return numbers(on_b(coordinate_, q, -force), {q.at_n1, rate, spring_.energy(x)});
}

void JointSpring::initialize(const PairStep& step, double* history) const {
  history[kCoordinate] = coordinate_at_n1(coordinate_, step.a, step.b, 0.0);
  damper_.initialize(rate_now(step), history + kDamper);
}

void JointSpring::commit(const PairStep& step, double* history) const {
  if (rows() > 0) {
    const StepRates v = rates(step, rate_step(coordinate(step), step.a, step.b).value);
    damper_.commit(v, rate_now(step), step.lambda, history + kDamper);
  }
  commit_off(step, history);
}

void JointSpring::commit_off(const PairStep& step, double* history) const {
  history[kCoordinate] = coordinate_at_n1(coordinate_, step.a, step.b, step.history[kCoordinate]);
}

void JointSpring::switch_on(const PairStep& step, double* history) const {
  commit_off(step, history);
  damper_.initialize(rate_now(step), history + kDamper);
}

void add_torsional_spring(System& system, const LoadDescription& load) {
  system.group<TorsionalSpring>().add(load);
}

void add_translational_spring(System& system, const LoadDescription& load) {
  system.group<TranslationalSpring>().add(load);
}

}  // namespace polhode
