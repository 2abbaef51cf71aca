// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Sparse>

#include <polhode/gradient/combination_derivative.hpp>
#include <polhode/gradient/parameter_shift.hpp>
#include <polhode/gradient/projection_derivative.hpp>
#include <polhode/gradient/run_tape.hpp>
#include <polhode/gradient/step_derivative.hpp>

namespace polhode {

/// The derivative of the whole steps of a tape: of single steps, one after the other, of
/// extrapolated ones by their members, the combination of these and its projection, and of those
/// with located impacts by their lengths and jumps.
class WholeStepDerivative {
 public:
  /// Derivatives of inputs by all parameters: of the single steps, member by member, and of the
  /// projection.
  using Inputs = std::vector<Eigen::SparseMatrix<double>>;

  WholeStepDerivative(const Simulation& simulation, const RunTape& tape);

  /// With located impacts the last number is the derivative of the time of a state.
  [[nodiscard]] int state_size() const { return single_.state_size() + (tape_.located() ? 1 : 0); }
  /// Largest remainder of a solution so far, as a part of its right-hand side [-].
  [[nodiscard]] double defect() const { return std::max(single_.defect(), projection_.defect()); }

  /// Takes tangents over a whole step. @param shifts  Of the parameters. @param direction  Of the
  /// only tangent; null: one for each parameter.
  /// @throws InputError where a velocity jumps, or a force is not symmetric in time.
  Inputs push(std::size_t step, std::vector<ParameterShift>& shifts, const Vec* direction,
              Mat& tangents);
  /// Takes adjoints back over a whole step. @param by  To which the derivatives by parameters are
  /// added.
  void pull(std::size_t step, const Inputs& inputs, std::vector<Vec>& mu, std::vector<Vec>& by);

 private:
  Eigen::SparseMatrix<double> push_single(std::size_t step, std::size_t member, std::size_t k,
                                          std::vector<ParameterShift>& shifts, const Vec* direction,
                                          Mat& tangents);
  void pull_single(std::size_t step, std::size_t member, std::size_t k,
                   const Eigen::SparseMatrix<double>& inputs, std::vector<Vec>& mu,
                   std::vector<Vec>& by);
  /// Derivatives of a step's inputs by its length and its time, and of the velocities at its end by
  /// its length, at fixed places.
  struct ByTime {
    Vec length, time, velocities;
  };
  [[nodiscard]] Eigen::SparseMatrix<double> linearize_single(std::size_t at, std::size_t member,
                                                             std::size_t k,
                                                             std::vector<ParameterShift>& shifts);
  Inputs push_located(std::size_t step, std::vector<ParameterShift>& shifts, const Vec* direction,
                      Mat& tangents);
  void pull_located(std::size_t step, const Inputs& inputs, std::vector<Vec>& mu,
                    std::vector<Vec>& by);
  [[nodiscard]] ByTime by_time(std::size_t step);
  [[nodiscard]] double of_end(ParameterShift& shift, std::size_t step) const;
  /// Derivative of the end of a step by its length.
  [[nodiscard]] Vec by_length(const ByTime& times);
  /// Derivative by the state of what is zero at the end of a step: gap of a row, or margin of an
  /// event.
  [[nodiscard]] Vec by_state(std::size_t step) const;
  void linearize_impact(std::size_t step);
  void check_rate(std::size_t step, double rate) const;
  /// The end of a step with the velocities of its motion; valid until the next call.
  [[nodiscard]] const State& before_jump(std::size_t step);
  void check_impact(std::size_t step) const;
  /// Whether the start of a step moves in time with the parameters.
  [[nodiscard]] bool starts_late(std::size_t step) const { return tape_.moves(step); }
  [[nodiscard]] Trial trial(const State& from, const State& to, double length) const;
  void combine(std::size_t step);
  void check_single(double t) const;
  void check_end(std::size_t step) const;

  const System& system_;
  const Model& model_;
  const RunTape& tape_;
  StepDerivative single_;
  CombinationDerivative combination_;
  ProjectionDerivative projection_;
  std::optional<InteractionSweep> sweep_;  ///< With located impacts.
  std::optional<InstantRows> rows_;        ///< Likewise.
  State before_jump_;
};

}  // namespace polhode
