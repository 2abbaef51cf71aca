// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/base/error.hpp>
#include <polhode/solve/contact_engine.hpp>
#include <polhode/solve/sparse_engine.hpp>

namespace polhode {

namespace {

/// Increments below this need no line search: Newton converges quadratically there.
constexpr double kNoSearchBelow = 1e-6;
constexpr int kMostCuts = 10;

}  // namespace

ContactEngine::ContactEngine(const System& system, const std::string& solver, MomentumRate form)
    : system_(&system),
      contacts_(system.contacts().get()),
      form_(form),
      solver_(make_linear_solver(solver)) {
  if (!contacts_)
    throw InputError("solver", "the system has no contacts", "Choose an engine without contact");
  contacts_->prepare(system);
  steps_.resize(static_cast<std::size_t>(system.body_count()) + 1);
  increments_.assign(static_cast<std::size_t>(system.body_count()), Vec6::Zero());
  set_up();
}

/// The pairs that touch and of which both move go into the matrix after those of interactions.
void ContactEngine::set_up() {
  std::vector<KktPair> more;
  place_.clear();
  for (const Participants& p : contacts_->pairs()) {
    const bool both = p.a != kGround && p.b != kGround;
    place_.push_back(both ? static_cast<int>(more.size()) : -1);
    if (both) more.push_back({p.a, p.b, 0, 0});
  }
  newton_.emplace(*system_, form_, more);
  known_ = contacts_->pairs();
  static_pairs_ = newton_->topology().pairs.size() - more.size();
  solver_->analyse(newton_->topology());
  terms_.resize(contacts_->pairs().size());
  for (PairTerms& t : terms_) t.set_zero();
  factored_ = false;
  ++analyses_;
}

bool ContactEngine::up_to_date() const {
  const std::vector<Participants>& now = contacts_->pairs();
  return std::equal(
      known_.begin(), known_.end(), now.begin(), now.end(),
      [](const Participants& x, const Participants& y) { return x.a == y.a && x.b == y.b; });
}

void ContactEngine::take_steps(const State& state, const Trial& trial) {
  for (int b = 0; b < system_->body_count(); ++b) steps_[b] = body_step(*system_, state, trial, b);
  steps_.back() = BodyStep::ground(trial.context.ga.alpha_f);
}

/// The prediction is held back like every increment.
void ContactEngine::begin_step(const State& state, Trial& trial) {
  take_steps(state, trial);
  std::vector<BodyStep> start = steps_;
  for (int b = 0; b < system_->body_count(); ++b) {
    start[b].r_n1 = start[b].r_n;
    start[b].Lambda_n1 = start[b].Lambda_n;
    start[b].u = start[b].theta = Vec3::Zero();
    increments_[b] << steps_[b].u, steps_[b].theta;
  }
  contacts_->begin_step(state, start, trial.context);
  contacts_->cover(start, trial.context, increments_);
  if (!up_to_date()) set_up();
  const double part = contacts_->filter(start, increments_);
  if (part >= 1.0) return;
  for (int b = 0; b < system_->body_count(); ++b)
    move_body(state, trial, system_->slot(b), part * steps_[b].u, part * steps_[b].theta);
}

void ContactEngine::assemble(const State& state, const Trial& trial, bool tangent) {
  newton_->assemble(state, trial, tangent);
  take_steps(state, trial);
  StepContext context = trial.context;
  context.tangents = tangent;
  contacts_->evaluate(steps_, context, terms_);
  const double s = trial.scale(*system_);
  rhs_ = newton_->right_hand_side();
  KktValues& values = newton_->values();
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    const Participants& p = contacts_->pairs()[k];
    const PairTerms& t = terms_[k];
    const auto add = [&](int body, const Vec6& wrench, const Mat6& D) {
      if (body == kGround) return;
      rhs_.segment<6>(6 * body) += s * wrench;
      if (tangent) values.diagonal[body] -= s * D;
    };
    add(p.a, t.wrench_a, t.D_aa);
    add(p.b, t.wrench_b, t.D_bb);
    if (!tangent || place_[k] < 0) continue;
    KktValues::Pair& v = values.pairs[static_pairs_ + static_cast<std::size_t>(place_[k])];
    v.K_ab = -s * t.D_ab;
    v.K_ba = -s * t.D_ba;
  }
}

/// R·M⁻¹R of the bodies, and g² of rows at the mean mass: an increment of Newton lowers it.
double ContactEngine::merit() const {
  double sum = 0.0;
  for (int b = 0; b < system_->body_count(); ++b) {
    const BodyData& body = system_->bodies()[b];
    sum += rhs_.segment<3>(6 * b).squaredNorm() / body.mass +
           3.0 * rhs_.segment<3>(6 * b + 3).squaredNorm() / body.inertia.trace();
  }
  return sum + rhs_.tail(system_->rows()).squaredNorm() / system_->mean_mass();
}

bool ContactEngine::solve(const State& state, const Trial& trial, bool refactor) {
  refactor = refactor || !factored_;
  assemble(state, trial, refactor);
  if (refactor) {
    factored_ = solver_->factor(newton_->values());
    if (!factored_) return false;
  }
  x_ = rhs_;
  solver_->solve(x_);
  if (!x_.allFinite()) return false;
  for (int b = 0; b < system_->body_count(); ++b) increments_[b] = x_.segment<6>(6 * b);
  return true;
}

Iteration ContactEngine::iterate(const State& state, Trial& trial, bool refactor, double damping) {
  Iteration done;
  for (int again = 0;; ++again) {
    if (!solve(state, trial, refactor)) return done;
    contacts_->cover(steps_, trial.context, increments_);
    if (up_to_date()) break;
    set_up();
    if (again == 3) return done;
  }
  done.solved = true;
  double part = std::min(damping, contacts_->filter(steps_, increments_));
  const double before = merit();
  const Trial start = trial;
  for (int cut = 0;; ++cut) {
    done.increment = done.rotation = 0.0;
    apply_increments(*system_, state, trial, x_, part, done, worst_body_);
    if (cut == kMostCuts || done.increment < kNoSearchBelow) break;
    assemble(state, trial, false);
    const double after = merit();
    if (after <= (1.0 - 1e-4 * part) * before) break;
    const double size = rhs_.lpNorm<Eigen::Infinity>();
    if (std::isfinite(after) && size < 1e-14 * system_->length_scale()) break;
    const double best = before / (after - (1.0 - 2.0 * part) * before) * part;  // of a parabola
    part *= std::isfinite(after) ? std::clamp(best, 0.1, 0.5) : 0.25;
    trial.blocks = start.blocks;
    trial.lambda = start.lambda;
  }
  done.applied = part;
  return done;
}

ConstraintCheck ContactEngine::check(const State& state, Trial& trial) {
  return newton_->check(state, trial);
}

void ContactEngine::end_step(const State& state, Trial& trial) {
  assemble(state, trial, false);
  ground_force_.setZero();
  ground_moment_.setZero();
  touches_ = false;
  const double alpha_f = trial.context.ga.alpha_f;
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    const Participants& p = contacts_->pairs()[k];
    if (!terms_[k].wrench_a.isZero(0.0)) touches_ = true;
    if (p.b != kGround) continue;
    const Vec3 f = terms_[k].wrench_a.head<3>();
    const BodyStep& s = steps_[p.a];
    ground_force_ += f;
    ground_moment_ += (s.r_n + alpha_f * s.u).cross(f) + terms_[k].wrench_a.tail<3>();
  }
}

void ContactEngine::add_ground_wrench(double* force, double* moment) const {
  for (int i = 0; i < 3; ++i) {
    force[i] += ground_force_[i];
    moment[i] += ground_moment_[i];
  }
}

double ContactEngine::stored(const State& state) const {
  std::vector<BodyStep> instants(steps_.size());
  for (int b = 0; b < system_->body_count(); ++b) instants[b] = system_->instant(state, b);
  instants.back() = BodyStep::ground(1.0);
  return contacts_->stored(state, instants);
}

Work ContactEngine::commit(State& state, const Trial& trial) {
  take_steps(state, trial);
  rows_ = joint_rows(state, trial);
  return contacts_->commit(state, steps_, trial.context);
}

/// Rows of joints at t_{n+1}; read before the state moves, since steps start from it.
std::vector<VelocityRow> ContactEngine::joint_rows(const State& state, const Trial& trial) const {
  std::vector<VelocityRow> rows;
  if (system_->rows() == 0 || !touches_) return rows;
  InteractionSweep sweep(*system_);
  sweep.run(
      steps_, trial.context, trial.lambda.data(), state.history.data(),
      [&](int interaction, const PairStep&, const PairTerms& t) {
        const InteractionRef& ref = system_->interactions()[interaction];
        for (int k = 0; k < ref.rows; ++k)
          if (t.compliance[k] == 0.0)
            rows.push_back({ref.a, ref.b, t.G_a.row(k).transpose(), t.G_b.row(k).transpose()});
      },
      true);
  return rows;
}

/// After impacts the velocities of past steps tell nothing about the next one.
VelocityJump ContactEngine::settle_impacts(State& state, const Trial&) {
  if (!touches_) return {};
  state.past_count = 0;
  return contacts_->settle_impacts(state, rows_);
}

}  // namespace polhode
