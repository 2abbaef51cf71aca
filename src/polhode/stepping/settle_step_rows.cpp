// SPDX-License-Identifier: Apache-2.0
// Velocity problems of islands with contacts and stops that were rows of the step.
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/impulses/velocity_problem.hpp>
#include <polhode/stepping/impact_rows.hpp>
#include <polhode/system/history_record.hpp>

namespace polhode {

namespace {

/// Rounding of a velocity relative to the sum of its terms.
constexpr double kVelocityRounding = 64.0 * std::numeric_limits<double>::epsilon();
/// Rounding of positions relative to their size.
constexpr double kPlaceRounding = 8.0 * std::numeric_limits<double>::epsilon();

}  // namespace

/// Forces are those of the step, closed is that of t_n.
void ImpactResolver::find_unilateral(const State& state, const Trial& trial) {
  std::vector<UnilateralRow> found;
  for (const int i : system_->unilateral()) {
    const InteractionRef& ref = system_->interactions()[static_cast<std::size_t>(i)];
    const PairView view = pair_view(*system_, state, trial, ref);
    found.clear();
    system_->group(ref.group).unilateral_rows(ref.item, view.step(), found);
    int memory = ref.first_history + system_->traits(ref).unilateral_entry;
    for (const UnilateralRow& row : found) {
      const auto record = read_record<UnilateralMemory>(state.history.data() + memory);
      const bool was_closed = record.closed != 0.0, touches = row.gap_n1 <= system_->touching_gap();
      if (was_closed || touches) {
        Impact impact;
        impact.on_a = row.by_a;
        impact.on_b = row.by_b;
        impact.given = std::abs(trial.context.dt) * record.force;
        PairImpact& made = rows_.emplace_back(PairImpact{{ref.a, ref.b}, impact, {}});
        made.row = StepRow{.was_closed = was_closed,
                           .touches = touches,
                           .restitution = row.restitution,
                           .absorbed = row.gap_n <= system_->touching_gap()
                                           ? 0.0
                                           : -record.force * change_of_gap(row, view.a, view.b)};
        stops_.push_back(i);
        row_memories_.push_back(memory);
      }
      memory += static_cast<int>(kNumbersOf<UnilateralMemory>);
    }
  }
}

void ImpactResolver::leave_still(State& state) {
  if (system_->unilateral().empty()) return;
  if (std::any_of(rows_.begin(), rows_.end(),
                  [](const PairImpact& r) { return r.row && r.row->changes(); }))
    return;
  settled_.assign(rows_.size(), {});
  close_unilateral(state);
  rows_.clear();
  of_joints_ = before_contacts_ = 0;
}

void ImpactResolver::close_unilateral(State& state) const {
  for (std::size_t k = 0; k < row_memories_.size(); ++k) {
    const StepRow& row = *rows_[k].row;
    const ResolvedImpact& s = settled_[k];
    double* const memory = state.history.data() + row_memories_[k];
    auto record = read_record<UnilateralMemory>(memory);
    record.force += s.normal / std::abs(dt_);
    record.closed = (s.solved ? s.closed : row.was_closed && row.touches) ? 1.0 : 0.0;
    write_record(record, memory);
  }
}

double ImpactResolver::energy_of(const State& state, const Island& island,
                                 const std::vector<Vec6>& jumps) const {
  double sum = 0.0;
  std::vector<Vec6> by_body(static_cast<std::size_t>(system_->body_count()), Vec6::Zero());
  for (std::size_t i = 0; i < jumps.size(); ++i) {
    const BodyData& data = system_->bodies()[static_cast<std::size_t>(island.bodies[i])];
    const Vec3 W = system_->motion(state, island.bodies[i]).q.conjugate() * jumps[i].tail<3>();
    sum += 0.5 * data.mass * jumps[i].head<3>().squaredNorm() + 0.5 * W.dot(data.inertia * W);
    by_body[static_cast<std::size_t>(island.bodies[i])] = jumps[i];
  }
  const auto v = [&](int body) -> Vec3 {
    if (body == kGround) return Vec3::Zero();
    return by_body[static_cast<std::size_t>(body)].head<3>();
  };
  for (const InteractionRef& ref : system_->interactions())
    if (const double mass = system_->traits(ref).coupled_mass; mass != 0.0)
      sum -= 0.5 * mass * (v(ref.b) - v(ref.a)).squaredNorm();
  return sum;
}

bool ImpactResolver::has_step_rows(const Island& island) const {
  return std::any_of(island.rows.begin(), island.rows.end(),
                     [&](int k) { return rows_[static_cast<std::size_t>(k)].row.has_value(); });
}

/// @eq{velocity-problem}
void ImpactResolver::settle_step_rows(State& state, const Island& island, std::vector<Row> rows) {
  std::vector<Vec6> v = velocities(state, island);
  const std::vector<Vec6> start = v;
  bool closes = false, stopped = false;
  double rounding = 0.0;
  VelocityProblem problem;
  const auto n = static_cast<Eigen::Index>(rows.size());
  problem.A.resize(n, n);
  problem.lengths = Vec::Ones(n);
  problem.w.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    Row& row = rows[static_cast<std::size_t>(i)];
    row.before = problem.w[i] = row.speed(v);
    double terms = 0.0;
    for (const auto& [place, J] : row.on)
      terms += J.cwiseAbs().dot(v[static_cast<std::size_t>(place)].cwiseAbs());
    rounding = std::max(rounding, kVelocityRounding * terms);
    for (Eigen::Index j = 0; j <= i; ++j)
      problem.A(i, j) = problem.A(j, i) = row.speed_by(rows[static_cast<std::size_t>(j)]);
  }
  problem.rounding = rounding;
  double far = system_->length_scale();
  for (const int body : island.bodies)
    far = std::max(far, system_->motion(state, body).r.lpNorm<Eigen::Infinity>());
  problem.noise = 2.0 * kPlaceRounding * far / std::abs(dt_);
  problem.projected = island.projected;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Row& row = rows[static_cast<std::size_t>(i)];
    const PairImpact& contact = rows_[static_cast<std::size_t>(row.impact)];
    const Impact& impact = contact.impact;
    const StepRow& of_step = *contact.row;
    ContactRows c{.normal = i,
                  .was_closed = of_step.was_closed,
                  .stuck = of_step.stuck,
                  .touches = of_step.touches,
                  .restitution = of_step.restitution,
                  .impulse = impact.given,
                  .absorbed = of_step.absorbed};
    if (i + 1 < n && rows[static_cast<std::size_t>(i + 1)].has_friction) {
      c.tangents = i + 1;
      c.half_axes = {impact.mu, impact.mu_across, 0.0};
      c.friction = std::hypot(impact.along.dot(impact.friction_impulse) / impact.mu,
                              impact.across.dot(impact.friction_impulse) / impact.mu_across);
      i += 2;
    }
    const TurningRow& turning = of_step.turning;
    const Vec3 normal = impact.on_a.head<3>();
    const double about = normal.dot(turning.impulse);
    if (turning.torsion > 0.0) {
      c.torsion = {.first = ++i,
                   .length = turning.torsion,
                   .used = std::abs(about) / turning.torsion,
                   .stuck = turning.torsion_stuck};
      problem.lengths[i] = turning.size;
    }
    if (turning.rolling > 0.0) {
      c.rolling = {.first = i + 1,
                   .length = turning.rolling,
                   .used = (turning.impulse - about * normal).norm() / turning.rolling,
                   .stuck = turning.rolling_stuck};
      problem.lengths[i + 1] = problem.lengths[i + 2] = turning.size;
      i += 2;
    }
    problem.contacts.push_back(c);
    closes = closes || of_step.closes();
    stopped = stopped || of_step.stops;
  }
  Vec work = Vec::Zero(n);
  if (closes || stopped) {
    const VelocityProblem::Result result = closes ? problem.impact() : problem.stop_slip();
    for (Eigen::Index i = 0; i < n; ++i)
      rows[static_cast<std::size_t>(i)].apply(result.impulses[i], v);
    work = result.work;
    for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
      const Row& row = rows[static_cast<std::size_t>(problem.contacts[k].normal)];
      ResolvedImpact& s = settled_[static_cast<std::size_t>(row.impact)];
      s.solved = true;
      // Restitution returns it with the work of the rows, which alone would seem to gain.
      s.normal_loss += island.projected / static_cast<double>(problem.contacts.size());
      s.closed = result.closed[k] != 0;
      s.sticks = result.sticks[k] != 0;
    }
    if (!result.report.converged && result.report.worst >= 0)
      note_error(rows[static_cast<std::size_t>(result.report.worst)].impact, result.report.error,
                 problem.w.lpNorm<Eigen::Infinity>());
  }
  apply(state, island, rows, start, v, 1.0, &work);
}

}  // namespace polhode
