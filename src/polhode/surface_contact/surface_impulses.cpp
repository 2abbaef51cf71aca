// SPDX-License-Identifier: Apache-2.0
// Impacts of points of a surface, from closing to the turn.
#include <algorithm>

#include <polhode/surface_contact/surface_contact.hpp>

namespace polhode::surface_contact {

/// Adds the impacts of points. Both sides act at the position of the point, so that impulses have
/// neither resultant nor moment. @eq{surface-turn}
void SurfaceContact::impacts(const NodeStep& step, const double* history,
                             std::vector<SurfaceImpact>& list) const {
  if (!step.context.conserving || !(step.context.dt > 0.0)) return;
  const Mat3 R = axes(step.x_n1);
  for (int i = 0; i < size(); ++i) {
    const Action a = act(step, i, memory_of(history, i), false);
    if (!a.acts || !a.phase.in_impact() || !(a.pressure > 0.0)) continue;
    const double length = a.normal.norm();
    if (!(length > 0.0)) continue;
    const SurfacePoints::Point& point = points_.points[static_cast<std::size_t>(i)];
    SurfaceImpact& s = list.emplace_back();
    s.point = i;
    const std::span<const int> own = nodes(i);
    for (int k = 0; k < n_; ++k)
      if (point.N[k] != 0.0) s.add(own[static_cast<std::size_t>(k)], point.N[k] * Mat3::Identity());
    if (frame_ > 0) {
      // Its position on the body is affine in the nodes of the frame.
      const Vec3 y = local(step.x_n1, i) / place_.size;
      s.add(place_.nodes[0], (y.sum() - 1.0) * Mat3::Identity());
      for (std::size_t k = 0; k < 3; ++k)
        s.add(place_.nodes[k + 1], -y[static_cast<int>(k)] * Mat3::Identity());
    }
    s.normal = R * a.normal / length;
    s.restitution = a.phase.restitution;
    s.turned = a.phase.is(contact::ContactPhase::restitution);
    s.mu = law_.mu;
    s.given = step.context.dt * point.area * a.pressure;
    s.terms.push_back({1.0, a.gap_n1});
    s.stored = point.area * a.phase.law(law_).normal.energy(a.gap_n1);
    s.beyond = std::max(0.0, a.gap_n1 - a.phase.law(law_).normal.reach());
  }
}

double SurfaceContact::turn(const SurfaceImpact& impact, double held, double* history) const {
  PointMemory memory = memory_of(history, impact.point);
  const double area = points_.points[static_cast<std::size_t>(impact.point)].area;
  const double energy = area * memory.phase.turn(law_, impact.terms, held / area);
  write_record(memory, history + place_of(impact.point));
  SurfaceTotals::add_normal_loss(energy, history + totals());
  return energy;
}

void SurfaceContact::settled(const SurfaceImpact& impact, const ResolvedImpact& settled, double dt,
                             double* history) const {
  SurfaceTotals::add_impulse(impact.normal, settled, dt, history + totals());
}

}  // namespace polhode::surface_contact
