// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/core/error.hpp>
#include <polhode/equations/body_contact_assembler.hpp>

namespace polhode {

BodyContactAssembler::BodyContactAssembler(const System& system)
    : system_(&system), contacts_(system.contacts().get()) {
  if (!contacts_)
    throw InputError("solver", "the system has no contacts", "Choose an engine without contact");
  contacts_->prepare(system);
  const auto n = static_cast<std::size_t>(system.body_count());
  steps_.resize(n + 1);
  increments_.assign(n, Vec6::Zero());
  take_pairs();
}

bool BodyContactAssembler::take_pairs() {
  const std::vector<Participants>& now = contacts_->pairs();
  if (std::equal(
          known_.begin(), known_.end(), now.begin(), now.end(),
          [](const Participants& x, const Participants& y) { return x.a == y.a && x.b == y.b; }))
    return true;
  known_ = now;
  place_.clear();
  couplings_.clear();
  for (const Participants& p : known_) {
    const bool both = p.a != kGround && p.b != kGround;
    place_.push_back(both ? static_cast<int>(couplings_.size()) : -1);
    if (both) couplings_.push_back({p.a, p.b, 0, 0});
  }
  terms_.resize(known_.size());
  for (PairTerms& t : terms_) t.set_zero();
  return false;
}

void BodyContactAssembler::take_steps(const State& state, const Trial& trial) {
  for (int b = 0; b < system_->body_count(); ++b) steps_[b] = body_step(*system_, state, trial, b);
  steps_.back() = BodyStep::ground(trial.context.ga.alpha_f);
}

bool BodyContactAssembler::begin_step(const State& state, const Trial& trial) {
  take_steps(state, trial);
  start_ = steps_;
  for (int b = 0; b < system_->body_count(); ++b) {
    start_[b].r_n1 = start_[b].r_n;
    start_[b].Lambda_n1 = start_[b].Lambda_n;
    start_[b].u = start_[b].theta = Vec3::Zero();
    increments_[b] << steps_[b].u, steps_[b].theta;
  }
  contacts_->begin_step(state, start_, trial.context);
  contacts_->cover(start_, trial.context, increments_);
  return take_pairs();
}

double BodyContactAssembler::free_part() { return contacts_->filter(start_, increments_); }

bool BodyContactAssembler::cover(const Trial& trial, const Vec& x) {
  for (int b = 0; b < system_->body_count(); ++b) increments_[b] = x.segment<6>(6 * b);
  contacts_->cover(steps_, trial.context, increments_);
  return take_pairs();
}

void BodyContactAssembler::evaluate(const State& state, const Trial& trial, bool tangents) {
  take_steps(state, trial);
  StepContext context = trial.context;
  context.tangents = tangents;
  contacts_->evaluate(steps_, context, terms_);
}

void BodyContactAssembler::add_wrenches(double scale, Vec& rhs) const {
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    const auto& [a, b] = known_[k];
    if (a != kGround) rhs.segment<6>(6 * a) += scale * terms_[k].wrench_a;
    if (b != kGround) rhs.segment<6>(6 * b) += scale * terms_[k].wrench_b;
  }
}

void BodyContactAssembler::add_tangents(double scale, linear::KktValues& values,
                                        std::span<linear::KktValues::Pair> pairs) const {
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    const auto& [a, b] = known_[k];
    const PairTerms& t = terms_[k];
    if (a != kGround) values.diagonal[a] -= scale * t.D_aa;
    if (b != kGround) values.diagonal[b] -= scale * t.D_bb;
    if (place_[k] < 0) continue;
    linear::KktValues::Pair& v = pairs[static_cast<std::size_t>(place_[k])];
    v.K_ab = -scale * t.D_ab;
    v.K_ba = -scale * t.D_ba;
  }
}

void BodyContactAssembler::end_step(const State& state, const Trial& trial) {
  evaluate(state, trial, false);
  ground_force_.setZero();
  ground_moment_.setZero();
  const double alpha_f = trial.context.ga.alpha_f;
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    const auto& [a, b] = known_[k];
    if (b != kGround) continue;
    const Vec3 f = terms_[k].wrench_a.head<3>();
    ground_force_ += f;
    ground_moment_ +=
        (steps_[a].r_n + alpha_f * steps_[a].u).cross(f) + terms_[k].wrench_a.tail<3>();
  }
}

void BodyContactAssembler::add_ground_wrench(double* force, double* moment) const {
  for (int i = 0; i < 3; ++i) {
    force[i] += ground_force_[i];
    moment[i] += ground_moment_[i];
  }
}

double BodyContactAssembler::stored(const State& state) const {
  std::vector<BodyStep> instants(steps_.size());
  for (int b = 0; b < system_->body_count(); ++b) instants[b] = system_->instant(state, b);
  instants.back() = BodyStep::ground(1.0);
  return contacts_->stored(state, instants);
}

Work BodyContactAssembler::commit(State& state, const Trial& trial) {
  take_steps(state, trial);
  return contacts_->commit(state, steps_, trial.context);
}

}  // namespace polhode
