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

/// State of a beam at an instant.
struct BeamReport {
  // Of the nodes.
  std::vector<Vec3> position, velocity;  ///< World [m, m/s].
  std::vector<Quat> orientation;         ///< Section axes to world, x along the beam.
  // Of the elements, along the axes of their sections.
  std::vector<Vec6> forces;   ///< Elastic: N, V_y, V_z [N], M_x, M_y, M_z [N m].
  std::vector<Vec6> strains;  ///< Extension and shears [-], twist and curvatures [1/m]; without
                              ///< those it has free of stress.
};

/// State of a cable at an instant.
struct CableReport {
  /// Of the ends of its segments, from one end to the other, world [m, m/s].
  std::vector<Vec3> position, velocity;
  /// Elastic, of the segments; negative in rods under compression [N].
  std::vector<double> tension;
  std::vector<double> length;               ///< Of the segments [m].
  std::vector<double> strain;               ///< Of the segments, elongation over free length [-].
  std::optional<RunningCableReport> whole;  ///< Of a running cable.
};

/// Report of a beam at the present state of a simulation. @param elements  Interactions of the
/// beam's elements.
[[nodiscard]] BeamReport beam_report(const Simulation& simulation, const BeamSpec& spec,
                                     const std::vector<int>& elements);
/// Report of a cable's segments.
[[nodiscard]] CableReport cable_report(const Simulation& simulation, const CableLineSpec& spec,
                                       const std::vector<int>& pieces);
/// Report of a running cable. @param group  Its group of elements, `cable`.
[[nodiscard]] CableReport running_cable_report(const Simulation& simulation,
                                               const CableLineSpec& spec, const RunningCable& cable,
                                               int group);

}  // namespace polhode
