// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include <polhode/loads/registry.hpp>

namespace polhode {

/// The kind of a point that slides along a beam. It has no `add`: its load is elements on nodes of
/// the beam (beams/slide_on_beam.hpp), which compile/build_slide.hpp adds.
[[nodiscard]] inline LoadKind slide_on_beam_kind() {
  constexpr double kMax = std::numeric_limits<double>::max();
  LoadKind kind;
  kind.name = "slide_on_beam";
  kind.meaning =
      "constraint that keeps a point of a body on the centre line of a beam, free along it: a "
      "trolley on a bridge, a bead on a wire, a beam that runs through a fixed eye";
  kind.parameters = {
      {"stiffness", "N/m", 0.0, 0.0, kMax, "spring along the beam: force per length"},
      {"free_position", "m", 0.0, -kMax, kMax, "position along the beam without spring force"},
      {"damping", "N*s/m", 0.0, 0.0, kMax, "force along the beam per speed"}};
  kind.drives = {{"force", "N", "force on the body along the beam, towards its end"},
                 {"position", "m", "position along the beam, from its start"}};
  kind.channels = {
      {"force", "N", 3}, {"position", "m"}, {"speed", "m/s"}, {"along", "N"}, {"energy", "J"}};
  kind.switches = false;
  return kind;
}

/// Whether a kind of load acts on a beam and a point of a body: `beam`, `body`, `at` or `at_body`.
[[nodiscard]] inline bool acts_on_beam(const LoadKind& kind) { return !kind.add; }

}  // namespace polhode
