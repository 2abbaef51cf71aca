// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/loads/planar_curve.hpp>

namespace polhode {

/// Two curves in one plane, the second of which moves in that of the first, and their distance.
///
/// Where the second stands is q = (P_x, P_y, c, s): the origin P of its own axes, and cosine and
/// sine of the angle of its x axis. They are four numbers of their own: c² + s² = 1 is not asked.
class CurvePair {
 public:
  using Vec2 = PlanarCurve::Vec2;
  using Vec4 = Eigen::Vector4d;
  using Mat4 = Eigen::Matrix4d;

  CurvePair() = default;
  CurvePair(PlanarCurve a, PlanarCurve b) : a_(std::move(a)), b_(std::move(b)) {}

  /// Parameters of a place on each curve.
  struct Places {
    double a = 0.0, b = 0.0;
  };
  /// Distance D(q) of the curves where they are nearest, positive where b is on a's side, with its
  /// derivatives. @eq{curves-distance} @eq{curves-derivatives}
  struct Distance {
    double value = 0.0;  ///< [m]
    Places at;           ///< Where both normals agree.
    Vec4 gradient;       ///< By q.
    Mat4 hessian;
    Vec2 normal, tangent;  ///< Of a, unit.
    Vec2 own;              ///< Place on b in b's axes [m].
    bool touches = true;   ///< It is a least distance: the curves do not fit each other there.
  };
  /// @param near  Places from which the nearest ones are looked for.
  [[nodiscard]] Distance distance(const Vec4& q, const Places& near) const;
  /// The pair of nearest places, among all of both curves, at which they come closest to touching.
  [[nodiscard]] Places first(const Vec4& q) const;
  /// Whether the place on b may have moved like that over a step that began at q: the curves part
  /// all the way there. Beyond a summit between them lies a place of its own, to which contact
  /// would jump.
  [[nodiscard]] bool leads_to(const Vec4& q, const Places& from, const Places& to) const;
  /// Both places are within the ends of their curves.
  [[nodiscard]] bool contains(const Places& at) const {
    return a_.contains(at.a) && b_.contains(at.b);
  }
  [[nodiscard]] bool known() const { return a_.known() && b_.known(); }
  [[nodiscard]] double size() const { return a_.size() + b_.size(); }  ///< Of both [m].

 private:
  PlanarCurve a_, b_;
};

}  // namespace polhode
