// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <numeric>

#include <Eigen/Geometry>

#include <polhode/contact/feature_pairs.hpp>
#include <polhode/contact/mouth_rim.hpp>
#include <polhode/contact/tube.hpp>
#include <polhode/core/assert.hpp>
#include <polhode/geometry/nearest.hpp>
#include <polhode/geometry/triangle_tree.hpp>

namespace polhode::contact {

namespace {

/// Angle at which sides count as parallel, times their half length over the sum of their radii.
constexpr double kParallel = 0.02;

/// Square of the sine of the angle between a bar and the axis of a tube up to which the bar has no
/// direction across the mouth, and range above it in which its contacts become those of one.
constexpr double kSteepFrom = 2e-3, kSteepRange = 8e-3;

double radius_of(const geometry::Shape& s) { return s.half[0] + s.rounding; }

bool is_cone(const geometry::Shape& s) { return s.round() && s.flat_ends.size() == 1; }
bool is_cylinder(const geometry::Shape& s) { return s.round() && s.flat_ends.size() == 2; }
/// Whether the shape is a cylinder that is longer than wide; others lie flat on a rim.
bool is_bar(const geometry::Shape& s) { return is_cylinder(s) && s.half[2] > s.half[0]; }

/// Whether the shape has a straight side, or flank, about its axis.
bool has_side(const geometry::Shape& s) {
  return is_tube(s) || (s.round() && !s.flat_ends.empty());
}

/// Angle between the axis and the side; zero but for a cone.
double flank_angle(const geometry::Shape& s) {
  return is_cone(s) ? std::atan2(s.half[0], 2.0 * s.half[2]) : 0.0;
}

/// Search for feature pairs with corners and faces of `b` as seen from shape `a`, in body
/// coordinates of b.
class Finder {
 public:
  Finder(const geometry::Shape& a, const geometry::Shape& b, const Placement<double>& at_a,
         const Placement<double>& at_b, double distance, bool swapped,
         std::vector<OrderedPair>& found)
      : a_(a),
        b_(b),
        at_a_(at_a),
        at_b_(at_b),
        distance_(distance),
        swapped_(swapped),
        found_(found) {
    find_region();
  }

  /// Adds points of a against b. @param other  The search with both shapes exchanged: features of
  /// `a` near b.
  void points(const Finder& other) {
    if (b_.solid == geometry::Solid::ball && a_.solid == geometry::Solid::ball && swapped_) return;
    // A tube is in contact with a plane as a cylinder is.
    const bool stands = is_tube(a_) && b_.solid == geometry::Solid::half_space;
    if (is_tube(a_) && !stands) return points_of_tube(other);
    // A ball has a single corner; the other shape's corners against it would duplicate the pair.
    if (b_.solid == geometry::Solid::ball && a_.solid != geometry::Solid::ball) return;
    const bool faces =
        b_.solid == geometry::Solid::polyhedron || b_.solid == geometry::Solid::surface;
    const bool some = a_.tree && !stands;
    const std::vector<int>& points = faces || some ? a_.face_points : a_.points;
    for (int i : some ? other.corners_ : points) {
      if (some && !std::binary_search(points.begin(), points.end(), i)) continue;
      // A fixed point of a rim acts on a plane where the rim lies flat.
      const bool rim = stands || i < a_.rim_corners;
      add_point(i, rim && b_.solid == geometry::Solid::half_space ? Fade::flat : Fade::none);
    }
  }

  void edges(const Finder& other) {
    const bool tubes = is_tube(a_) && is_tube(b_);
    if (!tubes && (is_round_tube() || other.is_round_tube())) return;  // by their rims
    for (int i : other.edges_) {
      if (!a_.edges[i].convex || (tubes && !is_inner_edge(a_, i))) continue;
      const Vec3 p = in_b(a_.corners[a_.edges[i].i]), u = in_b(a_.corners[a_.edges[i].j]) - p;
      if (out_of_ball(p + 0.5 * u, 0.5 * u.norm()) || !in_region({p, p + u})) continue;
      for (int j : edges_) {
        if (!b_.edges[j].convex || (tubes && !is_inner_edge(b_, j))) continue;
        const Vec3 &q = b_.corners[b_.edges[j].i], v = b_.corners[b_.edges[j].j] - q;
        const geometry::SegmentsRegion r = geometry::nearest_on_segments(p, u, q, v);
        if ((p + r.s * u - q - r.t * v).norm() < reach())
          push({GapKind::edge_edge, i, j, Fade::parallel});
      }
    }
  }

  /// Adds the pairs of a round side a, or of the outer side and rims of a tube.
  void round() {
    if (!a_.round() && !is_tube(a_)) return;
    const bool whole = a_.flat_ends.empty();
    const int parts = whole ? 1 : static_cast<int>(a_.flat_ends.size());
    const Fade fade = whole ? Fade::none : Fade::parallel;
    if (b_.solid == geometry::Solid::half_space) {
      for (int i = 0; i < parts; ++i) push({GapKind::extreme_plane, i, 0, fade});
      return;
    }
    if (out_of_ball(in_b(a_.bound_centre), a_.bound_radius)) return;
    const bool round_b = b_.round() || is_tube(b_), sides = has_side(a_) && has_side(b_);
    if (round_b && !swapped_) {
      if (sides)
        add_sides({GapKind::round_round, 0, 0, Fade::parallel}, radius_of(b_), b_.half[2]);
      else
        add({GapKind::round_round, 0, 0, Fade::none});
    }
    // Contact of parallel sides, at the discs at their ends.
    if (sides || (has_side(a_) && b_.solid == geometry::Solid::segment))
      for (int i = 0; i < parts; ++i) add({GapKind::end_round, i, 0, Fade::none});
    if (is_tube(a_) && is_bar(b_)) rims();
    if (b_.round() || (is_tube(a_) && !is_round_tube())) return;
    const bool tubes = is_tube(a_) && is_tube(b_);
    for (int i = 0; i < parts && !tubes; ++i)
      if (is_tube(b_)) {
        add({GapKind::part_solid, i, 0, Fade::none});
        add({GapKind::part_end, i, 0, Fade::none});
      } else if (b_.solid == geometry::Solid::surface) {
        add({GapKind::part_surface, i, 0, Fade::none});
      } else if (b_.solid == geometry::Solid::polyhedron) {
        add({GapKind::part_solid, i, 0, Fade::none});
      }
    if (is_tube(a_) && !tubes) rims();
    // Edges are tested against the lateral surface between both ends. An ellipsoid is already one
    // part: only edges without faces are left, capsules and rims of tubes.
    if (whole && b_.solid != geometry::Solid::segment && !is_tube(b_)) return;
    for (int j : edges_) {
      if (!b_.edges[j].convex || (is_tube(b_) && !is_inner_edge(b_, j))) continue;
      if (!has_side(a_) || (is_tube(b_) && !tubes)) {
        add({GapKind::round_edge, 0, j, is_bar(a_) ? Fade::aligned : Fade::none, kSteepRange,
             kSteepFrom});
        continue;
      }
      const double length = (b_.corners[b_.edges[j].j] - b_.corners[b_.edges[j].i]).norm();
      add_sides({GapKind::round_edge, 0, j, Fade::parallel}, b_.rounding, 0.5 * length);
    }
  }

  /// Adds the inner rims of a tube a over edges of b or a cylinder. Bars nearly along the axis have
  /// one contact with a rim, or cylinders those with its short arcs; others have two.
  void rims() {
    if (is_plug()) return;
    for (int number = 0; number < (b_.round() ? kHalfRims : kRimArcs); ++number) {
      const Fade fade = is_whole_rim(number) ? Fade::aligned : Fade::parallel;
      if (b_.round()) {
        add({GapKind::rim_bar, number, 0, fade, kSteepRange, kSteepFrom});
        continue;
      }
      for (int j : edges_)
        if (b_.edges[j].convex) add({GapKind::rim_edge, number, j, fade, kSteepRange, kSteepFrom});
    }
  }

 private:
  /// Finds the overlap of the bounding boxes of both shapes, in coordinates of b, and the features
  /// of b in it.
  void find_region() {
    Eigen::AlignedBox3d a, b;
    if (a_.tree)
      for (int k = 0; k < 8; ++k)
        a.extend(in_b(box_of(a_).corner(static_cast<Eigen::AlignedBox3d::CornerType>(k))));
    else
      for (const Vec3& X : a_.corners) a.extend(in_b(X));
    if (a_.round() || a_.corners.empty()) {
      const Vec3 middle = in_b(a_.bound_centre), half = Vec3::Constant(a_.bound_radius);
      if (a_.bounded()) a.extend(Vec3(middle - half)).extend(Vec3(middle + half));
    }
    if (b_.tree)
      b = box_of(b_);
    else
      for (const Vec3& X : b_.corners) b.extend(X);
    const Vec3 more = Vec3::Constant(reach());
    const Vec3 far = Vec3::Constant(std::numeric_limits<double>::max());
    region_ = Eigen::AlignedBox3d(Vec3(-far), far);
    if (!a.isEmpty()) region_.clamp({Vec3(a.min() - more), Vec3(a.max() + more)});
    if (!b.isEmpty() && !b_.round()) region_.clamp({Vec3(b.min() - more), Vec3(b.max() + more)});
    const auto numbers = [](std::size_t count) {
      std::vector<int> all(count);
      std::iota(all.begin(), all.end(), 0);
      return all;
    };
    triangles_ = numbers(b_.tree ? 0 : b_.triangles.size());
    if (b_.tree)
      b_.tree->visit(
          [&](const auto& box) {
            return region_.intersects(Eigen::AlignedBox3d(box.low, box.high));
          },
          [&](int t) { triangles_.push_back(t); });
    std::erase_if(triangles_, [&](int t) {
      const auto& c = b_.triangles[t];
      return !in_region({b_.corners[c[0]], b_.corners[c[1]], b_.corners[c[2]]});
    });
    if (b_.tree) {
      for (int t : triangles_)
        for (int k = 0; k < 3; ++k) {
          edges_.push_back(b_.triangle_edges[t][k]);
          corners_.push_back(b_.triangles[t][k]);
        }
      for (std::vector<int>* all : {&edges_, &corners_}) {
        std::sort(all->begin(), all->end());
        all->erase(std::unique(all->begin(), all->end()), all->end());
      }
    } else {
      edges_ = numbers(b_.edges.size());
      corners_ = numbers(b_.corners.size());
    }
    std::erase_if(edges_, [&](int e) {
      return !in_region({b_.corners[b_.edges[e].i], b_.corners[b_.edges[e].j]});
    });
    std::erase_if(corners_, [&](int k) { return !in_region({b_.corners[k]}); });
  }
  [[nodiscard]] static Eigen::AlignedBox3d box_of(const geometry::Shape& s) {
    return {s.tree->low(), s.tree->high()};
  }
  /// Whether the bounding box of points intersects the region.
  [[nodiscard]] bool in_region(std::initializer_list<Vec3> points) const {
    Eigen::AlignedBox3d box;
    for (const Vec3& x : points) box.extend(x);
    return region_.intersects(box);
  }

  /// Whether a is a tube whose outer side and rims act, instead of its polygon.
  [[nodiscard]] bool is_round_tube() const {
    return is_tube(a_) &&
           (b_.solid == geometry::Solid::polyhedron || b_.solid == geometry::Solid::segment ||
            b_.round() || b_.solid == geometry::Solid::surface);
  }
  /// Adds points of a tube a: corners of its outer rims against round bodies, those of its inner
  /// rims against a ball or capsule that does not fit into it and may touch all of a rim at once,
  /// and fixed points of its ends against what they stand on or what lies on them.
  void points_of_tube(const Finder& other) {
    const bool plug = is_plug();
    if (plug || is_tube(b_) || b_.round())
      for (int i : other.corners_)
        if (is_tube(b_) || on_inner_side(a_, i) == plug) add_point(i, Fade::none);
    const bool lid = is_cylinder(b_);
    if (lid || b_.solid == geometry::Solid::polyhedron ||
        (b_.solid == geometry::Solid::surface && !is_tube(b_)))
      for (int i : a_.face_points) add_point(i, lid ? Fade::aligned : Fade::none);
  }
  /// Whether b is a ball or capsule that does not fit into the tube a.
  [[nodiscard]] bool is_plug() const {
    return (b_.solid == geometry::Solid::ball || b_.solid == geometry::Solid::segment) &&
           a_.rounding + b_.rounding > a_.half[1];
  }
  void add_point(int i, Fade fade) {
    if (b_.solid != geometry::Solid::surface) return add({GapKind::point_solid, i, 0, fade});
    const Vec3 x = in_b(a_.corners[i]);
    if (out_of_ball(x, 0.0) || !in_region({x})) return;
    add({is_tube(b_) ? GapKind::point_solid : GapKind::point_surface, i, 0, fade});
  }
  [[nodiscard]] double reach() const { return distance_ + a_.rounding + b_.rounding; }
  [[nodiscard]] Vec3 in_b(const Vec3& X) const { return at_b_.to_body(value(at_a_.point(X))); }
  [[nodiscard]] bool out_of_ball(const Vec3& x, double radius) const {
    return b_.bounded() &&
           (x - b_.bound_centre).norm() > b_.bound_radius + a_.rounding + distance_ + radius;
  }
  void push(const FeaturePair& pair) { found_.push_back({pair, swapped_}); }
  /// Adds the pair if it is near.
  void add(const FeaturePair& pair) {
    if (gap(pair, a_, b_, at_a_, at_b_).distance < distance_) push(pair);
  }
  /// Adds the straight side of a and one of b, or an edge. They fade out where the ends of the
  /// shorter one are as near: there the gap at these differs by less than a thousandth of the
  /// radii.
  void add_sides(FeaturePair pair, double radius, double half) {
    const double angle = kParallel * (radius_of(a_) + radius) / std::min(a_.half[2], half);
    pair.fade_square = std::min(pair.fade_square, angle * angle);
    if (is_cone(a_) || is_cone(b_)) {
      const double of_a = flank_angle(a_), of_b = flank_angle(b_);
      pair.fade = Fade::flank;
      pair.aligned = std::cos(of_a + of_b);
      pair.opposed = -std::cos(of_a - of_b);
    }
    add(pair);
  }
  const geometry::Shape &a_, &b_;
  const Placement<double>&at_a_, &at_b_;
  double distance_;
  bool swapped_;
  std::vector<OrderedPair>& found_;
  Eigen::AlignedBox3d region_;
  std::vector<int> corners_, edges_, triangles_;  ///< Features of b in the region.
};

}  // namespace

void near_feature_pairs(const geometry::Shape& first, const geometry::Shape& second,
                        const Placement<double>& at_first, const Placement<double>& at_second,
                        double distance, std::vector<OrderedPair>& found) {
  if (!first.bounded() && !second.bounded()) return;
  const auto start = static_cast<std::ptrdiff_t>(found.size());
  Finder forth(first, second, at_first, at_second, distance, false, found);
  Finder back(second, first, at_second, at_first, distance, true, found);
  forth.points(back);
  back.points(forth);
  forth.edges(back);
  forth.round();
  back.round();
  std::sort(found.begin() + start, found.end(),
            [](const OrderedPair& x, const OrderedPair& y) { return x.key() < y.key(); });
  POLHODE_ASSERT(
      std::adjacent_find(found.begin() + start, found.end(), [](const auto& x, const auto& y) {
        return x.key() == y.key();
      }) == found.end());
}

}  // namespace polhode::contact
