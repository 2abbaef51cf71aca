// SPDX-License-Identifier: Apache-2.0
#include <cstring>

#include <polhode/system/interaction.hpp>

namespace polhode {

void InteractionGroup::finish() {
  traits_.clear();
  traits_.reserve(static_cast<std::size_t>(size_));
  for (int i = 0; i < size_; ++i) traits_.push_back(describe(i).traits);
}

void PairTerms::set_zero() {
  std::memset(static_cast<void*>(this), 0, sizeof *this);
  weight.setOnes();
}

void PairTerms::set_sums_zero() {
  set_values_zero();
  D_aa.setZero();
  D_ab.setZero();
  D_ba.setZero();
  D_bb.setZero();
}

void PairTerms::set_values_zero() {
  wrench_a.setZero();
  wrench_b.setZero();
  g.setZero();
  compliance.setZero();
  weight.setOnes();
}

void clear_ground_sides(const PairStep& step, PairTerms& t) {
  if (!step.a.moves) {
    t.wrench_a.setZero();
    t.D_aa.setZero();
    t.D_ab.setZero();
    t.D_ba.setZero();
    t.B_a.setZero();
    t.G_a.setZero();
  }
  if (!step.b.moves) {
    t.wrench_b.setZero();
    t.D_bb.setZero();
    t.D_ab.setZero();
    t.D_ba.setZero();
    t.B_b.setZero();
    t.G_b.setZero();
  }
}

void add_impulse(ImpulseSum kind, const PairStep& step, const Vec6& on_a, const Vec6& on_b,
                 double* sum) {
  const bool on_first = kind == ImpulseSum::on_a;
  const bool given = (on_first ? step.a : step.b).moves;  // else that of the other side
  const BodyStep& body = on_first == given ? step.a : step.b;
  const Vec6& w = on_first == given ? on_a : on_b;
  const Vec3 r = body.r_n + body.alpha_f * body.u, f = w.head<3>();
  const Vec3 m = r.cross(f) + w.tail<3>();
  const double sign = given ? 1.0 : -1.0;
  for (int i = 0; i < 3; ++i) {
    sum[i] += sign * f[i];
    sum[3 + i] += sign * m[i];
  }
}

}  // namespace polhode
