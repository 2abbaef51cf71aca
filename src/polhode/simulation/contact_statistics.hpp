// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <polhode/compile/build_contacts.hpp>
#include <polhode/contact/contact_reports.hpp>
#include <polhode/simulation/contact_report.hpp>
#include <polhode/system/state.hpp>

namespace polhode {

/// How impulses were sought since the start, of the non-smooth law.
struct ImpulseFigures {
  double sweeps = 0.0;       ///< In all steps.
  double unconverged = 0.0;  ///< Steps that ended above the tolerance.
};

/// What contacts did in the step that ended at a state.
struct ContactsSeen {
  std::vector<ContactReport> reports;  ///< By pair of the map; impulse and loss of the step alone.
  std::vector<contact::TouchingPoint> points;
  std::vector<Vec6> wrenches;  ///< By body of the system.
  int touching = 0;            ///< Pairs of shapes that pressed on each other.
  double least_gap = 0.0;      ///< [m]; infinite if none was small.
  double impact_loss = 0.0, friction_loss = 0.0, unresolved = 0.0;
  ImpulseFigures search;  ///< Of the non-smooth law.
};

/// Sums up what contacts do, step by step; the sums go with the state.
class ContactStatistics {
 public:
  /// @param contacts  May be null: there is nothing to keep. @param map  Outlives this.
  ContactStatistics(std::shared_ptr<contact::ContactSet> contacts, const ContactMap& map)
      : contacts_(std::move(contacts)), map_(&map) {}

  /// Looks at the start; sensors that overlap there begin.
  void begin(State& state);
  /// Goes on from a saved state.
  void resume(const State& state);
  /// After every step that is taken, before anything else is asked of the contacts: what they did
  /// is reported from then on.
  void see(const State& state);
  /// What is reported now, and the way back to it when the simulation goes back to its state.
  [[nodiscard]] const ContactsSeen& seen() const { return seen_; }
  void go_to(const ContactsSeen& seen) { seen_ = seen; }
  /// Adds what was seen last to the sums: the step stays.
  void after_step(State& state);

  [[nodiscard]] ContactReport report(int pair) const;
  [[nodiscard]] const std::vector<contact::TouchingPoint>& points() const { return seen_.points; }
  [[nodiscard]] ContactLosses losses() const;
  [[nodiscard]] ImpulseFigures impulse_figures() const;
  /// Pairs of shapes that pressed on each other in the last step.
  [[nodiscard]] int touching() const { return seen_.touching; }
  /// The smallest gap there was after any step since the start [m]; NaN if none was small.
  [[nodiscard]] double least_gap() const;
  /// Impacts since the start that took fewer than twenty steps although their law has a stiffness
  /// or a damper of its own.
  [[nodiscard]] double unresolved() const;
  /// Since the start or restart.
  [[nodiscard]] const std::vector<SensorEvent>& events() const { return events_; }
  /// By body of the system, over the last step; empty without contact.
  [[nodiscard]] const std::vector<Vec6>& wrenches() const { return seen_.wrenches; }

 private:
  void note_sensors(State& state);
  /// How many numbers are kept.
  [[nodiscard]] std::size_t total_count() const;

  std::shared_ptr<contact::ContactSet> contacts_;
  const ContactMap* map_;
  ContactsSeen seen_;
  bool summed_ = true;          ///< What was seen last is in the totals.
  std::vector<double> totals_;  ///< They are in the state, too.
  std::vector<SensorEvent> events_;
};

}  // namespace polhode
