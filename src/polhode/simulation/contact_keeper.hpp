// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <polhode/compile/build_contacts.hpp>
#include <polhode/contact/contact_reports.hpp>
#include <polhode/system/state.hpp>

namespace polhode {

/// What two bodies do to each other.
struct ContactReport {
  double gap = 0.0;              ///< Smallest [m]; NaN while they are too far apart to know.
  double normal_force = 0.0;     ///< Sum of all points, over the last step [N].
  Vec3 force = Vec3::Zero();     ///< On the first body, friction included, world [N].
  Vec3 friction = Vec3::Zero();  ///< On the first body, world [N].
  Vec3 point = Vec3::Zero();     ///< Mean of the points, by normal force [m]; zero if none.
  int points = 0;                ///< That carry force.
  int status = 0;                ///< 0 open, 1 sticks, 2 slips; of a sensor 1 overlaps.
  double impulse = 0.0;          ///< Of the normal force since the start [N s].
  double energy_lost = 0.0;      ///< Since the start, in impacts and by friction [J].
};

/// Where energy went since the start [J].
struct ContactLosses {
  double impacts = 0.0, friction = 0.0;
};

/// How impulses were sought since the start, of the non-smooth law.
struct ImpulseFigures {
  double sweeps = 0.0;       ///< In all steps.
  double unconverged = 0.0;  ///< Steps that ended above the tolerance.
};

/// A sensor's bodies began or ceased to overlap in the step that ended at t.
struct SensorEvent {
  double t = 0.0;
  std::string sensor;
  bool began = false;
};

/// Sums up what contacts do, step by step; the sums go with the state.
class ContactKeeper {
 public:
  /// @param contacts  May be null: there is nothing to keep. @param map  Outlives this.
  ContactKeeper(std::shared_ptr<contact::ContactSet> contacts, const ContactMap& map)
      : contacts_(std::move(contacts)), map_(&map) {}

  /// Looks at the start; sensors that overlap there begin.
  void begin(State& state);
  /// Goes on from a saved state.
  void resume(const State& state);
  /// After every accepted step, before anything else is asked of the contacts.
  void after_step(State& state);

  [[nodiscard]] ContactReport report(int pair) const;
  [[nodiscard]] const std::vector<contact::TouchingPoint>& points() const { return points_; }
  [[nodiscard]] ContactLosses losses() const;
  [[nodiscard]] ImpulseFigures impulse_figures() const;
  /// Pairs of shapes that pressed on each other in the last step.
  [[nodiscard]] int touching() const { return touching_; }
  /// The smallest gap there was after any step since the start [m]; NaN if none was small.
  [[nodiscard]] double least_gap() const;
  /// Impacts since the start that took fewer than twenty steps although their law has a stiffness
  /// or a damper of its own.
  [[nodiscard]] double unresolved() const;
  /// Since the start or restart.
  [[nodiscard]] const std::vector<SensorEvent>& events() const { return events_; }
  /// By body of the system, over the last step; empty without contact.
  [[nodiscard]] const std::vector<Vec6>& wrenches() const { return wrenches_; }

 private:
  void look(State& state, bool sum);
  /// How many numbers are kept.
  [[nodiscard]] std::size_t total_count() const;

  std::shared_ptr<contact::ContactSet> contacts_;
  const ContactMap* map_;
  std::vector<ContactReport> reports_;  ///< By pair of the map; totals are in the state.
  std::vector<double> totals_;
  std::vector<contact::TouchingPoint> points_;
  std::vector<Vec6> wrenches_;
  std::vector<SensorEvent> events_;
  int touching_ = 0;
};

}  // namespace polhode
