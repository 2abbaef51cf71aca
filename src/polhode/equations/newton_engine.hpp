// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <polhode/equations/constraint_check.hpp>
#include <polhode/equations/trial.hpp>

namespace polhode {

/// Result of one Newton iteration.
struct Iteration {
  bool solved = false;     ///< False: singular matrix or a value that is not finite.
  double increment = 0.0;  ///< Largest of |Δr|/ℓ and |Δθ| [-].
  double applied = 1.0;    ///< Applied part; below 1 the iteration cannot be the last.
  double rotation = 0.0;   ///< Largest |θ| of the step after the update [-].
  int worst_body = -1;     ///< If not solved: body with the zero pivot, if known.
  std::string reason;      ///< If not solved: other reason, and where.
};

/// Interface of the Newton iterations of a step: assemble, solve, update.
class NewtonEngine {
 public:
  virtual ~NewtonEngine() = default;
  [[nodiscard]] virtual std::string name() const = 0;
  /// An engine of its own for another thread, which solves the same steps with the same bits; null
  /// if there cannot be one.
  [[nodiscard]] virtual std::unique_ptr<NewtonEngine> another() const { return nullptr; }
  /// Called once per step when the trial was predicted.
  virtual void begin_step(const State& state, Trial& trial) = 0;
  /// Called when the trial was set back to an iterate of the same step: updates derived data.
  virtual void resume(const State& state, Trial& trial) { begin_step(state, trial); }
  /// Sets ε of exact rows from now on, see kProximal.
  virtual void set_proximal(double /*epsilon*/) {}
  /// Copies the engine's own multipliers to the trial and back, between iterations.
  virtual void store_multipliers(Trial& /*trial*/) {}
  virtual void load_multipliers(const Trial& /*trial*/) {}
  /// Whether a row of an interaction has a proximal centre; rows of tree joints have none.
  [[nodiscard]] virtual bool has_centre(int /*interaction*/) const { return true; }
  /// One iteration on the trial. `refactor` false: reuse the last factorisation if there is one.
  /// `damping` in (0, 1]: part of the increment that is applied.
  virtual Iteration iterate(const State& state, Trial& trial, bool refactor, double damping) = 0;
  [[nodiscard]] virtual ConstraintCheck check(const State& state, Trial& trial) = 0;
  /// Body with the largest increment of the last iteration, for reports.
  [[nodiscard]] virtual int worst_body() const = 0;
  /// Name of an object other than a body with the largest increment, such as "node 7 of solid
  /// 'pad'".
  [[nodiscard]] virtual std::string worst_other() const { return {}; }
  /// Whether factorisations are reused over many steps: it converges linearly then, so the last
  /// increment must be small.
  [[nodiscard]] virtual bool keeps_factor() const { return false; }
  /// Whether increments may grow for a while, as when strongly compressed bodies separate.
  [[nodiscard]] virtual bool may_grow() const { return false; }
  /// Adds force [N] and moment about the origin [N m] of ground joints that the engine sums itself,
  /// at the converged trial; those for which knows_ground(interaction) is true.
  virtual void add_ground_wrench(double* /*force*/, double* /*moment*/) const {}
  [[nodiscard]] virtual bool knows_ground(int /*interaction*/) const { return false; }
  /// Energy stored at a state by forces of the engine's own, such as contacts [J].
  [[nodiscard]] virtual double stored(const State& /*state*/) const { return 0.0; }
  /// Commits histories and work of such forces; the step is accepted, the state still at t_n.
  virtual Work commit(State& /*state*/, const Trial& /*trial*/) { return {}; }
  /// Contacts of the engine, whose impacts are resolved when the state has moved to t_{n+1}.
  [[nodiscard]] virtual BodyContacts* contacts() const { return nullptr; }
  /// Completes trial.lambda after convergence.
  virtual void end_step(const State& state, Trial& trial) = 0;
};

}  // namespace polhode
