// SPDX-License-Identifier: Apache-2.0
#include <polhode/loads/torsional_spring.hpp>

namespace polhode {

TorsionalSpring::TorsionalSpring(const LoadDescription& load)
    : angle_(load.angle.value()),
      k_(load.value("stiffness", 0.0)),
      c_(load.value("damping", 0.0)),
      phi_0_(load.value("free_angle", 0.0)) {
  name = load.name;
  bodies = load.bodies;
}

void TorsionalSpring::evaluate(const PairStep& step, PairTerms& t) const {
  const AngleStep phi =
      angle_step(angle_, step.a, step.b, step.history[0], step.context.conserving);
  const double M = k_ * (phi.at_alpha - phi_0_) + c_ * phi.rate;
  const Vec3 D_M_a = k_ * phi.D_alpha_a + c_ * phi.D_rate_a;
  const Vec3 D_M_b = k_ * phi.D_alpha_b + c_ * phi.D_rate_b;
  const Mat3 by_a = phi.mu * D_M_a.transpose() + M * phi.D_mu_a;
  const Mat3 by_b = phi.mu * D_M_b.transpose() + M * phi.D_mu_b;
  t.wrench_a.tail<3>() = M * phi.mu;
  t.wrench_b.tail<3>() = -M * phi.mu;
  t.D_aa.bottomRightCorner<3, 3>() = by_a;
  t.D_ab.bottomRightCorner<3, 3>() = by_b;
  t.D_ba.bottomRightCorner<3, 3>() = -by_a;
  t.D_bb.bottomRightCorner<3, 3>() = -by_b;
  clear_ground_sides(step, t);
}

Work TorsionalSpring::work(const PairStep& step) const {
  const AngleStep phi =
      angle_step(angle_, step.a, step.b, step.history[0], step.context.conserving);
  const double turned = phi.at_n1 - phi_0_;
  return {.stored = 0.5 * k_ * turned * turned,
          .dissipated = c_ * phi.rate * phi.rate * step.context.dt};
}

std::vector<double> TorsionalSpring::report(const PairStep& step) const {
  const AngleStep phi =
      angle_step(angle_, step.a, step.b, step.history[0], step.context.conserving);
  const double turned = phi.at_n1 - phi_0_, M = k_ * turned + c_ * phi.rate;
  return numbers(-M * phi.mu, {phi.at_n1, phi.rate, 0.5 * k_ * turned * turned});
}

void TorsionalSpring::initialize(const PairStep& step, double* history) const {
  history[0] = angle_.at_n1(step.a, step.b, 0.0);
}

void TorsionalSpring::commit(const PairStep& step, double* history) const {
  history[0] = angle_.at_n1(step.a, step.b, step.history[0]);
}

void add_torsional_spring(System& system, const LoadDescription& load) {
  system.group<TorsionalSpring>().items.emplace_back(load);
}

}  // namespace polhode
