// SPDX-License-Identifier: Apache-2.0
// Triangles, edges and corners of a surface that something meets, as one gap.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <polhode/contact/gap.hpp>
#include <polhode/contact/triangle_tree.hpp>

namespace polhode::contact {

/// Gap from which on features of a surface count together: that of shapes alone, whatever the law.
[[nodiscard]] inline double surface_reach(const Shape& a, const Shape& b) {
  return std::min(1e-3 * std::min(a.size, b.size), a.rounding + b.rounding);
}

/// Where something is nearest to a triangle, an edge or a corner.
struct SurfacePlace {
  int kind = 0, index = 0;  ///< 0 face, 1 edge, 2 corner; which of the shape's.
  double gap = 0.0;         ///< [m]
  double t = 0.0;           ///< Along the edge.
  int count = 0;            ///< How often it counts.
};

/// Places that count at a gap below `reach`, nearest first. Each triangle counts once, less each
/// edge that two share, plus each inner corner: neighbours that are nearest by what they have in
/// common cancel, by number, so over what is flat one face is left. In order of their gaps places
/// sum up to one at least, as over a pit that is narrower than a ball. @eq{contact-one-gap}
///
/// @param seen  triangle(t), edge(e), corner(k) → SurfacePlace.
template <class Seen>
std::vector<SurfacePlace> places_that_count(const Shape& b, const std::vector<int>& near,
                                            double reach, const Seen& seen) {
  std::vector<SurfacePlace> list;
  const auto take = [&](SurfacePlace place, int count) {
    if (!(place.gap < reach)) return;
    place.count = count;
    list.push_back(place);
  };
  std::vector<int> edges, corners;
  for (const int t : near) {
    take(seen.triangle(t), 1);
    for (const int e : b.triangle_edges[t])
      if (!b.edges[e].open) edges.push_back(e);
    for (const int k : b.triangles[t])
      if (!b.border_corner[k]) corners.push_back(k);
  }
  for (std::vector<int>* all : {&edges, &corners}) {
    std::sort(all->begin(), all->end());
    all->erase(std::unique(all->begin(), all->end()), all->end());
  }
  for (const int e : edges) take(seen.edge(e), -1);
  for (const int k : corners) take(seen.corner(k), 1);
  std::sort(list.begin(), list.end(), [](const SurfacePlace& x, const SurfacePlace& y) {
    return x.kind != y.kind ? x.kind < y.kind : x.index < y.index;
  });
  std::vector<SurfacePlace> counted;
  for (const SurfacePlace& p : list)
    if (!counted.empty() && counted.back().kind == p.kind && counted.back().index == p.index)
      counted.back().count += p.count;
    else
      counted.push_back(p);
  std::erase_if(counted, [](const SurfacePlace& p) { return p.count == 0; });
  std::stable_sort(counted.begin(), counted.end(),
                   [](const SurfacePlace& x, const SurfacePlace& y) { return x.gap < y.gap; });
  int open = 0, places = 0;
  for (SurfacePlace& p : counted) {
    open += p.count;
    p.count = std::max(1, open) - places;
    places += p.count;
  }
  std::erase_if(counted, [](const SurfacePlace& p) { return p.count == 0; });
  return counted;
}

/// One gap with the potential of all, β(g) = (reach − g)³ of each. @eq{contact-one-gap}
///
/// @param rho_a  What is round about side a [m].
template <class T>
Gap<T> one_gap(const std::vector<Gap<T>>& gaps, const std::vector<int>& counts, double reach) {
  if (gaps.size() == 1) return gaps.front();
  T cube(0.0);
  for (std::size_t k = 0; k < gaps.size(); ++k) {
    const T p = reach - gaps[k].distance;
    cube = cube + static_cast<double>(counts[k]) * (p * p * p);
  }
  T P(std::cbrt(value(cube)));
  for (int step = 0; step < 2; ++step)
    P = P - (1.0 / (3.0 * value(P) * value(P))) * (P * P * P - cube);
  Gap<T> g;
  g.feature = gaps.front().feature;
  g.distance = reach - P;
  V3<T> pull = constant<T>(Vec3::Zero()), point = pull;
  const V3<T> from = gaps.front().point;
  T share(0.0);
  for (std::size_t k = 0; k < gaps.size(); ++k) {
    const T p = (reach - gaps[k].distance) / P;
    const T force = static_cast<double>(counts[k]) * (p * p);
    pull = pull + force * gaps[k].normal;
    point = point + force * (gaps[k].point - from);
    share = share + force;
  }
  g.slope = norm(pull);
  g.share = share;
  g.point = from + (T(1.0) / share) * point;
  if (value(g.slope) > 1e-9)
    g.normal = (T(1.0) / g.slope) * pull;
  else
    g.normal = gaps.front().normal, g.slope = T(0.0);
  return g;
}

}  // namespace polhode::contact
