// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/core/assert.hpp>
#include <polhode/surface_contact/combined_gap.hpp>

namespace polhode::surface_contact {

SurfaceGap combined_gap(const contact::NormalLaw& law,
                        std::vector<std::pair<SurfaceGap, int>>& near, const SurfaceGap& nearest) {
  POLHODE_ASSERT(!near.empty());
  if (near.size() == 1) return near.front().first;
  std::stable_sort(near.begin(), near.end(),
                   [](const auto& a, const auto& b) { return a.first.value < b.first.value; });
  double V = 0.0;
  Vec3 force = Vec3::Zero();
  Mat3 stiffness = Mat3::Zero();
  int open = 0, places = 0;  // multiplicities of the features so far, and those counted
  for (const auto& [g, count] : near) {
    open += count;
    const int w = std::max(1, open) - places;
    places += w;
    if (w == 0) continue;
    const contact::NormalLaw::WithSlope one = law.force_and_slope(g.value);
    V += w * law.energy(g.value);
    force += w * one.value * g.normal;
    stiffness += w * (one.slope * g.normal * g.normal.transpose() + one.value * g.curvature);
  }
  SurfaceGap g;
  g.value = law.gap_of(V);
  const contact::NormalLaw::WithSlope all = law.force_and_slope(g.value);
  if (!(all.value > 0.0)) return nearest;
  g.normal = force / all.value;
  g.curvature = (stiffness - all.slope * g.normal * g.normal.transpose()) / all.value;
  return g;
}

}  // namespace polhode::surface_contact
