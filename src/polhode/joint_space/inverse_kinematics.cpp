// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include <polhode/core/error.hpp>
#include <polhode/joint_space/inverse_kinematics.hpp>
#include <polhode/math/exp_map.hpp>
#include <polhode/math/quaternion.hpp>

namespace polhode {

namespace {

using Motions = JointSpace::Motions;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
/// Error that counts as none, as a part of the mechanism's size or in radians.
constexpr double kReached = 1e-12;
constexpr int kMaxSteps = 100;
/// Number of starts: the given position, then others.
constexpr int kStarts = 24;
/// Largest change of an angle in a step [rad], and of a displacement as a part of the size.
constexpr double kLargestStep = 0.5;
constexpr double kFirstDamping = 1e-4, kMostDamping = 1e8;
/// Relative change of the error by a step below which the search has ended.
constexpr double kStill = 1e-10;

class Search {
 public:
  Search(const JointSpace& space, const CoordinateLimits& limits, const Motions& from,
         const PoseTarget& target)
      : space_(space), limits_(limits), from_(from), target_(target) {
    for (const BodyMotion& m : from) size_ = std::max(size_, (m.r - from.front().r).norm());
    if (target.position) size_ = std::max(size_, (*target.position - body_of(from).r).norm());
    if (size_ == 0.0) size_ = 1.0;
    find_rotations();
  }

  PoseReached from(const VectorXd& start) const {
    PoseReached at = place(start, from_);
    VectorXd e = error(at);
    double damping = kFirstDamping;
    if (at.positions.empty()) return at;
    for (int i = 0; i < kMaxSteps && !at.reached && damping < kMostDamping; ++i) {
      const MatrixXd J = jacobian(at);
      const VectorXd q = vector_of(at.positions), d = step(J, e, q, damping);
      PoseReached next;
      try {
        next = place(moved(q, d), at.motions);
      } catch (const InputError&) {  // a loop cannot follow
        damping *= 10.0;
        continue;
      }
      const VectorXd e_next = error(next);
      if (!(e_next.norm() < e.norm())) {
        damping *= 10.0;
        continue;
      }
      const bool still = e_next.norm() > (1.0 - kStill) * e.norm();
      at = std::move(next);
      e = e_next;
      damping = std::max(damping * 0.1, 1e-15);
      if (still) break;
    }
    return at;
  }

  /// Another start, for k = 1, 2, ...: points of a Halton-like sequence around the given one.
  [[nodiscard]] VectorXd start(const VectorXd& near, int k) const {
    VectorXd q = near;
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      const double part = std::fmod(k * std::sqrt(2.0 + 3.0 * static_cast<double>(i)), 1.0) - 0.5;
      q[i] += part * (turns(i) ? 3.0 : size_);
    }
    return clamped(q);
  }

  /// Error that is compared: parts of the size, radians.
  static double total(const PoseReached& at, double size) {
    return std::hypot(at.distance / size, at.angle);
  }
  [[nodiscard]] double size() const { return size_; }

 private:
  static VectorXd vector_of(const std::vector<double>& x) {
    return Eigen::Map<const VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
  }
  [[nodiscard]] const BodyMotion& body_of(const Motions& motions) const {
    return motions.at(static_cast<std::size_t>(target_.body));
  }
  [[nodiscard]] bool turns(Eigen::Index i) const {
    return space_.coordinates()[static_cast<std::size_t>(i)].turns;
  }

  /// Finds coordinates that are a whole rotation vector, the rates of which are no derivatives.
  void find_rotations() {
    const auto& c = space_.coordinates();
    for (std::size_t i = 0; i + 2 < c.size(); ++i) {
      const bool same = c[i].joint == c[i + 2].joint && c[i].body == c[i + 2].body;
      if (same && c[i].coordinate == "rx" && c[i + 1].coordinate == "ry" &&
          c[i + 2].coordinate == "rz")
        rotations_.push_back(static_cast<Eigen::Index>(i));
    }
  }

  [[nodiscard]] VectorXd clamped(VectorXd q) const {
    for (Eigen::Index i = 0; i < q.size(); ++i)
      q[i] = std::clamp(q[i], limits_.lower[static_cast<std::size_t>(i)],
                        limits_.upper[static_cast<std::size_t>(i)]);
    return q;
  }
  [[nodiscard]] VectorXd moved(const VectorXd& q, const VectorXd& d) const {
    VectorXd next = q + d;
    for (const Eigen::Index i : rotations_)
      next.segment<3>(i) = log_map(exp_map(Vec3(d.segment<3>(i))) * exp_map(Vec3(q.segment<3>(i))));
    return clamped(next);
  }

  [[nodiscard]] PoseReached place(const VectorXd& q, const Motions& from) const {
    PoseReached at;
    at.positions.assign(q.begin(), q.end());
    at.motions = space_.place(from, at.positions);
    const BodyMotion& m = body_of(at.motions);
    if (target_.position) at.distance = (*target_.position - m.r - m.q * target_.point).norm();
    if (target_.orientation)
      at.angle = rotation_vector(*target_.orientation * m.q.conjugate()).norm();
    at.reached = at.distance <= kReached * size_ && at.angle <= kReached;
    return at;
  }

  [[nodiscard]] VectorXd error(const PoseReached& at) const {
    const BodyMotion& m = body_of(at.motions);
    VectorXd e(rows());
    if (target_.position) e.head<3>() = (*target_.position - m.r - m.q * target_.point) / size_;
    if (target_.orientation) e.tail<3>() = rotation_vector(*target_.orientation * m.q.conjugate());
    return e;
  }
  [[nodiscard]] Eigen::Index rows() const {
    return (target_.position ? 3 : 0) + (target_.orientation ? 3 : 0);
  }
  [[nodiscard]] MatrixXd jacobian(const PoseReached& at) const {
    const std::vector<double> list = space_.jacobian(at.motions, target_.body, target_.point);
    const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>
        all(list.data(), 6, space_.size());
    MatrixXd J(rows(), space_.size());
    if (target_.position) J.topRows<3>() = all.topRows<3>() / size_;
    if (target_.orientation) J.bottomRows<3>() = all.bottomRows<3>();
    for (Eigen::Index i = 0; i < J.cols(); ++i)
      if (!turns(i)) J.col(i) *= size_;
    return J;
  }

  /// A damped step; coordinates at their limits stay there unless it leads back.
  [[nodiscard]] VectorXd step(MatrixXd J, const VectorXd& e, const VectorXd& q,
                              double damping) const {
    VectorXd d;
    for (int pass = 0; pass < 2; ++pass) {
      MatrixXd JJ = J * J.transpose();
      JJ.diagonal().array() += damping;
      d = J.transpose() * JJ.ldlt().solve(e);
      bool blocked = false;
      for (Eigen::Index i = 0; i < d.size(); ++i) {
        const auto k = static_cast<std::size_t>(i);
        const bool out =
            (q[i] >= limits_.upper[k] && d[i] > 0.0) || (q[i] <= limits_.lower[k] && d[i] < 0.0);
        if (!out) continue;
        J.col(i).setZero();
        blocked = true;
      }
      if (!blocked) break;
    }
    const double most = d.cwiseAbs().maxCoeff();
    if (most > kLargestStep) d *= kLargestStep / most;
    for (Eigen::Index i = 0; i < d.size(); ++i)
      if (!turns(i)) d[i] *= size_;
    return d;
  }

  const JointSpace& space_;
  const CoordinateLimits& limits_;
  const Motions& from_;
  const PoseTarget& target_;
  double size_ = 0.0;
  std::vector<Eigen::Index> rotations_;  ///< First coordinates.
};

}  // namespace

CoordinateLimits coordinate_limits(const Model& model, const JointSpace& space) {
  CoordinateLimits limits;
  const auto count = static_cast<std::size_t>(space.size());
  limits.lower.assign(count, -kInfinite);
  limits.upper.assign(count, kInfinite);
  for (std::size_t i = 0; i < count; ++i) {
    const IndependentCoordinate& c = space.coordinates()[i];
    if (c.joint < 0) continue;
    const JointSpec& joint = model.joints.at(static_cast<std::size_t>(c.joint));
    // `limits` is that of a displacement if there is one.
    const bool slides = std::ranges::any_of(space.coordinates(), [&](const auto& other) {
      return other.joint == c.joint && !other.turns;
    });
    const auto& of = c.turns && slides ? joint.angle_limits : joint.limits;
    if (!of) continue;
    limits.lower[i] = of->lower.value_or(-kInfinite);
    limits.upper[i] = of->upper.value_or(kInfinite);
  }
  return limits;
}

PoseReached reach(const JointSpace& space, const CoordinateLimits& limits, const Motions& from,
                  std::span<const double> near, const PoseTarget& target) {
  const Search search(space, limits, from, target);
  const VectorXd first =
      Eigen::Map<const VectorXd>(near.data(), static_cast<Eigen::Index>(near.size()));
  PoseReached best = search.from(first);
  for (int k = 1; k < kStarts && !best.reached; ++k) {
    try {
      PoseReached next = search.from(search.start(first, k));
      if (Search::total(next, search.size()) < Search::total(best, search.size()))
        best = std::move(next);
    } catch (const InputError&) {  // a loop cannot be there
      continue;
    }
  }
  return best;
}

}  // namespace polhode
