// SPDX-License-Identifier: Apache-2.0
// Impacts of points of a mesh on another one, from closing to the turn.
#include <cmath>
#include <cstddef>

#include <polhode/surface_contact/slip_rates.hpp>
#include <polhode/surface_contact/solid_contact.hpp>
#include <polhode/surface_contact/solid_contact_field.hpp>

namespace polhode::surface_contact {

namespace {

/// Vector from the triangle to the point.
Vec3 way_between(const Vec3 (&x)[4], const NearestFour& four) {
  Vec3 y = Vec3::Zero();
  for (int k = 1; k < 4; ++k) y += four.c[k] * (x[k] - x[0]);
  return y;
}

}  // namespace

double SolidContact::rate_n(const NodeStep& step, const Field& x_n, const Nearest& nearest,
                            int point) const {
  if (!of_cable()) {
    const PatchVector y = vector_to(point, nearest.foot);
    return y.between(x_n.nodes).normalized().dot(y.between(step.v_n));
  }
  Vec3 x[4], v = Vec3::Zero();
  four_points(x_n, point, nearest.triangle, x);
  for (int k = 0; k < 4; ++k)
    v += nearest.four.c[k] * corner(point, nearest.triangle, k).at(step.v_n);
  return way_between(x, nearest.four).normalized().dot(v);
}

/// Adds the rates of a point. The normal rate is that of the combined distance of all nearby
/// features over their resultant on the point; the point slides on the nearest one.
/// @eq{mesh-impact}
void SolidContact::add_rates(const NodeStep& step, const Field& x, const Action& a, int point,
                             SurfaceImpact& impact) const {
  const auto add = [&](int triangle, int k, const Mat3& J) {
    const MeshPoint& at = corner(point, triangle, k);
    for (int i = 0; i < at.count; ++i) impact.add(at.node[i], at.N[i] * J);
  };
  Vec3 resultant = Vec3::Zero(), at[4];
  const auto slide = [&](int triangle, const NearestFour& four) {
    four_points(x, point, triangle, at);
    const std::array<Mat3, 4> slip = slip_rates(at, four.c, impact.normal, {1, 2, 1, 3});
    for (int k = 0; k < 4; ++k) add(triangle, k, slip[static_cast<std::size_t>(k)]);
  };
  if (!of_cable()) {
    const PatchVector y = vector_to(point, a.foot_n1);
    impact.normal = y.between(step.x_n1).normalized();
    for (int k = 0; k < y.way.count; ++k)
      impact.add(y.way.node[k], y.way.N[k] * impact.normal * impact.normal.transpose());
    four_points(x, point, a.foot_n1.triangle, at);
    slide(a.foot_n1.triangle, nearest_of_triangle(at));
    return;
  }
  const MeshGap& gap = a.at_n1;
  for (const MeshGap::Part& part : gap.parts) {
    four_points(x, point, part.triangle, at);
    resultant += part.share * way_between(at, part.four).normalized();
  }
  const double size = resultant.norm();
  impact.normal = resultant / size;
  for (const MeshGap::Part& part : gap.parts) {
    four_points(x, point, part.triangle, at);
    const Vec3 n = part.share / size * way_between(at, part.four).normalized();
    for (int k = 0; k < 4; ++k)
      add(part.triangle, k, part.four.c[k] * impact.normal * n.transpose());
  }
  slide(gap.parts.front().triangle, gap.parts.front().four);
}

/// @eq{surface-turn} @eq{mesh-impact}
void SolidContact::impacts(const NodeStep& step, const double* history,
                           std::vector<SurfaceImpact>& list) const {
  if (!step.context.conserving || !(step.context.dt > 0.0)) return;
  const Search& s = search(history);
  if (s.triangle.empty()) return;
  const Field x_n(surface_, step.x_n), x_n1(surface_, step.x_n1);
  for (int p = 0; p < static_cast<int>(points_.size()); ++p) {
    const std::span<const int> triangles = found(s, p);
    const PointMemory kept = memory_of(history, p);
    if (triangles.empty() || kept.phase.is(contact::ContactPhase::rest)) continue;
    const Action a = act(step, x_n, x_n1, triangles, p, kept);
    if (!a.acts || !a.phase.in_impact() || !(a.normal_force.value > 0.0) ||
        !(a.at_n1.resultant > 0.0))
      continue;
    const double area = points_[static_cast<std::size_t>(p)].area;
    SurfaceImpact& impact = list.emplace_back();
    impact.point = p;
    add_rates(step, x_n1, a, p, impact);
    impact.restitution = a.phase.restitution;
    impact.turned = a.phase.is(contact::ContactPhase::restitution);
    impact.mu = law_.mu;
    impact.given = step.context.dt * area * a.normal_force.value;
    const contact::NormalLaw law = a.phase.law(law_, with_band_lowered).normal;
    const double all = law.force(a.gap_n1);
    if (!of_cable()) impact.terms.push_back({1.0, a.gap_n1});
    for (const MeshGap::Part& part : a.at_n1.parts) {
      const double own = part.four.distance - centre_;
      // Multiplicities of features are integers.
      const double weight = a.at_n1.single() ? 1.0 : std::round(part.share * all / law.force(own));
      impact.terms.push_back({weight, own});
    }
    impact.stored = area * law.energy(a.gap_n1);
    impact.beyond = std::max(0.0, a.gap_n1 - law.reach());
  }
}

double SolidContact::turn(const SurfaceImpact& impact, double held, double* history) const {
  PointMemory memory = memory_of(history, impact.point);
  const double area = points_[static_cast<std::size_t>(impact.point)].area;
  const double energy =
      area * memory.phase.turn(law_, impact.terms, held / area, with_band_lowered);
  write_record(memory, history + place_of(impact.point));
  SurfaceTotals::add_normal_loss(energy, history + totals());
  return energy;
}

void SolidContact::settled(const SurfaceImpact& impact, const ResolvedImpact& settled, double dt,
                           double* history) const {
  SurfaceTotals::add_impulse(impact.normal, settled, dt, history + totals());
}

}  // namespace polhode::surface_contact
