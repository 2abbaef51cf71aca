// SPDX-License-Identifier: Apache-2.0
#include <polhode/loads/point_force.hpp>

namespace polhode {

PointForce::PointForce(const LoadDescription& load)
    : Z_(load.Z_b),
      force_(load.vector),
      body_fixed_(load.body_fixed),
      potential_(!load.body_fixed && is_constant(load.vector)) {
  name = load.name;
  bodies = load.bodies;
}

void PointForce::evaluate(const PairStep& step, PairTerms& t) const {
  const double af = step.b.alpha_f;
  const Carried z = step.b.vector(Z_);
  const Vec3 F = polhode::evaluate(force_, step.context);
  Vec3 f = F;
  if (body_fixed_) {
    const Carried carried = step.b.vector(F);
    f = carried.at_alpha;
    const Mat3 D_f = -af * hat(carried.at_n1);
    t.D_bb.topRightCorner<3, 3>() = D_f;
    t.D_bb.bottomRightCorner<3, 3>() = hat(z.at_alpha) * D_f;
  }
  t.wrench_b << f, z.at_alpha.cross(f);
  t.D_bb.bottomRightCorner<3, 3>() += af * hat_hat(f, z.at_n1);
  clear_ground_sides(step, t);
}

Work PointForce::work(const PairStep& step) const {
  const Vec3 F = polhode::evaluate(force_, step.context);
  if (potential_) return {.stored = -F.dot(step.b.point(Z_).at_n1)};
  const Vec3 f = body_fixed_ ? step.b.vector(F).at_alpha : F;
  return {.put_in = f.dot(step.b.u + step.b.theta.cross(step.b.vector(Z_).at_alpha))};
}

std::vector<double> PointForce::report(const PairStep& step) const {
  const Vec3 F = polhode::evaluate(force_, step.context.t_n1());
  return numbers(body_fixed_ ? step.b.vector(F).at_n1 : F);
}

void add_point_force(System& system, const LoadDescription& load) {
  system.group<PointForce>().items.emplace_back(load);
}

}  // namespace polhode
