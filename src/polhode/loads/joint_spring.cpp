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
  return coordinate_motion(coordinate_, step.a, step.b, step.history[0], step.context.conserving);
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
    const LawValue d = damper_.at(rate.value);
    force += d.value;
    by_a += d.slope * rate.by_a;
    by_b += d.slope * rate.by_b;
  }
  add_force(q, -force, step, t);
  if (step.context.tangents) add_force_change(q, -by_a, -by_b, t);
  clear_ground_sides(step, t);
}

Work JointSpring::work(const PairStep& step) const {
  const CoordinateMotion q = coordinate(step);
  Work work{.stored = spring_.energy(q.at_n1 - free_)};
  if (!damper_.is_zero()) {
    const double rate = rate_step(q, step.a, step.b).value;
    work.dissipated = damper_.at(rate).value * rate * step.context.dt;
  }
  return work;
}

std::vector<double> JointSpring::report(const PairStep& step) const {
  const CoordinateMotion q = coordinate(step);
  const double x = q.at_n1 - free_, rate = coordinate_rate_at_n1(coordinate_, step.a, step.b);
  const double force = spring_.at(x).value + (damper_.is_zero() ? 0.0 : damper_.at(rate).value);
  return numbers(on_b(coordinate_, q, -force), {q.at_n1, rate, spring_.energy(x)});
}

void JointSpring::initialize(const PairStep& step, double* history) const {
  history[0] = coordinate_at_n1(coordinate_, step.a, step.b, 0.0);
}

void JointSpring::commit(const PairStep& step, double* history) const {
  history[0] = coordinate_at_n1(coordinate_, step.a, step.b, step.history[0]);
}

void add_torsional_spring(System& system, const LoadDescription& load) {
  system.group<TorsionalSpring>().add(load);
}

void add_translational_spring(System& system, const LoadDescription& load) {
  system.group<TranslationalSpring>().add(load);
}

}  // namespace polhode
