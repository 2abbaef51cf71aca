// SPDX-License-Identifier: Apache-2.0
#include <polhode/loads/moment.hpp>

namespace polhode {

Moment::Moment(const LoadDescription& load) : moment_(load) {
  name = load.name;
  bodies = load.bodies;
}

void Moment::evaluate(const PairStep& step, PairTerms& t) const {
  const LoadVector::OverStep m = moment_.over_step(step, Vec3::Zero());
  t.wrench_b.tail<3>() = m.value;
  if (step.context.tangents) t.D_bb.bottomRows<3>() = m.by_b;
  clear_ground_sides(step, t);
}

Work Moment::work(const PairStep& step) const {
  return {.put_in = moment_.value(step, Vec3::Zero()).dot(step.b.theta)};
}

std::vector<double> Moment::report(const PairStep& step) const {
  return numbers(moment_.at_instant(step, Vec3::Zero()));
}

void add_moment(System& system, const LoadDescription& load) { system.group<Moment>().add(load); }

}  // namespace polhode
