// SPDX-License-Identifier: Apache-2.0
// Only the sources of EdgeContact include this.
#pragma once

#include <polhode/surface_contact/edge_contact.hpp>

namespace polhode::surface_contact {

/// A pair of edges that is active over a step, or stores its impact.
struct EdgeContact::Touch {
  int e, f;
  int slot_n = -1, slot_n1 = -1;  ///< Slot of its bristle; −1: none.
  PointPhase phase;               ///< In the step.
  EdgePair pair;
  FourSlide slide;
  LineSlide along;
  double by_friction = 0.0, bristle_n1 = 0.0;  ///< Energies [J/m²].
};

}  // namespace polhode::surface_contact
