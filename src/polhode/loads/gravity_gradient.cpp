// SPDX-License-Identifier: Apache-2.0
#include <polhode/loads/gravity_gradient.hpp>

#include <cmath>
#include <limits>

#include <polhode/loads/registry.hpp>

namespace polhode {

namespace {

using Mat3x6 = Eigen::Matrix<double, 3, 6>;
using Row6 = Eigen::Matrix<double, 1, 6>;

/// Quotient (l_1^-k − l_0^-k)/(l_1² − l_0²), without cancellation, with its derivatives.
struct PowerQuotient {
  double value = 0.0, by_l0 = 0.0, by_l1 = 0.0;
};

PowerQuotient power_quotient(int k, double l0, double l1) {
  double sum = 0.0, sum_l0 = 0.0, sum_l1 = 0.0;  // sums of l_0^i l_1^(k-1-i)
  for (int i = 0; i < k; ++i) {
    const int j = k - 1 - i;
    sum += std::pow(l0, i) * std::pow(l1, j);
    if (i > 0) sum_l0 += i * std::pow(l0, i - 1) * std::pow(l1, j);
    if (j > 0) sum_l1 += j * std::pow(l0, i) * std::pow(l1, j - 1);
  }
  PowerQuotient q;
  q.value = -sum / (std::pow(l0 * l1, k) * (l0 + l1));
  q.by_l0 = q.value * (sum_l0 / sum - k / l0 - 1.0 / (l0 + l1));
  q.by_l1 = q.value * (sum_l1 / sum - k / l1 - 1.0 / (l0 + l1));
  return q;
}

}  // namespace

GravityGradient::GravityGradient(const LoadDescription& load)
    : Z_a_(load.bodies.a == kGround ? load.Z_a : Vec3::Zero().eval()),
      mu_(load.value("mu", 0.0)),
      mass_(load.mass_b),
      inertia_(load.inertia_b) {
  name = load.name;
  bodies = load.bodies;
}

/// Discrete gradients S by l² and B by q: ΔV = S Δ(l²) + B Δq.
void GravityGradient::evaluate(const PairStep& step, PairTerms& t) const {
  const BodyStep &a = step.a, &b = step.b;
  const double af = b.alpha_f, p = 2.0 * af - 1.0;
  const Vec3 d_n = b.r_n - a.r_n - Z_a_, d_n1 = b.r_n1 - a.r_n1 - Z_a_;
  const Vec3 d = (1.0 - af) * d_n + af * d_n1;
  const Vec3 D_n = b.Lambda_n.transpose() * d_n, D_n1 = b.Lambda_n1.transpose() * d_n1;
  const Mat3 Lambda = (1.0 - af) * b.Lambda_n + af * b.Lambda_n1;
  const Vec3 g = inertia_ * ((1.0 - af) * D_n + af * D_n1), c = Lambda * g;
  const double q_n1 = D_n1.dot(inertia_ * D_n1);
  const double q_0 = (1.0 - p) * D_n.dot(inertia_ * D_n) + p * q_n1;
  const double l_1 = d_n1.norm();
  const double l_0 = std::sqrt((1.0 - p) * d_n.squaredNorm() + p * d_n1.squaredNorm());
  const PowerQuotient one = power_quotient(1, l_0, l_1), three = power_quotient(3, l_0, l_1),
                      five = power_quotient(5, l_0, l_1);
  const double of_one = -mu_ * mass_, of_three = -0.5 * mu_ * inertia_.trace(),
               of_five = 0.75 * mu_ * (q_0 + q_n1);
  const double S = of_one * one.value + of_three * three.value + of_five * five.value;
  const double B = 0.75 * mu_ * (std::pow(l_0, -5) + std::pow(l_1, -5));

  const Vec3 F = -2.0 * (S * d + B * c), m = -2.0 * B * c.cross(d);
  t.wrench_a.head<3>() = -F;
  t.wrench_b << F, m;
  if (step.context.tangents) {
    // By the increments of d and of b's rotation.
    Mat3x6 D_d, D_D;
    D_d << Mat3::Identity(), Mat3::Zero();
    D_D << b.Lambda_n1.transpose(), b.Lambda_n1.transpose() * hat(d_n1);
    const Row6 D_s = 2.0 * d_n1.transpose() * D_d, D_q = 2.0 * (inertia_ * D_n1).transpose() * D_D;
    const double l0_by_s = 0.5 * p / l_0, l1_by_s = 0.5 / l_1;
    const auto by_s = [&](const PowerQuotient& x) { return x.by_l0 * l0_by_s + x.by_l1 * l1_by_s; };
    const Row6 D_S = (of_one * by_s(one) + of_three * by_s(three) + of_five * by_s(five)) * D_s +
                     0.75 * mu_ * five.value * (1.0 + p) * D_q;
    const Row6 D_B =
        -3.75 * mu_ * (std::pow(l_0, -6) * l0_by_s + std::pow(l_1, -6) * l1_by_s) * D_s;
    Mat3x6 D_c = af * Lambda * inertia_ * D_D;
    D_c.rightCols<3>() -= af * hat(b.Lambda_n1 * g);
    const Mat3x6 D_F = -2.0 * (d * D_S + S * af * D_d + c * D_B + B * D_c);
    const Mat3x6 D_m = -2.0 * (c.cross(d) * D_B + B * (af * hat(c) * D_d - hat(d) * D_c));
    t.D_bb << D_F, D_m;
    t.D_ba.leftCols<3>() << -D_F.leftCols<3>(), -D_m.leftCols<3>();
    t.D_ab.topRows<3>() = -D_F;
    t.D_aa.topLeftCorner<3, 3>() = D_F.leftCols<3>();
  }
  clear_ground_sides(step, t);
}

double GravityGradient::potential(const Vec3& d, const Mat3& Lambda) const {
  const double l = d.norm();
  const Vec3 E = Lambda.transpose() * d / l;
  return -mu_ / l * (mass_ + 0.5 / (l * l) * (inertia_.trace() - 3.0 * E.dot(inertia_ * E)));
}

Work GravityGradient::work(const PairStep& step) const {
  return {.stored = potential(step.b.r_n1 - step.a.r_n1 - Z_a_, step.b.Lambda_n1)};
}

std::vector<double> GravityGradient::report(const PairStep& step) const {
  PairTerms t;
  t.set_zero();
  evaluate(step, t);
  const Vec3 d = step.b.r_n1 - step.a.r_n1 - Z_a_;
  std::vector<double> list(t.wrench_b.data(), t.wrench_b.data() + 6);
  list.push_back(d.norm());
  list.push_back(potential(d, step.b.Lambda_n1));
  return list;
}

namespace {

void add_gravity_gradient(System& system, const LoadDescription& load) {
  system.group<GravityGradient>().add(load);
}

std::vector<double> report_of_gradient(const InteractionGroup& group, int item,
                                       const PairStep& step) {
  return items_of<GravityGradient>(group)[static_cast<std::size_t>(item)].report(step);
}

}  // namespace

LoadKind gravity_gradient_kind() {
  LoadKind kind;
  kind.name = GravityGradient::kKind;
  kind.meaning =
      "attraction of an extended body, the second, by a point mass or sphere at the centre of mass "
      "of the first, or at the world's origin if this is the ground";
  kind.place = LoadPlace::centres;
  kind.parameters = {{"mu",
                      "m^3/s^2",
                      {},
                      std::numeric_limits<double>::min(),
                      std::numeric_limits<double>::max(),
                      "G times the attracting mass; 3.986004418e14 of the Earth"}};
  kind.add = add_gravity_gradient;
  kind.channels = {{"force", "N", 3}, {"moment", "N m", 3}, {"length", "m"}, {"energy", "J"}};
  kind.report = report_of_gradient;
  kind.needs_one_of = {"mu"};
  return kind;
}

}  // namespace polhode
