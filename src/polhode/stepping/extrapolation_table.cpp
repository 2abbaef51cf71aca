// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <numeric>

#include <polhode/dynamics/extrapolation.hpp>
#include <polhode/equations/node_motion.hpp>
#include <polhode/math/quaternion.hpp>
#include <polhode/stepping/extrapolation_table.hpp>
#include <polhode/stepping/instant.hpp>
#include <polhode/stepping/step_control.hpp>
#include <polhode/stepping/step_error.hpp>

namespace polhode {

namespace {

/// Rates of constraints after their projection, relative to the largest speed: rounding is a
/// thousandth of it, and rows that contradict each other leave a part of the speed.
constexpr double kProjectedRates = 1e-10;

/// Cayley vector of the rotation of a unit quaternion: χ = 2 tan(φ/2) n.
Vec3 cayley_vector(const Quat& q) { return 2.0 / q.w() * q.vec(); }

}  // namespace

ExtrapolationTable::ExtrapolationTable(const System& system, int order)
    : system_(&system),
      counts_(extrapolation_substeps(order)),
      weights_(member_weights(counts_)),
      weights_before_(member_weights(std::vector<int>(counts_.begin() + 1, counts_.end()))),
      combined_history_(system.initial_state().history.size(), 0),
      members_(counts_.size()),
      solver_(std::make_unique<InstantSolver>(system)) {
  // Turns that are counted now and then, and the memories of events and controllers, which a step
  // does not change, are those of one member.
  for (const InteractionRef& ref : system.interactions()) {
    const InteractionTraits& traits = system.traits(ref);
    if (traits.lazy_history) continue;
    std::fill_n(combined_history_.begin() + ref.first_history, traits.history_size, 1);
  }
}

ExtrapolationTable::~ExtrapolationTable() = default;

int ExtrapolationTable::substeps() const {
  return std::accumulate(counts_.begin(), counts_.end(), 0);
}

NewtonReport ExtrapolationTable::advance(State& state, const std::vector<double>& parts, double H,
                                         SingleStep& single, const NewtonOptions& newton,
                                         bool fresh) {
  NewtonReport report;
  int iterations = 0;
  for (const double part : parts) {
    report = advance(state, part * H, single, newton, fresh);
    report.iterations = iterations += report.iterations;
    if (!report.converged) break;
  }
  return report;
}

NewtonReport ExtrapolationTable::advance(State& state, double H, SingleStep& single,
                                         const NewtonOptions& newton, bool fresh) {
  NewtonReport report;
  int iterations = 0;
  bool hard = false;
  for (std::size_t j = 0; j < counts_.size(); ++j) {
    State& member = members_[j];
    member = state;
    single.ledger().forget();
    for (int k = 0; k < counts_[j]; ++k) {
      const int degree = fresh && k == 0 ? -1 : step_control::kMemberDegree;
      report = single.take(member, H / counts_[j], newton, {degree});
      iterations += report.iterations;
      hard = hard || report.hard;
      report.iterations = iterations;
      if (!report.converged) {
        state.ledger.iterations += iterations;
        return report;
      }
    }
  }
  single.ledger().forget();
  report.hard = hard;
  // Members are combined relative to the last one, of which these are copies.
  other_ = result_ = members_.back();
  combine(weights_before_, 1, other_);
  combine(weights_, 0, result_);
  combine_ledger(state, result_);
  result_.t = state.t + H;
  difference_ = state_difference(*system_, result_, other_, H);
  std::swap(state, result_);
  if (system_->rows() > 0) {
    // Off the constraints by the error of the step.
    if (!solver_->assemble_positions(state).assembled) {
      report.converged = false;
      report.reason = "the extrapolated positions cannot be assembled";
      return report;
    }
    const VelocityReport velocities = solver_->project_velocities(state);
    if (!(velocities.residual <= kProjectedRates * velocities.scale)) {
      report.converged = false;
      report.reason = "the extrapolated velocities cannot be projected onto the joints";
      return report;
    }
  }
  bond_nodes(*system_, state);
  return report;
}

/// The chart is centred at the last member: any smooth chart keeps the expansion in even powers,
/// and in this one rotations of the step may be large, equal values stay equal to the last bit, and
/// little is lost to rounding.
void ExtrapolationTable::combine(const std::vector<double>& weights, std::size_t first,
                                 State& out) const {
  const State& last = members_.back();
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

void ExtrapolationTable::combine_ledger(const State& before, State& out) const {
  const auto combine = [&](auto sum) {
    double change = 0.0;
    for (std::size_t j = 0; j < members_.size(); ++j)
      change += weights_[j] * (sum(members_[j].ledger).value() - sum(before.ledger).value());
    return change;
  };
  std::array<double, 3> impulse{}, angular{};
  const double dissipated = combine([](const Ledger& l) { return l.dissipated; });
  const double put_in = combine([](const Ledger& l) { return l.put_in; });
  std::int64_t iterations = before.ledger.iterations;
  double constraint_max = 0.0;
  for (const State& member : members_) {
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
