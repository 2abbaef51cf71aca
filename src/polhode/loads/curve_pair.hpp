// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/loads/planar_curve.hpp>

namespace polhode {

/// Two curves in one plane, the second of which moves in that of the first, and their distance.
///
/// The second curve's placement is q = (P_x, P_y, c, s): the origin P of its own axes, and cosine
/// and sine of the angle of its x axis. The four numbers are independent: c² + s² = 1 is not
/// assumed.
class CurvePair {
 public:
  using Vec2 = PlanarCurve::Vec2;
  using Vec4 = Eigen::Vector4d;
  using Mat4 = Eigen::Matrix4d;

  CurvePair() = default;
  CurvePair(PlanarCurve a, PlanarCurve b) : a_(std::move(a)), b_(std::move(b)) {}

  /// Parameters of a point on each curve.
  struct Places {
    double a = 0.0, b = 0.0;
  };
  /// Distance D(q) of the curves at their nearest points, positive where b is on a's side, with its
  /// derivatives. @eq{curves-distance} @eq{curves-derivatives}
  struct Distance {
    double value = 0.0;  ///< [m]
    Places at;           ///< Points with a common normal.
    Vec4 gradient;       ///< By q.
    Mat4 hessian;
    Vec2 normal, tangent;  ///< Of a, unit.
    Vec2 own;              ///< Place on b in b's axes [m].
    bool touches = true;   ///< It is a local minimum: the curves are not conforming there.
  };
  /// @param near  Start of the search for the nearest points.
  [[nodiscard]] Distance distance(const Vec4& q, const Places& near) const;
  /// Pair of nearest points, among all of both curves, with the smallest distance.
  [[nodiscard]] Places first(const Vec4& q) const;
  /// Whether the contact point on b may have moved like that over a step that began at q: the
  /// curves separate all the way there. Beyond a maximum of the distance between them lies another
  /// minimum, to which contact would jump.
  [[nodiscard]] bool leads_to(const Vec4& q, const Places& from, const Places& to) const;
  /// Whether both points are within the ends of their curves.
  [[nodiscard]] bool contains(const Places& at) const {
    return a_.contains(at.a) && b_.contains(at.b);
  }
  [[nodiscard]] bool known() const { return a_.known() && b_.known(); }
  [[nodiscard]] double size() const { return a_.size() + b_.size(); }  ///< Of both [m].

 private:
  PlanarCurve a_, b_;
};

}  // namespace polhode
