// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <polhode/model/model.hpp>
#include <polhode/simulation/method.hpp>
#include <polhode/stepping/stepper.hpp>

namespace polhode {

/// States between the ends of a step, so that recording does not shorten steps.
///
/// Positions and rotations are polynomials that take the values, velocities and accelerations at
/// both ends of the step; where these differ from a polynomial of lower degree by more than the
/// tolerance of the steps, also those in the middle, which a step of its own reaches, and so on in
/// both halves. Velocities are their derivatives. Joints are then assembled. Angles, and what else
/// follows from positions, is counted from these; sums since the start, of works and impulses, are
/// of lower order, but energy and momenta balance as at the ends of steps. @eq{dense-output}
class DenseOutput {
 public:
  /// Whether the automatic steps of a simulation can have it: smooth models of bodies at orders
  /// above 2, whose interactions remember no more than what positions tell.
  [[nodiscard]] static bool suits(const System& system, const StepControl& control);

  /// @param method  Of the simulation's steps, with an engine of its own.
  DenseOutput(const System& system, Method method);
  ~DenseOutput();

  /// Remembers the start of a step that is about to be taken.
  void start(const State& state);
  /// Remembers its end. @param smooth  Whether it is free of impacts, and so its motion smooth.
  void finish(const State& state, bool smooth);
  /// The state at a time between them.
  [[nodiscard]] State at(double t);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace polhode
