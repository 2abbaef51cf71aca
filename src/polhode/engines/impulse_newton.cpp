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

constexpr int kMaxIterations = 60;
/// Halvings of a step that exceeds the merits of previous iterates.
constexpr LineSearchRule kHalve{0.0, 8, 0.5, 0.5, 0.5};
/// Number of previous iterates whose merit must not be exceeded; it may rise above the last one.
constexpr std::size_t kLookBack = 5;
/// Part of the diagonal of D added to it, so that points that share a load become unique.
constexpr double kUnique = 1e-10;

using Frame = std::array<Vec3, 3>;  ///< Normal and two tangents.

class Solution {
 public:
  explicit Solution(ProjectedGaussSeidel& sweeps)
      : s_(&sweeps), count_(static_cast<Eigen::Index>(sweeps.points.size())) {
    const Eigen::Index n = 3 * count_;
    D_.setZero(n, n);
    p_start_.resize(n);
    y_start_.resize(n);
    wanted_.resize(n);
    for (const ProjectedGaussSeidel::Point& p : sweeps.points) {
      const Vec3 t = p.normal.unitOrthogonal();
      frames_.push_back({p.normal, t, p.normal.cross(t)});
    }
    for (Eigen::Index k = 0; k < count_; ++k) {
      const ProjectedGaussSeidel::Point& p = point(k);
      const Vec3 y = speed(p);
      for (int i = 0; i < 3; ++i) {
        const Vec3& e = frames_[k][i];
        p_start_[3 * k + i] = i == 0 ? p.normal_impulse : e.dot(p.friction_impulse);
        y_start_[3 * k + i] = e.dot(y);
        wanted_[3 * k + i] = i == 0 ? p.least : e.dot(p.wanted);
      }
      for (Eigen::Index l = 0; l < count_; ++l) couple(k, l);
    }
    D_.diagonal() *= 1.0 + kUnique;
    p_ = p_start_;
  }

  bool find(double enough) {
    std::array<double, kLookBack> merits{};
    merits.fill(std::numeric_limits<double>::infinity());
    for (int it = 0; it < kMaxIterations; ++it) {
      const double merit = residual(p_, true);
      if (!std::isfinite(merit)) return false;
      if (std::sqrt(merit) <= enough) return true;
      merits[static_cast<std::size_t>(it) % kLookBack] = merit;
      const Vec step = J_.partialPivLu().solve(-F_);
      if (!step.allFinite()) return false;
      const double allowed = *std::max_element(merits.begin(), merits.end());
      const Vec start = p_;
      const auto apply = [&](double part) {
        p_ = start + part * step;
        return part;
      };
      search_along(kHalve, allowed, 1.0, apply, [&] { return residual(p_, false); });
    }
    return false;
  }

  /// Writes impulses and speeds back to the bodies.
  void give_back() {
    for (Eigen::Index k = 0; k < count_; ++k) {
      ProjectedGaussSeidel::Point& p = s_->points[static_cast<std::size_t>(k)];
      const Vec3 before = p.normal_impulse * p.normal + p.friction_impulse;
      p.normal_impulse = std::max(0.0, p_[3 * k]);
      p.friction_impulse = p_[3 * k + 1] * frames_[k][1] + p_[3 * k + 2] * frames_[k][2];
      const double limit = p.friction * p.normal_impulse, size = p.friction_impulse.norm();
      if (size > limit) p.friction_impulse *= limit / size;
      s_->apply(p, p.normal_impulse * p.normal + p.friction_impulse - before);
    }
  }

 private:
  [[nodiscard]] const ProjectedGaussSeidel::Point& point(Eigen::Index k) const {
    return s_->points[static_cast<std::size_t>(k)];
  }
  [[nodiscard]] Vec3 speed(const ProjectedGaussSeidel::Point& p) const {
    const ProjectedGaussSeidel::Body &a = s_->bodies[p.a], &b = s_->bodies[p.b];
    return a.v + a.w.cross(p.arm_a) - b.v - b.w.cross(p.arm_b);
  }
  /// Adds the speeds at k by unit impulses at l.
  void couple(Eigen::Index k, Eigen::Index l) {
    const ProjectedGaussSeidel::Point &to = point(k), &from = point(l);
    const auto add = [&](int body, double sign, const Vec3& arm_to, const Vec3& arm_from) {
      const ProjectedGaussSeidel::Body& b = s_->bodies[body];
      for (int j = 0; j < 3; ++j) {
        const Vec3& e = frames_[l][j];
        const Vec3 turned = b.inverse_inertia * arm_from.cross(e);
        const Vec3 y = sign * (b.inverse_mass * e + turned.cross(arm_to));
        for (int i = 0; i < 3; ++i) D_(3 * k + i, 3 * l + j) += frames_[k][i].dot(y);
      }
    };
    if (to.a == from.a) add(to.a, 1.0, to.arm_a, from.arm_a);
    if (to.b == from.b) add(to.b, 1.0, to.arm_b, from.arm_b);
    if (to.a == from.b) add(to.a, -1.0, to.arm_a, from.arm_b);
    if (to.b == from.a) add(to.b, -1.0, to.arm_b, from.arm_a);
  }

  /// Residual of the projection, as impulses, with its derivative. @returns the largest of it as a
  /// squared speed.
  double residual(const Vec& p, bool derivative) {
    const Vec off = y_start_ + D_ * (p - p_start_) - wanted_;
    F_.resize(p.size());
    if (derivative) J_.setIdentity(p.size(), p.size());
    double most = 0.0;
    for (Eigen::Index k = 0; k < count_; ++k) {
      const ProjectedGaussSeidel::Point& at = point(k);
      const Eigen::Index n = 3 * k, t = n + 1;
      const double z_n = p[n] - at.free_normal * off[n], normal_impulse = std::max(0.0, z_n);
      const Eigen::Vector2d z = p.segment<2>(t) - at.free_friction * off.segment<2>(t);
      const double limit = at.friction * normal_impulse, size = z.norm();
      F_[n] = p[n] - normal_impulse;
      const bool sticks = normal_impulse > 0.0 && size <= limit;
      F_.segment<2>(t) = p.segment<2>(t);
      if (sticks)
        F_.segment<2>(t) -= z;
      else if (limit > 0.0)
        F_.segment<2>(t) -= limit / size * z;
      const double normal = F_[n] * at.per_normal,
                   across = F_.segment<2>(t).norm() * at.per_friction;
      most = std::max({most, normal * normal, across * across});
      if (!derivative || normal_impulse == 0.0) continue;
      J_.row(n) = at.free_normal * D_.row(n);
      if (sticks) {
        J_.middleRows<2>(t) = at.free_friction * D_.middleRows<2>(t);
      } else if (limit > 0.0) {
        const Eigen::Vector2d e = z / size;
        const Eigen::Matrix2d turn =
            limit / size * (Eigen::Matrix2d::Identity() - e * e.transpose());
        J_.middleRows<2>(t) += turn * at.free_friction * D_.middleRows<2>(t);
        J_.block<2, 2>(t, t) -= turn;
        J_.middleRows<2>(t) += (at.friction * at.free_normal) * e * D_.row(n);
        J_.block<2, 1>(t, n) -= at.friction * e;
      }
    }
    return most;
  }

  ProjectedGaussSeidel* s_;
  Eigen::Index count_;
  std::vector<Frame> frames_;
  Eigen::MatrixXd D_, J_;
  Vec p_start_, y_start_, wanted_, p_, F_;
};

}  // namespace

bool solve_impulses(ProjectedGaussSeidel& sweeps, double enough) {
  Solution solution(sweeps);
  if (!solution.find(enough)) return false;
  solution.give_back();
  return true;
}

}  // namespace polhode
