// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/equations/constraint_check.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// The step being solved.
struct Trial {
  StepContext context;
  std::vector<TrialBlock> blocks;  ///< By slot; the last block is the ground.
  std::vector<double> lambda;      ///< By row, current iterate.
  // Nodes of deformable solids at t_{n+1}, three numbers each.
  std::vector<double> node_x, node_u, node_v;  ///< Position [m], x_{n+1} − x_n [m], velocity [m/s].
  std::vector<double> prescribed_v;            ///< At t_{n+1}, of prescribed components [m/s].
  std::vector<double> element_scratch;         ///< Of groups of elements: internal unknowns, ...
  std::vector<double> lambda_centre;           ///< By row: proximal centre; zero until converged.

  double compliance_scale = 0.0;  ///< Of statics, where it is the scale s; else 0 [m/N].

  /// s = βΔt²/m_ref: momentum rows are multiplied by it, λ̂ = s λ.
  [[nodiscard]] double scale(const System& system) const {
    if (compliance_scale > 0.0) return compliance_scale;
    return context.ga.beta * context.dt * context.dt / system.mean_mass();
  }
};

/// Makes room for the bodies and the ground.
void size_blocks(const State& state, Trial& trial);
/// Sizes the trial and fills it one body after the other: nobody has moved yet, λ is that of t_n,
/// the proximal centre is zero. The context must have been set. (The stepper's predictor does this
/// several bodies at a time.)
void start_trial(const System& system, const State& state, Trial& trial);
/// Body's step from the state at t_n and the trial at t_{n+1}; velocities by Newmark.
[[nodiscard]] BodyStep body_step(const System& system, const State& state, const Trial& trial,
                                 int body);
/// An interaction's view of the same step.
[[nodiscard]] PairView pair_view(const System& system, const State& state, const Trial& trial,
                                 const InteractionRef& ref);
/// Renews what an iteration changed: t_{n+1}; velocities there only if `rates`.
void update_body_step(const System& system, const State& state, const Trial& trial, int body,
                      BodyStep& step, bool rates);
/// Replaces a body's u, θ in the trial, and with them r and Λ at t_{n+1}.
void move_body(const State& state, Trial& trial, int slot, const Vec3& u, const Vec3& theta);

/// How one Newton iteration went.
struct Iteration {
  bool solved = false;     ///< False: singular matrix or a value that is not finite.
  double increment = 0.0;  ///< Largest of |Δr|/ℓ and |Δθ| [-].
  double applied = 1.0;    ///< Part that was applied; below 1 the iteration cannot be the last.
  double rotation = 0.0;   ///< Largest |θ| of the step after the update [-].
  int worst_body = -1;     ///< If not solved: whose pivot vanished, if known.
  std::string reason;      ///< If not solved: what else happened, and where.
};

/// One way of doing the Newton iterations of a step: assemble, solve, update.
class NewtonEngine {
 public:
  virtual ~NewtonEngine() = default;
  [[nodiscard]] virtual std::string name() const = 0;
  /// Called once per step when the trial was predicted.
  virtual void begin_step(const State& state, Trial& trial) = 0;
  /// The trial was set back to an iterate of the same step: what follows from it is renewed.
  virtual void resume(const State& state, Trial& trial) { begin_step(state, trial); }
  /// One iteration on the trial. `refactor` false: keep the last factorisation if there is one.
  /// `damping` in (0, 1]: part of the increment that is applied.
  virtual Iteration iterate(const State& state, Trial& trial, bool refactor, double damping) = 0;
  [[nodiscard]] virtual ConstraintCheck check(const State& state, Trial& trial) = 0;
  /// Body with the largest increment of the last iteration, for reports.
  [[nodiscard]] virtual int worst_body() const = 0;
  /// If something that is no body had it: its name, such as "node 7 of solid 'pad'".
  [[nodiscard]] virtual std::string worst_other() const { return {}; }
  /// Keeps factorisations over many steps: converges linearly, so the last increment must be small.
  [[nodiscard]] virtual bool keeps_factor() const { return false; }
  /// Increments may grow for a while, as when bodies part that were pressed together hard.
  [[nodiscard]] virtual bool may_grow() const { return false; }
  /// Adds force [N] and moment about the origin [N m] of ground joints that the engine sums itself,
  /// at the converged trial; `knows_ground(interaction)` says which.
  virtual void add_ground_wrench(double* /*force*/, double* /*moment*/) const {}
  [[nodiscard]] virtual bool knows_ground(int /*interaction*/) const { return false; }
  /// Energy that forces of the engine's own, such as contacts, store at a state [J].
  [[nodiscard]] virtual double stored(const State& /*state*/) const { return 0.0; }
  /// The step is accepted, the state still at t_n: histories and work of such forces.
  virtual Work commit(State& /*state*/, const Trial& /*trial*/) { return {}; }
  /// Contacts that it solves, whose impacts are to be settled when the state has moved to t_{n+1}.
  [[nodiscard]] virtual BodyContacts* contacts() const { return nullptr; }
  /// Called after convergence: makes trial.lambda complete.
  virtual void end_step(const State& state, Trial& trial) = 0;
};

}  // namespace polhode
