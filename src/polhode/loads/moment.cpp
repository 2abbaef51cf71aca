// SPDX-License-Identifier: Apache-2.0
#include <polhode/loads/moment.hpp>

namespace polhode {

Moment::Moment(const LoadDescription& load) : moment_(load.vector), body_fixed_(load.body_fixed) {
  name = load.name;
  bodies = load.bodies;
}

void Moment::evaluate(const PairStep& step, PairTerms& t) const {
  const Vec3 M = polhode::evaluate(moment_, step.context);
  if (body_fixed_) {
    const Carried m = step.b.vector(M);
    t.wrench_b.tail<3>() = m.at_alpha;
    t.D_bb.bottomRightCorner<3, 3>() = -step.b.alpha_f * hat(m.at_n1);
  } else {
    t.wrench_b.tail<3>() = M;
  }
  clear_ground_sides(step, t);
}

Work Moment::work(const PairStep& step) const {
  const Vec3 M = polhode::evaluate(moment_, step.context);
  return {.put_in = (body_fixed_ ? step.b.vector(M).at_alpha : M).dot(step.b.theta)};
}

std::vector<double> Moment::report(const PairStep& step) const {
  const Vec3 M = polhode::evaluate(moment_, step.context.t_n1());
  return numbers(body_fixed_ ? step.b.vector(M).at_n1 : M);
}

void add_moment(System& system, const LoadDescription& load) {
  system.group<Moment>().items.emplace_back(load);
}

}  // namespace polhode
