// SPDX-License-Identifier: Apache-2.0
// Impulses of the rows of an island.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <polhode/impulses/row_problem.hpp>
#include <polhode/stepping/impact_rows.hpp>

namespace polhode {

namespace {

/// Gauss-Seidel sweeps over the rows of an island end when no impulse changes by more than this
/// part of the largest one, or after a maximum number.
constexpr double kConverged = 1e-13;
constexpr int kMaxSweeps = 500;
/// Mobility of a row, as a part of the largest one, below which the row cannot move.
constexpr double kHeld = 1e-13;
/// Number of rows above which sweeps come first, as they cost less than factors of that size.
constexpr std::size_t kFactored = 60;
/// Largest number of rows that are factored where the sweeps leave an error that counts.
constexpr std::size_t kMostFactored = 1500;
/// Rounding of a velocity relative to the sum of its terms.
constexpr double kRowRounding = 64.0 * std::numeric_limits<double>::epsilon();
/// Error of a velocity that counts as unsolved, as a part of the island's largest.
constexpr double kUnsolved = 1e-6;

/// Point of the friction cone, an ellipse with these half axes, on the ray to p.
Eigen::Vector2d in_cone(const Eigen::Vector2d& p, double along, double across) {
  if (!(along > 0.0 && across > 0.0)) return Eigen::Vector2d::Zero();
  const double size = std::hypot(p.x() / along, p.y() / across);
  return size > 1.0 ? Eigen::Vector2d(p / size) : p;
}

}  // namespace

/// Friction impulses one update towards zero slip later, within the cone: a step by the larger
/// mobility of the two tangents, in the metric in which the cone is round, so that the slip is
/// against its normal. @eq{impact-friction}
Eigen::Vector2d ImpactResolver::updated_friction(const Row& along, const Row& across, double normal,
                                                 const std::vector<Vec6>& v) const {
  const Impact& impact = rows_[along.impact].impact;
  const Eigen::Vector2d slip(along.speed(v), across.speed(v)),
      friction_impulse(impact.along.dot(impact.friction_impulse),
                       impact.across.dot(impact.friction_impulse)),
      before(along.impulse, across.impulse);
  const double most = std::max(impact.mu, impact.mu_across);
  const Eigen::Array2d parts =
      Eigen::Array2d(impact.mu, impact.mu_across) / (most > 0.0 ? most : 1.0);
  const Eigen::Vector2d step = (parts.square() * slip.array()).matrix();
  return in_cone(friction_impulse + before - step / std::max(along.mobility, across.mobility),
                 impact.mu * normal, impact.mu_across * normal) -
         friction_impulse;
}

/// @returns the largest change of an impulse.
double ImpactResolver::apply_friction(Row& along, Row& across, double normal,
                                      std::vector<Vec6>& v) const {
  const Eigen::Vector2d change =
      updated_friction(along, across, normal, v) - Eigen::Vector2d(along.impulse, across.impulse);
  along.apply(change.x(), v);
  across.apply(change.y(), v);
  return change.lpNorm<Eigen::Infinity>();
}

/// Projected Gauss-Seidel sweeps over all impulses of an island. Normal impulses aim at the target
/// speeds but return at most the impulse of the step; friction stops the slip within its cone.
/// @returns whether they converged. @eq{impact-friction}
bool ImpactResolver::sweep(std::vector<Row>& rows, Acts acts, std::vector<Vec6>& v) const {
  double most = 0.0;
  for (const Row& row : rows) most = std::max(most, row.mobility);
  for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
    double change = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      Row& row = rows[i];
      const Impact& impact = rows_[row.impact].impact;
      if (acts == Acts::all && row.mobility > kHeld * most) {
        double p = (impact.wanted - row.speed(v)) / row.mobility;
        p = std::max(p, -impact.given - row.impulse);
        if (p != 0.0) row.apply(p, v);
        change = std::max(change, std::abs(p));
      }
      const double normal = std::max(0.0, impact.given + row.impulse);
      largest = std::max(largest, normal);
      if (i + 1 == rows.size() || !rows[i + 1].has_friction) continue;
      Row &along = rows[i + 1], &across = rows[i + 2];
      i += 2;
      if (!(along.mobility + across.mobility > kHeld * most)) continue;
      change = std::max(change, apply_friction(along, across, normal, v));
    }
    if (!(change > kConverged * largest)) return true;
  }
  return false;
}

/// Impact whose velocity misses its law most, -1 for none, and by how much: the natural map of the
/// row problem. @eq{row-problem}
std::pair<int, double> ImpactResolver::largest_miss(const std::vector<Row>& rows, Acts acts,
                                                    const std::vector<Vec6>& v) const {
  std::pair<int, double> largest(-1, 0.0);
  double most = 0.0;
  for (const Row& row : rows) most = std::max(most, row.mobility);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    const Impact& impact = rows_[row.impact].impact;
    const auto note = [&](double miss) {
      if (miss > largest.second) largest = {row.impact, miss};
    };
    const double normal = std::max(0.0, impact.given + row.impulse),
                 missing = impact.wanted - row.speed(v);
    if (acts == Acts::all && row.mobility > kHeld * most)
      note(std::max(missing, std::min(-missing, row.mobility * normal)));
    if (i + 1 == rows.size() || !rows[i + 1].has_friction) continue;
    const Row &along = rows[i + 1], &across = rows[i + 2];
    i += 2;
    const double mobility = std::max(along.mobility, across.mobility);
    if (!(mobility > kHeld * most)) continue;
    note(mobility * (updated_friction(along, across, normal, v) -
                     Eigen::Vector2d(along.impulse, across.impulse))
                        .lpNorm<Eigen::Infinity>());
  }
  return largest;
}

/// Impulses of an island as a row problem: their sums with those of the step are bounded by zero
/// and by the cones, and they are as small as possible where rows share a load.
/// @eq{impact-friction} @eq{row-problem}
void ImpactResolver::solve_rows(std::vector<Row>& rows, std::vector<Vec6>& v, Acts acts) {
  // Sweeps for cables: with the converged solution a rope that slips over a drum is slowed too
  // little. See docs/reference/numerics.md.
  const auto of_cable = [&](const Row& row) {
    return surface(row.impact) != nullptr &&
           system_->nodes().group(of_surface(row.impact).number).kind().find("cable") !=
               std::string::npos;
  };
  if (std::any_of(rows.begin(), rows.end(), of_cable)) {
    sweep(rows, acts, v);
    return;
  }
  double fastest = 0.0;
  for (const Row& row : rows) fastest = std::max(fastest, std::abs(row.before));
  if (rows.size() > kFactored && sweep(rows, acts, v)) return;
  if (rows.size() > static_cast<std::size_t>(kMostDenseRows)) {
    const auto [worst, error] = largest_miss(rows, acts, v);
    if (!(error > kUnsolved * fastest)) return;
    if (rows.size() > kMostFactored) return note_error(worst, error, fastest);
  }

  std::vector<std::size_t> used;  // rows of the problem
  std::vector<ImpulseRows> blocks;
  std::vector<double> given, target;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Impact& impact = rows_[rows[i].impact].impact;
    ImpulseRows friction{.kind = ImpulseRows::Kind::friction,
                         .size = 2,
                         .half_axes = {impact.mu, impact.mu_across, 0.0}};
    if (acts == Acts::all) {
      friction.normal = static_cast<Eigen::Index>(used.size());
      blocks.push_back({.kind = ImpulseRows::Kind::normal, .first = friction.normal});
      given.push_back(impact.given + rows[i].impulse);
      target.push_back(impact.wanted);
      used.push_back(i);
    } else {
      friction.carried = impact.given;
    }
    if (i + 1 == rows.size() || !rows[i + 1].has_friction) continue;
    friction.first = static_cast<Eigen::Index>(used.size());
    blocks.push_back(friction);
    for (const Vec3* t : {&impact.along, &impact.across}) {
      used.push_back(++i);
      given.push_back(t->dot(impact.friction_impulse) + rows[i].impulse);
      target.push_back(0.0);
    }
  }

  const auto count = static_cast<Eigen::Index>(used.size());
  RowProblem problem(count);
  problem.blocks = std::move(blocks);
  problem.given = Eigen::Map<const Vec>(given.data(), count);
  double rounding = 0.0;
  std::vector<const Vec6*> loads(v.size());  // of a row, by position in the island
  for (Eigen::Index i = 0; i < count; ++i) {
    const Row& row = rows[used[static_cast<std::size_t>(i)]];
    for (const auto& [place, J] : row.on) loads[static_cast<std::size_t>(place)] = &J;
    problem.b[i] = row.speed(v) - target[static_cast<std::size_t>(i)];
    double terms = 0.0;
    for (const auto& [place, J] : row.on)
      terms += J.cwiseAbs().dot(v[static_cast<std::size_t>(place)].cwiseAbs());
    rounding = std::max(rounding, kRowRounding * terms);
    for (Eigen::Index j = 0; j <= i; ++j) {
      double sum = 0.0;
      for (const auto& [place, x] : rows[used[static_cast<std::size_t>(j)]].answer)
        if (const Vec6* const J = loads[static_cast<std::size_t>(place)]) sum += J->dot(x);
      problem.A(i, j) = problem.A(j, i) = sum;
    }
    for (const auto& [place, J] : row.on) loads[static_cast<std::size_t>(place)] = nullptr;
  }
  Vec p = Vec::Zero(count);
  const RowReport report = problem.solve(p, rounding);
  for (Eigen::Index i = 0; i < count; ++i) rows[used[static_cast<std::size_t>(i)]].apply(p[i], v);
  if (!report.converged && report.worst >= 0)
    note_error(rows[used[static_cast<std::size_t>(report.worst)]].impact, report.error, fastest);
}

/// Notes an impact that misses its velocity by an error.
/// @param fastest  Velocity whose small parts are no error.
void ImpactResolver::note_error(int row, double error, double fastest) {
  if (error <= std::max(kUnsolved * fastest, unsolved_.largest)) return;
  unsolved_.largest = error;
  unsolved_.steps = 1;
  unsolved_.a = rows_[row].bodies.a;
  unsolved_.b = rows_[row].bodies.b;
  unsolved_.group = surface(row) ? of_surface(row).number : -1;
}

void ImpactResolver::report(double t, UnsolvedImpacts& impacts) const {
  if (unsolved_.steps == 0) return;
  const std::int64_t steps = impacts.steps + 1;
  if (unsolved_.largest > impacts.largest) {
    impacts = unsolved_;
    impacts.time = t;
  }
  impacts.steps = steps;
}

}  // namespace polhode
