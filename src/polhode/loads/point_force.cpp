// SPDX-License-Identifier: Apache-2.0
#include <polhode/loads/point_force.hpp>

namespace polhode {

PointForce::PointForce(const LoadDescription& load) : Z_(load.Z_b), force_(load) {
  name = load.name;
  bodies = load.bodies;
}

void PointForce::evaluate(const PairStep& step, PairTerms& t) const {
  const Carried z = step.b.vector(Z_);
  const LoadVector::OverStep f = force_.over_step(step, Z_);
  t.wrench_b << f.value, z.at_alpha.cross(f.value);
  if (step.context.tangents) {
    t.D_bb << f.by_b, hat(z.at_alpha) * f.by_b;
    t.D_bb.bottomRightCorner<3, 3>() += step.b.alpha_f * hat_hat(f.value, z.at_n1);
  }
  clear_ground_sides(step, t);
}

Work PointForce::work(const PairStep& step) const {
  const Vec3 f = force_.value(step, Z_);
  if (force_.is_dead()) return {.stored = -f.dot(step.b.point(Z_).at_n1)};
  return {.put_in = f.dot(step.b.u + step.b.theta.cross(step.b.vector(Z_).at_alpha))};
}

std::vector<double> PointForce::report(const PairStep& step) const {
  return numbers(force_.at_instant(step, Z_));
}

void add_point_force(System& system, const LoadDescription& load) {
  system.group<PointForce>().add(load);
}

}  // namespace polhode
