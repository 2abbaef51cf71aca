// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/equations/newton_system.hpp>
#include <polhode/system/body_contacts.hpp>

namespace polhode {

/// Contacts between bodies for Newton engines with a matrix: the pairs of bodies they couple, their
/// terms, and limits of increments.
class BodyContactAssembler {
 public:
  /// @throws InputError if the system has no contacts.
  explicit BodyContactAssembler(const System& system);

  /// Pairs of two moving bodies, for NewtonSystem::couple(). They may change in begin_step() and in
  /// cover().
  [[nodiscard]] const std::vector<linear::KktPair>& pairs() const { return couplings_; }
  /// Updates the nearby pairs. @returns whether they are unchanged.
  bool begin_step(const State& state, const Trial& trial);
  /// Part of the predicted motion in which no shapes pass through each other; after begin_step().
  [[nodiscard]] double free_part();
  /// Extends the search so that it covers the increments x from the trial.
  /// @returns whether the pairs are unchanged.
  bool cover(const Trial& trial, const Vec& x);
  /// Part of the increments in which no shapes pass through each other; after cover().
  [[nodiscard]] double filter() { return contacts_->filter(steps_, increments_); }
  /// Evaluates the terms of all pairs at the trial.
  void evaluate(const State& state, const Trial& trial, bool tangents);
  /// Adds the wrenches, times `scale`, to the bodies' right-hand side.
  void add_wrenches(double scale, Vec& rhs) const;
  /// Adds the tangents to the bodies' blocks and to those of pairs().
  void add_tangents(double scale, linear::KktValues& values,
                    std::span<linear::KktValues::Pair> pairs) const;

  /// Adds the wrench on the ground; the trial has converged.
  void end_step(const State& state, const Trial& trial);
  void add_ground_wrench(double* force, double* moment) const;
  [[nodiscard]] double stored(const State& state) const;
  Work commit(State& state, const Trial& trial);
  [[nodiscard]] BodyContacts* contacts() const { return contacts_; }

 private:
  void take_steps(const State& state, const Trial& trial);
  /// @returns whether the pairs are unchanged.
  bool take_pairs();

  const System* system_;
  BodyContacts* contacts_;
  std::vector<Participants> known_;  ///< Pairs of the present couplings.
  std::vector<int> place_;  ///< By contact pair: its coupling, or −1 (one side is fixed).
  std::vector<linear::KktPair> couplings_;
  std::vector<BodyStep> steps_, start_;  ///< By body, the ground last.
  std::vector<PairTerms> terms_;
  std::vector<Vec6> increments_;
  Vec3 ground_force_ = Vec3::Zero(), ground_moment_ = Vec3::Zero();
};

}  // namespace polhode
