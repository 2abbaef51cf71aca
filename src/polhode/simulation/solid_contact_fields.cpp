// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/equations/node_motion.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <polhode/simulation/solid_contact_fields.hpp>

namespace polhode {

namespace {

/// Whether a contact takes place on the surface of a solid.
bool is_on(const ContactMap::Surface& surface, int solid) {
  const auto is_it = [&](const Side& side) { return side.is_solid() && side.index == solid; };
  return is_it(surface.own) || is_it(surface.side);
}

}  // namespace

bool has_contact_fields(const Simulation& simulation, int solid) {
  return std::ranges::any_of(simulation.contact_map().surfaces,
                             [&](const ContactMap::Surface& s) { return is_on(s, solid); });
}

SolidContactFields solid_contact_fields(const Simulation& simulation, int solid) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const System& system = simulation.system();
  const State& state = simulation.state();
  const Nodes& nodes = system.nodes();
  StepContext still;
  still.t_n = state.t;
  const NodeStep instant = node_instant(system, state, still);
  std::vector<surface_contact::NodeContact> sums(static_cast<std::size_t>(nodes.count()));
  for (const ContactMap::Surface& s : simulation.contact_map().surfaces)
    if (is_on(s, solid))
      s.touching->add_to_nodes(instant, state.element_history.data() + nodes.first_history(s.group),
                               sums);
  const SolidMap& map = simulation.solids().at(static_cast<std::size_t>(solid));
  SolidContactFields fields;
  for (int k = 0; k < map.node_count(); ++k) {
    const surface_contact::NodeContact& node = sums[static_cast<std::size_t>(map.first_node + k)];
    fields.pressure.push_back(node.area > 0.0 ? node.force / node.area : kNone);
    fields.gap.push_back(std::isfinite(node.gap) ? node.gap : kNone);
  }
  return fields;
}

}  // namespace polhode
