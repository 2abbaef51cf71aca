// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <polhode/beams/running_cable_report.hpp>
#include <polhode/core/types.hpp>
#include <polhode/model/beam_spec.hpp>

namespace polhode {

class RunningCable;
class Simulation;

/// What a beam is like at an instant.
struct BeamReport {
  // Of the nodes.
  std::vector<Vec3> position, velocity;  ///< World [m, m/s].
  std::vector<Quat> orientation;         ///< Section axes to world, x along the beam.
  // Of the elements, along the axes of their sections.
  std::vector<Vec6> forces;   ///< Elastic: N, V_y, V_z [N], M_x, M_y, M_z [N m].
  std::vector<Vec6> strains;  ///< Extension and shears [-], twist and curvatures [1/m]; without
                              ///< those it has free of stress.
};

/// What a cable is like at an instant.
struct CableReport {
  /// Of the ends of its pieces, from one end to the other, world [m, m/s].
  std::vector<Vec3> position, velocity;
  std::vector<double> tension;  ///< Elastic, of the pieces; of rods below zero when pressed [N].
  std::vector<double> length;   ///< Of the pieces [m].
  std::vector<double> strain;   ///< Of the pieces, elongation over free length [-].
  std::optional<RunningCableReport> whole;  ///< Of one that slides.
};

/// At the present state of a simulation. @param elements  Interactions of the beam's elements.
[[nodiscard]] BeamReport beam_report(const Simulation& simulation, const BeamSpec& spec,
                                     const std::vector<int>& elements);
/// Likewise, of a cable's pieces.
[[nodiscard]] CableReport cable_report(const Simulation& simulation, const CableLineSpec& spec,
                                       const std::vector<int>& pieces);
/// Likewise, of a cable that slides. @param group  Its group of elements, `cable`.
[[nodiscard]] CableReport running_cable_report(const Simulation& simulation,
                                               const CableLineSpec& spec, const RunningCable& cable,
                                               int group);

}  // namespace polhode
