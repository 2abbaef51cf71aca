// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include <polhode/engines/impulse_newton.hpp>
#include <polhode/equations/line_search.hpp>

namespace polhode {

namespace {

constexpr int kMaxIterations = 120;
/// Number of iterations without an error below this part of the smallest one, which end the search.
constexpr int kPatience = 30;
constexpr double kProgress = 0.9;
/// Error of speeds that is round-off, as a part of the largest.
constexpr double kRoundedSpeed = 1e-14;
/// Halvings of a step that exceeds the merits of previous iterates.
constexpr LineSearchRule kHalve{0.0, 8, 0.5, 0.5, 0.5};
/// Number of previous iterates whose merit must not be exceeded; it may rise above the last one.
constexpr std::size_t kLookBack = 5;
/// Part ε_1 of the diagonal of D that is added to it in the first proximal iteration, so that
/// impulses of points that share a load are unique.
constexpr double kProximal = 1e-3;
/// Factor of that part in each further iteration.
constexpr double kLessProximal = 0.1;

using Frame = std::array<Vec3, 3>;  ///< Normal and two tangents.

/// A component of the impulses: wrenches of its unit on body a and, with the opposite sign, on b.
struct Direction {
  int a, b;
  Vec3 force, moment_a, moment_b;  ///< Force [-]; moments about the centres of mass [m].
};

/// Unknowns: three for each point, normal and tangential, then three for each of the turns, torsion
/// and rolling.
class Solution {
 public:
  explicit Solution(ProjectedGaussSeidel& sweeps)
      : s_(&sweeps), count_(static_cast<Eigen::Index>(sweeps.points.size())) {
    const Eigen::Index n = 3 * (count_ + static_cast<Eigen::Index>(sweeps.turns.size()));
    p_start_.resize(n);
    y_start_.resize(n);
    wanted_.resize(n);
    per_speed_.setOnes(n);
    directions_.reserve(static_cast<std::size_t>(n));
    for (const ProjectedGaussSeidel::Point& p : sweeps.points) {
      const Vec3 t = p.normal.unitOrthogonal();
      frames_.push_back({p.normal, t, p.normal.cross(t)});
      const Vec3 impulse = p.normal_impulse * p.normal + p.friction_impulse;
      for (const Vec3& e : frames_.back())
        add({p.a, p.b, e, p.arm_a.cross(e), p.arm_b.cross(e)}, e.dot(impulse), e.dot(p.wanted));
      wanted_[static_cast<Eigen::Index>(directions_.size()) - 3] = p.least;
    }
    for (const ProjectedGaussSeidel::Turn& t : sweeps.turns) {
      const ProjectedGaussSeidel::Point& p = sweeps.points[t.point];
      for (const Vec3& e : frames_[t.point])
        add({p.a, p.b, Vec3::Zero(), e, e}, e.dot(t.impulse), e.dot(t.wanted));
      per_speed_.segment<3>(static_cast<Eigen::Index>(directions_.size()) - 3)
          .setConstant(t.length);
    }
    D_.resize(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j <= i; ++j) D_(i, j) = D_(j, i) = coupling(i, j);
    proximal_ = kProximal * D_.diagonal();
    D_.diagonal() += proximal_;
    p_ = centre_ = p_start_;
  }

  /// Newton's method inside proximal iterations, which add ε_i D_kk times the change of an impulse
  /// since the last one to its speed. @returns whether an iterate has reached `enough`.
  bool find(double enough, double exact) {
    exact = std::max(exact,
                     kRoundedSpeed * y_start_.cwiseProduct(per_speed_).lpNorm<Eigen::Infinity>());
    std::array<double, kLookBack> merits{};
    merits.fill(std::numeric_limits<double>::infinity());
    Vec best = p_;
    double least = std::numeric_limits<double>::infinity();
    for (int it = 0, last = 0; it < kMaxIterations && it - last < kPatience; ++it) {
      const double merit = residual(p_, true);
      if (!std::isfinite(merit)) break;
      const double left =
          proximal_.cwiseProduct(p_ - centre_).cwiseProduct(per_speed_).lpNorm<Eigen::Infinity>();
      if (const double error = std::max(std::sqrt(merit), left); error < kProgress * least) {
        least = error;
        best = p_;
        last = it;
      }
      if (least <= exact) break;
      if (std::sqrt(merit) <= exact) {
        next_proximal_iteration();
        merits.fill(std::numeric_limits<double>::infinity());
        last = it;
        continue;
      }
      merits[static_cast<std::size_t>(it) % kLookBack] = merit;
      const Vec step = J_.partialPivLu().solve(-F_);
      if (!step.allFinite()) break;
      const double allowed = *std::max_element(merits.begin(), merits.end());
      const Vec start = p_;
      const auto apply = [&](double part) {
        p_ = start + part * step;
        return part;
      };
      search_along(kHalve, allowed, 1.0, apply, [&] { return residual(p_, false); });
    }
    p_ = best;
    return least <= enough;
  }

  /// Writes impulses and speeds back to the bodies.
  void give_back() {
    for (Eigen::Index k = 0; k < count_; ++k) {
      ProjectedGaussSeidel::Point& p = s_->points[static_cast<std::size_t>(k)];
      const Vec3 before = p.normal_impulse * p.normal + p.friction_impulse;
      p.normal_impulse = std::max(0.0, p_[3 * k]);
      p.friction_impulse = across(frames_[k], 3 * k, p.friction * p.normal_impulse);
      s_->apply(p, p.normal_impulse * p.normal + p.friction_impulse - before);
    }
    for (std::size_t k = 0; k < s_->turns.size(); ++k) {
      ProjectedGaussSeidel::Turn& t = s_->turns[k];
      const ProjectedGaussSeidel::Point& p = s_->points[t.point];
      const Eigen::Index first = first_of_turn(k);
      const double torsion = t.torsion * p.normal_impulse;
      const Vec3 before = t.impulse;
      t.impulse = across(frames_[t.point], first, t.rolling * p.normal_impulse) +
                  std::clamp(p_[first], -torsion, torsion) * p.normal;
      s_->turn(p, t.impulse - before);
    }
  }

 private:
  [[nodiscard]] Eigen::Index first_of_turn(std::size_t k) const {
    return 3 * (count_ + static_cast<Eigen::Index>(k));
  }
  void add(const Direction& d, double impulse, double wanted) {
    const auto i = static_cast<Eigen::Index>(directions_.size());
    const ProjectedGaussSeidel::Body &a = s_->bodies[d.a], &b = s_->bodies[d.b];
    p_start_[i] = impulse;
    y_start_[i] = d.force.dot(a.v - b.v) + d.moment_a.dot(a.w) - d.moment_b.dot(b.w);
    wanted_[i] = wanted;
    directions_.push_back(d);
  }
  void next_proximal_iteration() {
    centre_ = p_;
    D_.diagonal() -= (1.0 - kLessProximal) * proximal_;
    proximal_ *= kLessProximal;
  }
  /// Speed along one direction by a unit impulse along the other.
  [[nodiscard]] double coupling(Eigen::Index i, Eigen::Index j) const {
    const Direction &to = directions_[static_cast<std::size_t>(i)],
                    &from = directions_[static_cast<std::size_t>(j)];
    double sum = 0.0;
    const auto add = [&](int body, double sign, const Vec3& moment_to, const Vec3& moment_from) {
      const ProjectedGaussSeidel::Body& b = s_->bodies[body];
      sum += sign * (b.inverse_mass * to.force.dot(from.force) +
                     moment_to.dot(b.inverse_inertia * moment_from));
    };
    if (to.a == from.a) add(to.a, 1.0, to.moment_a, from.moment_a);
    if (to.b == from.b) add(to.b, 1.0, to.moment_b, from.moment_b);
    if (to.a == from.b) add(to.a, -1.0, to.moment_a, from.moment_b);
    if (to.b == from.a) add(to.b, -1.0, to.moment_b, from.moment_a);
    return sum;
  }
  /// The two unknowns after the first, inside a limit.
  [[nodiscard]] Vec3 across(const Frame& frame, Eigen::Index first, double limit) const {
    const Vec3 impulse = p_[first + 1] * frame[1] + p_[first + 2] * frame[2];
    const double size = impulse.norm();
    return size > limit ? Vec3(limit / size * impulse) : impulse;
  }

  /// Residual of the projection, as impulses, with its derivative. @returns the largest of it as a
  /// squared speed.
  double residual(const Vec& p, bool derivative) {
    off_ = y_start_ + D_ * (p - p_start_) + proximal_.cwiseProduct(p_start_ - centre_) - wanted_;
    F_.resize(p.size());
    if (derivative) J_.setIdentity(p.size(), p.size());
    double most = 0.0;
    const auto count = [&](double impulse, double per_impulse) {
      most = std::max(most, impulse * impulse * per_impulse * per_impulse);
    };
    pressed_.resize(count_);
    for (Eigen::Index k = 0; k < count_; ++k) {
      const ProjectedGaussSeidel::Point& at = s_->points[static_cast<std::size_t>(k)];
      const Eigen::Index n = 3 * k;
      pressed_[k] = std::max(0.0, p[n] - at.free_normal * off_[n]);
      F_[n] = p[n] - pressed_[k];
      count(F_[n], at.per_normal);
      if (derivative && pressed_[k] > 0.0) J_.row(n) = at.free_normal * D_.row(n);
      count(bounded<2>(p, n + 1, k, at.friction, at.free_friction, derivative), at.per_friction);
    }
    for (std::size_t k = 0; k < s_->turns.size(); ++k) {
      const ProjectedGaussSeidel::Turn& t = s_->turns[k];
      const Eigen::Index first = first_of_turn(k);
      const double free = 1.0 / t.per_impulse, speed = t.length * t.per_impulse;
      count(bounded<1>(p, first, t.point, t.torsion, free, derivative), speed);
      count(bounded<2>(p, first + 1, t.point, t.rolling, free, derivative), speed);
    }
    return most;
  }

  /// Residual of unknowns whose size is bounded by a multiple of a point's normal impulse. @returns
  /// its size.
  template <int N>
  double bounded(const Vec& p, Eigen::Index t, Eigen::Index point, double coefficient, double free,
                 bool derivative) {
    using Part = Eigen::Matrix<double, N, 1>;
    const Part z = p.segment<N>(t) - free * off_.segment<N>(t);
    const double limit = coefficient * pressed_[point], size = z.norm();
    const bool sticks = limit > 0.0 && size <= limit;
    F_.segment<N>(t) = p.segment<N>(t);
    if (sticks)
      F_.segment<N>(t) -= z;
    else if (limit > 0.0)
      F_.segment<N>(t) -= limit / size * z;
    if (derivative && sticks) {
      J_.middleRows<N>(t) = free * D_.middleRows<N>(t);
    } else if (derivative && limit > 0.0) {
      const Eigen::Index n = 3 * point;
      const Part e = z / size;
      const Eigen::Matrix<double, N, N> turn =
          limit / size * (Eigen::Matrix<double, N, N>::Identity() - e * e.transpose());
      const double free_normal = s_->points[static_cast<std::size_t>(point)].free_normal;
      J_.middleRows<N>(t) += turn * free * D_.middleRows<N>(t);
      J_.block<N, N>(t, t) -= turn;
      J_.middleRows<N>(t) += (coefficient * free_normal) * e * D_.row(n);
      J_.block<N, 1>(t, n) -= coefficient * e;
    }
    return F_.segment<N>(t).norm();
  }

  ProjectedGaussSeidel* s_;
  Eigen::Index count_;  ///< Of points.
  std::vector<Frame> frames_;
  std::vector<Direction> directions_;
  Eigen::MatrixXd D_, J_;
  Vec p_start_, y_start_, wanted_, p_, F_, off_;
  Vec per_speed_;  ///< Lengths that turn angular speeds into speeds; 1 for points.
  Vec proximal_;   ///< ε_i D_kk, in D_ too.
  Vec centre_;     ///< Impulses after the last proximal iteration.
  Vec pressed_;    ///< Normal impulses, projected.
};

}  // namespace

bool solve_impulses(ProjectedGaussSeidel& sweeps, double enough, double exact) {
  Solution solution(sweeps);
  if (!solution.find(enough, exact)) return false;
  solution.give_back();
  return true;
}

}  // namespace polhode
