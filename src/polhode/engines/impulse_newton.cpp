// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <polhode/engines/impulse_newton.hpp>
#include <polhode/impulses/row_problem.hpp>

namespace polhode {

namespace {

using Eigen::Index;
using Frame = std::array<Vec3, 3>;  ///< Normal and two tangents.

/// A component of the impulses: wrenches of its unit on body a and, with the opposite sign, on b.
struct Direction {
  int a, b;
  Vec3 force, moment_a, moment_b;  ///< Force [-]; moments about the centres of mass [m].
};

/// Three rows for each point, normal and tangential, then three for each of the turns, torsion and
/// rolling.
class PointRows {
 public:
  explicit PointRows(ProjectedGaussSeidel& sweeps)
      : s_(&sweeps),
        problem_(static_cast<Index>(3 * (sweeps.points.size() + sweeps.turns.size()))) {
    directions_.reserve(static_cast<std::size_t>(problem_.b.size()));
    for (const ProjectedGaussSeidel::Point& p : sweeps.points) {
      const Vec3 t = p.normal.unitOrthogonal();
      frames_.push_back({p.normal, t, p.normal.cross(t)});
      const Vec3 impulse = p.normal_impulse * p.normal + p.friction_impulse;
      const Index n = next();
      for (const Vec3& e : frames_.back())
        add({p.a, p.b, e, p.arm_a.cross(e), p.arm_b.cross(e)}, e.dot(impulse), e.dot(p.wanted));
      problem_.b[n] -= p.least;
      problem_.blocks.push_back({.kind = ImpulseRows::Kind::normal, .first = n});
      bound(n + 1, 2, n, p.friction);
    }
    for (const ProjectedGaussSeidel::Turn& t : sweeps.turns) {
      const ProjectedGaussSeidel::Point& p = sweeps.points[static_cast<std::size_t>(t.point)];
      const Index first = next(), n = 3 * static_cast<Index>(t.point);
      for (const Vec3& e : frames_[static_cast<std::size_t>(t.point)])
        add({p.a, p.b, Vec3::Zero(), e, e}, e.dot(t.impulse), e.dot(t.wanted));
      problem_.lengths.segment<3>(first).setConstant(t.length);
      bound(first, 1, n, t.torsion);
      bound(first + 1, 2, n, t.rolling);
    }
    for (Index i = 0; i < problem_.b.size(); ++i)
      for (Index j = 0; j <= i; ++j) problem_.A(i, j) = problem_.A(j, i) = coupling(i, j);
  }

  /// @returns whether every row's error is below `enough`.
  bool solve(double enough, double exact) {
    Vec p = Vec::Zero(problem_.b.size());
    const RowReport report = problem_.solve(p, exact);
    impulses_ = problem_.given + p;
    return report.converged || report.error <= enough;
  }

  /// Writes impulses and velocities back to the bodies.
  void give_back() {
    for (std::size_t k = 0; k < s_->points.size(); ++k) {
      ProjectedGaussSeidel::Point& p = s_->points[k];
      const Index first = 3 * static_cast<Index>(k);
      const Vec3 before = p.normal_impulse * p.normal + p.friction_impulse;
      p.normal_impulse = std::max(0.0, impulses_[first]);
      p.friction_impulse = across(frames_[k], first, p.friction * p.normal_impulse);
      s_->apply(p, p.normal_impulse * p.normal + p.friction_impulse - before);
    }
    for (std::size_t k = 0; k < s_->turns.size(); ++k) {
      ProjectedGaussSeidel::Turn& t = s_->turns[k];
      const auto point = static_cast<std::size_t>(t.point);
      const ProjectedGaussSeidel::Point& p = s_->points[point];
      const Index first = 3 * static_cast<Index>(s_->points.size() + k);
      const double torsion = t.torsion * p.normal_impulse;
      const Vec3 before = t.impulse;
      t.impulse = across(frames_[point], first, t.rolling * p.normal_impulse) +
                  std::clamp(impulses_[first], -torsion, torsion) * p.normal;
      s_->turn(p, t.impulse - before);
    }
  }

 private:
  [[nodiscard]] Index next() const { return static_cast<Index>(directions_.size()); }
  /// @param wanted  Target of the velocity.
  void add(const Direction& d, double impulse, double wanted) {
    const Index i = next();
    const ProjectedGaussSeidel::Body &a = s_->bodies[static_cast<std::size_t>(d.a)],
                                     &b = s_->bodies[static_cast<std::size_t>(d.b)];
    problem_.given[i] = impulse;
    problem_.b[i] = d.force.dot(a.v - b.v) + d.moment_a.dot(a.w) - d.moment_b.dot(b.w) - wanted;
    directions_.push_back(d);
  }
  void bound(Index first, Index size, Index normal, double coefficient) {
    problem_.blocks.push_back({.kind = ImpulseRows::Kind::friction,
                               .first = first,
                               .size = size,
                               .normal = normal,
                               .half_axes = Vec3::Constant(coefficient)});
  }
  /// Velocity along one direction by a unit impulse along the other.
  [[nodiscard]] double coupling(Index i, Index j) const {
    const Direction &to = directions_[static_cast<std::size_t>(i)],
                    &from = directions_[static_cast<std::size_t>(j)];
    double sum = 0.0;
    const auto add = [&](int body, double sign, const Vec3& moment_to, const Vec3& moment_from) {
      const ProjectedGaussSeidel::Body& b = s_->bodies[static_cast<std::size_t>(body)];
      sum += sign * (b.inverse_mass * to.force.dot(from.force) +
                     moment_to.dot(b.inverse_inertia * moment_from));
    };
    if (to.a == from.a) add(to.a, 1.0, to.moment_a, from.moment_a);
    if (to.b == from.b) add(to.b, 1.0, to.moment_b, from.moment_b);
    if (to.a == from.b) add(to.a, -1.0, to.moment_a, from.moment_b);
    if (to.b == from.a) add(to.b, -1.0, to.moment_b, from.moment_a);
    return sum;
  }
  /// The two impulses after the first, inside a limit.
  [[nodiscard]] Vec3 across(const Frame& frame, Index first, double limit) const {
    const Vec3 impulse = impulses_[first + 1] * frame[1] + impulses_[first + 2] * frame[2];
    const double size = impulse.norm();
    return size > limit ? Vec3(limit / size * impulse) : impulse;
  }

  ProjectedGaussSeidel* s_;
  RowProblem problem_;
  Vec impulses_;  ///< Solution: sums.
  std::vector<Frame> frames_;
  std::vector<Direction> directions_;
};

}  // namespace

bool solve_impulses(ProjectedGaussSeidel& sweeps, double enough, double exact) {
  PointRows rows(sweeps);
  if (!rows.solve(enough, exact)) return false;
  rows.give_back();
  return true;
}

}  // namespace polhode
