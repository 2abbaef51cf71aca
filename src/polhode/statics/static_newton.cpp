// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/beams/running_cable.hpp>
#include <polhode/core/format.hpp>
#include <polhode/dynamics/load_step.hpp>
#include <polhode/engines/unilateral_rows.hpp>
#include <polhode/equations/iterate_snapshot.hpp>
#include <polhode/equations/line_search.hpp>
#include <polhode/equations/node_motion.hpp>
#include <polhode/math/quaternion.hpp>
#include <polhode/statics/static_newton.hpp>
#include <polhode/system/lane_access.hpp>

namespace polhode {

namespace {

constexpr double kStaticRoundOff = std::numeric_limits<double>::epsilon();
/// Rounding of a residual, in units of the products of stiffness and position that it consists of.
constexpr double kFloor = 16.0;
/// Largest rotation of a body in one iteration: Cayley vector [-].
constexpr double kRotationCap = 1.9;
/// Increment, in sizes of the model, above which the iteration has diverged.
constexpr double kStaticDiverged = 1e6;
/// Increment below which stagnation is rounding, if the residual is at rounding too.
constexpr double kClose = 1e-5;
/// Cosine of half a rotation by half a turn: its Cayley vector is not finite [-].
constexpr double kHalfTurn = 1e-8;
/// Residual of a constraint that counts as satisfied [m or -].
constexpr double kAssembled = 1e-13;

}  // namespace

StaticNewton::StaticNewton(const System& system, const StaticOptions& options)
    : system_(&system),
      options_(options),
      newton_(system, MomentumRate::momentum),
      nodes_(system),
      matrix_(system, newton_.topology()) {
  newton_.set_static(true);
  if (UnilateralRows::of(system)) rows_ = std::make_unique<StaticRows>(system);
  const Nodes& nodes = system.nodes();
  mixed_ = options.mixed_point;
  nodes_.set_static(true, mixed_);
  here_.assign(nodes.pieces().size(), Mat3::Identity());
  trial_.context.ga = load_step_weights();
  trial_.context.conserving = false;
  trial_.context.dt = 1.0;
  trial_.compliance_scale = 1.0;
  trial_.element_scratch.resize(nodes.scratch_size());
  rhs_ = x_ = noise_ = Vec::Zero(matrix_.size());
  moments_.assign(system.body_count(), Vec6::Zero());
  held_ = nodes_.residual();
  for (int i = 0; i < static_cast<int>(system.interactions().size()); ++i) {
    const InteractionRef& ref = system.interactions()[i];
    const InteractionGroup& group = system.group(ref.group);
    if (group.traits(ref.item).history_size > 0 && group.traits(ref.item).lazy_history)
      turns_.push_back(i);
  }
  for (int g = 0; g < nodes.group_count(); ++g) {
    const BarrierConstraint* points = nodes.group(g).barrier_constraint();
    if (!points) continue;
    if (const ChangingSparsity* pattern = nodes.group(g).changing_sparsity())
      meetings_.push_back({pattern, points, static_cast<std::size_t>(nodes.first_history(g))});
    else
      shapes_.push_back(g);
  }
}

/// Sets the times of the step: they are the load factors. At an instant the step has a length all
/// the same, over which nothing moves.
void StaticNewton::enter(double load_factor, double last) {
  StepContext& c = trial_.context;
  const bool follows = options_.history > 0.0;
  const double t = follows ? std::max(load_factor, 0.0) : load_factor;
  const bool grows = !follows || load_factor < 0.0 || last < 0.0;
  c.load_factor = follows ? std::min(1.0 + load_factor, 1.0) : load_factor;
  c.dt = load_factor != last ? load_factor - last : 1.0;
  c.load_factor_n = grows && load_factor != last ? c.load_factor - c.dt : c.load_factor;
  c.t_n = t - c.dt;
  // Loads at the start of a history act suddenly, at its first instant.
  c.relaxation_time = !follows                       ? std::numeric_limits<double>::infinity()
                      : grows || load_factor == last ? 0.0
                                                     : c.dt;
}

/// Begins a search from the equilibrium of a state.
void StaticNewton::start_at(const State& state) { work_ = last_ = state; }

/// Puts the bodies of work_ into the trial. θ is not bounded: a load step may turn a body by half a
/// turn and more.
void StaticNewton::place_bodies() {
  for (int b = 0; b < system_->body_count(); ++b) {
    const int slot = system_->slot(b), lane = slot % kLanes;
    TrialBlock& t = trial_.blocks[slot / kLanes];
    const BodyMotion m = system_->motion(work_, b), m_n = system_->motion(last_, b);
    const Quat turned = m.q * m_n.q.conjugate();
    const double w =
        std::abs(turned.w()) < kHalfTurn ? std::copysign(kHalfTurn, turned.w()) : turned.w();
    put(t.u, lane, Vec3(m.r - m_n.r));
    put(t.theta, lane, Vec3(2.0 / w * turned.vec()));
    put(t.r, lane, m.r);
    put(t.Lambda, lane, m.Lambda());
  }
}

void StaticNewton::start_scratch(const State& state) {
  const Nodes& nodes = system_->nodes();
  std::fill(trial_.element_scratch.begin(), trial_.element_scratch.end(), 0.0);
  trial_.node_u.assign(state.node_x.size(), 0.0);
  trial_.node_v.assign(state.node_x.size(), 0.0);
  for (int g = 0; g < nodes.group_count(); ++g)
    nodes.group(g).begin_step(state.element_history.data() + nodes.first_history(g),
                              trial_.element_scratch.data() + nodes.first_scratch(g));
}

/// Residual and tangent at work_. @eq{statics-residual}
ElementReport StaticNewton::assemble() {
  start_trial(*system_, last_, trial_);
  place_bodies();
  trial_.lambda_centre = trial_.lambda = work_.lambda;
  trial_.node_x = work_.node_x;
  trial_.context.mixed_point = mixed_;
  ElementReport report;
  if (!system_->nodes().empty()) {
    follow_bodies(*system_, work_, trial_);
    std::fill(trial_.node_u.begin(), trial_.node_u.end(), 0.0);
    look_for_neighbours();
    report = nodes_.assemble(work_, trial_, true, here_);
    if (!(report.least_volume > 0.0)) return report;
    if (matrix_.set_moving(nodes_.moving())) solver_.forget();
  }
  std::swap(last_.history, work_.history);
  newton_.assemble(last_, trial_, true);
  if (rows_) rows_->place(last_, trial_);
  std::swap(last_.history, work_.history);
  set_matrix();

  const double s = scale();
  const int bodies = 6 * system_->body_count(), n = matrix_.movable();
  rhs_.setZero();
  matrix_.gather(nodes_.residual(), -s, rhs_);
  rhs_.head(bodies) += newton_.right_hand_side().head(bodies);
  rhs_.segment(n, system_->rows()) = -newton_.right_hand_side().tail(system_->rows());
  if (rows_) rows_->add_forces(s, rhs_, contact_noise_);
  for (int b = 0; b < system_->body_count(); ++b) moments_[b] = -rhs_.segment<6>(6 * b);

  // Rounding by products of stiffness and position, row by row; and the largest force.
  for (int b = 0; b < system_->body_count(); ++b)
    x_.segment<6>(6 * b) << system_->motion(work_, b).r, Vec3::Ones();
  for (int i = 0; i < system_->nodes().count(); ++i)
    for (int c = 0; c < 3; ++c)
      if (const int u = matrix_.unknown(i, c); u >= 0) x_[u] = work_.node_x[3 * i + c];
  for (int row = 0; row < system_->rows(); ++row) x_[n + row] = s * work_.lambda[row];
  x_.tail(matrix_rows() - system_->rows()).setZero();
  matrix_.magnitudes(x_, noise_);
  noise_ *= kFloor * kStaticRoundOff;
  if (rows_) noise_.head(bodies) += contact_noise_;
  force_ = rows_ ? rows_->largest_force() : 0.0;
  for (int b = 0; b < system_->body_count(); ++b) {
    const Vec6& f = newton_.body_residual_scale(b);
    force_ = std::max(
        {force_, f.head<3>().maxCoeff(), f.tail<3>().maxCoeff() / system_->length_scale()});
  }
  for (double f : nodes_.residual()) force_ = std::max(force_, std::abs(f));
  return report;
}

/// Sets s = 1/(largest stiffness): K is then of the order of one, as G is.
void StaticNewton::choose_scale() {
  trial_.compliance_scale = 1.0;
  if (!(assemble().least_volume > 0.0)) return;
  double stiffest = 0.0;
  for (const Mat6& K : newton_.values().diagonal)
    stiffest = std::max(stiffest, K.topLeftCorner<3, 3>().cwiseAbs().maxCoeff());
  for (double k : nodes_.tangent()) stiffest = std::max(stiffest, std::abs(k));
  if (stiffest == 0.0) stiffest = force_ / system_->length_scale();
  if (stiffest > 0.0 && std::isfinite(stiffest)) trial_.compliance_scale = 1.0 / stiffest;
}

void StaticNewton::measure(StaticStep& step) const {
  const double s = scale(), length = system_->length_scale();
  step.residual = 0.0;
  step.force = force_;
  int worst = -1;
  const int bodies = 6 * system_->body_count();
  for (int i = 0; i < matrix_.movable(); ++i) {
    const double per = i < bodies && i % 6 >= 3 ? 1.0 / (s * length) : 1.0 / s;
    const double size = per * std::abs(rhs_[i]);
    if (size <= step.residual) continue;
    step.residual = size;
    worst = i;
  }
  if (worst >= 0 && worst < bodies)
    step.worst = format("body '{}'", system_->bodies()[worst / 6].name);
  if (worst < bodies) return;
  for (int i = 0; i < system_->nodes().count(); ++i)
    for (int c = 0; c < 3; ++c)
      if (matrix_.unknown(i, c) == worst) step.worst = system_->nodes().node_name(i);
}

/// Whether every row is balanced, within the tolerance or to rounding.
StaticNewton::Balance StaticNewton::balanced(StaticStep& step) const {
  measure(step);
  Balance balance = Balance::rounded;
  const double s = scale(), length = system_->length_scale();
  const int bodies = 6 * system_->body_count(), n = matrix_.movable();
  for (int i = 0; i < n; ++i) {
    const double allowed =
        options_.residual * s * force_ * (i < bodies && i % 6 >= 3 ? length : 1.0);
    if (!(std::abs(rhs_[i]) <= std::max(allowed, noise_[i]))) return Balance::off;
    if (std::abs(rhs_[i]) > noise_[i]) balance = Balance::within;
  }
  for (int row = 0; row < system_->rows(); ++row) {
    const double allowed = std::max(kAssembled * std::max(1.0, length), noise_[n + row]);
    if (!(std::abs(rhs_[n + row]) <= allowed)) {
      step.worst.clear();
      for (const InteractionRef& ref : system_->interactions())
        if (row >= ref.first_row && row < ref.first_row + ref.rows)
          step.worst = format("{} '{}'", system_->group(ref.group).kind(), system_->name(ref));
      return Balance::off;
    }
  }
  return balance;
}

/// Remaining displacements of prescribed components, three per node.
void StaticNewton::aim(std::vector<double>& du) const {
  const Nodes& nodes = system_->nodes();
  du.assign(work_.node_x.size(), 0.0);
  const StepContext& c = trial_.context;
  for (const PrescribedComponent& p : nodes.prescribed()) {
    const std::size_t k = 3 * static_cast<std::size_t>(p.node) + p.component;
    const double target = c.load_factor * (*p.displacement)(c.t_n1());
    du[k] = nodes[p.node].position[p.component] + target - work_.node_x[k];
  }
}

/// Counts the turns of bodies up to work_.
void StaticNewton::count_turns() {
  for (int i : turns_) {
    const InteractionRef& ref = system_->interactions()[i];
    const BodyStep a = system_->instant(work_, ref.a), b = system_->instant(work_, ref.b);
    double* history = work_.history.data() + ref.first_history;
    system_->group(ref.group).commit(
        ref.item, {a, b, trial_.context, work_.lambda.data() + ref.first_row, history}, history);
  }
}

/// Moves work_ by part of x_; stresses are extrapolated by the whole of it. @returns the largest
/// scaled increment of the whole.
double StaticNewton::apply(double part, StaticStep& step) {
  const double per_length = 1.0 / system_->length_scale();
  double most = 0.0;
  step.worst.clear();
  int worst_body = -1, worst_node = -1;
  for (const InteractionRef& ref : system_->interactions()) {
    if (system_->traits(ref).history_size == 0) continue;
    const auto of = [&](int body) -> Vec6 {
      return body == kGround ? Vec6::Zero() : Vec6(x_.segment<6>(6 * body));
    };
    const BodyStep a = body_step(*system_, last_, trial_, ref.a);
    const BodyStep b = body_step(*system_, last_, trial_, ref.b);
    double* history = work_.history.data() + ref.first_history;
    const PairStep pair{a, b, trial_.context, work_.lambda.data() + ref.first_row, history};
    system_->group(ref.group).extrapolate(ref.item, pair, of(ref.a), of(ref.b), history);
  }
  for (int b = 0; b < system_->body_count(); ++b) {
    const Vec3 r = x_.segment<3>(6 * b), theta = x_.segment<3>(6 * b + 3);
    const double size =
        std::max(per_length * r.lpNorm<Eigen::Infinity>(), theta.lpNorm<Eigen::Infinity>());
    if (!(size <= most)) {
      most = size;
      worst_body = b;
    }
    BodyMotion m = system_->motion(work_, b);
    m.r += part * r;
    m.q = (quaternion_from_cayley(part * theta) * m.q).normalized();
    work_.set_motion(system_->slot(b), m);
  }
  for (int row = 0; row < system_->rows(); ++row)
    work_.lambda[row] += part / scale() * x_[matrix_.movable() + row];
  const Nodes& nodes = system_->nodes();
  if (!nodes.empty()) {
    matrix_.expand(x_, du_);
    for (std::size_t k = 0; k < du_.size(); ++k) du_[k] = part * (du_[k] + given_[k]);
    const double per_size = 1.0 / (part * nodes.element_size());
    for (int i = 0; i < nodes.count(); ++i)
      for (int c = 0; c < 3; ++c) {
        const std::size_t k = 3 * static_cast<std::size_t>(i) + c;
        if (nodes.bonded(i)) continue;
        work_.node_x[k] += du_[k];
        const double size = per_size * std::abs(du_[k]);
        if (size <= most) continue;
        most = size;
        worst_node = i;
      }
    most = std::max(most, per_size * nodes_.advance(du_.data(), trial_, here_));
  }
  count_turns();
  if (worst_node >= 0)
    step.worst = system_->nodes().node_name(worst_node);
  else if (worst_body >= 0)
    step.worst = format("body '{}'", system_->bodies()[worst_body].name);
  return most;
}

/// Search for the part of x_ at which no element is inverted; applies it and assembles there.
/// @returns whether none is.
bool StaticNewton::search(double most, StaticStep& step, ElementReport& elements) {
  const bool nodes = !system_->nodes().empty();
  const State before = nodes ? work_ : State{};
  const std::vector<double> unknowns = element_unknowns(*system_, trial_);
  double applied = 0.0, increment = 0.0;
  const auto shorten = [&](double part) {
    if (applied == 0.0) {
      increment = apply(part, step);
      step.increments.push_back(increment);
    } else {
      const std::vector<double> inside =
          part_way(unknowns, element_unknowns(*system_, trial_), part / applied);
      work_ = before;
      apply(part, step);
      set_element_unknowns(*system_, inside, trial_);
    }
    applied = part;
    return increment;
  };
  const auto merit = [&] {
    if (!(increment < kStaticDiverged)) return kAdmissible;
    elements = assemble();
    return elements.least_volume > 0.0 ? kAdmissible : kInadmissible;
  };
  return search_along(kUntilAdmissible, 1.0, most, shorten, merit);
}

StaticStep StaticNewton::solve(State& state, double load_factor, const State* start) {
  if (rows_) return solve_with_rows(state, load_factor);
  StaticStep step;
  step.load_factor = load_factor;
  enter(load_factor, state.t);
  start_at(state);
  if (start && free_part(state.node_x.data(), start->node_x.data()) < 1.0) start = nullptr;
  if (start) work_ = *start;
  x_before_.clear();
  kinks_.clear();
  resisted_ = shifted_ = false;
  start_scratch(work_);
  choose_scale();
  const auto fail = [&](std::string reason) {
    step.reason = std::move(reason);
    return step;
  };
  ElementReport elements = assemble();
  const auto inverted = [&] {
    step.worst = system_->nodes().element_name(nodes_.worst_group(), elements.worst_element);
    if (elements.least_volume == RunningCable::kNoLine)
      return fail(
          "a point of a cable is inside of an obstacle, or the cable comes to its other side");
    return fail(format("an element is inverted (det F = {:.2g})", elements.least_volume));
  };
  if (!(elements.least_volume > 0.0)) return inverted();
  for (;;) {
    const Balance balance = balanced(step);
    aim(given_);
    const bool arrived =
        std::all_of(given_.begin(), given_.end(), [](double d) { return d == 0.0; });
    const std::size_t n = step.increments.size();
    if (balance != Balance::off && arrived) {
      // At rounding level a slender wire may still carry a different load: the iteration continues.
      if (n == 0 && step.residual <= options_.residual * force_) break;
      const double e = n > 0 ? step.increments[n - 1] : 1.0;
      // With a shift in the matrix a rate near one is the true rate.
      const double rate = std::min(n > 1 ? e / step.increments[n - 2] : e, shifted_ ? 1.0 : 0.99);
      if (e <= options_.tolerance || e * rate <= options_.tolerance * (1.0 - rate)) break;
      if (balance == Balance::rounded && e < kClose) break;  // no further improvement
    }
    if (arrived && balanced_on_a_kink(step)) break;
    if (stopped()) return fail("stopped");
    if (step.iterations == options_.max_iterations)
      return fail(format("has not converged in {} iterations", options_.max_iterations));
    ++step.iterations;
    if (!factor_and_solve(step))
      return fail("the linear system is singular, or a value is not finite");
    double turn = 0.0;
    for (int b = 0; b < system_->body_count(); ++b)
      turn = std::max(turn, x_.segment<3>(6 * b + 3).norm());
    const double most =
        std::min(turn > kRotationCap ? kRotationCap / turn : 1.0, free_part_of_increment());
    if (!search(most, step, elements)) return inverted();
    if (!(step.increments.back() < kStaticDiverged)) return fail("diverges");
  }
  if (const std::string refusal = refused(step); !refusal.empty()) return fail(refusal);
  step.converged = true;
  commit(state, load_factor);
  count_unstable(step);
  return step;
}

/// Assembles residual and tangent at work_ with the actual stresses instead of the extrapolated
/// ones of Newton's iterations.
void StaticNewton::assemble_unmixed() {
  const bool mixed = mixed_;
  mixed_ = false;
  nodes_.set_static(true, false);
  assemble();
  mixed_ = mixed;
  nodes_.set_static(true, mixed_);
}

void StaticNewton::assemble_at(const State& state, double load_factor) {
  enter(load_factor, load_factor);
  start_at(state);
  start_scratch(work_);
  if (rows_) rows_->begin(state);
  choose_scale();
  if (rows_) rows_->recall(state);
  hold_ = true;
  assemble_unmixed();
  matrix_.make_hessian(moments_);
}

/// Assembles as in a dynamic step at whose end the rate is Dv/Dx, without inertia.
/// @eq{modes-damped}
void StaticNewton::assemble_with_rates(double rate) {
  trial_.context.ga.c = rate * trial_.context.dt;
  // About a state of rest prescribed components rest, too.
  trial_.prescribed_v.assign(system_->nodes().prescribed().size(), 0.0);
  const bool mixed = mixed_;
  mixed_ = false;
  nodes_.set_static(false, false);
  start_scratch(work_);
  assemble();
  matrix_.make_hessian(moments_);
  mixed_ = mixed;
  nodes_.set_static(true, mixed_);
  trial_.context.ga.c = 0.0;
}

}  // namespace polhode
