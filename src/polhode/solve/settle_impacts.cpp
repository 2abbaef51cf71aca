// SPDX-License-Identifier: Apache-2.0
#include <Eigen/QR>

#include <polhode/solve/settle_impacts.hpp>

namespace polhode {

namespace {

/// Impulses of rows that are redundant to this part are shared out.
constexpr double kRedundant = 1e-9;

}  // namespace

void SettleImpacts::find(const State& state, const Trial& trial) {
  rows_.clear();
  if (!system_->nodes().empty()) return;  // impulses would have to reach the solids, too
  std::vector<Impact> impacts;
  for (int i : system_->barriers()) {
    const InteractionRef& ref = system_->interactions()[i];
    impacts.clear();
    const PairView view = pair_view(*system_, state, trial, ref);
    system_->group(ref.group).impacts(ref.item, view.step(), impacts);
    for (const Impact& impact : impacts) rows_.push_back({ref.a, ref.b, impact});
  }
}

/// v += X p with X = P M⁻¹ Jᵀ, P the projection on G v = 0, and J X p = what is wanted.
void SettleImpacts::settle(State& state) {
  if (!solver_) solver_ = std::make_unique<InstantSolver>(*system_);
  const int bodies = system_->body_count(), n = static_cast<int>(rows_.size());
  const auto times = [&](const Row& row, const std::vector<Vec6>& field) {
    double sum = 0.0;
    if (row.a != kGround) sum += row.impact.on_a.dot(field[row.a]);
    if (row.b != kGround) sum += row.impact.on_b.dot(field[row.b]);
    return sum;
  };
  std::vector<Vec6> v(bodies);
  std::vector<Mat3> Lambda(bodies);
  for (int b = 0; b < bodies; ++b) {
    const BodyMotion m = system_->motion(state, b);
    Lambda[b] = m.Lambda();
    v[b] << m.v, Lambda[b] * m.W;
  }
  std::vector<std::vector<Vec6>> X(n, std::vector<Vec6>(bodies, Vec6::Zero()));
  for (int k = 0; k < n; ++k) {
    const auto accelerate = [&](int body, const Vec6& impulse) {
      if (body == kGround) return;
      const BodyData& data = system_->bodies()[body];
      const Mat3 J = Lambda[body] * data.inertia * Lambda[body].transpose();
      X[k][body].head<3>() += impulse.head<3>() / data.mass;
      X[k][body].tail<3>() += J.ldlt().solve(Vec3(impulse.tail<3>()));
    };
    accelerate(rows_[k].a, rows_[k].impact.on_a);
    accelerate(rows_[k].b, rows_[k].impact.on_b);
    solver_->keep_admissible(state, X[k]);
  }
  Mat A(n, n);
  Vec missing(n);
  for (int i = 0; i < n; ++i) {
    missing[i] = rows_[i].impact.wanted - times(rows_[i], v);
    for (int k = 0; k < n; ++k) A(i, k) = times(rows_[i], X[k]);
  }
  Eigen::CompleteOrthogonalDecomposition<Mat> pseudo_inverse;
  pseudo_inverse.setThreshold(kRedundant);
  pseudo_inverse.compute(A);
  Vec p = pseudo_inverse.solve(missing);
  // Impacts at once with unequal restitutions may gain: then all of them give back less.
  const Vec before = Vec::NullaryExpr(n, [&](Eigen::Index i) { return times(rows_[i], v); });
  for (double part = 0.5; p.dot(before + 0.5 * A * p) > 0.0 && part > 1e-3; part *= 0.5)
    p = pseudo_inverse.solve(Vec(part * (missing + before) - before));
  for (int b = 0; b < bodies; ++b) {
    Vec6 jump = Vec6::Zero();
    for (int k = 0; k < n; ++k) jump += p[k] * X[k][b];
    const Vec3 v_new = v[b].head<3>() + jump.head<3>();
    const Vec3 W_new = Lambda[b].transpose() * (v[b].tail<3>() + jump.tail<3>());
    BodyBlock& block = state.blocks[system_->slot(b) / kLanes];
    const int lane = system_->slot(b) % kLanes;
    for (int i = 0; i < 3; ++i) {  // positions keep what rounding took from them
      block.v[i][lane] = v_new[i];
      block.W[i][lane] = W_new[i];
    }
  }
}

}  // namespace polhode
