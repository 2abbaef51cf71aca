// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/base/error.hpp>
#include <polhode/solve/crowd_engine.hpp>
#include <polhode/solve/lanes/dispatch.hpp>

namespace polhode {

namespace {

/// How far the squared residual falls in the inner iterations: coarse while Newton is far.
constexpr double kCoarse = 1e-4, kFine = 1e-6;
constexpr int kCoarseIterations = 2, kMostInner = 400;
constexpr int kMostCuts = 8;
constexpr double kRoundOff = 4.4e-16;
/// Without gravity, the acceleration that counts as weight: this part of the speed in one step.
constexpr double kPartOfSpeed = 1e-3;

}  // namespace

bool CrowdEngine::suits(const System& system) {
  if (!system.contacts() || system.rows() > 0) return false;
  if (!dynamic_cast<PointwiseContacts*>(system.contacts().get())) return false;
  return std::none_of(
      system.interactions().begin(), system.interactions().end(),
      [](const InteractionRef& ref) { return ref.a != kGround && ref.b != kGround; });
}

CrowdEngine::CrowdEngine(const System& system, double residual)
    : system_(&system),
      contacts_(system.contacts().get()),
      pointwise_(dynamic_cast<PointwiseContacts*>(contacts_)),
      loads_(system),
      tolerance_(residual) {
  if (!suits(system))
    throw InputError("solver", "'crowd' needs bodies that contacts alone couple",
                     "Choose another solver for models with joints or forces between bodies");
  contacts_->prepare(system);
  const auto n = static_cast<std::size_t>(system.body_count());
  steps_.resize(n + 1);
  at_n_.resize(n);
  blocks_.resize(n);
  wrenches_.resize(n);
  rhs_.resize(n);
  increments_.assign(n, Vec6::Zero());
}

void CrowdEngine::take_steps(const State& state, const Trial& trial, bool all) {
  for (int b = 0; b < system_->body_count(); ++b) {
    if (all)
      steps_[b] = body_step(*system_, state, trial, b);
    else
      update_body_step(*system_, state, trial, b, steps_[b], true);
  }
  steps_.back() = BodyStep::ground(trial.context.ga.alpha_f);
}

void CrowdEngine::begin_step(const State& state, Trial& trial) {
  take_steps(state, trial, true);
  std::vector<BodyStep> start = steps_;
  for (int b = 0; b < system_->body_count(); ++b) {
    at_n_[b] = system_->motion(state, b);
    start[b].r_n1 = start[b].r_n;
    start[b].Lambda_n1 = start[b].Lambda_n;
    increments_[b] << steps_[b].u, steps_[b].theta;
  }
  contacts_->begin_step(state, start, trial.context);
  contacts_->cover(start, trial.context, increments_);
  const double part = contacts_->filter(start, increments_);
  if (part < 1.0) {
    for (int b = 0; b < system_->body_count(); ++b)
      move_body(state, trial, system_->slot(b), part * steps_[b].u, part * steps_[b].theta);
    take_steps(state, trial, false);
  }
  evaluated_ = false;
  searches_ = 0;
}

/// Forces of bodies, loads and contacts at the trial, whose steps are up to date.
void CrowdEngine::evaluate(const State& state, const Trial& trial) {
  const StepContext& context = trial.context;
  std::fill(wrenches_.begin(), wrenches_.end(), Vec6::Zero());
  double fastest = 0.0;
  for (int b = 0; b < system_->body_count(); ++b) {
    const BodyData& body = system_->bodies()[b];
    const MomentumRates m = momentum_rates(body.mass, body.inertia, at_n_[b], steps_[b], context);
    rhs_[b] << body.mass * system_->gravity() - m.p_dot, -m.h_dot;
    Mat6& K = blocks_[b];
    K.setZero();
    K.topLeftCorner<3, 3>().diagonal().setConstant(m.K_r);
    K.bottomRightCorner<3, 3>() = m.K_theta;
    fastest = std::max(fastest, steps_[b].v_n.squaredNorm());
  }
  loads_.run(steps_, context, trial.lambda.data(), state.history.data(),
             [&](int interaction, const PairStep&, const PairTerms& t) {
               const InteractionRef& ref = system_->interactions()[interaction];
               if (ref.a != kGround) {
                 rhs_[ref.a] += t.wrench_a;
                 blocks_[ref.a] -= t.D_aa;
               }
               if (ref.b != kGround) {
                 rhs_[ref.b] += t.wrench_b;
                 blocks_[ref.b] -= t.D_bb;
               }
             });
  pointwise_->evaluate_pointwise(steps_, context, wrenches_, springs_);
  merit_ = 0.0;
  double worst = 0.0;
  worst_body_ = -1;
  for (int b = 0; b < system_->body_count(); ++b) {
    rhs_[b] += wrenches_[b];
    const BodyData& body = system_->bodies()[b];
    const double size = rhs_[b].head<3>().squaredNorm() / body.mass +
                        3.0 * rhs_[b].tail<3>().squaredNorm() / body.inertia.trace();
    merit_ += size;
    if (!(size / body.mass <= worst)) worst = size / body.mass, worst_body_ = b;
  }
  double weight = system_->gravity().norm();
  if (weight == 0.0) weight = kPartOfSpeed * std::sqrt(fastest) / std::abs(context.dt);
  weight = std::max(weight, std::numeric_limits<double>::min());
  residual_ = std::sqrt(worst) / weight;
  // What rounding of positions leaves of stiff contacts: no residual can be smaller.
  double noise = 0.0;
  for (const ContactSpring& s : springs_) {
    const int b = s.a != kGround ? s.a : s.b;
    noise = std::max(
        noise, s.C.trace() * steps_[b].r_n1.cwiseAbs().maxCoeff() / system_->bodies()[b].mass);
  }
  enough_ = std::max(tolerance_, kRoundOff * noise / weight);
  evaluated_ = true;
}

Iteration CrowdEngine::iterate(const State& state, Trial& trial, bool, double damping) {
  Iteration done;
  if (!evaluated_) evaluate(state, trial);
  done.solved = std::isfinite(merit_);
  if (!done.solved || residual_ < enough_) return done;
  if (!cg_.set(blocks_, springs_)) {
    done.solved = false;
    return done;
  }
  inner_ += cg_.solve(rhs_, x_, searches_ < kCoarseIterations ? kCoarse : kFine, kMostInner);
  ++searches_;
  for (int b = 0; b < system_->body_count(); ++b) increments_[b] = x_[b];
  contacts_->cover(steps_, trial.context, increments_);
  double part = std::min(damping, contacts_->filter(steps_, increments_));
  const double before = merit_, per_length = 1.0 / system_->length_scale();
  const std::vector<BodyStep> start = steps_;
  for (int cut = 0;; ++cut) {
    done.increment = done.rotation = 0.0;
    for (int b = 0; b < system_->body_count(); ++b) {
      const Vec3 D_r = x_[b].head<3>(), D_theta = x_[b].tail<3>();
      done.increment = std::max({done.increment, per_length * D_r.lpNorm<Eigen::Infinity>(),
                                 D_theta.lpNorm<Eigen::Infinity>()});
      const Vec3 turned = compose_cayley(part * D_theta, start[b].theta);
      done.rotation = std::max(done.rotation, turned.norm());
      move_body(state, trial, system_->slot(b), start[b].u + part * D_r, turned);
    }
    take_steps(state, trial, false);
    evaluate(state, trial);
    if (cut == kMostCuts || merit_ <= (1.0 - 1e-4 * part) * before || residual_ < enough_) break;
    const double best = before / (merit_ - (1.0 - 2.0 * part) * before) * part;  // of a parabola
    part *= std::isfinite(merit_) ? std::clamp(best, 0.1, 0.5) : 0.25;
  }
  done.applied = part;
  // What the residual says is final: the increment is no measure of the next one.
  if (residual_ < enough_) {
    done.increment = 0.0;
    done.applied = 1.0;
  } else {
    done.increment = std::max(done.increment, 1e-4);
  }
  return done;
}

void CrowdEngine::end_step(const State&, Trial&) { touches_ = !springs_.empty(); }

void CrowdEngine::add_ground_wrench(double* force, double* moment) const {
  Vec3 f = Vec3::Zero(), m = Vec3::Zero();
  for (std::size_t b = 0; b < wrenches_.size(); ++b) {
    f += wrenches_[b].head<3>();
    m += (steps_[b].r_n + steps_[b].alpha_f * steps_[b].u).cross(Vec3(wrenches_[b].head<3>())) +
         wrenches_[b].tail<3>();
  }
  // Forces between bodies cancel in the sums: what is left is the ground's.
  for (int i = 0; i < 3; ++i) {
    force[i] += f[i];
    moment[i] += m[i];
  }
}

double CrowdEngine::stored(const State& state) const {
  std::vector<BodyStep> instants(steps_.size());
  for (int b = 0; b < system_->body_count(); ++b) instants[b] = system_->instant(state, b);
  instants.back() = BodyStep::ground(1.0);
  return contacts_->stored(state, instants);
}

Work CrowdEngine::commit(State& state, const Trial& trial) {
  return contacts_->commit(state, steps_, trial.context);
}

VelocityJump CrowdEngine::settle_impacts(State& state, const Trial&) {
  if (!touches_) return {};
  return contacts_->settle_impacts(state, {});
}

}  // namespace polhode
