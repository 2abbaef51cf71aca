// SPDX-License-Identifier: Apache-2.0
// Velocity problems of islands with contacts that were rows of the step.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <polhode/impulses/velocity_problem.hpp>
#include <polhode/stepping/impact_rows.hpp>

namespace polhode {

namespace {

/// Rounding of a velocity relative to the sum of its terms.
constexpr double kVelocityRounding = 64.0 * std::numeric_limits<double>::epsilon();

}  // namespace

bool ImpactResolver::has_step_rows(const Island& island) const {
  return std::any_of(island.rows.begin(), island.rows.end(),
                     [&](int k) { return rows_[static_cast<std::size_t>(k)].row.has_value(); });
}

/// Rows of stops, which are forces of the step, follow after those of contacts.
/// @eq{velocity-problem}
void ImpactResolver::settle_step_rows(State& state, const Island& island, std::vector<Row> rows) {
  std::vector<Vec6> v = velocities(state, island);
  const std::vector<Vec6> start = v;
  const auto of_stop = [&](const Row& row) {
    return !rows_[static_cast<std::size_t>(row.impact)].row.has_value();
  };
  std::vector<Row> stops;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(stops), of_stop);
  std::erase_if(rows, of_stop);

  bool closes = false, stopped = false;
  double rounding = 0.0;
  VelocityProblem problem;
  const auto n = static_cast<Eigen::Index>(rows.size());
  problem.A.resize(n, n);
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
    problem.contacts.push_back(c);
    closes = closes || of_step.closes();
    stopped = stopped || of_step.stops;
  }
  if (closes || stopped) {
    const VelocityProblem::Result result = closes ? problem.impact() : problem.stop_slip();
    for (Eigen::Index i = 0; i < n; ++i)
      rows[static_cast<std::size_t>(i)].apply(result.impulses[i], v);
    for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
      const Row& row = rows[static_cast<std::size_t>(problem.contacts[k].normal)];
      ResolvedImpact& s = settled_[static_cast<std::size_t>(row.impact)];
      s.solved = true;
      s.closed = result.closed[k] != 0;
      s.sticks = result.sticks[k] != 0;
    }
    if (!result.report.converged && result.report.worst >= 0)
      note_error(rows[static_cast<std::size_t>(result.report.worst)].impact, result.report.error,
                 problem.w.lpNorm<Eigen::Infinity>());
  }
  if (!stops.empty()) {
    for (Row& row : stops) row.before = row.speed(v);
    solve_rows(stops, v, Acts::all);
    rows.insert(rows.end(), std::make_move_iterator(stops.begin()),
                std::make_move_iterator(stops.end()));
  }
  apply(state, island, rows, start, v, 1.0);
}

}  // namespace polhode
