// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/assert.hpp>
#include <polhode/surface_contact/mesh_gap.hpp>

namespace polhode::surface_contact {

namespace {

/// Height above the end of the barrier, as a part of its band, below which only the nearest feature
/// counts. Only iterates get there.
constexpr double kDeepInMesh = 1e-9;

/// Corners of the surface that a feature has, ascending; −1 where it has none.
using Corners = std::array<int, 3>;

struct Feature {
  Corners corners;
  int triangle;
  NearestFour four;
  int count = 0;  ///< Multiplicity.
};

Corners corners_of(const TriangleAt& t, const NearestFour& four) {
  Corners own{-1, -1, -1};
  for (std::size_t k = 0; k < 3; ++k)
    if (four.c[static_cast<int>(k) + 1] != 0.0) own[k] = t.corners[k];
  std::sort(own.begin(), own.end());
  return own;
}

/// Multiplicities of features. Every triangle, edge and corner counts at its nearest point, and
/// most cancel. Each has to count once in total, so one with others around it counts once less
/// their multiplicities.
std::vector<Feature> features(const std::vector<TriangleAt>& near) {
  std::vector<Feature> list;
  const auto count = [&](const TriangleAt& t, const NearestFour& four, int weight) {
    const Corners own = corners_of(t, four);
    for (Feature& known : list)
      if (known.corners == own) {
        known.count += weight;
        return;
      }
    list.push_back({own, t.triangle, four, weight});
  };
  struct Around {  // an edge, or a corner with b = −1
    int a, b;
    const TriangleAt* triangle;
    int i, j;       // corners by position in the list
    int times = 0;  // number of triangles that contain it
    int weight = 1;
  };
  std::vector<Around> edges, corners;
  const auto meet = [](std::vector<Around>& known, const Around& one) {
    for (Around& k : known)
      if (k.a == one.a && k.b == one.b) {
        ++k.times;
        return;
      }
    known.push_back(one);
    known.back().times = 1;
  };
  for (const TriangleAt& t : near) {
    count(t, nearest_of_triangle(t.x), 1);
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3, a = t.corners[static_cast<std::size_t>(k)],
                b = t.corners[static_cast<std::size_t>(next)];
      meet(edges, {std::min(a, b), std::max(a, b), &t, k + 1, next + 1});
      meet(corners, {a, -1, &t, k + 1, 0});
    }
  }
  for (Around& e : edges) {
    e.weight = 1 - e.times;
    if (e.weight != 0) count(*e.triangle, nearest_of_edge(e.triangle->x, e.i, e.j), e.weight);
  }
  for (Around& c : corners) {
    c.weight = 1 - c.times;
    for (const Around& e : edges)
      if (e.a == c.a || e.b == c.a) c.weight -= e.weight;
    if (c.weight != 0) count(*c.triangle, nearest_of_corner(c.triangle->x, c.i), c.weight);
  }
  return list;
}

}  // namespace

/// @eq{surface-feature-sum} @eq{surface-feature-holes}
MeshGap mesh_gap(const std::vector<TriangleAt>& near, const contact::NormalLaw& law,
                 double centre) {
  POLHODE_ASSERT(!near.empty());
  const auto nearest = [&] {
    MeshGap best = MeshGap::of(near.front().triangle, nearest_of_triangle(near.front().x));
    for (const TriangleAt& t : near) {
      const NearestFour four = nearest_of_triangle(t.x);
      if (four.distance < best.distance) best = MeshGap::of(t.triangle, four);
    }
    return best;
  };
  if (near.size() == 1) return nearest();
  std::vector<Feature> list;
  for (Feature& f : features(near))
    if (f.count != 0 && f.four.distance - centre < law.reach()) list.push_back(std::move(f));
  if (list.empty()) return nearest();
  std::sort(list.begin(), list.end(), [](const Feature& a, const Feature& b) {
    return a.four.distance != b.four.distance ? a.four.distance < b.four.distance
                                              : a.corners < b.corners;
  });
  const double deep = law.floor() + kDeepInMesh * 2.0 * law.tolerance;
  if (list.size() == 1 || list.front().four.distance - centre < deep)
    return MeshGap::of(list.front().triangle, list.front().four);
  MeshGap gap;
  double V = 0.0;
  Vec3 force = Vec3::Zero();
  std::vector<double> forces;
  int open = 0, places = 0;  // of the features so far, and of the counted ones
  for (const Feature& f : list) {
    open += f.count;
    const int w = std::max(1, open) - places;
    places += w;
    if (w == 0) continue;
    const contact::NormalLaw::WithSlope one = law.force_and_slope(f.four.distance - centre);
    V += w * law.energy(f.four.distance - centre);
    gap.parts.push_back({f.triangle, f.four, w * one.value, w * one.slope});
    const auto& x = std::find_if(near.begin(), near.end(), [&](const TriangleAt& t) {
                      return t.triangle == f.triangle;
                    })->x;
    Vec3 y = Vec3::Zero();
    for (int k = 0; k < 4; ++k) y += f.four.c[k] * (x[k] - x[0]);
    force += w * one.value * y.normalized();
  }
  gap.distance = law.gap_of(V) + centre;
  const contact::NormalLaw::WithSlope all = law.force_and_slope(gap.distance - centre);
  if (gap.parts.size() == 1 || !(all.value > 0.0))
    return MeshGap::of(list.front().triangle, list.front().four);
  for (MeshGap::Part& p : gap.parts) {
    p.share /= all.value;
    p.bend /= all.value;
  }
  gap.bend = all.slope / all.value;
  gap.resultant = force.norm() / all.value;
  return gap;
}

/// Derivatives of the combined distance. D² has 2D Σ p ∂d with shares p, and D the second
/// derivative Σ (w f′(d)/f(D) ∂d∂d + p ∂²d) − f′(D)/f(D) ∂D∂D.
void MeshGapStep::fill(const MeshGap& at_n, const MeshGap& at_n1) {
  constexpr int kSetLengths = NearestFour::kLengths;
  over.d_n = at_n.distance;
  over.d_n1 = at_n1.distance;
  over.resize();
  for (const MeshGap* gap : {&at_n, &at_n1}) {
    const bool last = gap == &at_n1;
    auto& g = last ? over.g_n1 : over.g_n;
    const double D = gap->distance;
    for (const MeshGap::Part& p : gap->parts) {
      const int set = place(p.triangle);
      if (set < 0) continue;
      const double d = p.four.distance, weight = gap->single() ? 1.0 : D * p.share / d;
      const NearestFour::Lengths slope = p.four.gradient();
      g.segment<kSetLengths>(kSetLengths * set) += weight * slope;
      if (!last) continue;
      auto H = over.H_n1.block<kSetLengths, kSetLengths>(kSetLengths * set, kSetLengths * set);
      H += weight * p.four.hessian(over.moves[set].x_n1);
      if (!gap->single())
        H += 2.0 * D * (p.bend / (4.0 * d * d) - p.share / (4.0 * d * d * d)) * slope *
             slope.transpose();
    }
    if (last && !gap->single()) {
      const auto of_D = (g / (2.0 * D)).eval();
      over.H_n1 += 2.0 * (1.0 - D * gap->bend) * of_D * of_D.transpose();
    }
  }
}

}  // namespace polhode::surface_contact
