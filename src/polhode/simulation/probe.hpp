// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <polhode/compile/solid_point.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode {

/// Resolved probe: its target and its columns.
struct ProbeTarget {
  ProbeSpec spec{};
  int index = 0;              ///< Of the body, joint, load, solid, beam or cable, or of the pair.
  SolidPoint point{};         ///< Of a solid.
  int interface = -1;         ///< Of a solid; -1: none.
  std::vector<int> bodies{};  ///< Of a probe of momentum.
  std::vector<std::string> header{};  ///< Names of the columns with units, the time first.
};

/// @param where  Path of the request, for messages; "": the probe of that name.
/// @throws InputError if the model has no such object.
[[nodiscard]] ProbeTarget probe_target(const Simulation& simulation, const ProbeSpec& spec,
                                       const std::string& where = "");
/// Output times of a probe: the first end of a step at or after each multiple of its interval, or
/// every step.
class ProbeClock {
 public:
  /// @param last  Time of the last row of a continued table.
  ProbeClock(const ProbeSpec& spec, const OutputSpec& output,
             std::optional<double> last = std::nullopt);
  /// Whether there is a row at the end of this step; if so, advances to the next one.
  /// @param last  The run ends here early: there is a row.
  [[nodiscard]] bool strikes(double t, bool last = false);

 private:
  double every_;           ///< [s]; 0: every step.
  std::int64_t next_ = 0;  ///< The next row is due at next·every.
  std::optional<double> last_;
};

/// The time and the values of a probe at the present state, in the order of its header.
[[nodiscard]] std::vector<double> probe_row(const ProbeTarget& probe, const Simulation& simulation);

}  // namespace polhode
