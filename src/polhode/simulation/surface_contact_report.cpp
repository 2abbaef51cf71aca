// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/compile/build_surface_contacts.hpp>
#include <polhode/core/format.hpp>
#include <polhode/simulation/surface_contact_report.hpp>

namespace polhode {

namespace {

surface_contact::SurfaceReport report_of(const System& system, const State& state,
                                         const ContactMap::Surface& surface) {
  return surface.touching->report(state.element_history.data() +
                                  system.nodes().first_history(surface.group));
}

}  // namespace

ContactReport surface_report(const System& system, const State& state, const ContactMap& map,
                             const ContactMap::Pair& pair) {
  ContactReport report;
  report.gap = std::numeric_limits<double>::quiet_NaN();
  for (const ContactMap::Surface& surface : map.surfaces) {
    const Side own = surface.own;
    if (std::minmax(own, surface.side) != std::minmax(pair.a, pair.b)) continue;
    const surface_contact::SurfaceReport r = report_of(system, state, surface);
    const double sign = own == pair.a ? 1.0 : -1.0;  // reports are of forces on the solid
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
  if (pair.a == pair.b) {  // self-contact forces have no resultant
    report.force.setZero();
    report.friction.setZero();
  }
  if (report.normal_force > 0.0) report.point /= report.normal_force;
  return report;
}

ContactLosses surface_losses(const System& system, const State& state, const ContactMap& map) {
  ContactLosses sum;
  for (const ContactMap::Surface& surface : map.surfaces) {
    const surface_contact::SurfaceReport r = report_of(system, state, surface);
    sum.impacts += r.normal_loss;
    sum.friction += r.friction_loss;
  }
  return sum;
}

SurfaceFigures surface_figures(const System& system, const State& state, const ContactMap& map) {
  SurfaceFigures figures{std::numeric_limits<double>::quiet_NaN(), 0};
  for (const ContactMap::Surface& surface : map.surfaces) {
    const surface_contact::SurfaceReport r = report_of(system, state, surface);
    figures.least_gap = std::fmin(figures.least_gap, r.least_gap);
    if (r.sticking + r.slipping > 0) ++figures.touching;
  }
  return figures;
}

}  // namespace polhode
