// SPDX-License-Identifier: Apache-2.0
// Impacts of pairs of edges, from closing to the turn.
#include <algorithm>
#include <cstddef>

#include <polhode/surface_contact/edge_touch.hpp>

namespace polhode::surface_contact {

/// Adds the impacts of pairs. The normal rate is that of the stored energy over the resultant on
/// the first edge; without stored energy that of the distance. @eq{surface-turn} @eq{cable-impact}
void EdgeContact::impacts(const NodeStep& step, const double* history,
                          std::vector<SurfaceImpact>& list) const {
  if (!step.context.conserving || !(step.context.dt > 0.0)) return;
  for (const Touch& t : touches(step, history, false)) {
    if (!t.pair.acts() || !t.phase.in_impact() || !(t.pair.pressure() > 0.0)) continue;
    const SurfaceLaw law = t.phase.law(law_, with_band_lowered);
    FourMoves at;
    for (int k = 0; k < 4; ++k) {
      at.x_n1[k] = end(t.e, t.f, k).at(step.x_n1);
      at.u[k].setZero();
    }
    const EdgePair now(at, data(t.e, t.f), law, 1.0, true);
    EdgePair::Force force = now.force();
    Vec3 on_first = force.segment<3>(0) + force.segment<3>(3);
    const double size = on_first.norm();
    const bool presses = now.pressure() > 0.0 && size > 0.0;
    SurfaceImpact& impact = list.emplace_back();
    if (!presses) {
      const Vec3 n = now.normal();
      for (int k = 0; k < 4; ++k) force.segment<3>(3 * k) = now.nearest().c[k] * n;
      on_first = n;
    } else {
      force /= size;
      on_first /= size;
    }
    impact.point = t.slot_n1;
    impact.normal = on_first;
    const std::array<Mat3, 4> slip = now.slip_rates(on_first);
    for (int k = 0; k < 4; ++k) {
      const Mat3 J =
          on_first * force.segment<3>(3 * k).transpose() + slip[static_cast<std::size_t>(k)];
      const MeshPoint& p = end(t.e, t.f, k);
      for (int a = 0; a < p.count; ++a) impact.add(p.node[a], p.N[a] * J);
    }
    impact.restitution = t.phase.restitution;
    impact.turned = t.phase.is(contact::ContactPhase::restitution);
    impact.mu = law_.mu;
    impact.given =
        step.context.dt * sides_.area * t.pair.pressure() * (presses ? size / now.pressure() : 1.0);
    impact.terms = t.pair.terms();
    impact.stored = sides_.area * t.pair.stored();
    if (!presses) impact.beyond = std::max(0.0, now.gap_n1() - law.normal.reach());
  }
}

double EdgeContact::turn(const SurfaceImpact& impact, double held, double* history) const {
  if (impact.point < 0) return 0.0;  // it has opened
  EdgeMemory memory = memory_of(history, impact.point);
  const double energy =
      sides_.area * memory.phase.turn(law_, impact.terms, held / sides_.area, with_band_lowered);
  write_record(memory, history + place_of(impact.point));
  SurfaceTotals::add_normal_loss(energy, history + totals());
  return energy;
}

void EdgeContact::settled(const SurfaceImpact& impact, const ResolvedImpact& settled, double dt,
                          double* history) const {
  SurfaceTotals::add_impulse(impact.normal, settled, dt, history + totals());
}

}  // namespace polhode::surface_contact
