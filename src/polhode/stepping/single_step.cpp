// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cmath>

#include <polhode/beams/slide_on_beam.hpp>
#include <polhode/core/assert.hpp>
#include <polhode/core/format.hpp>
#include <polhode/engines/tree_engine.hpp>
#include <polhode/equations/node_motion.hpp>
#include <polhode/kernels/denormals.hpp>
#include <polhode/newton/rank_report.hpp>
#include <polhode/stepping/contradiction.hpp>
#include <polhode/stepping/instant.hpp>
#include <polhode/stepping/single_step.hpp>
#include <polhode/stepping/stored_rates.hpp>
#include <polhode/system/impulsive_contacts.hpp>
#include <polhode/system/regular_state.hpp>

namespace polhode {

namespace {

using Clock = std::chrono::steady_clock;

double seconds(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

/// Rotation of bodies in a step below which two axes cannot change from parallel to opposite.
constexpr double kNoMirrorBelow = 0.8;
/// Degree of the extrapolation of nodes' velocities.
constexpr int kNodeDegree = 0;
/// Rotation at which turns are counted, before two bodies can have a relative rotation of half a
/// turn within one more step like the last [rad].
constexpr double kCountTurnsBefore = 2.5;

/// Weights that extrapolate the stored mean velocities to the middle of the next step.
PredictWeights extrapolation(const State& state, double middle, int degree) {
  PredictWeights w;
  const int count = std::min(state.past_count, degree + 1);
  int used[kPast];
  for (int k = 0; k < count; ++k) used[k] = (state.past_next - 1 - k + 2 * kPast) % kPast;
  for (int k = 0; k < count; ++k) {
    double way = 1.0, spread = 1.0;
    for (int j = 0; j < count; ++j) {
      if (j == k) continue;
      way *= middle - state.past_time[used[j]];
      spread *= state.past_time[used[k]] - state.past_time[used[j]];
    }
    if (spread == 0.0) return {};  // two stages with the same middle: start from v_n
    w.weight[used[k]] = way / spread;
  }
  w.count = count;
  return w;
}

}  // namespace

SingleStep::SingleStep(const System& system, std::unique_ptr<NewtonEngine> engine,
                       const GeneralizedAlpha& ga, const LaneKernels& kernels, bool conserving)
    : system_(&system),
      engine_(std::move(engine)),
      kernels_(&kernels),
      ledger_(system, kernels, *engine_),
      impacts_(system),
      rows_(system),
      mass_(mass_blocks(system)) {
  trial_.context.ga = ga;
  trial_.context.conserving = conserving;
  size_blocks(system.initial_state(), trial_);
  trial_.lambda.resize(system.rows());
  trial_.lambda_centre.resize(system.rows());
  if (LeastReactions::may_act(system)) {
    // The model's own start, so that a restart from any state decides alike.
    State start = system.initial_state();
    (void)assemble_positions(system, start);
    reactions_.emplace(system, start);
    if (!reactions_->act()) reactions_.reset();
  }
  for (int i = 0; i < static_cast<int>(system.interactions().size()); ++i) {
    const InteractionRef& ref = system.interactions()[i];
    const InteractionGroup& group = system.group(ref.group);
    if (group.traits(ref.item).always_queried) always_queried_.push_back(i);
    if (group.traits(ref.item).history_size > 0)
      (group.traits(ref.item).lazy_history ? lazy_ : eager_).push_back(i);
  }
}

std::unique_ptr<SingleStep> SingleStep::another() const {
  std::unique_ptr<NewtonEngine> engine = engine_->another();
  if (!engine) return nullptr;
  const StepContext& c = trial_.context;
  return std::make_unique<SingleStep>(*system_, std::move(engine), c.ga, *kernels_, c.conserving);
}

void SingleStep::predict(const State& state, const Predictor& predictor) {
  const StepContext& c = trial_.context;
  const PredictWeights weights = predictor.degree < 0
                                     ? PredictWeights{}
                                     : extrapolation(state, c.t_n + 0.5 * c.dt, predictor.degree);
  // Solids have undamped vibrations that polynomials of high degree do not follow.
  const PredictWeights node_weights =
      predictor.degree < 0
          ? PredictWeights{}
          : extrapolation(state, c.t_n + 0.5 * c.dt, std::min(predictor.degree, kNodeDegree));
  kernels_->predict(state.blocks.data(), mass_.data(), trial_.blocks.data(),
                    static_cast<int>(state.blocks.size()), c.dt, &weights);
  std::copy(state.lambda.begin(), state.lambda.end(), trial_.lambda.begin());
  predict_nodes(*system_, state, trial_, node_weights);
  if (!predictor.remember) return;
  predicted_ = trial_.blocks;
  predicted_nodes_ = trial_.node_u;
  if (weights.count < 2) return;
  // The prediction of nodes differs from the one that estimates their error.
  const std::size_t n = predicted_nodes_.size();
  for (std::size_t k = 0; k < n; ++k) {
    double v = 0.0;
    for (int p = 0; p < kPast; ++p) v += weights.weight[p] * state.node_past[p * n + k];
    predicted_nodes_[k] = c.dt * v;
  }
  for (const PrescribedComponent& p : system_->nodes().prescribed()) {
    const std::size_t k = 3 * static_cast<std::size_t>(p.node) + p.component;
    predicted_nodes_[k] = trial_.node_u[k];
  }
}

NewtonReport SingleStep::take(State& state, double dt, const NewtonOptions& options,
                              Predictor predictor) {
  POLHODE_ASSERT(std::isfinite(dt) && dt != 0.0);  // stages of compositions also go back
  [[maybe_unused]] const DenormalsAreZero tiny_is_zero;
  const Clock::time_point t0 = Clock::now();
  trial_.context.t_n = state.t;
  trial_.context.dt = dt;
  adapt_stored_rates(state, trial_.context.ga, dt);
  predict(state, predictor);
  const Clock::time_point t1 = Clock::now();
  NewtonOptions scaled = options;
  scaled.energy_scale = state.ledger.energy_scale;
  if (reactions_) scaled.reactions = &*reactions_;
  NewtonReport report = solve_newton(*system_, state, trial_, *engine_, scaled);
  const Clock::time_point t2 = Clock::now();
  seconds_[0] += seconds(t0, t1);
  seconds_[1] += seconds(t1, t2);
  state.ledger.iterations += report.iterations;
  open_.reset();
  if (report.converged && (is_open(state, report) || refused(state, report)))
    report.converged = false;
  if (!report.converged) {
    restore_stored_rates(state);
    return report;
  }
  const bool watches = predictor.remember || predictor.watch_stops;
  if (predictor.remember) estimate_error();
  if (watches) stopped_ = meets_barrier(state);

  ledger_.before_commit(state, trial_);
  ledger_.add(state, engine_->commit(state, trial_));
  impacts_.find(state, trial_);
  commit_histories(state, report.rotation);
  std::copy(trial_.lambda.begin(), trial_.lambda.end(), state.lambda.begin());
  const GeneralizedAlpha& ga = trial_.context.ga;
  TreeView method;
  method.dt = dt;
  method.beta = ga.beta;
  method.gamma = ga.gamma;
  method.c = ga.c;
  method.c_A = ga.c_A;
  kernels_->commit(state.blocks.data(), mass_.data(), trial_.blocks.data(),
                   static_cast<int>(state.blocks.size()), &method, state.past_next);
  commit_nodes(*system_, state, trial_);
  renew_stored_rates(state, ga, dt);
  state.past_time[state.past_next] = state.t + 0.5 * dt;
  state.past_next = (state.past_next + 1) % kPast;
  state.past_count = std::min(kPast, state.past_count + 1);
  state.t += dt;  // drives act in impacts with their velocity at t_{n+1}
  impacts_.find_turns(state);
  if (BodyContacts* contacts = engine_->contacts(); contacts && contacts->touched()) {
    ledger_.add(state, impacts_.find(state, *contacts));
    // Measured: steps then start best from the velocities at t_n.
    if (!are_rows(contacts)) state.past_count = 0;
  }
  if (watches) stopped_ = stopped_ || impacts_.touched();
  impacts_.leave_still(state);
  jumped_ = impacts_.any();
  if (jumped_) {
    const BodySums before = ledger_.sums(state);
    const Work work = impacts_.settle(state);
    ledger_.add_jump(state, before, impacts_.drive_work());
    ledger_.add(state, work);
    impacts_.report(state.t, state.ledger.impacts);
  }
  state.dt_last = dt;
  state.ledger.constraint_max = std::max(state.ledger.constraint_max, report.constraints.residual);
  POLHODE_ASSERT(is_regular(state));
  ledger_.after_commit(state, trial_);
  seconds_[2] += seconds(t2, Clock::now());
  return report;
}

/// Small increments do not close rows that contradict each other: with the proximal iteration the
/// bodies stay where the gaps are smallest, and the multipliers grow for ever. @eq{row-tolerance}
bool SingleStep::is_open(const State& state, NewtonReport& report) {
  if (system_->rows() == 0) return false;
  contradicting_.clear();
  const bool holds = rows_.surely_hold(report.constraints, to_round_off_) ||
                     rows_.hold(state, trial_, to_round_off_);
  // Their tolerance is that of singular positions. Drives that contradict each other have none, and
  // their multipliers grow at any gap.
  if (holds && (!report.leaks || to_round_off_ || system_->drives().empty() ||
                rows_.hold(state, trial_, true)))
    return false;
  if (!system_->drives().empty()) contradicting_ = held_open(*system_, state, rows_.gaps());
  if (holds && contradicting_.empty()) return false;
  open_ = rows_.open();
  report.reason =
      format("{} remains at {}", open_->gap_text(), interaction_name(*system_, open_->interaction));
  report.worst.clear();
  return true;
}

bool SingleStep::refused(const State& state, NewtonReport& report) const {
  const auto refuses = [&](const InteractionRef& ref) {
    const PairView view = pair_view(*system_, state, trial_, ref);
    const InteractionGroup& group = system_->group(ref.group);
    if (group.acceptable(ref.item, view.step())) return false;
    report.reason =
        format("{} '{}': {}", group.kind(), system_->name(ref), group.traits(ref.item).refusal);
    report.worst.clear();
    return true;
  };
  for (int i : always_queried_)
    if (refuses(system_->interactions()[i])) return true;
  const Nodes& nodes = system_->nodes();
  for (int g = 0; g < nodes.group_count(); ++g) {
    const SlideOnBeam* slide = as_slide(nodes.group(g));
    if (!slide) continue;
    std::string reason = slide->refusal(trial_.element_scratch.data() + nodes.first_scratch(g));
    if (reason.empty()) continue;
    report.reason = std::move(reason);
    report.worst.clear();
    return true;
  }
  if (report.rotation <= kNoMirrorBelow) return false;
  for (const InteractionRef& ref : system_->interactions())
    if (ref.rows > 0 && refuses(ref)) return true;
  return false;
}

void SingleStep::commit_histories(State& state, double rotation) {
  const auto commit = [&](int interaction) {
    const InteractionRef& ref = system_->interactions()[interaction];
    const PairView view = pair_view(*system_, state, trial_, ref);
    double* history = state.history.data() + ref.first_history;
    system_->group(ref.group).commit(ref.item, view.step(), history);
  };
  for (int i : eager_) commit(i);
  if (lazy_.empty()) return;
  state.turned += 2.0 * rotation;  // two bodies may rotate in opposite directions
  if (state.turned + 2.0 * rotation <= kCountTurnsBefore) return;
  for (int i : lazy_) commit(i);
  state.turned = 0.0;
}

void SingleStep::estimate_error() {
  double most = 0.0;
  const double per_length = 1.0 / system_->length_scale();
  for (int s = 0; s < system_->tree().slots; ++s) {
    if (system_->tree().body_of_slot[s] < 0) continue;
    const TrialBlock& t = trial_.blocks[s / kLanes];
    const TrialBlock& p = predicted_[s / kLanes];
    const int l = s % kLanes;
    double moved = 0.0, turned = 0.0, angle = 0.0;
    for (int i = 0; i < 3; ++i) {
      moved = std::hypot(moved, t.u[i][l] - p.u[i][l]);
      turned = std::hypot(turned, t.theta[i][l] - p.theta[i][l]);
      angle = std::hypot(angle, t.theta[i][l]);
    }
    most = std::max({most, per_length * moved, turned + angle * angle * angle});
  }
  for (std::size_t k = 0; k < predicted_nodes_.size(); ++k)
    most = std::max(most, per_length * std::abs(trial_.node_u[k] - predicted_nodes_[k]));
  error_ = most / 12.0;
}

bool SingleStep::meets_barrier(const State& state) const {
  return std::any_of(system_->barriers().begin(), system_->barriers().end(), [&](int i) {
    const InteractionRef& ref = system_->interactions()[static_cast<std::size_t>(i)];
    const InteractionGroup& group = system_->group(ref.group);
    const PairView at_n1 = pair_view(*system_, state, trial_, ref);
    const PairView at_n = system_->instant(state, ref, nullptr);
    return group.clearance(ref.item, at_n1.step()) < 1.0 ||
           group.clearance(ref.item, at_n.step()) < 1.0;
  });
}

std::vector<std::pair<std::string, double>> SingleStep::phases() const {
  return {{"predictor", seconds_[0]}, {"newton", seconds_[1]}, {"acceptance", seconds_[2]}};
}

}  // namespace polhode
