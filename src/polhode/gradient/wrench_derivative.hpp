// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include <polhode/equations/newton_system.hpp>
#include <polhode/linear/kkt.hpp>

namespace polhode {

/// Derivatives of wrenches and rows of all interactions by the motion at t_n, at any ρ∞.
///
/// For ρ∞ < 1 laws of loads are not symmetric in time: joints are seen backwards, with the weight
/// 1 − α_f, and loads are differentiated by differences of order four. Velocities act through those
/// at t_{n+αf} alone, so that their derivative is the part of the step's own tangent that grows
/// with 1/Δt. @eq{damped-step-derivative}
class WrenchDerivative {
 public:
  explicit WrenchDerivative(const System& system);

  /// @param steps  Of the bodies, the ground last. @param scale  Of forces and moments, s of Trial.
  void evaluate(const State& from, const Trial& step, std::span<const BodyStep> steps,
                double scale);

  /// Residuals by (dr_n, dφ_n), velocities at both ends held.
  [[nodiscard]] const linear::KktValues& by_place() const { return by_place_; }
  /// Residuals by those (Δr, Δθ) at t_{n+1} that change the velocities there, places held.
  [[nodiscard]] const linear::KktValues& by_velocity() const { return by_velocity_; }

 private:
  using Values = Eigen::Matrix<double, 18, 1>;  ///< Wrenches on a and b, then rows.
  struct Sides {
    const BodyStep &a, &b;
    const StepContext& context;
    const double *lambda, *history;
  };
  [[nodiscard]] Values values(const InteractionRef& ref, const Sides& sides);
  /// Evaluates with tangents into terms_.
  void tangents(const InteractionRef& ref, const Sides& sides);
  void see_backwards(const InteractionRef& ref, const Sides& sides);
  [[nodiscard]] const double* history_at(const InteractionRef& ref, const Sides& sides);
  void difference(const InteractionRef& ref, const Sides& sides);
  void add(linear::KktValues& to, int interaction, double factor);

  const System* system_;
  KktMap map_;
  linear::KktValues by_place_, by_velocity_;
  std::vector<bool> backwards_;  ///< By interaction: joints.
  double scale_ = 1.0;
  PairTerms terms_;
  std::vector<double> history_;
};

}  // namespace polhode
