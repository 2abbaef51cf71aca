// SPDX-License-Identifier: Apache-2.0
// Nearest features of a body with faces to a part of a round solid or of a tube, in plain numbers.
#pragma once

#include <limits>

#include <polhode/contact/gap.hpp>
#include <polhode/contact/round_solids/ring.hpp>

namespace polhode::contact {

/// Feature of b nearest to a part.
struct Nearest {
  enum Kind { none, face, edge, corner, overlap } kind = none;
  int index = 0;
  double t = 0.0;  ///< Along an edge; with an overlap, the angle of a place on the ring.
  double distance = std::numeric_limits<double>::infinity();
};

/// A part, see part_of(), as seen from a body b with faces.
class SeenPart {
 public:
  enum class Sides { one, two, two_or_through };

  template <class T>
  SeenPart(const geometry::Shape& part, const Placement<T>& at_a, const Placement<T>& at_b)
      : ring_(is_ring(part)),
        half_(part.half),
        centre_(at_b.to_body(value(at_a.point(part.centre)))),
        farthest_(part.half.maxCoeff()) {
    const Vec3 origin = at_b.to_body(Vec3::Zero());
    for (int i = 0; i < 3; ++i)
      axes_.col(i) = at_b.to_body(value(at_a.vector(part.axes.col(i)))) - origin;
  }
  [[nodiscard]] const Vec3& centre() const { return centre_; }
  [[nodiscard]] bool ring() const { return ring_; }

  /// Nearest point of a plane if it lies in its triangle; where the part penetrates the plane, the
  /// middle of the section.
  /// @param sides  Of the triangle. `two_or_through`: a ring whose centre is in front of it may
  ///   also reach through it, but not by much.
  /// @returns the signed distance of the part from the plane.
  double face(const geometry::Shape& b, int triangle, Sides sides, Nearest& best) const;
  void edge(const geometry::Shape& b, int index, Nearest& best) const;
  [[nodiscard]] double corner(const Vec3& x) const;

  /// Overlap of a ring and the convex polyhedron b: the face through which the arcs of it that lie
  /// below all planes leave on the shortest way, and the angle of their deepest place.
  [[nodiscard]] Nearest overlap(const geometry::Shape& b) const;

  /// Lower bound of the distance: convex bodies lie behind their tangent planes, so no point of a
  /// box is nearer.
  [[nodiscard]] double bound(const Vec3& low, const Vec3& high) const;

 private:
  /// Height of a ring above a plane: middle + most·cos(angle − highest).
  struct Height {
    double middle, most, highest;
  };
  [[nodiscard]] Height height_above(const geometry::Shape::Plane& plane) const;

  /// Distance of a point from the part. @param n  Direction in which it grows, in axes of the part.
  [[nodiscard]] double from(const Vec3& y, Vec3& n) const;

  /// Extent of the part along n. @param to_nearest  From its centre to its lowest point.
  [[nodiscard]] double extent(const Vec3& n, Vec3& to_nearest) const;

  /// Calls refine(low, high) for the ranges of an edge around the minima of its distance from a
  /// ring. The nearest place is no farther from the centre than that nearest to the centre plus two
  /// radii.
  template <class At, class Refine>
  void around_minima(const Vec3& X, const Vec3& V, double middle, const At& at,
                     const Refine& refine) const;

  bool ring_;
  Vec3 half_, centre_;
  Mat3 axes_;
  double farthest_;
};

}  // namespace polhode::contact
