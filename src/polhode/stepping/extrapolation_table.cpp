// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string>

#include <polhode/dynamics/extrapolation.hpp>
#include <polhode/equations/node_motion.hpp>
#include <polhode/math/quaternion.hpp>
#include <polhode/stepping/extrapolation_table.hpp>
#include <polhode/stepping/instant.hpp>
#include <polhode/stepping/member_threads.hpp>
#include <polhode/stepping/step_control.hpp>
#include <polhode/stepping/step_error.hpp>

namespace polhode {

namespace {

/// Rates of constraints after their projection, relative to the largest speed: rounding is a
/// thousandth of it, and rows that contradict each other leave a part of the speed.
constexpr double kProjectedRates = 1e-10;

/// Cayley vector of the rotation of a unit quaternion: χ = 2 tan(φ/2) n.
Vec3 cayley_vector(const Quat& q) { return 2.0 / q.w() * q.vec(); }

/// Whether interactions of a kind remember coordinates at t_n, which follow from positions, and
/// sums that a step of no length leaves as they are.
bool remembers_coordinates(const std::string& kind) {
  constexpr std::array kEndings = {"al_spring", "_motor", "_servo", "gear", "screw", "coupling"};
  return std::any_of(kEndings.begin(), kEndings.end(),
                     [&](const char* ending) { return kind.ends_with(ending); });
}

/// Weights of members first to end−1 of a table.
std::vector<double> weights_of(const std::vector<int>& counts, std::size_t first, std::size_t end) {
  return member_weights({counts.begin() + static_cast<std::ptrdiff_t>(first),
                         counts.begin() + static_cast<std::ptrdiff_t>(end)});
}

}  // namespace

ExtrapolationTable::ExtrapolationTable(const System& system, int order, const SingleStep& single,
                                       int threads)
    : system_(&system),
      counts_(extrapolation_substeps(order)),
      combined_history_(system.initial_state().history.size(), 0),
      members_(counts_.size()),
      solver_(std::make_unique<InstantSolver>(system)),
      threads_(MemberThreads::make(single, std::min(threads, static_cast<int>(counts_.size())))) {
  // Turns that are counted now and then, and the memories of events and controllers, which a step
  // does not change, are those of one member.
  for (int i = 0; i < static_cast<int>(system.interactions().size()); ++i) {
    const InteractionRef& ref = system.interactions()[static_cast<std::size_t>(i)];
    const InteractionTraits& traits = system.traits(ref);
    if (traits.lazy_history || traits.history_size == 0) continue;
    std::fill_n(combined_history_.begin() + ref.first_history, traits.history_size, 1);
    if (!traits.set_valued && remembers_coordinates(system.group(ref.group).kind()))
      coordinate_memories_.push_back(i);
  }
}

ExtrapolationTable::~ExtrapolationTable() = default;

double ExtrapolationTable::waited() const { return threads_ ? threads_->waited() : 0.0; }

NewtonReport ExtrapolationTable::advance(State& state, const std::vector<double>& parts, double H,
                                         SingleStep& single, const NewtonOptions& newton,
                                         const Way& way) {
  NewtonReport report;
  int iterations = 0;
  for (const double part : parts) {
    report = advance(state, part * H, single, newton, way);
    report.iterations = iterations += report.iterations;
    if (!report.converged) break;
  }
  return report;
}

NewtonReport ExtrapolationTable::advance(State& state, double H, SingleStep& single,
                                         const NewtonOptions& newton, const Way& way) {
  NewtonReport report;
  int iterations = 0;
  bool hard = false;
  std::vector<double> rounding;  // by member: increments of its substeps add up
  const auto columns = static_cast<std::size_t>(way.columns);
  difference_before_ = 0.0;
  const auto hopeless = [&] {
    if (columns < 3) return false;
    difference_before_ = compare_columns(columns - 1, H);
    // Factor by which the last member and one more reduce the leading error. The estimate of the
    // first column but one has a lower order and shows nothing.
    const double gain = counts_[columns - 1] * (counts_[columns - 1] + 2.0) / 4.0;
    difference_ = difference_before_ / gain;
    return columns > 3 && way.allowed > 0.0 && difference_before_ > gain * gain * way.allowed;
  };
  std::vector<MemberEnd> ends;
  if (threads_) {
    std::fill_n(members_.begin(), columns, state);
    ends =
        threads_->take({members_.data(), columns}, counts_, H, single, newton, way.fresh, hopeless);
  }
  for (std::size_t j = 0; j < columns; ++j) {
    MemberEnd end = threads_ ? std::move(ends[j]) : MemberEnd{};
    if (!threads_ || !end.report.converged) {
      // One that fails is taken again for what its single step then knows about it.
      members_[j] = state;
      end = take_member(members_[j], counts_[j], H, single, newton, way.fresh);
    }
    report = std::move(end.report);
    met_stop_ = end.met_stop;
    report.iterations = iterations += report.iterations;
    report.hard = hard = hard || report.hard;
    rounding.push_back(counts_[j] * report.rounding);
    const bool ends_here = !report.converged || met_stop_;
    gave_up_ = !ends_here && j + 2 == columns && hopeless();
    if (ends_here || gave_up_) {
      state.ledger.iterations += iterations;
      return report;
    }
  }
  single.ledger().forget();
  difference_ = compare_columns(columns, H);
  rounding_ = 0.0;
  const std::vector<double> weights = weights_of(counts_, 0, columns);
  for (std::size_t j = 0; j < columns; ++j) rounding_ += std::abs(weights[j]) * rounding[j];
  if (columns == 2) difference_before_ = state_difference(*system_, result_, members_[0], H);
  combine_ledger(state, columns, result_);
  result_.t = state.t + H;
  std::swap(state, result_);
  if (system_->rows() > 0) report = project(state, report, way.to_break);
  if (!report.converged) return report;
  bond_nodes(*system_, state);
  remember_coordinates(state);
  return report;
}

void ExtrapolationTable::remember_coordinates(State& state) const {
  for (const int i : coordinate_memories_) {
    const InteractionRef& ref = system_->interactions()[static_cast<std::size_t>(i)];
    const PairView view = system_->instant(state, ref, state.lambda.data());
    system_->group(ref.group).commit(ref.item, view.step(),
                                     state.history.data() + ref.first_history);
  }
}

/// Puts positions onto the joints, and velocities: at a kink of a drive onto those before it, as
/// their jump follows the step.
NewtonReport ExtrapolationTable::project(State& state, NewtonReport report, bool to_break) {
  report.converged = false;
  if (!solver_->assemble_positions(state).assembled) {
    report.reason = "the extrapolated positions cannot be assembled";
    return report;
  }
  const double t = state.t;
  // Limits of functions from the right are those of times which are nearer than this.
  if (to_break) state.t = beside(beside(t, TimeSide::kBefore), TimeSide::kBefore);
  const VelocityReport velocities = solver_->project_velocities(state);
  state.t = t;
  report.converged = velocities.residual <= kProjectedRates * velocities.scale;
  if (!report.converged)
    report.reason = "the extrapolated velocities cannot be projected onto the joints";
  return report;
}

double ExtrapolationTable::compare_columns(std::size_t last, double H) {
  // Members are combined relative to the last one, of which these are copies.
  other_ = result_ = members_[last - 1];
  combine(1, last, other_);
  combine(0, last, result_);
  return state_difference(*system_, result_, other_, H);
}

int ExtrapolationTable::worst_body(double H) const {
  // After an accepted step the result is the state that was given, at its start.
  return other_.blocks.empty() ? -1 : most_different_body(*system_, members_[0], other_, H);
}

/// The chart is centred at the last member: any smooth chart keeps the expansion in even powers,
/// and in this one rotations of the step may be large, equal values stay equal to the last bit, and
/// little is lost to rounding.
void ExtrapolationTable::combine(std::size_t first, std::size_t end, State& out) const {
  const State& last = members_[end - 1];
  const std::vector<double> weights = weights_of(counts_, first, end);
  const std::size_t others = weights.size() - 1;  // the last one's difference is zero
  for (int b = 0; b < system_->body_count(); ++b) {
    const BodyMotion centre = system_->motion(last, b);
    Vec3 r = Vec3::Zero(), chi = Vec3::Zero(), v = Vec3::Zero(), omega = Vec3::Zero();
    for (std::size_t j = 0; j < others; ++j) {
      const BodyMotion m = system_->motion(members_[first + j], b);
      const double w = weights[j];
      r += w * (m.r - centre.r);
      chi += w * cayley_vector(m.q * centre.q.conjugate());
      v += w * (m.v - centre.v);
      omega += w * (m.omega() - centre.omega());
    }
    BodyMotion m = centre;
    m.r += r;
    m.q = (quaternion_from_cayley(chi) * centre.q).normalized();
    m.v += v;
    m.W = m.q.conjugate() * (centre.omega() + omega);
    out.set_motion(system_->slot(b), m);
  }
  const auto field = [&](std::vector<double> State::*of, const char* which) {
    const std::vector<double>& centre = last.*of;
    for (std::size_t k = 0; k < centre.size(); ++k) {
      if (which != nullptr && which[k] == 0) continue;
      double sum = 0.0;
      for (std::size_t j = 0; j < others; ++j)
        sum += weights[j] * ((members_[first + j].*of)[k] - centre[k]);
      (out.*of)[k] = centre[k] + sum;
    }
  };
  field(&State::node_x, nullptr);
  field(&State::node_v, nullptr);
  field(&State::element_history, nullptr);
  field(&State::history, combined_history_.data());
}

void ExtrapolationTable::combine_ledger(const State& before, std::size_t members,
                                        State& out) const {
  const std::vector<double> weights = weights_of(counts_, 0, members);
  const auto combine = [&](auto sum) {
    double change = 0.0;
    for (std::size_t j = 0; j < members; ++j)
      change += weights[j] * (sum(members_[j].ledger).value() - sum(before.ledger).value());
    return change;
  };
  std::array<double, 3> impulse{}, angular{};
  const double dissipated = combine([](const Ledger& l) { return l.dissipated; });
  const double put_in = combine([](const Ledger& l) { return l.put_in; });
  std::int64_t iterations = before.ledger.iterations;
  double constraint_max = 0.0;
  for (std::size_t j = 0; j < members; ++j) {
    const State& member = members_[j];
    iterations += member.ledger.iterations - before.ledger.iterations;
    constraint_max = std::max(constraint_max, member.ledger.constraint_max);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    impulse[i] = combine([i](const Ledger& l) { return l.impulse[i]; });
    angular[i] = combine([i](const Ledger& l) { return l.angular_impulse[i]; });
  }
  Ledger& l = out.ledger;
  l.iterations = iterations;
  l.constraint_max = constraint_max;
  l.dissipated = before.ledger.dissipated;
  l.put_in = before.ledger.put_in;
  l.impulse = before.ledger.impulse;
  l.angular_impulse = before.ledger.angular_impulse;
  l.dissipated.add(dissipated);
  l.put_in.add(put_in);
  for (std::size_t i = 0; i < 3; ++i) {
    l.impulse[i].add(impulse[i]);
    l.angular_impulse[i].add(angular[i]);
  }
}

}  // namespace polhode
