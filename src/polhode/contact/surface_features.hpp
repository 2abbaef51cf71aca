// SPDX-License-Identifier: Apache-2.0
// Combined gap to the triangles, edges and corners of a surface.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <polhode/contact/gap.hpp>
#include <polhode/geometry/triangle_tree.hpp>

namespace polhode::contact {

/// Gap below which features of a surface count together; it depends on the shapes alone, not on the
/// law.
[[nodiscard]] inline double surface_reach(const geometry::Shape& a, const geometry::Shape& b) {
  return std::min(1e-3 * std::min(a.size, b.size), a.rounding + b.rounding);
}

/// Nearest point on a triangle, an edge or a corner.
struct SurfacePlace {
  int kind = 0, index = 0;  ///< 0 face, 1 edge, 2 corner; its index in the shape.
  double gap = 0.0;         ///< [m]
  double t = 0.0;           ///< Along the edge.
  int count = 0;            ///< Multiplicity.
};

/// Lists of a search among features of a surface, reused by the searches of a thread.
struct SurfaceSearch {
  std::vector<int> triangles, edges, corners;
  std::vector<SurfacePlace> places;

  static SurfaceSearch& of_this_thread() {
    thread_local SurfaceSearch search;
    return search;
  }
};

/// Nearest points at a gap below `reach`, nearest first. Each triangle counts once, minus each edge
/// shared by two, plus each inner corner. Neighbours with a common nearest point thus cancel
/// exactly, so that over a flat region one face is left; those with a positive multiplicity are the
/// places at which the distance from the surface is least.
///
/// @param search  Its triangles are those that may be near; receives the places.
/// @param seen  triangle(t), edge(e), corner(k) → SurfacePlace.
template <class Seen>
void find_least_places(const geometry::Shape& b, SurfaceSearch& search, double reach,
                       const Seen& seen) {
  std::vector<SurfacePlace>& list = search.places;
  list.clear();
  search.edges.clear();
  search.corners.clear();
  for (const int t : search.triangles) {
    SurfacePlace place = seen.triangle(t);
    if (!(place.gap < reach)) continue;
    place.count = 1;
    list.push_back(place);
    // An edge or corner is at most as near as one of its triangles.
    for (int k = 0; k < 3; ++k) {
      const int e = b.triangle_edges[t][k], c = b.triangles[t][k];
      if (!b.edges[e].open) search.edges.push_back(e);
      if (!b.border_corner[c]) search.corners.push_back(c);
    }
  }
  for (std::vector<int>* all : {&search.edges, &search.corners}) {
    std::sort(all->begin(), all->end());
    all->erase(std::unique(all->begin(), all->end()), all->end());
  }
  const auto take = [&](SurfacePlace place, int count) {
    if (!(place.gap < reach)) return;
    place.count = count;
    list.push_back(place);
  };
  for (const int e : search.edges) take(seen.edge(e), -1);
  for (const int k : search.corners) take(seen.corner(k), 1);
  const auto uncounted = [](const SurfacePlace& p) { return p.count == 0; };
  std::sort(list.begin(), list.end(), [](const SurfacePlace& x, const SurfacePlace& y) {
    return x.kind != y.kind ? x.kind < y.kind : x.index < y.index;
  });
  for (std::size_t k = 1; k < list.size(); ++k) {
    SurfacePlace &before = list[k - 1], &here = list[k];
    if (before.kind != here.kind || before.index != here.index) continue;
    here.t = before.t, here.gap = before.gap;
    here.count += before.count;
    before.count = 0;
  }
  std::erase_if(list, uncounted);
  std::sort(list.begin(), list.end(), [](const SurfacePlace& x, const SurfacePlace& y) {
    if (x.gap != y.gap) return x.gap < y.gap;
    return x.kind != y.kind ? x.kind < y.kind : x.index < y.index;
  });
}

/// Places that count in one gap: in order of their gaps the multiplicities sum to at least one, as
/// over a pit narrower than a ball. @eq{contact-one-gap}
template <class Seen>
void find_places_that_count(const geometry::Shape& b, SurfaceSearch& search, double reach,
                            const Seen& seen) {
  find_least_places(b, search, reach, seen);
  std::vector<SurfacePlace>& list = search.places;
  int open = 0, places = 0;
  for (SurfacePlace& p : list) {
    open += p.count;
    p.count = std::max(1, open) - places;
    places += p.count;
  }
  std::erase_if(list, [](const SurfacePlace& p) { return p.count == 0; });
}

/// Appends the gap of a least place, unless the surface is seen from its inside there.
void add_from_outside(const Gap<double>& g, const SurfacePlace& place, const geometry::Shape& b,
                      const Placement<double>& at_b, std::vector<Gap<double>>& gaps);

/// One gap with the potential of all, β(g) = (reach − g)³ of each. @eq{contact-one-gap}
template <class T>
class OneGap {
 public:
  explicit OneGap(double reach) : reach_(reach), gaps_(list()) { gaps_.clear(); }

  /// Adds a gap, the nearest one first; others beyond `reach` do not count.
  void add(const Gap<T>& gap, int count) {
    if (gaps_.empty() || value(gap.distance) < reach_) gaps_.push_back({gap, double(count)});
  }
  [[nodiscard]] Gap<T> gap() const {
    const Gap<T>& nearest = gaps_.front().gap;
    if (gaps_.size() == 1 || !(value(nearest.distance) < reach_)) return nearest;
    T cube(0.0);
    for (const auto& [g, count] : gaps_) {
      const T p = reach_ - g.distance;
      cube = cube + count * (p * p * p);
    }
    T P(std::cbrt(value(cube)));
    for (int step = 0; step < 2; ++step)
      P = P - (1.0 / (3.0 * value(P) * value(P))) * (P * P * P - cube);
    Gap<T> one;
    one.feature = nearest.feature;
    one.distance = reach_ - P;
    V3<T> pull = constant<T>(Vec3::Zero()), point = pull;
    T share(0.0);
    for (const auto& [g, count] : gaps_) {
      const T p = (reach_ - g.distance) / P;
      const T force = count * (p * p);
      pull = pull + force * g.normal;
      point = point + force * (g.point - nearest.point);
      share = share + force;
    }
    one.slope = norm(pull);
    one.share = share;
    one.point = nearest.point + (T(1.0) / share) * point;
    if (value(one.slope) > 1e-9)
      one.normal = (T(1.0) / one.slope) * pull;
    else
      one.normal = nearest.normal, one.slope = T(0.0);
    return one;
  }

 private:
  struct Counted {
    Gap<T> gap;
    double count;
  };
  static std::vector<Counted>& list() {
    thread_local std::vector<Counted> gaps;
    return gaps;
  }

  double reach_;
  std::vector<Counted>& gaps_;  ///< One OneGap at a time per thread.
};

}  // namespace polhode::contact
