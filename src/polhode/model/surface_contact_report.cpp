// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/base/format.hpp>
#include <polhode/model/build_surface_contacts.hpp>
#include <polhode/solve/node_motion.hpp>

namespace polhode {

namespace {

const SurfaceContact& contact_of(const System& system, const ContactMap::Surface& surface) {
  return dynamic_cast<const SurfaceContact&>(system.nodes().group(surface.group));
}

SurfaceReport report_of(const System& system, const State& state,
                        const ContactMap::Surface& surface) {
  return contact_of(system, surface)
      .report(state.element_history.data() + system.nodes().first_history(surface.group));
}

}  // namespace

ContactReport surface_report(const System& system, const State& state, const ContactMap& map,
                             const ContactMap::Pair& pair) {
  const int solid = solid_of_side(is_solid_side(pair.a) ? pair.a : pair.b);
  const int body = is_solid_side(pair.a) ? pair.b : pair.a;
  const double sign = is_solid_side(pair.a) ? 1.0 : -1.0;  // reports are of forces on the solid
  ContactReport report;
  report.gap = std::numeric_limits<double>::quiet_NaN();
  for (const ContactMap::Surface& surface : map.surfaces) {
    if (surface.solid != solid || surface.body != body) continue;
    const SurfaceReport r = report_of(system, state, surface);
    report.gap = std::fmin(report.gap, r.least_gap);
    report.normal_force += r.normal_force;
    report.force += sign * r.force;
    report.friction += sign * r.friction;
    report.point += r.normal_force * r.point;
    report.points += r.sticking + r.slipping;
    if (r.sticking > 0) report.status = std::max(report.status, 1);
    if (r.slipping > 0) report.status = 2;
    report.impulse += r.impulse;
    report.energy_lost += r.friction_loss + r.normal_loss;
  }
  if (report.normal_force > 0.0) report.point /= report.normal_force;
  return report;
}

ContactLosses surface_losses(const System& system, const State& state, const ContactMap& map) {
  ContactLosses sum;
  for (const ContactMap::Surface& surface : map.surfaces) {
    const SurfaceReport r = report_of(system, state, surface);
    sum.impacts += r.normal_loss;
    sum.friction += r.friction_loss;
  }
  return sum;
}

SurfaceFigures surface_figures(const System& system, const State& state, const ContactMap& map) {
  SurfaceFigures figures{std::numeric_limits<double>::quiet_NaN(), 0};
  for (const ContactMap::Surface& surface : map.surfaces) {
    const SurfaceReport r = report_of(system, state, surface);
    figures.least_gap = std::fmin(figures.least_gap, r.least_gap);
    if (r.sticking + r.slipping > 0) ++figures.touching;
  }
  return figures;
}

std::vector<std::string> surface_overlaps(const Model& model, const System& system,
                                          const State& state, const ContactMap& map) {
  std::vector<std::string> list;
  const StepContext still;
  const NodeStep instant = node_instant(state, still);
  for (const ContactMap::Surface& surface : map.surfaces) {
    const SurfaceContact& contact = contact_of(system, surface);
    const double gap = contact.least_gap(instant);
    if (gap > -contact.law().normal.tolerance) continue;
    list.push_back(format("{} in {} by {:.3g} m",
                          model.solids[static_cast<std::size_t>(surface.solid)].name,
                          model.bodies[static_cast<std::size_t>(surface.body)].name, -gap));
  }
  return list;
}

}  // namespace polhode
