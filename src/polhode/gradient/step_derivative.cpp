// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/gradient/step_derivative.hpp>
#include <polhode/math/cayley.hpp>
#include <polhode/math/quaternion.hpp>

namespace polhode {

namespace {

/// Solutions are swept at least and at most so often. A sweep multiplies the part of redundant rows
/// by ε/σ², which is 1e-6 where the smallest singular value σ of the rows is 1e-3.
constexpr int kLeastSweeps = 2, kMostSweeps = 8;
/// Remainder of a solution that is round-off [-].
constexpr double kSolved = 1e-15;
/// Rounding of the increments of a step, in units of the distance from the origin.
constexpr double kIncrementRounding = 16.0 * std::numeric_limits<double>::epsilon();

/// K x of a block matrix, or with `transposed` Kᵀ x, without the proximal ε on its diagonal.
void multiply(const linear::KktTopology& topology, const linear::KktValues& values, const Vec& x,
              bool transposed, Vec& out) {
  out.setZero(x.size());
  const int first_row = 6 * topology.bodies;
  const auto add = [&](const Mat6& K, int to, int from) {
    if (transposed)
      out.segment<6>(6 * from) += K.transpose() * x.segment<6>(6 * to);
    else
      out.segment<6>(6 * to) += K * x.segment<6>(6 * from);
  };
  for (int b = 0; b < topology.bodies; ++b) add(values.diagonal[b], b, b);
  for (std::size_t p = 0; p < topology.pairs.size(); ++p) {
    const linear::KktPair& pair = topology.pairs[p];
    const linear::KktValues::Pair& v = values.pairs[p];
    if (pair.a != kGround && pair.b != kGround) {
      add(v.K_ab, pair.a, pair.b);
      add(v.K_ba, pair.b, pair.a);
    }
    const int row = first_row + pair.first_row, rows = pair.rows;
    const auto add_rows_of = [&](int body, const auto& B, const auto& G) {
      if (body == kGround || rows == 0) return;
      const auto of_body = x.segment<6>(6 * body);
      const auto of_rows = x.segment(row, rows);
      if (transposed) {
        out.segment<6>(6 * body) += G.topRows(rows).transpose() * of_rows;
        out.segment(row, rows) -= B.leftCols(rows).transpose() * of_body;
      } else {
        out.segment<6>(6 * body) -= B.leftCols(rows) * of_rows;
        out.segment(row, rows) += G.topRows(rows) * of_body;
      }
    };
    add_rows_of(pair.a, v.B_a, v.G_a);
    add_rows_of(pair.b, v.B_b, v.G_b);
  }
}

}  // namespace

Trial reversed(const System& system, const Trial& step, const State& to) {
  Trial back;
  back.context = step.context;
  back.context.t_n = step.context.t_n1();
  back.context.dt = -step.context.dt;
  start_trial(system, to, back);
  for (int b = 0; b < system.body_count(); ++b) {
    const int slot = system.slot(b), lane = slot % kLanes;
    const TrialBlock& t = step.blocks[static_cast<std::size_t>(slot / kLanes)];
    const Vec3 u(t.u[0][lane], t.u[1][lane], t.u[2][lane]);
    const Vec3 theta(t.theta[0][lane], t.theta[1][lane], t.theta[2][lane]);
    move_body(to, back, slot, -u, -theta);
  }
  back.lambda = back.lambda_centre = step.lambda;
  return back;
}

StepDerivative::StepDerivative(const System& system)
    : system_(&system),
      forward_(system, MomentumRate::momentum),
      backward_(system, MomentumRate::momentum),
      solver_(linear::make_linear_solver("block_lu")),
      bodies_(static_cast<std::size_t>(system.body_count())) {
  solver_->analyse(forward_.topology());
  const KktMap map = kkt_map(system);
  rolls_.assign(map.topology.pairs.size(), false);
  for (std::size_t i = 0; i < system.interactions().size(); ++i) {
    const InteractionRef& ref = system.interactions()[i];
    const int pair = map.pair[i];
    if (system.group(ref.group).kind() == "rolling" && pair >= 0)
      rolls_[static_cast<std::size_t>(pair)] = true;
    if (const double m = system.traits(ref).coupled_mass; m != 0.0)
      masses_.push_back({ref.a, ref.b, pair, m});
  }
}

Trial StepDerivative::trial(const State& from, const State& to, double dt) const {
  Trial step;
  step.context.ga = GeneralizedAlpha::from_spectral_radius(1.0);
  step.context.t_n = from.t;
  step.context.dt = dt;
  start_trial(*system_, from, step);
  for (int b = 0; b < system_->body_count(); ++b) {
    const BodyMotion m = system_->motion(from, b), n = system_->motion(to, b);
    const Quat turn = n.q * m.q.conjugate();
    move_body(from, step, system_->slot(b), n.r - m.r, 2.0 / turn.w() * turn.vec());
  }
  step.lambda = step.lambda_centre = to.lambda;
  return step;
}

void StepDerivative::linearize(const State& from, const State& to, const Trial& step) {
  dt_ = step.context.dt;
  scale_ = step.scale(*system_);
  forward_.assemble(from, step, true);
  if (!solver_->factor(forward_.values()))
    throw SolveError(
        format("The matrix of the step at t = {:.6g} s is singular, so that it has no derivative",
               from.t),
        "Look for bodies that nothing holds");
  const Trial back = reversed(*system_, step, to);
  backward_.assemble(to, back, true);
  by_y_ = backward_.values();
  for (std::size_t p = 0; p < by_y_.pairs.size(); ++p) {
    linear::KktValues::Pair& v = by_y_.pairs[p];
    v.B_a.setZero();  // the multipliers are unknowns of the step, not of the state
    v.B_b.setZero();
    // Rows hold at t_{n+1}; those of rolling are increments, which change sign backwards.
    v.G_a *= rolls_[p] ? -1.0 : 0.0;
    v.G_b *= rolls_[p] ? -1.0 : 0.0;
    v.G_a.row(0).setZero();
    v.G_b.row(0).setZero();
  }
  find_velocity_terms(from, to, step);
  measure_symmetry(step);
}

/// Terms of the inertia, which alone knows the direction of time.
void StepDerivative::find_velocity_terms(const State& from, const State& to, const Trial& step) {
  const double h = dt_, s = scale_;
  jumped_ = -1;
  jump_ = 0.0;
  for (int b = 0; b < system_->body_count(); ++b) {
    const BodyData& body = system_->bodies()[static_cast<std::size_t>(b)];
    const BodyStep x = body_step(*system_, from, step, b);
    const Mat3 J_n = x.Lambda_n * body.inertia * x.Lambda_n.transpose();
    const Mat3 J_n1 = x.Lambda_n1 * body.inertia * x.Lambda_n1.transpose();
    Mat6& D = by_y_.diagonal[static_cast<std::size_t>(b)];
    D.topLeftCorner<3, 3>().diagonal().array() -= s * 4.0 * body.mass / (h * h);
    D.bottomRightCorner<3, 3>() -=
        s * 2.0 / (h * h) * (J_n1 * cayley_tangent(x.theta) + J_n * cayley_tangent(-x.theta));
    BodyTerms& t = bodies_[static_cast<std::size_t>(b)];
    t.by_v = -s * 2.0 * body.mass / h;
    t.by_W = -s / h * (x.Lambda_n1 + x.Lambda_n) * body.inertia;
    t.G = 2.0 / h * cayley_tangent(x.Lambda_n.transpose() * x.theta) * x.Lambda_n1.transpose();

    const BodyMotion end = system_->motion(to, b);
    const double rounding =
        kIncrementRounding / std::abs(h) * (x.r_n.norm() + system_->length_scale());
    const double size = std::max({x.v_n.norm(), end.v.norm(), 1e6 * rounding});
    const double turn =
        std::max({x.W_n.norm(), end.W.norm(), 1e6 * kIncrementRounding / std::abs(h)});
    const double jump = std::max((end.v - x.v_n1).norm() / size, (end.W - x.W_n1).norm() / turn);
    if (jump <= jump_) continue;
    jump_ = jump;
    jumped_ = b;
  }
  for (const MassPair& m : masses_) {
    const double by_r = s * 4.0 * m.mass / (h * h);
    const auto own = [&](int body) {
      if (body == kGround) return;
      by_y_.diagonal[static_cast<std::size_t>(body)].topLeftCorner<3, 3>().diagonal().array() +=
          by_r;
      bodies_[static_cast<std::size_t>(body)].by_v += s * 2.0 * m.mass / h;
    };
    own(m.a);
    own(m.b);
    if (m.a == kGround || m.b == kGround) continue;
    linear::KktValues::Pair& v = by_y_.pairs[static_cast<std::size_t>(m.pair)];
    v.K_ab.topLeftCorner<3, 3>().diagonal().array() -= by_r;
    v.K_ba.topLeftCorner<3, 3>().diagonal().array() -= by_r;
  }
}

void StepDerivative::measure_symmetry(const Trial& step) {
  asymmetric_ = -1;
  asymmetry_ = 0.0;
  const double per_square = 4.0 / (dt_ * dt_);
  for (int b = 0; b < system_->body_count(); ++b) {
    const BodyData& body = system_->bodies()[static_cast<std::size_t>(b)];
    const int slot = system_->slot(b), lane = slot % kLanes;
    const TrialBlock& t = step.blocks[static_cast<std::size_t>(slot / kLanes)];
    const double reach = Vec3(t.r[0][lane], t.r[1][lane], t.r[2][lane]).norm();
    const Vec6 difference = backward_.body_residual(b) - forward_.body_residual(b);
    const Vec6& size = forward_.body_residual_scale(b);
    // Below 1e6 roundings of the inertia a force says nothing.
    const double force =
        std::max(size.head<3>().maxCoeff(), 1e6 * kIncrementRounding * per_square * body.mass *
                                                (reach + system_->length_scale()));
    const double moment =
        std::max(size.tail<3>().maxCoeff(),
                 1e6 * kIncrementRounding * per_square * body.inertia.diagonal().maxCoeff());
    const double part = std::max(
        difference.head<3>().norm() / force,
        difference.tail<3>().norm() / std::max(moment, 1e-3 * force * system_->length_scale()));
    if (part <= asymmetry_) continue;
    asymmetry_ = part;
    asymmetric_ = b;
  }
}

Vec StepDerivative::solve(const Vec& rhs, bool transposed) {
  const double size = rhs.lpNorm<Eigen::Infinity>();
  Vec x = Vec::Zero(rhs.size()), rest = rhs, product;
  if (size == 0.0) return x;
  double last = std::numeric_limits<double>::infinity();
  Vec best = x;
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    transposed ? solver_->solve_transposed(rest) : solver_->solve(rest);
    x += rest;
    multiply(forward_.topology(), forward_.values(), x, transposed, product);
    rest = rhs - product;
    const double left = rest.lpNorm<Eigen::Infinity>() / size;
    if (!(left < last)) break;  // round-off
    best = x;
    last = left;
    if (left < kSolved && sweep + 1 >= kLeastSweeps) break;
  }
  defect_ = std::max(defect_, last);
  return best;
}

Vec StepDerivative::by_state(const Vec& x, bool transposed) const {
  const int bodies = system_->body_count(), rows = system_->rows();
  Vec in(6 * bodies + rows), out;
  if (transposed) {
    in = x;
  } else {
    in.tail(rows).setZero();
    for (int b = 0; b < bodies; ++b) in.segment<6>(6 * b) = x.segment<6>(kStateNumbers * b);
  }
  multiply(forward_.topology(), by_y_, in, transposed, out);
  if (!transposed) {
    for (int b = 0; b < bodies; ++b) {
      const BodyTerms& t = bodies_[static_cast<std::size_t>(b)];
      out.segment<3>(6 * b) += t.by_v * x.segment<3>(kStateNumbers * b + 6);
      out.segment<3>(6 * b + 3) += t.by_W * x.segment<3>(kStateNumbers * b + 9);
    }
    for (const MassPair& m : masses_) {
      if (m.a == kGround || m.b == kGround) continue;
      const double by_v = -scale_ * 2.0 * m.mass / dt_;
      out.segment<3>(6 * m.a) += by_v * x.segment<3>(kStateNumbers * m.b + 6);
      out.segment<3>(6 * m.b) += by_v * x.segment<3>(kStateNumbers * m.a + 6);
    }
    return out;
  }
  Vec by_y = Vec::Zero(state_size());
  for (int b = 0; b < bodies; ++b) {
    const BodyTerms& t = bodies_[static_cast<std::size_t>(b)];
    by_y.segment<6>(kStateNumbers * b) = out.segment<6>(6 * b);
    by_y.segment<3>(kStateNumbers * b + 6) = t.by_v * x.segment<3>(6 * b);
    by_y.segment<3>(kStateNumbers * b + 9) = t.by_W.transpose() * x.segment<3>(6 * b + 3);
  }
  for (const MassPair& m : masses_) {
    if (m.a == kGround || m.b == kGround) continue;
    const double by_v = -scale_ * 2.0 * m.mass / dt_;
    by_y.segment<3>(kStateNumbers * m.b + 6) += by_v * x.segment<3>(6 * m.a);
    by_y.segment<3>(kStateNumbers * m.a + 6) += by_v * x.segment<3>(6 * m.b);
  }
  return by_y;
}

void StepDerivative::push(const Vec& residual, Vec& dy) {
  const int bodies = system_->body_count();
  Vec rhs = -by_state(dy, false);
  rhs.head(6 * bodies) -= scale_ * residual.head(6 * bodies);
  rhs.tail(system_->rows()) -= residual.tail(system_->rows());
  const Vec dx = solve(rhs, false);
  for (int b = 0; b < bodies; ++b) {
    const int y = kStateNumbers * b;
    const Vec3 dr = dx.segment<3>(6 * b) - dy.segment<3>(y);
    const Vec3 dphi = dx.segment<3>(6 * b + 3) - dy.segment<3>(y + 3);
    dy.segment<6>(y) = dx.segment<6>(6 * b);
    dy.segment<3>(y + 6) = 2.0 / dt_ * dr - Vec3(dy.segment<3>(y + 6));
    dy.segment<3>(y + 9) =
        bodies_[static_cast<std::size_t>(b)].G * dphi - Vec3(dy.segment<3>(y + 9));
  }
}

Vec StepDerivative::pull(Vec& mu) {
  const int bodies = system_->body_count();
  Vec rhs = Vec::Zero(unknowns()), before = Vec::Zero(state_size());
  for (int b = 0; b < bodies; ++b) {
    const int y = kStateNumbers * b;
    const Vec3 by_v = 2.0 / dt_ * mu.segment<3>(y + 6);
    const Vec3 by_W = bodies_[static_cast<std::size_t>(b)].G.transpose() * mu.segment<3>(y + 9);
    rhs.segment<3>(6 * b) = -(mu.segment<3>(y) + by_v);
    rhs.segment<3>(6 * b + 3) = -(mu.segment<3>(y + 3) + by_W);
    before.segment<3>(y) = -by_v;
    before.segment<3>(y + 3) = -by_W;
    before.segment<6>(y + 6) = -mu.segment<6>(y + 6);
  }
  Vec eta = solve(rhs, true);
  mu = before + by_state(eta, true);
  eta.head(6 * bodies) *= scale_;
  return eta;
}

}  // namespace polhode
