// SPDX-License-Identifier: Apache-2.0
// Impacts of an edge or a face that lands flat: several points that meet at once.
#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/QR>

#include <polhode/stepping/impact_resolver.hpp>
#include <polhode/stepping/impact_rows.hpp>

namespace polhode {

namespace {

/// Largest difference of the approach speeds of points that land flat, as a part of the speed, and
/// largest angle between their normals.
constexpr double kFlat = 1e-3;

/// Equivalent single point of several: columns of impulses, and means of velocities, along a common
/// normal and two common tangents. Normal impulses are distributed so that all normal velocities
/// change alike; tangential ones are equal.
struct OnePoint {
  Mat impulses;  ///< 3m x 3: of all rows, by unit impulses of the one point.
  Mat means;     ///< 3m x 3: its velocities are means' times those of all rows.
  Mat3 mobility;
};

/// @param K  Velocities of all rows by their unit impulses. @param turns  Of each point: its
/// tangents in the common ones.
OnePoint one_point(const Mat& K, const std::vector<Eigen::Matrix2d>& turns) {
  const auto m = static_cast<Eigen::Index>(turns.size());
  OnePoint one{Mat::Zero(3 * m, 3), Mat::Zero(3 * m, 3), Mat3::Zero()};
  for (Eigen::Index i = 0; i < m; ++i) {
    one.means(3 * i, 0) = 1.0 / static_cast<double>(m);
    one.means.block<2, 2>(3 * i + 1, 1) =
        turns[static_cast<std::size_t>(i)].transpose() / static_cast<double>(m);
  }
  // Equal changes w of all normal velocities: K_nn q − w = −K_nt p_t with Σ q given.
  Mat saddle = Mat::Zero(m + 1, m + 1), rhs = Mat::Zero(m + 1, 3);
  double scale = 0.0;
  for (Eigen::Index i = 0; i < m; ++i) {
    for (Eigen::Index j = 0; j < m; ++j) saddle(i, j) = K(3 * i, 3 * j);
    scale = std::max(scale, saddle(i, i));
    rhs.block<1, 2>(i, 1) = -K.row(3 * i) * one.means.rightCols<2>();
  }
  saddle.row(m).head(m).setConstant(scale);
  saddle.col(m).head(m).setConstant(-scale);
  rhs(m, 0) = scale;
  const Mat solution = saddle.completeOrthogonalDecomposition().solve(rhs);
  one.impulses.rightCols<2>() = one.means.rightCols<2>();
  for (Eigen::Index i = 0; i < m; ++i) one.impulses.row(3 * i) += solution.row(i);
  one.mobility = one.means.transpose() * K * one.impulses;
  one.mobility = 0.5 * (one.mobility + one.mobility.transpose()).eval();
  return one;
}

}  // namespace

/// Impacts between two bodies that approach at the same speed along the same normal, alike in their
/// laws, which Routh's method can follow as one.
bool ImpactResolver::lands_flat(const Island& island, const std::vector<Row>& rows) const {
  if (island.rows.size() < 2 || rows.size() != 3 * island.rows.size() || !island.nodes.empty())
    return false;
  const PairImpact& first = rows_[island.rows.front()];
  return std::all_of(island.rows.begin(), island.rows.end(), [&](int k) {
    const PairImpact& r = rows_[static_cast<std::size_t>(k)];
    if (!r.course || !first.course) return false;
    const Vec3 n = first.impact.on_a.head<3>(), own = r.impact.on_a.head<3>();
    return r.bodies.a == first.bodies.a && r.bodies.b == first.bodies.b &&
           (own - n).norm() < kFlat && r.impact.mu == first.impact.mu &&
           r.impact.mu_across == first.impact.mu && first.impact.mu_across == first.impact.mu &&
           r.course->turns == first.course->turns &&
           r.course->restitution == first.course->restitution;
  });
}

/// Resolves the impact of an edge or a face that lands flat as that of one point, which may take a
/// couple besides. @returns whether it did: not if a point would have to pull. @eq{routh}
bool ImpactResolver::follow_flat(std::vector<Row>& rows, std::vector<Vec6>& v) {
  const auto& [bodies, impact, course, slow, row] = rows_[rows.front().impact];
  const auto count = static_cast<Eigen::Index>(rows.size());
  const Eigen::Index m = count / 3;
  Mat K(count, count);
  Vec now(count), given = Vec::Zero(count);
  std::vector<Eigen::Matrix2d> turns;
  for (Eigen::Index i = 0; i < count; ++i) {
    now[i] = rows[i].speed(v);
    for (Eigen::Index j = 0; j < count; ++j) K(i, j) = rows[i].speed_by(rows[j]);
  }
  double stored_n = 0.0, stored_n1 = 0.0;
  for (Eigen::Index i = 0; i < m; ++i) {
    const PairImpact& r = rows_[rows[3 * i].impact];
    given[3 * i] = r.impact.given;
    stored_n += r.course->stored_n;
    stored_n1 += r.course->stored_n1;
    Eigen::Matrix2d turn;
    turn << impact.along.dot(r.impact.along), impact.along.dot(r.impact.across),
        impact.across.dot(r.impact.along), impact.across.dot(r.impact.across);
    turns.push_back(turn);
  }
  const Vec before = now - K * given;
  for (Eigen::Index i = 0; i < m; ++i)
    if (!(std::abs(before[3 * i] - before[0]) <= kFlat * std::abs(before[0]))) return false;
  if (friction_alone(*course)) {
    solve_rows(rows, v, Acts::friction);
    return true;
  }
  const OnePoint one = one_point(K, turns);
  if (!(one.mobility(0, 0) > 0.0)) return false;
  ImpactCourse whole = *course;
  whole.stored_n = stored_n;
  whole.stored_n1 = stored_n1;
  const Vec changes =
      one.impulses * impulse_by_routh(one.mobility, {impact.mu, impact.mu_across}, whole,
                                      one.means.transpose() * before, one.means.transpose() * now);
  for (Eigen::Index i = 0; i < m; ++i)
    if (given[3 * i] + changes[3 * i] < 0.0) return false;
  for (Eigen::Index i = 0; i < count; ++i) rows[i].apply(changes[i], v);
  return true;
}

}  // namespace polhode
