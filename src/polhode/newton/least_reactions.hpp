// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <polhode/equations/newton_engine.hpp>

namespace polhode {

/// Reactions of smallest norm in the equations of a step, for forces that depend on reactions:
/// friction in joints with redundant rows, whose multipliers the motion leaves undetermined.
/// @eq{least-reactions}
///
/// The null vectors n of the rows, Gᵀ n = 0, are those of the assembled positions at both ends of
/// the step: averages of directions would not be exactly dependent. Only interactions that are
/// connected to such friction and share redundant rows take part.
class LeastReactions {
 public:
  /// Whether the friction of some joint depends on reactions that may be redundant.
  [[nodiscard]] static bool may_act(const System& system);
  /// @param assembled  State with assembled positions, whose rank decides which joints take part.
  LeastReactions(const System& system, const State& assembled);
  ~LeastReactions();
  LeastReactions(LeastReactions&&) noexcept;

  /// Whether any interaction takes part.
  [[nodiscard]] bool act() const;
  /// Prepares a step. @returns false if a value is not finite.
  bool begin_step(const State& state, const Trial& trial, NewtonEngine& engine);
  /// Removes the redundant part of the multipliers of the iterate, and sets the proximal centres so
  /// that the next iteration adds none. @returns false if a value is not finite.
  bool apply(const State& state, Trial& trial, NewtonEngine& engine);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace polhode
