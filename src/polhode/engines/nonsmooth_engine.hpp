// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/engines/compact_gauss_seidel.hpp>
#include <polhode/engines/impulse_newton.hpp>
#include <polhode/engines/projected_gauss_seidel.hpp>
#include <polhode/equations/newton_engine.hpp>
#include <polhode/equations/newton_system.hpp>
#include <polhode/system/body_contacts.hpp>
#include <polhode/system/impulsive_contacts.hpp>

namespace polhode {

/// Steps of bodies with impulsive contacts (Moreau's midpoint rule): velocities jump inside a step,
/// forces and positions follow the midpoint rule. One search for impulses, which always ends,
/// replaces Newton's iterations of other engines; joints are not supported.
///
/// Momenta are exact for any result of the search: the last impulses move the bodies by the same
/// equations as forces would. @eq{nonsmooth-step}
class NonsmoothEngine final : public NewtonEngine {
 public:
  /// @throws InputError if the contacts have no impulses, or the system has joints or solids.
  explicit NonsmoothEngine(const System& system);
  [[nodiscard]] std::string name() const override { return "impulses: projected Gauss-Seidel"; }
  void begin_step(const State& state, Trial& trial) override;
  Iteration iterate(const State& state, Trial& trial, bool refactor, double damping) override;
  [[nodiscard]] ConstraintCheck check(const State&, Trial&) override { return {}; }
  [[nodiscard]] int worst_body() const override { return worst_body_; }
  void add_ground_wrench(double* force, double* moment) const override;
  void end_step(const State&, Trial&) override {}
  Work commit(State& state, const Trial& trial) override;

  [[nodiscard]] const ImpulseSearch& last_search() const { return search_; }
  [[nodiscard]] int point_count() const { return static_cast<int>(points_.size()); }
  /// Whether the contacts of a system act by impulses of Moreau's rule.
  [[nodiscard]] static bool has_impulses(const System& system);

 private:
  [[nodiscard]] int index(int body) const { return body == kGround ? bodies_ : body; }
  bool move(const State& state, const Trial& trial);
  [[nodiscard]] bool search(const State& state, const Trial& trial);
  void set_up(double dt, bool first);
  bool sweep();
  [[nodiscard]] int most_sweeps() const;
  /// Number of points and turns.
  [[nodiscard]] int unknowns() const {
    return point_count() + static_cast<int>(sweeps_.turns.size());
  }
  [[nodiscard]] bool is_small() const { return unknowns() <= kMaxDensePoints; }
  void add_up(double dt);
  /// @returns whether any point is newly held back.
  [[nodiscard]] bool hold_back();
  [[nodiscard]] int pressed_in(const StepContext& context);

  const System* system_;
  BodyContacts* contacts_;
  ImpulsiveContacts* impulsive_;
  int bodies_;
  InteractionSweep loads_;
  ImpulseOptions options_;
  ProjectedGaussSeidel sweeps_;
  CompactGaussSeidel compact_;
  std::vector<BodyStep> steps_;  ///< By body, the ground last.
  std::vector<ImpulsePoint> points_;
  std::vector<ImpulseLoss> losses_;
  std::vector<char> held_back_;  ///< By point: its mean slip over the step is zero.
  std::vector<Vec3> places_;     ///< By point: where impulses acted when bodies were last moved.
  std::vector<Vec6> loads_now_, impulses_, nowhere_;  ///< By body.
  std::vector<Mat3> inertia_;                         ///< World, at t_n.
  std::vector<char> round_;                           ///< By body: isotropic inertia.
  ImpulseSearch search_;
  double dt_ = 0.0;         ///< Of the step [s].
  double reference_ = 0.0;  ///< Reference speed of ImpulseOptions::tolerance [m/s].
  int worst_body_ = -1;
};

}  // namespace polhode
