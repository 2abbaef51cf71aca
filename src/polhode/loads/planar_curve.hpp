// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include <polhode/core/time_function.hpp>

namespace polhode {

/// A smooth curve X(s) in a plane, and the signed distance of points from it.
class PlanarCurve {
 public:
  using Vec2 = Eigen::Vector2d;
  using Mat2 = Eigen::Matrix2d;

  PlanarCurve() = default;
  /// @param x, y  Coordinates over s [m].
  /// @param length  Largest s, or the period of a closed curve.
  /// @param ends  An open curve: it continues straight beyond its ends.
  /// @param side  +1: distances are positive to the right of its direction, −1: to the left.
  PlanarCurve(TimeFunctionPtr x, TimeFunctionPtr y, double length, bool ends, double side);

  /// A point of the curve.
  struct Point {
    Vec2 X, slope, second;  ///< X, X', X''.
  };
  [[nodiscard]] Point at(double s) const;

  /// The distance d of a point, with its derivatives: d = n·(P − X) at the foot, ∇d = n,
  /// ∇∇d = κ/(1 + κ d) τ τᵀ. @eq{curve-distance}
  struct Distance {
    double value = 0.0, foot = 0.0;  ///< d [m], s of the foot.
    Vec2 normal, tangent;            ///< Unit.
    double curvature = 0.0;          ///< κ/(1 + κ d) [1/m].
    double room = 1.0;               ///< 1 + κ d: 0 at the centre of curvature.
  };
  /// @param near  s from which the search for the foot starts.
  [[nodiscard]] Distance distance(const Vec2& P, double near) const;
  /// The foot nearest to a point on the whole curve.
  [[nodiscard]] double nearest(const Vec2& P) const;
  /// Points along the whole curve, at equal intervals of s, including its ends.
  [[nodiscard]] const std::vector<Vec2>& samples() const { return samples_; }
  [[nodiscard]] double length() const { return length_; }  ///< Of s.
  /// Whether s is within the ends of an open curve.
  [[nodiscard]] bool contains(double s) const { return !ends_ || (s >= 0.0 && s <= length_); }
  [[nodiscard]] double size() const { return size_; }  ///< Of its bounding box [m].
  [[nodiscard]] bool known() const { return x_ != nullptr; }

 private:
  TimeFunctionPtr x_, y_;
  double length_ = 1.0;
  bool ends_ = false;
  double side_ = 1.0, size_ = 1.0;
  std::vector<Vec2> samples_;
};

struct LoadDescription;

/// Curve from a load's laws curve_x and curve_y, values period and open; not known if it has none.
/// @param prefix  Of these words: "", or "other_" for a second curve.
[[nodiscard]] PlanarCurve planar_curve(const LoadDescription& load, const std::string& prefix,
                                       double side);

}  // namespace polhode
