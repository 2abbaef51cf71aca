// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <polhode/stepping/single_impact.hpp>

namespace polhode {

namespace {

using Vec2 = Eigen::Vector2d;
using Mat2 = Eigen::Matrix2d;

constexpr double kEndless = std::numeric_limits<double>::infinity();
/// Part of the point's initial speed below which its slip has stopped.
constexpr double kNoSlip = 1e-12;
/// Sine of the angle between a slip and its rate below which the slip is straight.
constexpr double kStraight = 1e-12;
/// Largest relative change of the slip in one step along its curve.
constexpr double kCurveStep = 0.04;
constexpr int kMaxCurveSteps = 4000;
/// Number of directions in the first search for a resumed slip.
constexpr int kDirections = 180;

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Velocities as functions of the normal impulse.
class Course {
 public:
  explicit Course(const SingleImpact& impact)
      : law_(impact), v_(impact.velocity), stored_(impact.stored) {
    slow_ = kNoSlip * impact.velocity.norm();
    has_friction_ = impact.mu > 0.0 && impact.mu_across > 0.0;
  }

  SingleImpactEnd follow() {
    if (v_.x() >= 0.0) turn();
    if (!has_friction_) go_straight(Vec2::Zero(), kEndless);
    while (!over_) {
      if (slip().norm() <= slow_) {
        go_straight(friction_without_slip(), kEndless);
        break;
      }
      const Vec2 f = friction(slip()), rate = slip_rate(f);
      if (std::abs(cross(slip(), rate)) > kStraight * slip().norm() * rate.norm()) {
        go_curved();
        continue;
      }
      const double closing = -slip().dot(rate);
      const bool ends = closing > 0.0;
      go_straight(f, ends ? slip().squaredNorm() / closing : kEndless);
      if (!ends) break;
      if (!over_) v_.tail<2>().setZero();
    }
    return {p_, v_};
  }

 private:
  [[nodiscard]] Vec2 slip() const { return v_.tail<2>(); }
  /// Friction impulse per unit normal impulse against a slip: the point of the ellipse that
  /// dissipates most.
  [[nodiscard]] Vec2 friction(const Vec2& s) const {
    const Vec2 weighted(law_.mu * s.x(), law_.mu_across * s.y());
    return -Vec2(law_.mu * weighted.x(), law_.mu_across * weighted.y()) / weighted.norm();
  }
  [[nodiscard]] Vec2 slip_rate(const Vec2& f) const {
    return (law_.mobility * Vec3(1.0, f.x(), f.y())).tail<2>();
  }

  /// Friction that sticks, or else that against the incipient slip.
  [[nodiscard]] Vec2 friction_without_slip() const {
    const Mat2 K = law_.mobility.bottomRightCorner<2, 2>();
    const Vec2 holding =
        -K.completeOrthogonalDecomposition().solve(Vec2(law_.mobility.col(0).tail<2>()));
    if (std::hypot(holding.x() / law_.mu, holding.y() / law_.mu_across) <= 1.0) return holding;
    const auto direction = [](double at) { return Vec2(std::cos(at), std::sin(at)); };
    const auto turning = [&](double at) {
      return cross(direction(at), slip_rate(friction(direction(at))));
    };
    Vec2 best = direction(0.0);
    double fastest = -kEndless;
    const auto angle = [](int i) { return 2.0 * std::numbers::pi * i / kDirections; };
    const double first = turning(0.0);
    double at_b = first;
    for (int i = 0; i < kDirections; ++i) {
      double a = angle(i), b = angle(i + 1);
      const double at_a = at_b;
      at_b = i + 1 < kDirections ? turning(b) : first;  // not by the rounded sine of 2π
      if (at_a * at_b > 0.0) continue;
      for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (a + b);
        (at_a * turning(middle) > 0.0 ? a : b) = middle;
      }
      const Vec2 d = direction(0.5 * (a + b));
      const double outward = d.dot(slip_rate(friction(d)));
      if (outward > fastest) {
        fastest = outward;
        best = d;
      }
    }
    return friction(best);
  }

  /// Switches from compression to restitution, once.
  void turn() {
    if (turned_) return;
    turned_ = true;
    if (std::isfinite(law_.until)) {
      over_ = true;
      return;
    }
    stored_ *= law_.restitution * law_.restitution;
    over_ = stored_ <= law_.kept;
  }

  void advance(const Vec3& force, double p) {
    const Vec3 rate = law_.mobility * force;
    stored_ -= p * (v_.x() + 0.5 * p * rate.x());
    v_ += p * rate;
    p_ += p * force;
  }

  /// Normal impulse at which the stored energy equals that left at the end of compression.
  [[nodiscard]] double filled_after(double rate) const {
    const double more = law_.until - stored_, square = v_.x() * v_.x() - 2.0 * rate * more;
    if (!std::isfinite(more) || !(square >= 0.0)) return kEndless;
    return more > 0.0 ? 2.0 * more / (std::sqrt(square) - v_.x()) : 0.0;
  }

  /// Advances under constant friction, up to this normal impulse.
  void go_straight(const Vec2& f, double most) {
    const Vec3 force(1.0, f.x(), f.y());
    const double rate = law_.mobility.row(0).dot(force);
    if (!turned_) {
      if (const double p = filled_after(rate); p < most) {
        advance(force, p);
        over_ = true;
        return;
      }
      const double p = rate > 0.0 ? -v_.x() / rate : kEndless;
      if (!(p < most)) return stop_or_advance(force, most);
      advance(force, p);
      v_.x() = 0.0;
      most -= p;
      turn();
      if (over_) return;
    }
    // stored − v p − rate p²/2 = kept.
    const double square = v_.x() * v_.x() + 2.0 * rate * (stored_ - law_.kept);
    const double p = square >= 0.0 && v_.x() + std::sqrt(square) > 0.0
                         ? 2.0 * (stored_ - law_.kept) / (v_.x() + std::sqrt(square))
                         : kEndless;
    if (!(p < most)) return stop_or_advance(force, most);
    advance(force, p);
    over_ = true;
  }

  void stop_or_advance(const Vec3& force, double p) {
    if (std::isfinite(p))
      advance(force, p);
    else
      over_ = true;  // does not end: no mobility is like this
  }

  /// v, p along the tangents, p along the normal, stored energy.
  using Values = Eigen::Matrix<double, 7, 1>;

  /// Derivatives by ∫ dp/|slip|, in which a slip decays asymptotically instead of ending.
  [[nodiscard]] Values rates(const Values& y) const {
    const Vec2 s = y.segment<2>(1), f = friction(s);
    const Vec3 force(1.0, f.x(), f.y());
    Values r;
    r << law_.mobility * force, f, 1.0, -y[0];
    return s.norm() * r;
  }

  [[nodiscard]] Values after(const Values& y, double h) const {
    const Values a = rates(y), b = rates(y + 0.5 * h * a), c = rates(y + 0.5 * h * b),
                 d = rates(y + h * c);
    return y + h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
  }

  void go_curved() {
    Values y;
    y << v_, p_.tail<2>(), p_.x(), stored_;
    const double end = std::max(slow_, 1e-10 * slip().norm());
    bool slips = true;
    for (int i = 0; i < kMaxCurveSteps && slips && !over_; ++i) {
      const double h = kCurveStep / slip_rate(friction(y.segment<2>(1))).norm();
      // The present phase ends at a sign change.
      const auto left = [&](const Values& z) {
        return turned_ ? z[6] - law_.kept : std::min(-z[0], law_.until - z[6]);
      };
      Values next = after(y, h);
      if (left(next) <= 0.0 && left(y) > 0.0) {
        double low = 0.0, high = h;
        for (int k = 0; k < 60; ++k) {
          const double middle = 0.5 * (low + high);
          (left(after(y, middle)) > 0.0 ? low : high) = middle;
        }
        y = next = after(y, high);
        take(y);
        if (turned_ || stored_ >= law_.until) {
          over_ = true;
        } else {
          turn();
          y[6] = stored_;
        }
        continue;
      }
      y = next;
      slips = y.segment<2>(1).norm() > end;
    }
    take(y);
    if (!slips) v_.tail<2>().setZero();
    if (slips && !over_) over_ = true;
  }
  void take(const Values& y) {
    v_ = y.head<3>();
    p_ << y[5], y[3], y[4];
    stored_ = y[6];
  }

  SingleImpact law_;
  Vec3 v_, p_ = Vec3::Zero();
  double stored_, slow_ = 0.0;
  bool has_friction_ = false, turned_ = false, over_ = false;
};

}  // namespace

SingleImpactEnd end_of(const SingleImpact& impact) { return Course(impact).follow(); }

}  // namespace polhode
