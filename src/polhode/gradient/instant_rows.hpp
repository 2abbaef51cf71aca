// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <polhode/system/impulsive_contacts.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// A stop of a joint or a contact point at one instant: its gap, and how that depends on the
/// motion.
struct InstantRow {
  int a = kGround, b = kGround;
  /// Derivative of the gap by (dr, dφ) of both bodies.
  Vec6 by_a = Vec6::Zero(), by_b = Vec6::Zero();
  double gap = 0.0;  ///< [m]
  double restitution = 0.0, friction = 0.0;
  int interaction = -1, number = 0;  ///< Of a stop, and its number there; −1: a contact.
  Vec3 normal = Vec3::Zero(), place = Vec3::Zero();  ///< Of a contact, from b to a, world.

  [[nodiscard]] bool is_contact() const { return interaction < 0; }
};

/// Bodies at a state as steps of no length, the ground last.
[[nodiscard]] std::vector<BodyStep> instant_steps(const System& system, const State& state);

/// Unilateral rows of a system at instants.
class InstantRows {
 public:
  /// @param dt  Length of the run's steps [s].
  InstantRows(const System& system, double dt);

  /// Whether a system has such rows.
  [[nodiscard]] static bool of(const System& system);
  /// All stops, and contact points that touch or would be passed if the bodies kept their
  /// velocities for this time.
  [[nodiscard]] std::vector<InstantRow> ahead(const State& state, double time);
  /// The row of this system that corresponds to one of a neighbouring motion or model.
  /// @param state    With the memory of contacts. @param steps  At the instant, the ground last.
  /// @param history  Of interactions. @throws InputError if there is none.
  [[nodiscard]] InstantRow same(const State& state, std::span<const BodyStep> steps,
                                const double* history, const InstantRow& like);
  /// Rate of the gap of a row by the velocities of a state [m/s].
  [[nodiscard]] double speed(const State& state, const InstantRow& row) const;
  /// The largest that this rate could be with the speeds of the bodies.
  [[nodiscard]] double size_of_speed(const State& state, const InstantRow& row) const;
  /// "the contact of body 'a' and the ground", "the stop of joint 'knee'".
  [[nodiscard]] std::string name(const InstantRow& row) const;

 private:
  [[nodiscard]] StepContext context(double t) const;
  void add_stops(std::span<const BodyStep> steps, const double* history, double t,
                 std::vector<InstantRow>& rows) const;
  void add_contacts(const State& state, std::span<const BodyStep> steps,
                    std::span<const BodyStep> moved, std::vector<InstantRow>& rows);

  const System* system_;
  double dt_;
  BodyContacts* contacts_ = nullptr;
  ImpulsiveContacts* impulsive_ = nullptr;
  std::vector<ImpulsePoint> points_;
};

}  // namespace polhode
