// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/assert.hpp>
#include <polhode/newton/globalization.hpp>

#include <algorithm>
#include <limits>

#include <polhode/equations/node_motion.hpp>

namespace polhode {

namespace {

/// Part of the clearance to a barrier that an iteration must leave.
constexpr double kLeave = 0.1;
/// Reduction of step fractions, as the path to a barrier is not straight.
constexpr double kShorterWay = 0.98;
constexpr int kMaxRepeats = 20;
/// Increment above which growth is undone, factor by which it has to grow, and damping below which
/// it is accepted.
constexpr double kLarge = 0.05, kGrowth = 2.0, kLeastDamping = 0.2;

double smallest(const std::vector<double>& clearances) {
  double least = std::numeric_limits<double>::infinity();
  for (const double c : clearances) least = std::min(least, c);
  return least;
}

}  // namespace

Globalization::Globalization(const System& system, const State& state, Trial& trial,
                             NewtonEngine& engine, bool undoes_growth)
    : system_(system),
      state_(state),
      trial_(trial),
      engine_(engine),
      undoes_growth_(undoes_growth) {
  const Nodes& nodes = system.nodes();
  for (int g = 0; g < nodes.group_count(); ++g)
    if (const BarrierConstraint* points = nodes.group(g).barrier_constraint())
      points_.push_back({points, state.element_history.data() + nodes.first_history(g)});
  barriers_ = !system.barriers().empty() || !points_.empty();
}

void Globalization::measure(std::vector<double>& clearance) const {
  clearance.clear();
  for (int i : system_.barriers()) {
    const InteractionRef& ref = system_.interactions()[i];
    const PairView view = pair_view(system_, state_, trial_, ref);
    clearance.push_back(system_.group(ref.group).clearance(ref.item, view.step()));
  }
  if (points_.empty()) return;
  const NodeStep step = node_step(state_, trial_);
  for (const Watched& w : points_) w.points->clearances(step, w.history, clearance);
}

void Globalization::measure_start() {
  measure(from_);
  if (!points_.empty()) from_x_ = trial_.node_x;
}

double Globalization::admissible_part() const {
  double most = 1.0;
  for (std::size_t i = 0; i < from_.size(); ++i) {
    const double leave = kLeave * std::min(from_[i], 1.0);
    if (to_[i] >= leave) continue;
    const double way = from_[i] - to_[i];
    most = std::min(most, way > 0.0 ? kShorterWay * (from_[i] - leave) / way : 0.0);
  }
  if (points_.empty()) return most;
  const NodeStep to = node_step(state_, trial_);
  NodeStep from = to;
  from.x_n1 = from_x_.data();
  for (const Watched& w : points_) {
    const double free = w.points->free_part(from, to, w.history);
    if (free < 1.0) most = std::min(most, kShorterWay * free);
  }
  return most;
}

void Globalization::limit_prediction() {
  if (!barriers_) return;
  const std::vector<TrialBlock> predicted = trial_.blocks;
  const std::vector<double> node_u = trial_.node_u;
  const auto go = [&](double part) {
    std::copy(predicted.begin(), predicted.end(), trial_.blocks.begin());
    trial_.node_u = node_u;
    shorten_motion(system_, state_, part, trial_);
  };
  measure(to_);
  near_ = smallest(to_) < 1.0;
  if (!near_ && points_.empty()) return;
  go(0.0);
  measure_start();
  go(1.0);
  double taken = 1.0;
  for (int repeat = 0; repeat < kMaxRepeats; ++repeat) {
    const double fits = admissible_part();
    POLHODE_ASSERT(fits >= 0.0);
    if (fits >= 1.0) break;
    taken = repeat + 1 < kMaxRepeats ? taken * fits : 0.0;
    go(taken);
    measure(to_);
  }
}

void Globalization::keep(double last) {
  large_ = undoes_growth_ && last > kLarge;
  if (barriers_) measure_start();
  if (!barriers_ && !large_) return;
  engine_.end_step(state_, trial_);  // stores the multipliers in the trial
  iterate_.keep(system_, trial_);
}

void Globalization::go_back() {
  iterate_.restore(system_, trial_);
  engine_.resume(state_, trial_);
}

Iteration Globalization::limit(Iteration done, bool refactor) {
  if (!barriers_) return done;
  double applied = 1.0;
  for (int repeat = 0; done.solved && repeat < kMaxRepeats; ++repeat) {
    measure(to_);
    const double fits = admissible_part();
    POLHODE_ASSERT(fits >= 0.0);
    if (fits >= 1.0) break;
    applied *= fits;
    go_back();
    done = engine_.iterate(state_, trial_, refactor, damping_ * applied);
  }
  near_ = std::min(smallest(from_), smallest(to_)) < 1.0;
  done.applied *= applied;
  return done;
}

void Globalization::undo_growth(double increment, double last) {
  undone_ = large_ && increment > kGrowth * last && damping_ >= kLeastDamping;
  damping_ = undone_ ? 0.5 * damping_ : std::min(1.0, 2.0 * damping_);
  POLHODE_ASSERT(damping_ > 0.0 && damping_ <= 1.0);
  if (undone_) go_back();
}

Iteration Globalization::iterate(double last, bool refactor) {
  keep(last);
  undone_ = false;
  const Iteration done = limit(engine_.iterate(state_, trial_, refactor, damping_), refactor);
  if (done.solved && !near_) undo_growth(done.increment, last);
  return done;
}

}  // namespace polhode
