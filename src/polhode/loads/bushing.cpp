// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/loads/bushing.hpp>

namespace polhode {

namespace {

constexpr std::array<const char*, 6> kLawNames{"law_x",  "law_y",  "law_z",
                                               "law_rx", "law_ry", "law_rz"};

/// Axes of both frames at the three times of a step.
struct Axes {
  std::array<Carried, 3> a, b;
};

/// Product of e_i of a and e_j of b, at one time.
double product(const Axes& x, Vec3 Carried::*when, int i, int j) {
  return (x.a[static_cast<std::size_t>(i)].*when).dot(x.b[static_cast<std::size_t>(j)].*when);
}
/// Its gradient by the rotation of b; that by the rotation of a is the opposite.
Vec3 gradient(const Axes& x, Vec3 Carried::*when, int i, int j) {
  return (x.b[static_cast<std::size_t>(j)].*when).cross(x.a[static_cast<std::size_t>(i)].*when);
}

/// Sum of products of axes: its value at the ends, its gradient at t_{n+αf} and t_{n+1}, and the
/// tangents of the former by the rotations of a and b.
struct Quadratic {
  double at_n = 0.0, at_n1 = 0.0;
  Vec3 alpha = Vec3::Zero(), n1 = Vec3::Zero();
  Mat3 by_a = Mat3::Zero(), by_b = Mat3::Zero();

  void add(const Axes& x, double factor, int i, int j, double alpha_f) {
    at_n += factor * product(x, &Carried::at_n, i, j);
    at_n1 += factor * product(x, &Carried::at_n1, i, j);
    alpha += factor * gradient(x, &Carried::at_alpha, i, j);
    n1 += factor * gradient(x, &Carried::at_n1, i, j);
    const Carried &p = x.a[static_cast<std::size_t>(i)], &w = x.b[static_cast<std::size_t>(j)];
    by_a -= factor * alpha_f * hat_hat(w.at_alpha, p.at_n1);
    by_b += factor * alpha_f * hat_hat(p.at_alpha, w.at_n1);
  }
};

/// c_k = N/D over the step; rotations of a and b have opposite effects.
CoordinateMotion cayley_component(const Quadratic& N, const Quadratic& D, double alpha_f) {
  CoordinateMotion q;
  q.at_n = N.at_n / D.at_n;
  q.at_n1 = N.at_n1 / D.at_n1;
  const double c = q.at_alpha = (1.0 - alpha_f) * q.at_n + alpha_f * q.at_n1;
  const double d = (1.0 - alpha_f) * D.at_n + alpha_f * D.at_n1;
  const Vec3 mu = (N.alpha - c * D.alpha) / d;
  const Vec3 at_n1 = (N.n1 - q.at_n1 * D.n1) / D.at_n1;
  // By the rotation of b; D's own change enters through c̄ and D̄.
  const Mat3 shared = -alpha_f / d * (D.alpha * at_n1.transpose() + mu * D.n1.transpose());
  const Mat3 by_b = (N.by_b - c * D.by_b) / d + shared;
  const Mat3 by_a = (N.by_a - c * D.by_a) / d - shared;
  q.mu_a << Vec3::Zero(), -mu;
  q.mu_b << Vec3::Zero(), mu;
  q.at_n1_a << Vec3::Zero(), -at_n1;
  q.at_n1_b << Vec3::Zero(), at_n1;
  q.alpha_a = alpha_f * q.at_n1_a;
  q.alpha_b = alpha_f * q.at_n1_b;
  for (Mat6* M : {&q.D_aa, &q.D_ab, &q.D_ba, &q.D_bb}) M->setZero();
  q.D_aa.bottomRightCorner<3, 3>() = -by_a;
  q.D_ab.bottomRightCorner<3, 3>() = -by_b;
  q.D_ba.bottomRightCorner<3, 3>() = by_a;
  q.D_bb.bottomRightCorner<3, 3>() = by_b;
  return q;
}

Mat6 matrix(const LoadDescription& load, const char* name, const char* along, const char* about) {
  const auto found = load.matrices.find(name);
  Mat6 K = found == load.matrices.end() ? Mat6::Zero() : found->second;
  for (int i = 0; i < 3; ++i) {
    K(i, i) += load.value(std::string(along) + "." + "xyz"[i], 0.0);
    K(3 + i, 3 + i) += load.value(std::string(about) + "." + "xyz"[i], 0.0);
  }
  return K;
}

}  // namespace

Bushing::Bushing(const LoadDescription& load)
    : Z_a_(load.Z_a),
      Z_b_(load.Z_b),
      R_a_(load.R_a),
      R_b_(load.R_b),
      K_(matrix(load, "stiffness_matrix", "stiffness", "turning_stiffness")),
      C_(matrix(load, "damping_matrix", "damping", "turning_damping")) {
  name = load.name;
  bodies = load.bodies;
  for (std::size_t i = 0; i < 6; ++i) {
    LoadDescription single;
    single.laws = load.laws;
    law_[i] = ForceLaw(single, kLawNames[i]);
  }
}

Bushing::Coordinates Bushing::coordinates(const PairStep& step) const {
  const BodyStep &a = step.a, &b = step.b;
  Coordinates y;
  Axes x;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    y[k] = coordinate_motion(FreeDisplacement{Z_a_, Z_b_, R_a_.col(i)}, a, b, 0.0, true);
    x.a[k] = a.vector(R_a_.col(i));
    x.b[k] = b.vector(R_b_.col(i));
  }
  Quadratic D;
  D.at_n = D.at_n1 = 1.0;
  for (int i = 0; i < 3; ++i) D.add(x, 1.0, i, i, a.alpha_f);
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    Quadratic N;
    N.add(x, 2.0, j, i, a.alpha_f);
    N.add(x, -2.0, i, j, a.alpha_f);
    y[static_cast<std::size_t>(3 + k)] = cayley_component(N, D, a.alpha_f);
  }
  return y;
}

void Bushing::evaluate(const PairStep& step, PairTerms& t) const {
  const Coordinates y = coordinates(step);
  Vec6 middle, rate = Vec6::Zero();
  Mat6 by_a, by_b;  // row k: D y_k
  Mat6 rate_a = Mat6::Zero(), rate_b = Mat6::Zero();
  for (int k = 0; k < 6; ++k) {
    const CoordinateMotion& q = y[static_cast<std::size_t>(k)];
    middle[k] = q.at_alpha;
    by_a.row(k) = q.alpha_a;
    by_b.row(k) = q.alpha_b;
    if (!dissipates()) continue;
    const RateStep r = rate_step(q, step.a, step.b);
    rate[k] = r.value;
    rate_a.row(k) = r.by_a;
    rate_b.row(k) = r.by_b;
  }
  Vec6 force = K_ * middle + C_ * rate;
  Mat6 force_a = K_ * by_a + C_ * rate_a, force_b = K_ * by_b + C_ * rate_b;
  for (int k = 0; k < 6; ++k) {
    const CoordinateMotion& q = y[static_cast<std::size_t>(k)];
    const ForceLaw& law = law_[static_cast<std::size_t>(k)];
    if (!law.is_zero()) {
      const LawValue f = law.over_step(q.at_n, q.at_n1, step.a.alpha_f);
      force[k] += f.value;
      force_a.row(k) += f.slope * q.at_n1_a;
      force_b.row(k) += f.slope * q.at_n1_b;
    }
    add_force(q, -force[k], step, t);
    if (step.context.tangents)
      add_force_change(q, -force_a.row(k).transpose(), -force_b.row(k).transpose(), t);
  }
  clear_ground_sides(step, t);
}

bool Bushing::piecewise() const {
  return std::ranges::any_of(law_, [](const ForceLaw& law) { return law.piecewise(); });
}

void Bushing::pieces(const PairStep& step, ForcePieces& pieces) const {
  const Coordinates y = coordinates(step);
  for (std::size_t k = 0; k < 6; ++k) law_[k].piece(y[k].at_n1, pieces);
}

double Bushing::energy(const Vec6& y) const {
  double energy = 0.5 * y.dot(K_ * y);
  for (int k = 0; k < 6; ++k) {
    const ForceLaw& law = law_[static_cast<std::size_t>(k)];
    if (!law.is_zero()) energy += law.energy(y[k]);
  }
  return energy;
}

Work Bushing::work(const PairStep& step) const {
  const Coordinates y = coordinates(step);
  Vec6 end, rate = Vec6::Zero();
  for (int k = 0; k < 6; ++k) {
    const CoordinateMotion& q = y[static_cast<std::size_t>(k)];
    end[k] = q.at_n1;
    if (dissipates()) rate[k] = rate_step(q, step.a, step.b).value;
  }
  return {.stored = energy(end), .dissipated = rate.dot(C_ * rate) * step.context.dt};
}

std::vector<double> Bushing::report(const PairStep& step) const {
  const Coordinates y = coordinates(step);
  PairTerms t;
  t.set_zero();
  evaluate(step, t);
  Vec6 end;
  for (int k = 0; k < 6; ++k) end[k] = y[static_cast<std::size_t>(k)].at_n1;
  // On b, or the opposite of the wrench on a, moved to b's point.
  const bool from_b = step.b.moves;
  const Vec3 force = from_b ? Vec3(t.wrench_b.head<3>()) : Vec3(-t.wrench_a.head<3>());
  const Vec3 arm =
      from_b ? Vec3(step.b.vector(Z_b_).at_n1) : Vec3(step.b.point(Z_b_).at_n1 - step.a.r_n1);
  const Vec3 moment =
      (from_b ? Vec3(t.wrench_b.tail<3>()) : Vec3(-t.wrench_a.tail<3>())) - arm.cross(force);
  std::vector<double> list = numbers(force);
  for (const Vec3& v : {moment, Vec3(end.head<3>()), Vec3(end.tail<3>())})
    list.insert(list.end(), v.data(), v.data() + 3);
  list.push_back(energy(end));
  return list;
}

void add_bushing(System& system, const LoadDescription& load) { system.group<Bushing>().add(load); }

}  // namespace polhode
