// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/equations/trial.hpp>

namespace polhode {

/// Internal unknowns of all elements, one group after the other: enhanced modes, pressures.
[[nodiscard]] std::vector<double> element_unknowns(const System& system, const Trial& trial);
void set_element_unknowns(const System& system, const std::vector<double>& unknowns, Trial& trial);
/// Linear interpolation a + part (b − a) of internal unknowns.
[[nodiscard]] std::vector<double> part_way(const std::vector<double>& a,
                                           const std::vector<double>& b, double part);

/// Stored iterate: everything that iterations change, without the condensations of elements and
/// other data derived from the unknowns.
class IterateSnapshot {
 public:
  void keep(const System& system, const Trial& trial);
  void forget() { kept_ = false; }
  [[nodiscard]] bool kept() const { return kept_; }
  /// Restores the trial, including velocities of nodes.
  void restore(const System& system, Trial& trial) const;
  [[nodiscard]] const std::vector<double>& unknowns() const { return unknowns_; }

 private:
  bool kept_ = false;
  std::vector<TrialBlock> blocks_;
  std::vector<double> lambda_, node_x_, node_u_, node_v_, unknowns_;
};

}  // namespace polhode
