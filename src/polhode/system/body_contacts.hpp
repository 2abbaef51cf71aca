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

/// Phase of an impact with friction in a step, for the law that follows it where it shares its
/// bodies with no other one. @eq{routh}
struct ImpactCourse {
  bool turns = false;        ///< The end of compression lies in the step.
  double restitution = 0.0;  ///< e, Stronge's.
  double stored_n = 0.0;     ///< Energy that the contact stores at t_n [J].
  double stored_n1 = 0.0;    ///< At t_{n+1}, before any of it is lost [J].
  double fallen = 0.0;  ///< 2 a h by what pulled the bodies together after they parted [m²/s²].
};

/// An impact between two bodies, or of one with the ground.
struct PairImpact {
  Participants bodies;
  Impact impact;
  std::optional<ImpactCourse> course;
  double slow = 0.0;  ///< Of lasting contact: it answers what presses it faster than that [m/s].
};

/// Impulse of an impact, with its losses.
struct ResolvedImpact {
  double normal = 0.0;           ///< Along J [N s].
  Vec3 friction = Vec3::Zero();  ///< On a, world [N s].
  double normal_loss = 0.0;      ///< Energy it took [J].
  double friction_loss = 0.0;    ///< [J]
};

/// Forces between bodies that meet and part: which pairs of bodies they couple changes during a
/// run. Their memory is State::contacts. Steps are given by body, the ground last.
class BodyContacts {
 public:
  virtual ~BodyContacts() = default;
  // What contacts may be besides; null where they are not.
  [[nodiscard]] virtual ImpulsiveContacts* impulsive() { return nullptr; }
  [[nodiscard]] virtual PointwiseContacts* pointwise() { return nullptr; }

  /// Once, when the system is finished.
  virtual void prepare(const System& system) = 0;
  /// Before the first iteration of a step, nobody having moved yet: finds what is near.
  /// @returns whether pairs() changed.
  virtual bool begin_step(const State& state, std::span<const BodyStep> steps,
                          const StepContext& context) = 0;
  /// Pairs of bodies that may touch in this step; at least one of each moves.
  [[nodiscard]] virtual const std::vector<Participants>& pairs() const = 0;
  /// Makes sure that bodies can move by the increments (Δr, Δθ) from where they are in the trial.
  /// @returns whether pairs() changed.
  virtual bool cover(std::span<const BodyStep> steps, const StepContext& context,
                     std::span<const Vec6> increments) = 0;
  /// Terms of every pair; rows are never used.
  virtual void evaluate(std::span<const BodyStep> steps, const StepContext& context,
                        std::span<PairTerms> terms) = 0;
  /// The largest part of the increments, at most 1, that lets nothing pass through.
  [[nodiscard]] virtual double filter(std::span<const BodyStep> steps,
                                      std::span<const Vec6> increments) = 0;
  /// Energy stored at the state [J].
  [[nodiscard]] virtual double stored(const State& state, std::span<const BodyStep> instants) = 0;
  /// The step is accepted: histories go into the state, before it moves to t_{n+1}.
  virtual Work commit(State& state, std::span<const BodyStep> steps,
                      const StepContext& context) = 0;
  /// Something acted in the step that was committed last.
  [[nodiscard]] virtual bool touched() const = 0;
  /// Impacts that go on in the step or end in it, appended to the list, the state having moved to
  /// t_{n+1}. Their memory goes into the state.
  /// @returns the change of the stored energy, and what was dissipated by it.
  virtual Work impacts(State& state, std::vector<PairImpact>& list) = 0;
  /// Lasting contacts of these bodies, appended to the list, to answer what impacts elsewhere do:
  /// they want the speed that they have. None that was listed since impacts(). @eq{impact-carried}
  virtual void resting(const State& /*state*/, std::span<const int> /*bodies*/,
                       std::vector<PairImpact>& /*list*/) {}
  /// Their impulses, in the order of the list.
  virtual void settled(std::span<const ResolvedImpact> impacts) = 0;
  /// Where a step that cannot be solved is tightest: "box 'a' on 'floor'"; may be empty.
  [[nodiscard]] virtual std::string tightest() const = 0;
};

}  // namespace polhode
