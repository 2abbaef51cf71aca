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
constexpr double kCoarse = 1e-3, kFine = 1e-4;
constexpr int kCoarseIterations = 2, kMostInner = 400;
constexpr int kMostCuts = 8;
/// Part of the merit that an increment shall take away. An increment that takes hardly anything
/// flips between sticking and sliding: half of it takes nearly all.
constexpr double kDecrease = 0.25;
constexpr double kRoundOff = 4.4e-16;
/// Without gravity, the acceleration that counts as weight: this part of the speed in one step.
constexpr double kPartOfSpeed = 1e-3;

}  // namespace

bool CrowdEngine::suits(const System& system) {
  if (!system.contacts() || system.rows() > 0 || !system.nodes().empty()) return false;
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
  inertia_.resize(n);
  own_.resize(n);
  wrenches_.resize(n);
  rhs_.resize(n);
  x_.resize(n);
  start_.resize(n);
}

/// The inertia tangent of the step's start serves all iterations: turns of a step are small.
/// @eq{eq:ga-momenta-Newmark} @eq{ga-K-momentum}
void CrowdEngine::start_inertia(const State& state, const StepContext& context) {
  const GeneralizedAlpha& ga = context.ga;
  const double dt = context.dt, K = ga.alpha_m / (ga.beta * dt * dt);
  for (int b = 0; b < system_->body_count(); ++b) {
    const BodyData& body = system_->bodies()[b];
    const BodyMotion m = system_->motion(state, b);
    const Mat3& Lambda = steps_[b].Lambda_n;
    Inertia& at = inertia_[b];
    at.force = body.mass * (system_->gravity() + ga.kappa / dt * m.v - (1.0 - ga.kappa) * m.a);
    at.moment = ga.kappa / dt * (Lambda * (body.inertia * m.W)) - (1.0 - ga.kappa) * m.h_dot;
    at.v = (1.0 - ga.c) * m.v + dt * ga.c_A * m.a;
    at.W = (1.0 - ga.c) * m.W + dt * ga.c_A * m.A;
    own_[b].setZero();
    own_[b].topLeftCorner<3, 3>().diagonal().setConstant(K * body.mass);
    own_[b].bottomRightCorner<3, 3>() = K * Lambda * body.inertia * Lambda.transpose();
  }
}

/// @eq{eq:td-Newmark-COM} @eq{eq:td-Newmark-mrot} @eq{eq:td-incremental-rotation}
void CrowdEngine::move(int body, const Vec3& u, const Vec3& theta) {
  BodyStep& s = steps_[body];
  s.u = u;
  s.theta = theta;
  s.r_n1 = s.r_n + u;
  s.Lambda_n1 = cay(theta) * s.Lambda_n;
  s.v_n1 = s.rate * u + inertia_[body].v;
  s.W_n1 = s.rate * (s.Lambda_n.transpose() * theta) + inertia_[body].W;
}

void CrowdEngine::write(const State& state, Trial& trial) const {
  for (int b = 0; b < system_->body_count(); ++b)
    move_body(state, trial, system_->slot(b), steps_[b].u, steps_[b].theta);
}

void CrowdEngine::begin_step(const State& state, Trial& trial) {
  std::vector<BodyStep> start(steps_.size(), BodyStep::ground(trial.context.ga.alpha_f));
  steps_.back() = start.back();
  for (int b = 0; b < system_->body_count(); ++b) {
    start[b] = steps_[b] = body_step(*system_, state, trial, b);
    start[b].r_n1 = start[b].r_n;
    start[b].Lambda_n1 = start[b].Lambda_n;
    start[b].u = start[b].theta = Vec3::Zero();
    x_[b] << steps_[b].u, steps_[b].theta;
  }
  start_inertia(state, trial.context);
  contacts_->begin_step(state, start, trial.context);
  contacts_->cover(start, trial.context, x_);
  pointwise_->place_impacts(start, trial.context, x_);
  const double part = contacts_->filter(start, x_);
  for (int b = 0; b < system_->body_count(); ++b)
    move(b, part * x_[b].head<3>(), part * x_[b].tail<3>());
  write(state, trial);
  evaluated_ = false;
  searches_ = 0;
}

/// Forces of bodies, loads and contacts at the trial, whose steps are up to date.
void CrowdEngine::evaluate(const State& state, const Trial& trial) {
  const StepContext& context = trial.context;
  std::fill(wrenches_.begin(), wrenches_.end(), Vec6::Zero());
  const double per_speed = context.ga.kappa / context.dt;
  double fastest = 0.0;
  for (int b = 0; b < system_->body_count(); ++b) {
    const BodyData& body = system_->bodies()[b];
    const BodyStep& s = steps_[b];
    rhs_[b] << inertia_[b].force - per_speed * body.mass * s.v_n1,
        inertia_[b].moment - per_speed * (s.Lambda_n1 * (body.inertia * s.W_n1));
    fastest = std::max(fastest, s.v_n.squaredNorm());
  }
  if (!loads_.empty()) blocks_ = own_;
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
  if ((searches_ == 0 || !loads_.empty()) && !cg_.set_bodies(loads_.empty() ? own_ : blocks_)) {
    done.solved = false;
    return done;
  }
  cg_.set_springs(springs_);
  inner_ += cg_.solve(rhs_, x_, searches_ < kCoarseIterations ? kCoarse : kFine, kMostInner);
  ++searches_;
  contacts_->cover(steps_, trial.context, x_);
  double part = std::min(damping, contacts_->filter(steps_, x_));
  const double before = merit_, per_length = 1.0 / system_->length_scale();
  for (int b = 0; b < system_->body_count(); ++b) start_[b] << steps_[b].u, steps_[b].theta;
  for (int cut = 0;; ++cut) {
    done.increment = done.rotation = 0.0;
    for (int b = 0; b < system_->body_count(); ++b) {
      const Vec3 D_r = x_[b].head<3>(), D_theta = x_[b].tail<3>();
      done.increment = std::max({done.increment, per_length * D_r.lpNorm<Eigen::Infinity>(),
                                 D_theta.lpNorm<Eigen::Infinity>()});
      const Vec3 turned = compose_cayley(part * D_theta, Vec3(start_[b].tail<3>()));
      done.rotation = std::max(done.rotation, turned.norm());
      move(b, start_[b].head<3>() + part * D_r, turned);
    }
    evaluate(state, trial);
    if (cut == kMostCuts || merit_ <= (1.0 - kDecrease * part) * before || residual_ < enough_)
      break;
    const double best = before / (merit_ - (1.0 - 2.0 * part) * before) * part;  // of a parabola
    part *= std::isfinite(merit_) ? std::clamp(best, 0.1, 0.5) : 0.25;
  }
  write(state, trial);
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

}  // namespace polhode
