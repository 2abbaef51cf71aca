// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/dynamics/placement.hpp>
#include <polhode/geometry/shape.hpp>

namespace polhode::contact {

/// Point in the half plane through the axis of a solid of revolution: h along the axis, q from it.
template <class T>
struct Meridian {
  T h, q;
  V3<T> axis, outward;  ///< Unit.

  Meridian(const V3<T>& x, const geometry::Shape& b, const Placement<T>& at_b) {
    axis = at_b.vector(b.axes.col(2));
    const V3<T> w = x - at_b.point(b.centre);
    h = dot(axis, w);
    const V3<T> across = w - h * axis;
    if (value(dot(across, across)) > 0.0) {
      q = norm(across);
      outward = (T(1.0) / q) * across;
    } else {
      q = T(0.0);
      outward = at_b.vector(b.axes.col(0));
    }
  }
  [[nodiscard]] V3<T> point(const Placement<T>& at_b, const geometry::Shape& b, double h_0,
                            double q_0) const {
    return at_b.point(b.centre) + h_0 * axis + q_0 * outward;
  }
};

}  // namespace polhode::contact
