// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/impulses/row_problem.hpp>
#include <polhode/stepping/instant.hpp>
#include <polhode/system/impulsive_contacts.hpp>
#include <polhode/system/unilateral_stops.hpp>

namespace polhode {

/// Forces of unilateral rows at an instant: of contacts and stops that are closed and stay so,
/// their rates being zero, so that accelerations a and forces p satisfy 0 ≤ p ⊥ a ≥ 0 with
/// Coulomb's law. Forces of the step itself are means over it, which differ from those of its end
/// by the order of its length. @eq{closed-rows}
class ClosedRows {
 public:
  /// @param contacts  Of the system, or of a copy of it, as searching for their points changes what
  ///                  they remember of the last search; null: none that are rows.
  ClosedRows(const System& system, BodyContacts* contacts);

  /// Computes the forces and puts those of stops into their records.
  /// @param solver    For the system.
  /// @param state     With velocities on G v = 0. @param rounding  Of velocities [m/s].
  /// @param wrenches  By body: further ones in, those of contacts that are rows added.
  /// @returns false if the row problem is too large or was not solved: the state and the wrenches
  /// are then as given.
  [[nodiscard]] bool solve(InstantSolver& solver, State& state, double rounding,
                           std::vector<Vec6>& wrenches);

 private:
  /// A row with the wrenches of a unit force.
  struct Row {
    int a = kGround, b = kGround;
    Vec6 on_a = Vec6::Zero(), on_b = Vec6::Zero();
    double convective = 0.0;  ///< γ: the row's acceleration is on·(r̈, ω̇) + γ [m/s²].
    /// Wrenches of its unit force together with sliding and rolling friction in proportion to it.
    Vec6 with_a = Vec6::Zero(), with_b = Vec6::Zero();
    double length = 1.0;  ///< Turns an angular acceleration into an acceleration [m].
    int memory = -1;      ///< Record of a stop in State::history; −1: a contact.
  };
  struct Motion {
    Vec3 r = Vec3::Zero(), v = Vec3::Zero(), omega = Vec3::Zero();
  };
  void find_stops(State& state, double rounding);
  void find_contacts(const State& state, double rounding);
  void put_contact(const ContactInstant& at, double rounding);
  [[nodiscard]] Motion motion_of(int body) const {
    return body == kGround ? Motion{} : motions_[static_cast<std::size_t>(body)];
  }
  [[nodiscard]] double rate(const Row& row) const;
  [[nodiscard]] double largest_rate(const Row& row) const;

  const System* system_;
  BodyContacts* contacts_;
  std::vector<UnilateralStop> stops_;
  std::vector<Motion> motions_;  ///< By body.
  std::vector<BodyStep> steps_;  ///< At the instant, the ground last.
  std::vector<Row> rows_;
  std::vector<ImpulseRows> blocks_;
};

}  // namespace polhode
