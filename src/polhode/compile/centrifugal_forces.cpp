// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <polhode/beams/beam_element.hpp>
#include <polhode/beams/cable.hpp>
#include <polhode/compile/centrifugal_forces.hpp>
#include <polhode/loads/centrifugal.hpp>
#include <polhode/solids/loads/centrifugal_force.hpp>

namespace polhode {

void add_centrifugal_forces(System& system, const Model& model) {
  const TurningFrame& frame = model.analysis.turning.value();
  if (frame.speed == 0.0) return;
  for (int b = 0; b < system.body_count(); ++b)
    system.group<CentrifugalForce>().add(system.bodies()[static_cast<std::size_t>(b)], b, frame);
  const auto couple = [&](const auto& items) {
    for (const auto& item : items)
      if (item.coupled_mass() != 0.0)
        system.group<CentrifugalCoupling>().add(item.name, item.bodies, item.coupled_mass(), frame);
  };
  if (!model.beams.empty()) couple(system.group<BeamElement>().items());
  if (!model.cables.empty()) couple(system.group<Cable>().items());
  for (int g = 0, all = system.nodes().group_count(); g < all; ++g)
    if (auto force = solids::make_centrifugal_force(system.nodes().group(g), frame))
      system.add_elements(std::move(force));
}

}  // namespace polhode
