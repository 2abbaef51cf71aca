// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <polhode/compile/build_contacts.hpp>
#include <polhode/contact/contact_reports.hpp>
#include <polhode/simulation/contact_report.hpp>
#include <polhode/system/state.hpp>

namespace polhode {

/// Statistics of the impulse iteration since the start, of the non-smooth law.
struct ImpulseFigures {
  double sweeps = 0.0;       ///< In all steps.
  double unconverged = 0.0;  ///< Steps that ended above the tolerance.
};

/// Contact results of the step that ended at a state.
struct ContactsSeen {
  std::vector<ContactReport> reports;  ///< By pair of the map; impulse and loss in the step.
  std::vector<contact::TouchingPoint> points;
  std::vector<Vec6> wrenches;  ///< By body of the system.
  int touching = 0;            ///< Pairs of shapes in contact.
  double least_gap = 0.0;      ///< [m]; infinite if no shapes were near.
  double impact_loss = 0.0, friction_loss = 0.0, unresolved = 0.0;
  std::optional<std::pair<int, int>> near_floor;  ///< First pair of shapes near their floor.
  ImpulseFigures search;                          ///< Of the non-smooth law.
};

/// Statistics of contacts over the steps; the sums are part of the state.
class ContactStatistics {
 public:
  /// @param contacts  May be null: nothing to record. @param map  Must outlive this.
  ContactStatistics(std::shared_ptr<contact::ContactSet> contacts, const ContactMap& map)
      : contacts_(std::move(contacts)), map_(&map) {}

  /// Records the start; overlaps of sensors there begin.
  void begin(State& state);
  /// Continues from a saved state.
  void resume(const State& state);
  /// Records the contact results after every step, before any other query of the contacts; they are
  /// reported from then on.
  void see(const State& state);
  /// Present results, which can be restored when the simulation returns to their state.
  [[nodiscard]] const ContactsSeen& seen() const { return seen_; }
  void go_to(const ContactsSeen& seen) { seen_ = seen; }
  /// Adds the last results to the sums: the step is final.
  void after_step(State& state);

  [[nodiscard]] ContactReport report(int pair) const;
  [[nodiscard]] const std::vector<contact::TouchingPoint>& points() const { return seen_.points; }
  [[nodiscard]] ContactLosses losses() const;
  [[nodiscard]] ImpulseFigures impulse_figures() const;
  /// Number of pairs of shapes in contact in the last step.
  [[nodiscard]] int touching() const { return seen_.touching; }
  /// Smallest gap after any step since the start [m]; NaN if no shapes were near.
  [[nodiscard]] double least_gap() const;
  /// Number of impacts since the start of fewer than twenty steps although their law has a given
  /// stiffness or damper.
  [[nodiscard]] double unresolved() const;
  /// Overlaps beyond which springs of given stiffness are stiffer than stated.
  struct NearFloor {
    std::int64_t steps = 0;                 ///< With such an overlap, since the start.
    std::string first_shape, second_shape;  ///< Names of the first pair.
  };
  [[nodiscard]] NearFloor near_floor() const;
  /// Sensor events since the start or restart.
  [[nodiscard]] const std::vector<SensorEvent>& events() const { return events_; }
  /// Contact wrenches by body of the system, over the last step; empty without contact.
  [[nodiscard]] const std::vector<Vec6>& wrenches() const { return seen_.wrenches; }

 private:
  void note_sensors(State& state);
  /// Number of totals.
  [[nodiscard]] std::size_t total_count() const;

  std::shared_ptr<contact::ContactSet> contacts_;
  const ContactMap* map_;
  ContactsSeen seen_;
  bool summed_ = true;          ///< The last results are in the totals.
  std::vector<double> totals_;  ///< Also stored in the state.
  std::vector<SensorEvent> events_;
};

}  // namespace polhode
