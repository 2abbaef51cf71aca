// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/gradient/kkt_product.hpp>
#include <polhode/gradient/step_derivative.hpp>
#include <polhode/math/cayley.hpp>
#include <polhode/math/quaternion.hpp>
#include <polhode/stepping/stored_rates.hpp>
#include <polhode/system/lane_access.hpp>

namespace polhode {

namespace {

/// Solutions are swept at least and at most so often. A sweep multiplies the part of redundant rows
/// by ε/σ², which is 1e-6 where the smallest singular value σ of the rows is 1e-3.
constexpr int kLeastSweeps = 2, kMostSweeps = 8;
/// Remainder of a solution that is round-off [-].
constexpr double kSolved = 1e-15;
/// Rounding of the increments of a step, in units of the distance from the origin.
constexpr double kIncrementRounding = 16.0 * std::numeric_limits<double>::epsilon();

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

int state_size(const System& system, double rho_inf) {
  return (rho_inf < 1.0 ? kStateNumbers + 2 * kStoredNumbers : kStateNumbers) * system.body_count();
}

void put_stored(const System& system, const State& state, Eigen::Ref<Vec> out) {
  const int all = kStoredNumbers * system.body_count();
  for (int b = 0; b < system.body_count(); ++b) {
    const int slot = system.slot(b), lane = slot % kLanes, at = kStoredNumbers * b;
    const BodyBlock& block = state.blocks[static_cast<std::size_t>(slot / kLanes)];
    out.segment<9>(at) << get(block.a, lane), get(block.A, lane), get(block.h_dot, lane);
    const RatesBlock& rates = state.rates[static_cast<std::size_t>(slot / kLanes)];
    out.segment<9>(all + at) << get(rates.a_rate, lane), get(rates.A_rate, lane),
        get(rates.h_dot_rate, lane);
  }
}

StepDerivative::StepDerivative(const System& system, double rho_inf)
    : system_(&system),
      ga_(GeneralizedAlpha::from_spectral_radius(rho_inf)),
      forward_(system, MomentumRate::momentum),
      backward_(system, MomentumRate::momentum),
      solver_(linear::make_linear_solver("block_lu")),
      bodies_(static_cast<std::size_t>(system.body_count())) {
  solver_->analyse(forward_.topology());
  if (stores()) wrenches_.emplace(system);
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

const State& StepDerivative::beginning(const State& from, double dt) {
  if (!stores()) return from;
  later_ = ga_.delta * (dt - from.rates_dt);
  beginning_ = from;
  adapt_stored_rates(beginning_, ga_, dt);
  return beginning_;
}

Trial StepDerivative::trial(const State& from, const State& to, double dt) const {
  Trial step;
  step.context.ga = ga_;
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
  if (stores())
    differentiate_wrenches(from, step);
  else
    see_backwards(step, to);
  find_inertia_terms(from, to, step);
  add_coupled_masses();
  if (!stores()) measure_symmetry(step);
}

void StepDerivative::see_backwards(const Trial& step, const State& to) {
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
}

void StepDerivative::differentiate_wrenches(const State& from, const Trial& step) {
  std::vector<BodyStep> steps;
  for (int b = 0; b < system_->body_count(); ++b)
    steps.push_back(body_step(*system_, from, step, b));
  steps.push_back(BodyStep::ground(ga_.alpha_f));
  wrenches_->evaluate(from, step, steps, scale_);
  by_y_ = wrenches_->by_place();
  // A place further on at t_n takes from the velocities at t_{n+1} what one there adds.
  const linear::KktValues& by_velocity = wrenches_->by_velocity();
  for (std::size_t b = 0; b < by_y_.diagonal.size(); ++b)
    by_y_.diagonal[b] -= by_velocity.diagonal[b];
  for (std::size_t p = 0; p < by_y_.pairs.size(); ++p) {
    linear::KktValues::Pair& v = by_y_.pairs[p];
    const linear::KktValues::Pair& w = by_velocity.pairs[p];
    v.K_ab -= w.K_ab;
    v.K_ba -= w.K_ba;
    v.G_a -= w.G_a;
    v.G_b -= w.G_b;
  }
}

/// Terms of the inertia, which alone knows the direction of time.
void StepDerivative::find_inertia_terms(const State& from, const State& to, const Trial& step) {
  const double h = dt_, s = scale_, rate = ga_.c / h, k = s * ga_.kappa / h;
  jumped_ = -1;
  jump_ = 0.0;
  for (int b = 0; b < system_->body_count(); ++b) {
    const BodyData& body = system_->bodies()[static_cast<std::size_t>(b)];
    const BodyStep x = body_step(*system_, from, step, b);
    BodyTerms& t = bodies_[static_cast<std::size_t>(b)];
    t.H_n = x.Lambda_n * body.inertia;
    t.H_n1 = x.Lambda_n1 * body.inertia;
    t.h_n = t.H_n * x.W_n;
    t.h_n1 = t.H_n1 * x.W_n1;
    const Mat3 J_n = t.H_n * x.Lambda_n.transpose(), J_n1 = t.H_n1 * x.Lambda_n1.transpose();
    Mat6& D = by_y_.diagonal[static_cast<std::size_t>(b)];
    D.topLeftCorner<3, 3>().diagonal().array() += body.mass * mass_terms().by_r;
    if (stores())
      D.bottomRightCorner<3, 3>() += k * (hat(t.h_n) - rate * J_n1 * cayley_tangent(x.theta));
    else
      D.bottomRightCorner<3, 3>() -=
          k * rate * (J_n1 * cayley_tangent(x.theta) + J_n * cayley_tangent(-x.theta));
    t.by_v = body.mass * mass_terms().by_v;
    t.by_a = body.mass * mass_terms().by_a;
    t.by_W = k * ((1.0 - ga_.c) * t.H_n1 - t.H_n);
    t.by_A = k * h * ga_.c_A * t.H_n1;
    const Vec3 Theta = x.Lambda_n.transpose() * x.theta;
    t.G = rate * cayley_tangent(Theta) * x.Lambda_n1.transpose();
    t.G_inverse = x.Lambda_n1 * cayley_tangent_inverse(Theta);

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
}

StepDerivative::MassTerms StepDerivative::mass_terms() const {
  const double by_r = -scale_ * ga_.alpha_m / (ga_.beta * dt_ * dt_);
  // Seen backwards, the inertia at ρ∞ = 1 is there already, with the other sign.
  return {.by_r = stores() ? by_r : 2.0 * by_r,
          .by_v = by_r * dt_,
          .by_a = scale_ * (1.0 - 0.5 * ga_.alpha_m / ga_.beta)};
}

void StepDerivative::add_coupled_masses() {
  const MassTerms terms = mass_terms();
  for (const MassPair& m : masses_) {
    const auto own = [&](int body) {
      if (body == kGround) return;
      by_y_.diagonal[static_cast<std::size_t>(body)].topLeftCorner<3, 3>().diagonal().array() -=
          m.mass * terms.by_r;
      BodyTerms& t = bodies_[static_cast<std::size_t>(body)];
      t.by_v -= m.mass * terms.by_v;
      t.by_a -= m.mass * terms.by_a;
    };
    own(m.a);
    own(m.b);
    if (m.a == kGround || m.b == kGround) continue;
    linear::KktValues::Pair& v = by_y_.pairs[static_cast<std::size_t>(m.pair)];
    v.K_ab.topLeftCorner<3, 3>().diagonal().array() += m.mass * terms.by_r;
    v.K_ba.topLeftCorner<3, 3>().diagonal().array() += m.mass * terms.by_r;
  }
}

/// Force and moment of a body of which parts count. Forces below 8e6 roundings of the inertia are
/// noise.
std::pair<double, double> StepDerivative::force_scales(const Trial& step, int b) const {
  const double rounding = 8e6 * kIncrementRounding * 4.0 / (dt_ * dt_);
  const BodyData& body = system_->bodies()[static_cast<std::size_t>(b)];
  const int slot = system_->slot(b), lane = slot % kLanes;
  const TrialBlock& t = step.blocks[static_cast<std::size_t>(slot / kLanes)];
  const double reach = Vec3(t.r[0][lane], t.r[1][lane], t.r[2][lane]).norm();
  const Vec6& size = forward_.body_residual_scale(b);
  const double force =
      std::max(size.head<3>().maxCoeff(), rounding * body.mass * (reach + system_->length_scale()));
  const double moment =
      std::max(size.tail<3>().maxCoeff(), rounding * body.inertia.diagonal().maxCoeff());
  return {force, std::max(moment, 1e-3 * force * system_->length_scale())};
}

void StepDerivative::measure_symmetry(const Trial& step) {
  asymmetric_ = -1;
  asymmetry_ = 0.0;
  for (int b = 0; b < system_->body_count(); ++b) {
    const auto [force, moment] = force_scales(step, b);
    const Vec6 difference = backward_.body_residual(b) - forward_.body_residual(b);
    const double part =
        std::max(difference.head<3>().norm() / force, difference.tail<3>().norm() / moment);
    if (part <= asymmetry_) continue;
    asymmetry_ = part;
    asymmetric_ = b;
  }
}

double StepDerivative::unbalanced(const Trial& step) const {
  double most = 0.0;
  for (int b = 0; b < system_->body_count(); ++b) {
    const auto [force, moment] = force_scales(step, b);
    const Vec6& left = forward_.body_residual(b);
    most = std::max({most, left.head<3>().norm() / force, left.tail<3>().norm() / moment});
  }
  return most;
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
    kkt_product(forward_.topology(), forward_.values(), x, transposed, product);
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
  const double by_v_of_other = mass_terms().by_v;
  Vec in(6 * bodies + rows), out;
  if (transposed) {
    in = x.head(unknowns());
  } else {
    in.tail(rows).setZero();
    for (int b = 0; b < bodies; ++b) in.segment<6>(6 * b) = x.segment<6>(kStateNumbers * b);
  }
  kkt_product(forward_.topology(), by_y_, in, transposed, out);
  if (!transposed) {
    for (int b = 0; b < bodies; ++b) {
      const BodyTerms& t = bodies_[static_cast<std::size_t>(b)];
      out.segment<3>(6 * b) += t.by_v * x.segment<3>(kStateNumbers * b + 6);
      out.segment<3>(6 * b + 3) += t.by_W * x.segment<3>(kStateNumbers * b + 9);
    }
    for (const MassPair& m : masses_) {
      if (m.a == kGround || m.b == kGround) continue;
      const double by_v = m.mass * by_v_of_other;
      out.segment<3>(6 * m.a) += by_v * x.segment<3>(kStateNumbers * m.b + 6);
      out.segment<3>(6 * m.b) += by_v * x.segment<3>(kStateNumbers * m.a + 6);
    }
    if (stores()) add_by_rates(x, out);
    return out;
  }
  Vec by_y = Vec::Zero(state_size());
  for (int b = 0; b < bodies; ++b) {
    const BodyTerms& t = bodies_[static_cast<std::size_t>(b)];
    by_y.segment<6>(kStateNumbers * b) = out.segment<6>(6 * b);
    by_y.segment<3>(kStateNumbers * b + 6) = t.by_v * in.segment<3>(6 * b);
    by_y.segment<3>(kStateNumbers * b + 9) = t.by_W.transpose() * in.segment<3>(6 * b + 3);
  }
  for (const MassPair& m : masses_) {
    if (m.a == kGround || m.b == kGround) continue;
    const double by_v = m.mass * by_v_of_other;
    by_y.segment<3>(kStateNumbers * m.b + 6) += by_v * in.segment<3>(6 * m.a);
    by_y.segment<3>(kStateNumbers * m.a + 6) += by_v * in.segment<3>(6 * m.b);
  }
  if (stores()) add_by_rates_transposed(in, by_y);
  return by_y;
}

StepDerivative::RateWeights StepDerivative::rate_weights() const {
  const double af = ga_.alpha_f, rate = ga_.c / dt_;
  return {.v = (1.0 - af * ga_.c) / (af * rate),
          .a = dt_ * ga_.c_A / rate,
          .h_dot = scale_ * (1.0 - ga_.kappa),
          .coupled_a = mass_terms().by_a};
}

/// Adds what velocities at t_n do through those at t_{n+αf}, and what stored accelerations do.
void StepDerivative::add_by_rates(const Vec& y, Vec& out) const {
  const RateWeights w = rate_weights();
  Vec in = Vec::Zero(unknowns()), product;
  for (int b = 0; b < system_->body_count(); ++b) {
    const BodyTerms& t = bodies_[static_cast<std::size_t>(b)];
    const auto v = y.segment<3>(kStateNumbers * b + 6), W = y.segment<3>(kStateNumbers * b + 9);
    const auto a = y.segment<3>(stored(b)), A = y.segment<3>(stored(b) + 3);
    in.segment<3>(6 * b) = w.v * v + w.a * a;
    in.segment<3>(6 * b + 3) = t.G_inverse * (w.v * W + w.a * A);
    out.segment<3>(6 * b) += t.by_a * a;
    out.segment<3>(6 * b + 3) += t.by_A * A + w.h_dot * y.segment<3>(stored(b) + 6);
  }
  for (const MassPair& m : masses_) {
    if (m.a == kGround || m.b == kGround) continue;
    out.segment<3>(6 * m.a) += m.mass * w.coupled_a * y.segment<3>(stored(m.b));
    out.segment<3>(6 * m.b) += m.mass * w.coupled_a * y.segment<3>(stored(m.a));
  }
  kkt_product(forward_.topology(), wrenches_->by_velocity(), in, false, product);
  out += product;
}

void StepDerivative::add_by_rates_transposed(const Vec& eta, Vec& y) const {
  const RateWeights w = rate_weights();
  Vec product;
  kkt_product(forward_.topology(), wrenches_->by_velocity(), eta, true, product);
  for (int b = 0; b < system_->body_count(); ++b) {
    const BodyTerms& t = bodies_[static_cast<std::size_t>(b)];
    const Vec3 of_v = product.segment<3>(6 * b);
    const Vec3 of_W = t.G_inverse.transpose() * product.segment<3>(6 * b + 3);
    const auto force = eta.segment<3>(6 * b), moment = eta.segment<3>(6 * b + 3);
    y.segment<3>(kStateNumbers * b + 6) += w.v * of_v;
    y.segment<3>(kStateNumbers * b + 9) += w.v * of_W;
    y.segment<3>(stored(b)) += w.a * of_v + t.by_a * force;
    y.segment<3>(stored(b) + 3) += w.a * of_W + t.by_A.transpose() * moment;
    y.segment<3>(stored(b) + 6) += w.h_dot * moment;
  }
  for (const MassPair& m : masses_) {
    if (m.a == kGround || m.b == kGround) continue;
    y.segment<3>(stored(m.b)) += m.mass * w.coupled_a * eta.segment<3>(6 * m.a);
    y.segment<3>(stored(m.a)) += m.mass * w.coupled_a * eta.segment<3>(6 * m.b);
  }
}

StepDerivative::NewmarkWeights StepDerivative::newmark_weights() const {
  const double per_beta = 1.0 / (ga_.beta * dt_);
  return {.v_by_r = ga_.c / dt_,
          .v_by_v = 1.0 - ga_.c,
          .v_by_a = dt_ * ga_.c_A,
          .a_by_r = per_beta / dt_,
          .a_by_v = -per_beta,
          .a_by_a = 1.0 - 0.5 / ga_.beta,
          .h_dot_by_h = 1.0 / (ga_.gamma * dt_),
          .h_dot_by_h_dot = 1.0 - 1.0 / ga_.gamma};
}

void StepDerivative::push(const Vec& by_parameter, Vec& dy) {
  const int bodies = system_->body_count();
  const NewmarkWeights n = newmark_weights();
  if (stores()) dy.segment(stored(0), all_stored()) += later_ * dy.tail(all_stored());
  Vec rhs = -by_state(dy, false);
  rhs.head(6 * bodies) -= scale_ * by_parameter.head(6 * bodies);
  rhs.tail(system_->rows()) -= by_parameter.segment(6 * bodies, system_->rows());
  const Vec dx = solve(rhs, false);
  for (int b = 0; b < bodies; ++b) {
    const int y = kStateNumbers * b;
    const BodyTerms& t = bodies_[static_cast<std::size_t>(b)];
    const Vec3 dphi_n = dy.segment<3>(y + 3), dphi_n1 = dx.segment<3>(6 * b + 3);
    const Vec3 dr = dx.segment<3>(6 * b) - dy.segment<3>(y), turned = t.G * (dphi_n1 - dphi_n);
    const Vec3 dv = dy.segment<3>(y + 6), dW = dy.segment<3>(y + 9);
    dy.segment<6>(y) = dx.segment<6>(6 * b);
    dy.segment<3>(y + 6) = n.v_by_r * dr + n.v_by_v * dv;
    dy.segment<3>(y + 9) = turned + n.v_by_v * dW;
    if (!stores()) continue;
    const int at = stored(b);
    const Vec3 da = dy.segment<3>(at), dA = dy.segment<3>(at + 3), dh_dot = dy.segment<3>(at + 6);
    dy.segment<3>(y + 6) += n.v_by_a * da;
    dy.segment<3>(y + 9) += n.v_by_a * dA;
    const Vec3 dh =
        t.H_n1 * dy.segment<3>(y + 9) - t.H_n * dW - t.h_n1.cross(dphi_n1) + t.h_n.cross(dphi_n);
    dy.segment<3>(at) = n.a_by_r * dr + n.a_by_v * dv + n.a_by_a * da;
    dy.segment<3>(at + 3) = n.a_by_r / n.v_by_r * turned + n.a_by_v * dW + n.a_by_a * dA;
    dy.segment<3>(at + 6) =
        n.h_dot_by_h * dh + n.h_dot_by_h_dot * dh_dot + by_parameter.segment<3>(unknowns() + 3 * b);
    auto rates = dy.segment<kStoredNumbers>(at + all_stored());
    Eigen::Matrix<double, kStoredNumbers, 1> change = dy.segment<kStoredNumbers>(at);
    change.head<3>() -= da;
    change.segment<3>(3) -= dA;
    change.tail<3>() -= dh_dot;
    rates = (1.0 - kFreshRate) * rates + kFreshRate / dt_ * change;
  }
}

Vec StepDerivative::pull(Vec& mu) {
  const int bodies = system_->body_count();
  const NewmarkWeights n = newmark_weights();
  Vec rhs = Vec::Zero(unknowns()), before = Vec::Zero(state_size()), eta(inputs());
  if (stores()) {
    const Vec of_rates = mu.tail(all_stored());
    mu.segment(stored(0), all_stored()) += kFreshRate / dt_ * of_rates;
    before.segment(stored(0), all_stored()) = -kFreshRate / dt_ * of_rates;
    before.tail(all_stored()) = (1.0 - kFreshRate) * of_rates;
  }
  for (int b = 0; b < bodies; ++b) {
    const int y = kStateNumbers * b;
    const BodyTerms& t = bodies_[static_cast<std::size_t>(b)];
    const Vec3 of_v = mu.segment<3>(y + 6);
    Vec3 of_W = mu.segment<3>(y + 9), of_dr = n.v_by_r * of_v, of_phi = mu.segment<3>(y + 3);
    Vec3 of_turned = Vec3::Zero(), of_phi_n = Vec3::Zero();
    if (stores()) {
      const int at = stored(b);
      const Vec3 of_a = mu.segment<3>(at), of_A = mu.segment<3>(at + 3);
      const Vec3 of_h_dot = mu.segment<3>(at + 6), of_h = n.h_dot_by_h * of_h_dot;
      eta.segment<3>(unknowns() + 3 * b) = of_h_dot;
      of_W += t.H_n1.transpose() * of_h;
      of_phi += t.h_n1.cross(of_h);
      of_phi_n = -t.h_n.cross(of_h);
      of_dr += n.a_by_r * of_a;
      of_turned = n.a_by_r / n.v_by_r * of_A;
      before.segment<3>(y + 6) = n.a_by_v * of_a;
      before.segment<3>(y + 9) = n.a_by_v * of_A - t.H_n.transpose() * of_h;
      before.segment<3>(at) += n.v_by_a * of_v + n.a_by_a * of_a;
      before.segment<3>(at + 3) += n.v_by_a * of_W + n.a_by_a * of_A;
      before.segment<3>(at + 6) += n.h_dot_by_h_dot * of_h_dot;
    }
    const Vec3 of_dphi = t.G.transpose() * (of_turned + of_W);
    rhs.segment<3>(6 * b) = -(mu.segment<3>(y) + of_dr);
    rhs.segment<3>(6 * b + 3) = -(of_phi + of_dphi);
    before.segment<3>(y) = -of_dr;
    before.segment<3>(y + 3) = of_phi_n - of_dphi;
    before.segment<3>(y + 6) += n.v_by_v * of_v;
    before.segment<3>(y + 9) += n.v_by_v * of_W;
  }
  eta.head(unknowns()) = solve(rhs, true);
  mu = before + by_state(eta, true);
  if (stores()) mu.tail(all_stored()) += later_ * mu.segment(stored(0), all_stored());
  eta.head(6 * bodies) *= scale_;
  return eta;
}

}  // namespace polhode
