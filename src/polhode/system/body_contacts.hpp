// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <polhode/system/pair_terms.hpp>
#include <polhode/system/state.hpp>

namespace polhode {

class ImpulsiveContacts;
class PointwiseContacts;
class System;

/// Phase of an impact with friction in a step, for Routh's method where it shares its bodies with
/// no other impact. @eq{routh}
struct ImpactCourse {
  bool turns = false;        ///< Compression ends in the step.
  double restitution = 0.0;  ///< e, Stronge's.
  double stored_n = 0.0;     ///< Energy stored in the contact at t_n [J].
  double stored_n1 = 0.0;    ///< At t_{n+1}, before any loss [J].
  double fallen = 0.0;       ///< 2 a h by attracting forces after the bodies separated [m²/s²].
};

/// Torsional and rolling friction of a contact that was a row of the step.
struct TurningRow {
  double torsion = 0.0, rolling = 0.0;  ///< Angular impulse over normal impulse [m]; 0: none.
  double size = 1.0;            ///< Length that turns their velocities into those of points.
  Vec3 impulse = Vec3::Zero();  ///< On a, in the step [N m s].
  /// The relative rotation about the normal, or across it, was zero over the step and before it.
  bool torsion_stuck = false, rolling_stuck = false;
};

/// A contact or a stop that was a row of the step, for its velocity problem. @eq{velocity-problem}
struct StepRow {
  bool was_closed = false;  ///< At t_n.
  bool stuck = false;       ///< Its slip was zero over the step, and before it.
  bool stops = false;       ///< Its slip or rotation was not zero before the step, but over it.
  bool touches = false;     ///< At t_{n+1}.
  double restitution = 0.0;
  double absorbed = 0.0;  ///< Work of its impulse in the step; 0 if it touched at t_n [J].
  TurningRow turning = {};

  [[nodiscard]] bool closes() const { return !was_closed && touches; }
  /// Whether its velocity, or its slip, has to change.
  [[nodiscard]] bool changes() const { return closes() || stops; }
};

/// An impact between two bodies, or of one on the ground.
struct PairImpact {
  Participants bodies;
  Impact impact;
  std::optional<ImpactCourse> course;
  double slow = 0.0;  ///< Of resting contact: it reacts to faster approach only [m/s].
  std::optional<StepRow> row = {};  ///< Of contacts and stops that are rows.
};

/// Impulse of a resolved impact, with its losses.
struct ResolvedImpact {
  double normal = 0.0;           ///< Along J [N s].
  Vec3 friction = Vec3::Zero();  ///< On a, world [N s].
  double normal_loss = 0.0;      ///< Energy dissipated by it [J].
  double friction_loss = 0.0;    ///< [J]
  /// Whether the velocity problem of a contact that is a row was solved.
  bool solved = false;
  bool closed = false, sticks = false;  ///< From now on.
};

/// Interface of contacts between bodies: the pairs of bodies they couple change during a run. Their
/// histories are in State::contacts. Steps are given by body, the ground last.
class BodyContacts {
 public:
  virtual ~BodyContacts() = default;
  // Further interfaces of contacts; null if not available.
  [[nodiscard]] virtual ImpulsiveContacts* impulsive() { return nullptr; }
  [[nodiscard]] virtual PointwiseContacts* pointwise() { return nullptr; }

  /// Called once, when the system is finished.
  virtual void prepare(const System& system) = 0;
  /// Called before the first iteration of a step, without any motion yet: updates the nearby pairs.
  /// @returns whether pairs() changed.
  virtual bool begin_step(const State& state, std::span<const BodyStep> steps,
                          const StepContext& context) = 0;
  /// Pairs of bodies that may be in contact in this step; at least one of each is movable.
  [[nodiscard]] virtual const std::vector<Participants>& pairs() const = 0;
  /// Extends the search to the increments (Δr, Δθ) from the trial.
  /// @returns whether pairs() changed.
  virtual bool cover(std::span<const BodyStep> steps, const StepContext& context,
                     std::span<const Vec6> increments) = 0;
  /// Evaluates the terms of every pair; rows are never used.
  virtual void evaluate(std::span<const BodyStep> steps, const StepContext& context,
                        std::span<PairTerms> terms) = 0;
  /// Largest part of the increments, at most 1, in which no shapes pass through each other.
  [[nodiscard]] virtual double filter(std::span<const BodyStep> steps,
                                      std::span<const Vec6> increments) = 0;
  /// Stored energy at the state [J].
  [[nodiscard]] virtual double stored(const State& state, std::span<const BodyStep> instants) = 0;
  /// Commits an accepted step: histories are stored in the state, before it moves to t_{n+1}.
  virtual Work commit(State& state, std::span<const BodyStep> steps,
                      const StepContext& context) = 0;
  /// Whether any contact was active in the last committed step.
  [[nodiscard]] virtual bool touched() const = 0;
  /// Appends impacts that continue in the step or end in it to the list; the state has moved to
  /// t_{n+1}. Their histories are stored in the state.
  /// @returns the change of the stored energy, and its dissipated part.
  virtual Work impacts(State& state, std::vector<PairImpact>& list) = 0;
  /// Appends resting contacts of these bodies to the list, as reaction to impacts elsewhere; their
  /// target speed is the present one. Those listed since impacts() are left out.
  /// @eq{impact-carried}
  virtual void resting(const State& /*state*/, std::span<const int> /*bodies*/,
                       std::vector<PairImpact>& /*list*/) {}
  /// Receives the impulses, in the order of the list; histories are stored in the state.
  virtual void settled(State& state, std::span<const ResolvedImpact> impacts) = 0;
  /// Location of the smallest clearance in a step that cannot be solved: "box 'a' on 'floor'"; may
  /// be empty.
  [[nodiscard]] virtual std::string tightest() const = 0;
};

}  // namespace polhode
