// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/Cholesky>

#include <polhode/core/assert.hpp>
#include <polhode/core/error.hpp>
#include <polhode/engines/contact_cg_engine.hpp>
#include <polhode/equations/line_search.hpp>
#include <polhode/kernels/dispatch.hpp>
#include <polhode/math/dense.hpp>

namespace polhode {

namespace {

/// Reduction of the squared residual by the inner iterations: coarse in the first Newton
/// iterations.
constexpr double kCoarse = 1e-3, kFine = 1e-4;
constexpr int kCoarseIterations = 2, kMaxInner = 400;
/// Residual, in weights, below which friction forces follow the normal forces within an increment,
/// and number of search directions for that: at larger residuals sliding points change too much.
constexpr double kFrictionBelow = 1.0;
constexpr int kFrictionDirections = 3;
/// Remaining part of the residual above which an increment needs that coupling of friction.
constexpr double kSlow = 0.2;
/// Part of the target residual above which bodies are still moved, together with others within so
/// many contacts of them. If these are most of all bodies, all are moved.
constexpr double kLate = 0.02, kMaxMovingPart = 0.7;
constexpr int kRings = 2;
/// Line search that asks for a considerable reduction: an increment with hardly any alternates
/// between sticking and sliding, and half of it gives nearly the whole reduction.
constexpr LineSearchRule kReduceMuch{0.25, 2, 0.1, 0.5, 0.25};
constexpr double kPositionRoundOff = 4.4e-16;
/// Remaining violation of joint rows that is accepted if iterations do not reduce it, as a part of
/// ℓ.
constexpr double kRowsHold = 1e-12;
/// Step below which the tolerated residual decreases in proportion [s].
constexpr double kWholeStep = 1e-3;
/// Acceleration that replaces weight without gravity: this part of the speed per step.
constexpr double kPartOfApproach = 1e-3;

/// Whether an interaction acts between two bodies, or constrains one.
bool couples(const InteractionRef& ref) {
  return ref.rows > 0 || (ref.a != kGround && ref.b != kGround);
}

/// Numbers of the bodies of interactions, ascending.
template <class Which>
std::vector<int> bodies_of(const System& system, Which&& which) {
  std::vector<int> list;
  for (const InteractionRef& ref : system.interactions())
    for (const int body : {ref.a, ref.b})
      if (body != kGround && which(ref)) list.push_back(body);
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

}  // namespace

bool ContactCgEngine::suits(const System& system) {
  if (!system.contacts() || !system.nodes().empty()) return false;
  if (!system.contacts()->pointwise()) return false;
  if (system.stiff() || !system.barriers().empty()) return false;
  return std::none_of(system.interactions().begin(), system.interactions().end(),
                      [&](const InteractionRef& ref) {
                        const InteractionTraits& of = system.traits(ref);
                        return of.compliant || ref.shares_row() ||
                               (ref.rows == 0 && couples(ref) && of.reach > 0.0);
                      });
}

int ContactCgEngine::free_bodies(const System& system) {
  return system.body_count() - static_cast<int>(bodies_of(system, couples).size());
}

ContactCgEngine::ContactCgEngine(const System& system, double residual)
    : system_(&system),
      contacts_(system.contacts().get()),
      pointwise_(contacts_ ? contacts_->pointwise() : nullptr),
      loads_(system),
      tolerance_(residual),
      acted_on_(bodies_of(system, [](const InteractionRef&) { return true; })),
      coupled_(bodies_of(system, couples)) {
  if (!suits(system))
    throw InputError(
        "solver",
        "the contact CG solver needs bodies coupled by contacts and frictionless joints only",
        "Choose another solver for models with solids, beams, cables, penalised joints, "
        "friction in joints or stops");
  contacts_->prepare(system);
  const auto n = static_cast<std::size_t>(system.body_count());
  steps_.resize(n + 1);
  inertia_.resize(n);
  own_.resize(n);
  of_motion_.resize(n);
  rhs_.resize(n);
  sizes_.resize(n);
  far_.resize(n);
  for (const BodyData& body : system.bodies())
    per_mass_.push_back({1.0 / body.mass, 3.0 / body.inertia.trace()});
  x_.resize(n);
  start_.resize(n);
}

/// Inertia tangent at the start of the step, used in all its iterations: rotations in a step are
/// small. @eq{eq:ga-momenta-Newmark} @eq{ga-K-momentum}
void ContactCgEngine::start_inertia(const State& state, const StepContext& context) {
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

/// Increments at which the momentum balance holds without contacts: of bodies without loads
/// exactly, of others linearised about their prediction. @eq{eq:td-Newmark-COM}
/// @eq{eq:td-Newmark-mrot}
void ContactCgEngine::find_free_motions(const State& state, const Trial& trial) {
  const StepContext& context = trial.context;
  const double per_speed = context.ga.kappa / context.dt;
  free_.resize(inertia_.size());
  free_rows_.clear();
  for (const int b : acted_on_) {
    move(b, x_[b].head<3>(), x_[b].tail<3>());
    rhs_[b] = of_motion(b, per_speed);
    blocks_[b] = own_[b];
  }
  loads_.run(steps_, context, trial.lambda.data(), state.history.data(),
             [&](int interaction, const PairStep&, const PairTerms& t) {
               const InteractionRef& ref = system_->interactions()[interaction];
               add_wrenches(ref, t);
               add_free_rows(ref, t);
             });
  for (const int b : acted_on_) {
    free_[b].has_loads = true;
    const Mat6 symmetric = 0.5 * (blocks_[b] + blocks_[b].transpose());
    const bool regular = is_positive_definite(symmetric);
    free_[b].response = inverse(regular ? blocks_[b] : own_[b]);
    free_[b].increment = x_[b] + free_[b].response * rhs_[b];
    move(b, Vec3::Zero(), Vec3::Zero());
  }
  for (std::size_t b = 0; b < free_.size(); ++b) {
    if (free_[b].has_loads) continue;
    const BodyData& body = system_->bodies()[b];
    const Inertia& at = inertia_[b];
    const BodyStep& s = steps_[b];
    const Vec3 v = at.force / (per_speed * body.mass);
    const Vec3 W = body.inertia.ldlt().solve(s.Lambda_n.transpose() * at.moment) / per_speed;
    free_[b].increment << (v - at.v) / s.rate, s.Lambda_n * (W - at.W) / s.rate;
  }
}

void ContactCgEngine::add_free_rows(const InteractionRef& ref, const PairTerms& t) {
  PointwiseContacts::FreeRows rows;
  rows.a = ref.a;
  rows.b = ref.b;
  for (int k = 0; k < ref.rows; ++k) {
    if (t.compliance[k] != 0.0) continue;
    const auto row = static_cast<Eigen::Index>(rows.numbers.size());
    if (ref.a != kGround) rows.G_a.row(row) = t.G_a.row(k);
    if (ref.b != kGround) rows.G_b.row(row) = t.G_b.row(k);
    rows.g[row] = t.g[k];
    rows.numbers.push_back(ref.first_row + k);
  }
  if (!rows.numbers.empty()) free_rows_.push_back(std::move(rows));
}

/// Residual of a body's momentum balance without loads and contacts. @eq{eq:ga-momenta-Newmark}
Vec6 ContactCgEngine::of_motion(int b, double per_speed) const {
  const BodyData& body = system_->bodies()[b];
  const BodyStep& s = steps_[b];
  Vec6 residual;
  residual << inertia_[b].force - per_speed * body.mass * s.v_n1,
      inertia_[b].moment - per_speed * (s.Lambda_n1 * (body.inertia * s.W_n1));
  return residual;
}

/// @eq{eq:td-Newmark-COM} @eq{eq:td-Newmark-mrot} @eq{eq:td-incremental-rotation}
void ContactCgEngine::move(int body, const Vec3& u, const Vec3& theta) {
  BodyStep& s = steps_[body];
  s.u = u;
  s.theta = theta;
  s.r_n1 = s.r_n + u;
  s.Lambda_n1 = cay(theta) * s.Lambda_n;
  s.v_n1 = s.rate * u + inertia_[body].v;
  s.W_n1 = s.rate * (s.Lambda_n.transpose() * theta) + inertia_[body].W;
}

void ContactCgEngine::end_step(const State& state, Trial& trial) {
  for (int b = 0; b < system_->body_count(); ++b)
    move_body(state, trial, system_->slot(b), steps_[b].u, steps_[b].theta);
}

void ContactCgEngine::begin_step(const State& state, Trial& trial) {
  steps_.back() = BodyStep::ground(trial.context.ga.alpha_f);
  double fastest = 0.0;
  for (int b = 0; b < system_->body_count(); ++b) {
    BodyStep& s = steps_[b] = body_step(*system_, state, trial, b);
    x_[b] << s.u, s.theta;
    s.r_n1 = s.r_n;
    s.Lambda_n1 = s.Lambda_n;
    s.u = s.theta = Vec3::Zero();
    far_[b] = s.r_n.lpNorm<Eigen::Infinity>();
    fastest = std::max(fastest, s.v_n.squaredNorm());
  }
  start_inertia(state, trial.context);
  for (std::size_t i = 0; i < system_->interactions().size(); ++i) {
    const InteractionRef& ref = system_->interactions()[i];
    if (ref.rows > 0 && system_->is_off(state, static_cast<int>(i)))
      std::fill_n(trial.lambda.begin() + ref.first_row, ref.rows, 0.0);
  }
  weight_ = system_->gravity().norm();
  if (weight_ == 0.0) weight_ = kPartOfApproach * std::sqrt(fastest) / std::abs(trial.context.dt);
  weight_ = std::max(weight_, std::numeric_limits<double>::min());
  contacts_->begin_step(state, steps_, trial.context);
  contacts_->cover(steps_, trial.context, x_);
  blocks_ = own_;
  find_free_motions(state, trial);
  pointwise_->predict(steps_, trial.context, free_, free_rows_, x_);
  for (const PointwiseContacts::FreeRows& rows : free_rows_)
    for (std::size_t k = 0; k < rows.numbers.size(); ++k)
      trial.lambda[rows.numbers[k]] += rows.change[static_cast<Eigen::Index>(k)];
  const double part = contacts_->filter(steps_, x_);
  for (int b = 0; b < system_->body_count(); ++b)
    move(b, part * x_[b].head<3>(), part * x_[b].tail<3>());
  searches_ = 0;
  slow_ = false;
  rows_off_before_ = std::numeric_limits<double>::infinity();
  move_all();
  evaluated_ = false;
}

void ContactCgEngine::move_all() {
  moving_.resize(static_cast<std::size_t>(system_->body_count()));
  std::iota(moving_.begin(), moving_.end(), 0);
  moves_.assign(moving_.size() + 1, 1);
  moves_.back() = 0;
}

void ContactCgEngine::move_late() {
  const auto n = static_cast<std::size_t>(system_->body_count());
  const double late = kLate * enough_ * weight_;
  for (std::size_t b = 0; b < n; ++b) moves_[b] = sizes_[b] * per_mass_[b].moved > late * late;
  for (int ring = 0; ring < kRings; ++ring) {
    ring_ = moves_;
    for (const ActingPoint& p : acting_) {
      const int a = p.spring.a, b = p.spring.b;
      if (a != kGround && b != kGround && ring_[a] != ring_[b]) moves_[a] = moves_[b] = 1;
    }
  }
  for (const int b : acted_on_) moves_[b] = 1;
  moving_.clear();
  for (std::size_t b = 0; b < n; ++b)
    if (moves_[b]) moving_.push_back(static_cast<int>(b));
  if (static_cast<double>(moving_.size()) > kMaxMovingPart * static_cast<double>(n)) move_all();
}

void ContactCgEngine::add_wrenches(const InteractionRef& ref, const PairTerms& t) {
  if (ref.a != kGround) {
    rhs_[ref.a] += t.wrench_a;
    blocks_[ref.a] -= t.D_aa;
  }
  if (ref.b != kGround) {
    rhs_[ref.b] += t.wrench_b;
    blocks_[ref.b] -= t.D_bb;
  }
}

/// Adds an interaction's forces and rows; rows that are switched off have no motion of their own.
void ContactCgEngine::add_interaction(int interaction, const PairTerms& t, const Trial& trial) {
  const InteractionRef& ref = system_->interactions()[interaction];
  add_wrenches(ref, t);
  if (!couples(ref)) return;
  if (ref.a != kGround && ref.b != kGround && trial.context.tangents)
    ties_.push_back({ref.a, ref.b, -0.5 * (t.D_ab + t.D_ba.transpose())});
  for (int k = 0; k < ref.rows; ++k) {
    if (t.compliance[k] != 0.0) continue;
    rows_.push_back({ref.a, ref.b, t.G_a.row(k), t.G_b.row(k), t.g[k]});
    row_number_.push_back(ref.first_row + k);
  }
}

/// Whether the rows hold: to rounding of positions, or with a violation that iterations no longer
/// reduce.
bool ContactCgEngine::rows_hold() const {
  if (rows_.empty()) return true;
  double far = system_->length_scale();
  for (const int b : coupled_) far = std::max(far, far_[b]);
  return rows_off_ <= 4.0 * kPositionRoundOff * far ||
         (rows_off_ <= kRowsHold * far && rows_off_ > 0.5 * rows_off_before_);
}

/// Evaluates forces of bodies, loads and contacts at the trial, whose steps are up to date.
void ContactCgEngine::evaluate(const State& state, const Trial& trial) {
  const StepContext& context = trial.context;
  const double per_speed = context.ga.kappa / context.dt;
  for (const int b : moving_) of_motion_[b] = of_motion(b, per_speed);
  rhs_ = of_motion_;
  for (const int b : acted_on_) blocks_[b] = own_[b];
  ties_.clear();
  rows_.clear();
  row_number_.clear();
  loads_.run(steps_, context, trial.lambda.data(), state.history.data(),
             [&](int interaction, const PairStep&, const PairTerms& t) {
               add_interaction(interaction, t, trial);
             });
  rows_off_ = 0.0;
  for (const linear::BlockCg::Row& row : rows_)
    if (!(std::abs(row.g) <= rows_off_)) rows_off_ = std::abs(row.g);
  acting_ = pointwise_->evaluate_pointwise(steps_, context, moves_);
  double noise = 0.0;  // rounding of positions times the stiffness of contacts
  for (const ActingPoint& p : acting_) {
    const int a = p.spring.a, b = p.spring.b;
    if (a != kGround) {
      rhs_[a].head<3>() += p.force;
      rhs_[a].tail<3>() += p.moment_a;
    }
    if (b != kGround) {
      rhs_[b].head<3>() -= p.force;
      rhs_[b].tail<3>() += p.moment_b;
    }
    const int one = a != kGround ? a : b;
    noise = std::max(noise, p.spring.C.trace() * far_[one] * per_mass_[one].moved);
  }
  merit_ = 0.0;
  double worst = 0.0;
  worst_body_ = -1;
  for (int b = 0; b < system_->body_count(); ++b) {
    const PerMass& per = per_mass_[b];
    const double size =
        per.moved * rhs_[b].head<3>().squaredNorm() + per.turned * rhs_[b].tail<3>().squaredNorm();
    merit_ += sizes_[b] = size;
    if (!(size * per.moved <= worst)) worst = size * per.moved, worst_body_ = b;
  }
  residual_ = std::sqrt(worst) / weight_;
  // Residual forces act in every step: the tolerance decreases with the step.
  const double asked = tolerance_ * std::min(1.0, std::abs(context.dt) / kWholeStep);
  enough_ = std::max(asked, kPositionRoundOff * noise / weight_);  // no residual can be smaller
  evaluated_ = true;
}

/// Solves for increments of moving bodies and of multipliers.
bool ContactCgEngine::solve(const Trial& trial) {
  if (searches_ == 0 && !cg_.set_bodies(own_)) return false;
  if (!acted_on_.empty() && !cg_.update_bodies(acted_on_, blocks_)) return false;
  POLHODE_ASSERT(is_strictly_ascending(moving_));
  cg_.set_springs(acting_, moving_);
  cg_.set_ties(ties_);
  if (!rows_.empty() && !cg_.set_rows(rows_)) return false;
  inner_ += cg_.solve(rhs_, x_, searches_ < kCoarseIterations ? kCoarse : kFine, kMaxInner,
                      slow_ && residual_ < kFrictionBelow ? kFrictionDirections : 0);
  start_lambda_.clear();
  for (const int row : row_number_) start_lambda_.push_back(trial.lambda[row]);
  rows_off_before_ = rows_off_;
  return true;
}

Iteration ContactCgEngine::iterate(const State& state, Trial& trial, bool, double damping) {
  Iteration done;
  if (!evaluated_) evaluate(state, trial);
  done.solved = std::isfinite(merit_) && std::isfinite(rows_off_);
  if (!done.solved || (residual_ < enough_ && rows_hold())) return done;
  move_late();
  if (!solve(trial)) {
    done.solved = false;
    return done;
  }
  ++searches_;
  contacts_->cover(steps_, trial.context, x_);
  const double most = std::min(damping, contacts_->filter(steps_, x_));
  const double before = merit_, residual_before = residual_,
               per_length = 1.0 / system_->length_scale();
  double at_stake = 0.0;
  for (const int b : moving_) {
    at_stake += sizes_[b];
    start_[b] << steps_[b].u, steps_[b].theta;
  }
  const auto apply = [&](double part) {
    done.applied = part;
    done.increment = done.rotation = 0.0;
    for (const int b : moving_) {
      const Vec3 D_r = x_[b].head<3>(), D_theta = x_[b].tail<3>();
      done.increment = std::max({done.increment, per_length * D_r.lpNorm<Eigen::Infinity>(),
                                 D_theta.lpNorm<Eigen::Infinity>()});
      const Vec3 turned = compose_cayley(part * D_theta, Vec3(start_[b].tail<3>()));
      done.rotation = std::max(done.rotation, turned.norm());
      move(b, start_[b].head<3>() + part * D_r, turned);
    }
    for (std::size_t i = 0; i < start_lambda_.size(); ++i)
      trial.lambda[row_number_[i]] =
          start_lambda_[i] + part * cg_.multipliers()[static_cast<Eigen::Index>(i)];
    evaluate(state, trial);
    return done.increment;
  };
  const auto merit_left = [&] { return residual_ < enough_ ? -1.0 : at_stake - (before - merit_); };
  search_along(kReduceMuch, at_stake, most, apply, merit_left);
  if (done.applied == 1.0 && residual_before < kFrictionBelow)
    slow_ = slow_ || residual_ > kSlow * residual_before;
  // The residual decides: the increment is no measure of the next one.
  if (residual_ < enough_ && rows_hold()) {
    done.increment = 0.0;
    done.applied = 1.0;
  } else {
    done.increment = std::max(done.increment, 1e-4);
  }
  return done;
}

void ContactCgEngine::add_ground_wrench(double* force, double* moment) const {
  Vec3 f = Vec3::Zero(), m = Vec3::Zero();
  const auto add = [&](int b, const Vec3& on_b, const Vec3& moment_on_b) {
    if (b == kGround) return;
    f += on_b;
    m += (steps_[b].r_n + steps_[b].alpha_f * steps_[b].u).cross(on_b) + moment_on_b;
  };
  // Forces between bodies cancel in the sums: the remainder is that of the ground.
  for (const ActingPoint& p : acting_) {
    add(p.spring.a, p.force, p.moment_a);
    add(p.spring.b, -p.force, p.moment_b);
  }
  for (int i = 0; i < 3; ++i) {
    force[i] += f[i];
    moment[i] += m[i];
  }
}

ConstraintCheck ContactCgEngine::check(const State& state, Trial& trial) {
  ConstraintCheck check;
  StepContext context = trial.context;
  context.tangents = false;
  loads_.run(
      steps_, context, trial.lambda.data(), state.history.data(),
      [&](int interaction, const PairStep& step, const PairTerms& terms) {
        add_rows(system_->interactions()[interaction], step, terms, trial, system_->length_scale(),
                 check);
      },
      true);
  return check;
}

double ContactCgEngine::stored(const State& state) const {
  std::vector<BodyStep> instants(steps_.size());
  for (int b = 0; b < system_->body_count(); ++b) instants[b] = system_->instant(state, b);
  instants.back() = BodyStep::ground(1.0);
  return contacts_->stored(state, instants);
}

Work ContactCgEngine::commit(State& state, const Trial& trial) {
  return contacts_->commit(state, steps_, trial.context);
}

}  // namespace polhode
