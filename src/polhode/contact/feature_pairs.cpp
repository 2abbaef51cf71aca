// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

#include <Eigen/Geometry>

#include <polhode/contact/feature_pairs.hpp>
#include <polhode/contact/nearest.hpp>

namespace polhode::contact {

namespace {

/// Corners and faces of `b` as seen by shape `a`; both in body coordinates of b.
class Finder {
 public:
  Finder(const Shape& a, const Shape& b, const Placement<double>& at_a,
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

  void points() {
    if (b_.solid == Solid::ball && a_.solid == Solid::ball && swapped_) return;
    // A ball has one corner and no other feature: the other shape's corners would repeat it.
    if (b_.solid == Solid::ball && a_.solid != Solid::ball) return;
    for (int i : a_.points) {
      const Vec3 x = in_b(a_.corners[i]);
      if (b_.solid == Solid::surface) {
        point_over_surface(i, x);
        continue;
      }
      if (a_.solid == Solid::cylinder || (a_.solid == Solid::cone && i != cone_apex())) {
        rim_point(i, x);
        continue;
      }
      add({GapKind::point_solid, i, 0, 1.0, Fade::none});
    }
  }

  void edges() {
    for (int i = 0; i < static_cast<int>(a_.edges.size()); ++i) {
      if (!a_.edges[i].convex) continue;
      const Vec3 p = in_b(a_.corners[a_.edges[i].i]), u = in_b(a_.corners[a_.edges[i].j]) - p;
      if (out_of_ball(p + 0.5 * u, 0.5 * u.norm()) || !in_region({p, p + u})) continue;
      for (int j : edges_) {
        if (!b_.edges[j].convex) continue;
        const Vec3 &q = b_.corners[b_.edges[j].i], v = b_.corners[b_.edges[j].j] - q;
        const SegmentsRegion r = nearest_on_segments(p, u, q, v);
        if ((p + r.s * u - q - r.t * v).norm() < reach())
          push({GapKind::edge_edge, i, j, 1.0, Fade::parallel});
      }
    }
  }

  /// Side a is round.
  void round() {
    if (!a_.round()) return;
    const bool rims = a_.solid != Solid::ellipsoid;
    const int extremes = a_.solid == Solid::cylinder ? 2 : 1;
    const Fade fade = rims ? Fade::parallel : Fade::none;
    if (b_.solid == Solid::half_space) {
      for (int i = 0; i < extremes; ++i) push({GapKind::extreme_solid, i, 0, 1.0, fade});
      return;
    }
    if (b_.round()) {
      if (!swapped_) push({GapKind::round_round, 0, 0, 1.0, Fade::none});
      return;
    }
    const Vec3 middle = in_b(a_.bound_centre);
    if (out_of_ball(middle, a_.bound_radius)) return;
    for (int j = 0; j < static_cast<int>(b_.planes.size()); ++j) {
      if (b_.solid == Solid::polyhedron && !first_of_its_plane(j)) continue;
      // Of a surface a triangle acts, of a solid the whole: the extreme point may touch another
      // face.
      if (b_.solid == Solid::surface &&
          std::abs(b_.planes[j].normal.dot(middle) - b_.planes[j].offset) >
              a_.bound_radius + b_.rounding + distance_)
        continue;
      for (int i = 0; i < extremes; ++i)
        add({GapKind::extreme_solid, i, j, 1.0, fade}, rims ? slide(b_.planes[j].normal) : 0.0);
    }
    const Fade along = a_.solid == Solid::cylinder ? Fade::parallel : Fade::none;
    for (int j : edges_)
      if (b_.edges[j].convex) add({GapKind::round_edge, 0, j, 1.0, along});
  }

 private:
  /// Where the boxes around both shapes overlap, in coordinates of b, and what of b lies there.
  void find_region() {
    Eigen::AlignedBox3d a, b;
    for (const Vec3& X : a_.corners) a.extend(in_b(X));
    if (a_.round() || a_.corners.empty()) {
      const Vec3 middle = in_b(a_.bound_centre), half = Vec3::Constant(a_.bound_radius);
      if (a_.bounded()) a.extend(Vec3(middle - half)).extend(Vec3(middle + half));
    }
    for (const Vec3& X : b_.corners) b.extend(X);
    const Vec3 more = Vec3::Constant(reach());
    const Vec3 far = Vec3::Constant(std::numeric_limits<double>::max());
    region_ = Eigen::AlignedBox3d(Vec3(-far), far);
    if (!a.isEmpty()) region_.clamp({Vec3(a.min() - more), Vec3(a.max() + more)});
    if (!b.isEmpty() && !b_.round()) region_.clamp({Vec3(b.min() - more), Vec3(b.max() + more)});
    const auto size = [](const auto& list) { return static_cast<int>(list.size()); };
    for (int k = 0; k < size(b_.corners); ++k)
      if (in_region({b_.corners[k]})) corners_.push_back(k);
    for (int e = 0; e < size(b_.edges); ++e)
      if (in_region({b_.corners[b_.edges[e].i], b_.corners[b_.edges[e].j]})) edges_.push_back(e);
    for (int t = 0; t < size(b_.triangles); ++t) {
      const auto& c = b_.triangles[t];
      if (in_region({b_.corners[c[0]], b_.corners[c[1]], b_.corners[c[2]]}))
        triangles_.push_back(t);
    }
  }
  /// Whether the box around points meets the region.
  [[nodiscard]] bool in_region(std::initializer_list<Vec3> points) const {
    Eigen::AlignedBox3d box;
    for (const Vec3& x : points) box.extend(x);
    return region_.intersects(box);
  }

  [[nodiscard]] int cone_apex() const { return static_cast<int>(a_.corners.size()) - 1; }
  [[nodiscard]] double reach() const { return distance_ + a_.rounding + b_.rounding; }
  [[nodiscard]] Vec3 in_b(const Vec3& X) const { return at_b_.to_body(value(at_a_.point(X))); }
  [[nodiscard]] bool out_of_ball(const Vec3& x, double radius) const {
    return b_.bounded() &&
           (x - b_.bound_centre).norm() > b_.bound_radius + a_.rounding + distance_ + radius;
  }
  void push(const FeaturePair& pair) { found_.push_back({pair, swapped_}); }
  /// Adds the pair if it is near. @param more  How much nearer it may come by its own [m].
  void add(const FeaturePair& pair, double more = 0.0) {
    if (gap(pair, a_, b_, at_a_, at_b_).distance < distance_ + more) push(pair);
  }
  /// How far the extreme point of a rim of a, against a plane of b, slides along it while the
  /// shapes turn by what moves them by the distance: far, if the axis is nearly along the normal.
  [[nodiscard]] double slide(const Vec3& normal) const {
    const double cosine = value(at_a_.vector(a_.axes.col(2))).dot(value(at_b_.vector(normal)));
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine)), R = a_.half[0];
    const double left = sine - distance_ / R;  // of the sine, after such a turn
    return left > 0.0 ? std::min(2.0 * R, distance_ / left) : 2.0 * R;
  }

  /// A fixed point of a rim acts where the rim lies flat: on a plane, or on faces turned to it.
  void rim_point(int i, const Vec3& x) {
    if (b_.solid == Solid::half_space) {
      add({GapKind::point_solid, i, 0, 1.0, Fade::flat});
    } else if (b_.solid == Solid::polyhedron) {
      if (out_of_ball(x, 0.0)) return;
      for (int j = 0; j < static_cast<int>(b_.planes.size()); ++j)
        if (first_of_its_plane(j)) add({GapKind::point_solid, i, j, 1.0, Fade::flat});
    } else {
      add({GapKind::point_solid, i, 0, 1.0, Fade::none});
    }
  }

  /// Triangles, less the edges that two of them share, plus the corners those had in common.
  void point_over_surface(int i, const Vec3& x) {
    if (out_of_ball(x, 0.0) || !in_region({x})) return;
    const double r = reach();
    for (int t : triangles_) {
      const auto& c = b_.triangles[t];
      if (std::abs(b_.planes[t].normal.dot(x) - b_.planes[t].offset) > r) continue;
      const TriangleRegion n =
          nearest_on_triangle(x, b_.corners[c[0]], b_.corners[c[1]], b_.corners[c[2]]);
      if ((x - n.nearest).norm() < r) push({GapKind::point_triangle, i, t, 1.0, Fade::none});
    }
    for (int e : edges_) {
      if (b_.edges[e].open) continue;
      const Vec3 &p = b_.corners[b_.edges[e].i], v = b_.corners[b_.edges[e].j] - p;
      const double along = std::clamp((x - p).dot(v) / v.squaredNorm(), 0.0, 1.0);
      if ((x - p - along * v).norm() < r) push({GapKind::point_edge, i, e, -1.0, Fade::none});
    }
    for (int k : corners_)
      if (!b_.border_corner[k] && (x - b_.corners[k]).norm() < r)
        push({GapKind::point_corner, i, k, 1.0, Fade::none});
  }

  [[nodiscard]] bool first_of_its_plane(int j) const {
    for (int k = 0; k < j; ++k)
      if (b_.planes[k].normal.dot(b_.planes[j].normal) > 1.0 - 1e-12) return false;
    return true;
  }

  const Shape &a_, &b_;
  const Placement<double>&at_a_, &at_b_;
  double distance_;
  bool swapped_;
  std::vector<OrderedPair>& found_;
  Eigen::AlignedBox3d region_;
  std::vector<int> corners_, edges_, triangles_;  ///< Of b, in the region.
};

}  // namespace

void near_feature_pairs(const Shape& first, const Shape& second, const Placement<double>& at_first,
                        const Placement<double>& at_second, double distance,
                        std::vector<OrderedPair>& found) {
  if (!first.bounded() && !second.bounded()) return;
  const auto start = static_cast<std::ptrdiff_t>(found.size());
  Finder forth(first, second, at_first, at_second, distance, false, found);
  Finder back(second, first, at_second, at_first, distance, true, found);
  forth.points();
  back.points();
  forth.edges();
  forth.round();
  back.round();
  std::sort(found.begin() + start, found.end(),
            [](const OrderedPair& x, const OrderedPair& y) { return x.key() < y.key(); });
}

}  // namespace polhode::contact
