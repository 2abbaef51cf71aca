// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/engines/tree_engine.hpp>
#include <polhode/loads/rotor.hpp>
#include <polhode/stepping/ledger.hpp>

namespace polhode {

namespace {

/// Relative rounding of a sum of numbers.
constexpr double kRounding = 16.0 * std::numeric_limits<double>::epsilon();
/// Largest drift reported for rounding alone, and for bodies that are at rest but for rounding.
constexpr double kReadsAs = 1e-10, kRestReadsAs = 1e-7;
/// Part of the energy that is rounding in the balance of one step [-].
constexpr double kImbalanceRounding = 1e-13;

/// Keeps the larger one; what is not a number stays: std::max() would forget it.
void keep_larger(double& largest, double value) {
  if (!std::isnan(largest) && !(value <= largest)) largest = value;
}

std::vector<int> with_work(const System& system) {
  std::vector<int> list;
  for (int i = 0; i < static_cast<int>(system.interactions().size()); ++i)
    if (const InteractionRef& ref = system.interactions()[i]; system.traits(ref).works)
      list.push_back(i);
  return list;
}

/// Whether an interaction is the moment of a rotor, whose momentum counts as that of a body.
bool is_rotor(const System& system, const InteractionRef& ref) {
  return system.group(ref.group).is_of(kTypeTag<Rotor>);
}

std::vector<int> on_the_ground(const System& system, const NewtonEngine& engine) {
  std::vector<int> list;
  for (int i = 0; i < static_cast<int>(system.interactions().size()); ++i) {
    const InteractionRef& ref = system.interactions()[i];
    const bool one_body = (ref.a == kGround) != (ref.b == kGround) && !engine.knows_ground(i) &&
                          !is_rotor(system, ref);
    if (one_body || system.traits(ref).holds_ground) list.push_back(i);
  }
  return list;
}

/// Joints of the tree with one body whose forces beside the rows the engine does not sum.
std::vector<int> beside_rows_on_the_ground(const System& system, const NewtonEngine& engine) {
  std::vector<int> list;
  for (int i = 0; i < static_cast<int>(system.interactions().size()); ++i) {
    const InteractionRef& ref = system.interactions()[i];
    if ((ref.a == kGround) != (ref.b == kGround) && engine.knows_ground(i) &&
        acts_beside_rows(system, i))
      list.push_back(i);
  }
  return list;
}

Vec3 vec(const double* x) { return {x[0], x[1], x[2]}; }

}  // namespace

EnergyLedger::EnergyLedger(const System& system, const LaneKernels& kernels,
                           const NewtonEngine& engine)
    : system_(&system),
      kernels_(&kernels),
      engine_(&engine),
      mass_(mass_blocks(system)),
      working_(with_work(system)),
      outside_(on_the_ground(system, engine)),
      outside_sweep_(system, on_the_ground(system, engine)),
      beside_rows_(system, beside_rows_on_the_ground(system, engine)),
      nodes_(system) {
  for (const BodyData& b : system.bodies()) total_mass_ += b.mass;
  for (int i = 0; i < system.nodes().count(); ++i) total_mass_ += system.nodes().node_mass(i);
  for (const auto& list : {working_, outside_})
    for (int i : list)
      for (int body : {system.interactions()[i].a, system.interactions()[i].b})
        if (body != kGround) touched_.push_back(body);
  std::sort(touched_.begin(), touched_.end());
  touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
  for (const InteractionRef& ref : system.interactions()) {
    const double mass = system.traits(ref).coupled_mass;
    const auto slot = [&](int body) { return body == kGround ? -1 : system.slot(body); };
    if (mass != 0.0) coupled_.push_back({slot(ref.a), slot(ref.b), mass});
  }
  for (const InteractionRef& ref : system.interactions()) {
    if (ref.rows == 0 || ref.further_part) continue;
    const auto basis = system.group(ref.group).describe(ref.item).motion_basis;
    const int forces = basis ? basis->translation_rows() : ref.rows;
    row_sizes_.push_back(
        {ref.first_row, forces, ref.rows - forces, system.slot(ref.a == kGround ? ref.b : ref.a)});
  }
  if (!touched_.empty()) steps_.resize(system.body_count() + 1);
}

BodySums EnergyLedger::sums(const State& state) const {
  BodySums s;
  const double g[3] = {system_->gravity()[0], system_->gravity()[1], system_->gravity()[2]};
  kernels_->sums(state.blocks.data(), mass_.data(), system_->tree().body_of_slot.data(),
                 static_cast<int>(state.blocks.size()), g, &s);
  nodes_.add_sums(state, s);
  const auto of = [&](const Lane3 BodyBlock::*member, int slot) -> Vec3 {
    if (slot < 0) return Vec3::Zero();
    const Lane3& x = state.blocks[static_cast<std::size_t>(slot / kLanes)].*member;
    return {x[0][slot % kLanes], x[1][slot % kLanes], x[2][slot % kLanes]};
  };
  for (const auto& [a, b, mass] : coupled_) {
    const Vec3 v = of(&BodyBlock::v, b) - of(&BodyBlock::v, a);
    s.kinetic -= 0.5 * mass * v.squaredNorm();
    if (a < 0 || b < 0) continue;  // the ground's side is external: its impulse is counted
    const Vec3 l = mass * (of(&BodyBlock::r, b) - of(&BodyBlock::r, a)).cross(v);
    for (int i = 0; i < 3; ++i) s.l[i] -= l[i];
  }
  for (const int i : working_) {  // @eq{rotor-work}
    const InteractionRef& ref = system_->interactions()[i];
    if (!is_rotor(*system_, ref)) continue;
    const Rotor& rotor =
        items_of<Rotor>(system_->group(ref.group))[static_cast<std::size_t>(ref.item)];
    const double* history = state.history.data() + ref.first_history;
    const BodyStep b = system_->instant(state, ref.b);
    const Vec3 momentum = rotor.added_momentum(b, history);
    s.kinetic += rotor.added_energy(b, history);
    s.l_scale += momentum.norm();
    for (int k = 0; k < 3; ++k) s.l[k] += momentum[k];
  }
  return s;
}

double EnergyLedger::stored(const State& state) const {
  double potential = nodes_.stored(state) + engine_->stored(state);
  for (int i : working_) {
    const InteractionRef& ref = system_->interactions()[i];
    const PairView view = system_->instant(state, ref, nullptr);
    potential += system_->group(ref.group).work(ref.item, view.step()).stored;
  }
  return potential;
}

void EnergyLedger::begin(State& state) {
  Ledger& l = state.ledger;
  l = Ledger{};
  at_n_ = sums(state);
  potential_ = stored(state);
  l.initial_potential = at_n_.gravity_potential + potential_;
  l.initial_energy = at_n_.kinetic + l.initial_potential;
  for (int i = 0; i < 3; ++i) {
    l.initial_p[i] = at_n_.p[i];
    l.initial_l[i] = at_n_.l[i];
  }
  l.energy_scale = at_n_.kinetic;
  l.p_scale = at_n_.p_scale;
  l.l_scale = at_n_.l_scale;
  sums_are_of_state_ = true;
}

void EnergyLedger::before_commit(State& state, Trial& trial) {
  if (!sums_are_of_state_) at_n_ = sums(state);
  Ledger& l = state.ledger;
  const double dt = trial.context.dt, alpha_f = trial.context.ga.alpha_f;
  for (int body : touched_) steps_[body] = body_step(*system_, state, trial, body);
  if (!steps_.empty()) steps_.back() = BodyStep::ground(alpha_f);
  const auto step_of = [&](int body) -> const BodyStep& {
    return body == kGround ? steps_.back() : steps_[body];
  };
  potential_ = 0.0;
  for (int i : working_) {
    const InteractionRef& ref = system_->interactions()[i];
    const PairStep step{step_of(ref.a), step_of(ref.b), trial.context,
                        trial.lambda.data() + ref.first_row,
                        state.history.data() + ref.first_history};
    const Work w = system_->group(ref.group).work(ref.item, step);
    potential_ += w.stored;
    l.dissipated.add(w.dissipated);
    l.put_in.add(w.put_in);
  }
  add_drives(state, trial);
  Vec3 impulse = Vec3::Zero(), turning = Vec3::Zero();
  potential_ += nodes_.close(l, state, trial, impulse, turning);
  engine_->add_ground_wrench(impulse.data(), turning.data());
  // Sums of magnitudes: terms that cancel, in a body or in the sums, leave their round-off.
  outside_force_ = impulse.norm();
  outside_moment_ = turning.norm();
  const auto add_ground = [&](const BodyStep& body, const Vec6& w) {
    const Vec3 r = body.r_n + alpha_f * body.u, f = w.head<3>(), m = w.tail<3>();
    impulse += f;
    turning += r.cross(f) + m;
    outside_force_ += f.norm();
    outside_moment_ += r.norm() * f.norm() + m.norm();
  };
  for (const RowSizes& rows : row_sizes_) {
    const double* lambda = trial.lambda.data() + rows.first_row;
    double f = 0.0, m = 0.0;
    for (int k = 0; k < rows.forces; ++k) f += std::abs(lambda[k]);
    for (int k = 0; k < rows.moments; ++k) m += std::abs(lambda[rows.forces + k]);
    const Lane3& r = state.blocks[static_cast<std::size_t>(rows.slot / kLanes)].r;
    const int lane = rows.slot % kLanes;
    outside_force_ += f;
    outside_moment_ += m + f * (std::abs(r[0][lane]) + std::abs(r[1][lane]) + std::abs(r[2][lane]) +
                                system_->length_scale());
  }
  StepContext values_only = trial.context;
  values_only.tangents = false;
  const auto add = [&](int interaction, const PairStep& step, const PairTerms& terms) {
    const InteractionRef& ref = system_->interactions()[interaction];
    if (ref.a != kGround) add_ground(step.a, terms.wrench_a);
    if (ref.b != kGround) add_ground(step.b, terms.wrench_b);
  };
  outside_sweep_.run(steps_, values_only, trial.lambda.data(), state.history.data(), add);
  beside_rows_.run(steps_, values_only, nullptr, state.history.data(), add);
  for (int i = 0; i < 3; ++i) {
    l.impulse[i].add(dt * impulse[i]);
    l.angular_impulse[i].add(dt * turning[i]);
  }
}

/// @eq{drive-work}
void EnergyLedger::add_drives(State& state, const Trial& trial) const {
  for (const int i : system_->drives()) {
    const InteractionRef& ref = system_->interactions()[i];
    const PairView view = pair_view(*system_, state, trial, ref);
    const PrescribedRows rows =
        system_->group(ref.group).prescribed(ref.item, view.step(), TimeSide::kBefore);
    for (int k = 0; k < ref.rows; ++k)
      state.ledger.put_in.add(trial.lambda[ref.first_row + k] * rows.increment[k]);
  }
}

void EnergyLedger::add(State& state, const Work& work) {
  potential_ += work.stored;
  state.ledger.dissipated.add(work.dissipated);
  state.ledger.put_in.add(work.put_in);
}

void EnergyLedger::add_jump(State& state, const BodySums& before, double work) {
  const BodySums after = sums(state);
  state.ledger.put_in.add(work);
  state.ledger.dissipated.add(work + before.kinetic - after.kinetic);
  add_impulses(state, before, after);
}

void EnergyLedger::add_driven_jump(State& state, const BodySums& before) {
  at_n_ = sums(state);
  state.ledger.put_in.add(at_n_.kinetic - before.kinetic);
  add_impulses(state, before, at_n_);
  if (!sums_are_of_state_) potential_ = stored(state);
  sums_are_of_state_ = true;
}

void EnergyLedger::add_switch(State& state, const BodySums& before, double lost, double potential) {
  Ledger& l = state.ledger;
  at_n_ = sums(state);
  l.dissipated.add(lost + std::max(0.0, -potential));
  l.put_in.add(at_n_.kinetic - before.kinetic + lost + std::max(0.0, potential));
  add_impulses(state, before, at_n_);
  potential_ = stored(state);
  sums_are_of_state_ = true;
}

void EnergyLedger::add_impulses(State& state, const BodySums& before, const BodySums& after) {
  for (int i = 0; i < 3; ++i) {
    state.ledger.impulse[i].add(after.p[i] - before.p[i]);
    state.ledger.angular_impulse[i].add(after.l[i] - before.l[i]);
  }
}

void EnergyLedger::after_commit(State& state, const Trial& trial) {
  at_n1_ = sums(state);
  const double dt = trial.context.dt, alpha_f = trial.context.ga.alpha_f;
  // Gravity: m g at the centres of mass, averaged as all positions are.
  const Vec3 moment = (1.0 - alpha_f) * vec(at_n_.mr) + alpha_f * vec(at_n1_.mr);
  const Vec3 f = total_mass_ * system_->gravity(), m = moment.cross(system_->gravity());
  Ledger& l = state.ledger;
  for (int i = 0; i < 3; ++i) {
    l.impulse[i].add(dt * f[i]);
    l.angular_impulse[i].add(dt * m[i]);
  }
  const double p = dt * (f.norm() + outside_force_), g = system_->gravity().norm();
  const double lever =
      dt * (g * moment.norm() + f.norm() * system_->length_scale() + outside_moment_);
  l.p_noise += (kRounding * p) * (kRounding * p);
  l.l_noise += (kRounding * lever) * (kRounding * lever);
  // A step closes gaps of rounding by velocities, which are all that bodies at rest have.
  if (total_mass_ > 0.0 && dt != 0.0) {
    const double reach = vec(at_n1_.mr).norm() / total_mass_ + system_->length_scale();
    const double v = 0.25 * kRounding * reach / dt;
    l.energy_noise = std::max(l.energy_noise, kReadsAs / kRestReadsAs * total_mass_ * v * v);
  }
  at_n_ = at_n1_;
  sums_are_of_state_ = true;
}

void EnergyLedger::close_step(State& state) {
  if (!sums_are_of_state_) {
    at_n_ = sums(state);
    potential_ = stored(state);
    sums_are_of_state_ = true;
  }
  Ledger& l = state.ledger;
  const BodySums& s = at_n_;
  const double potential = s.gravity_potential + potential_;
  const double energy = s.kinetic + potential;
  l.energy_scale = std::max(l.energy_scale, s.kinetic + std::abs(potential - l.initial_potential));
  l.p_scale = std::max(l.p_scale, s.p_scale);
  l.l_scale = std::max(l.l_scale, s.l_scale);
  keep_larger(l.energy_drift,
              std::abs(energy - l.initial_energy - l.put_in.value() + l.dissipated.value()));
  const double g = system_->gravity().norm();
  l.energy_noise = std::max(l.energy_noise,
                            kRounding * (s.kinetic + std::abs(potential_) + g * vec(s.mr).norm() +
                                         total_mass_ * g * system_->length_scale()));
  double p = 0.0, angular = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double dp = s.p[i] - l.initial_p[i] - l.impulse[i].value();
    const double dl = s.l[i] - l.initial_l[i] - l.angular_impulse[i].value();
    p += dp * dp;
    angular += dl * dl;
  }
  keep_larger(l.p_drift, std::sqrt(p));
  keep_larger(l.l_drift, std::sqrt(angular));
}

Drifts drifts(const Ledger& l) {
  const auto relative = [](double drift, double scale, double noise) {
    const double floor = std::max(scale, noise / kReadsAs);
    return floor > 0.0 ? drift / floor : drift;
  };
  return {relative(l.energy_drift, l.energy_scale, l.energy_noise),
          relative(l.p_drift, l.p_scale, std::sqrt(l.p_noise)),
          relative(l.l_drift, l.l_scale, std::sqrt(l.l_noise))};
}

Balance EnergyLedger::balance(const State& state) const {
  const BodySums s = sums(state);
  return {.kinetic = s.kinetic,
          .potential = s.gravity_potential + stored(state),
          .put_in = state.ledger.put_in.value(),
          .dissipated = state.ledger.dissipated.value(),
          .linear_momentum = vec(s.p),
          .angular_momentum = vec(s.l)};
}

double EnergyLedger::imbalance(const State& from, const State& to, double rounding) const {
  const auto kept = [](const Balance& b) {
    return b.kinetic + b.potential + b.dissipated - b.put_in;
  };
  const Balance before = balance(from), after = balance(to);
  const double missed = std::abs(kept(after) - kept(before));
  // A first tiny motion has less energy than others round.
  const double momenta =
      std::max(from.ledger.p_scale, std::sqrt(2.0 * total_mass_ * std::max(0.0, after.kinetic)));
  if (missed <=
      rounding * momenta + kImbalanceRounding * (after.kinetic + std::abs(after.potential)))
    return 0.0;
  const double scale = std::max(from.ledger.energy_scale, after.kinetic);
  return scale > 0.0 ? missed / scale : 0.0;
}

}  // namespace polhode
