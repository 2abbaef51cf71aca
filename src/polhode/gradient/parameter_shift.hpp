// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Sparse>

#include <polhode/equations/newton_system.hpp>
#include <polhode/gradient/changed_items.hpp>
#include <polhode/gradient/combination_derivative.hpp>
#include <polhode/gradient/event_margin.hpp>
#include <polhode/gradient/gradient.hpp>
#include <polhode/gradient/outcome.hpp>
#include <polhode/gradient/projection_derivative.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode {

/// A parameter's four neighbouring models, and central differences of order four between them:
/// (2/3)(f₁ − f₋₁) − (1/12)(f₂ − f₋₂) over the step. @eq{parameter-difference}
///
/// Each has its own memory of interactions, which follows the motion of the run that is
/// differentiated: constants that the start sets, and integrals of prescribed speeds, depend on the
/// parameter, turns counted do not.
class ParameterShift {
 public:
  /// @throws InputError if a neighbour cannot start, or differs from the base in more than numbers.
  ParameterShift(const GradientParameter& parameter, const Simulation& base, const SystemMap& map,
                 const std::vector<Outcome>& outcomes);

  [[nodiscard]] double step() const { return step_; }
  /// Derivative of the state at the start. @param start  Of the base.
  [[nodiscard]] Vec start_derivative(const System& system, const State& start) const;
  /// Memory at the start of the run that is differentiated.
  void begin(const State& start);
  /// Derivative of the inputs of a step, see StepDerivative::inputs(), by the parameter at fixed
  /// motion: added to the entries of this column.
  /// @param steps  Of the bodies, the ground last. @param step  Without tangents.
  void add_residual(const State& from, const Trial& step, std::span<const BodyStep> steps,
                    int column, std::vector<Eigen::Triplet<double>>& entries);
  /// Takes the memories to the end of the step.
  void commit(const Trial& step, std::span<const BodyStep> steps);
  /// Take the memories through an extrapolated step: each member begins with those at its start,
  /// the members' ones are combined, and coordinates are those of the projected positions.
  void begin_member(bool first);
  void end_member() { keep_memories(); }
  void combine(const CombinationDerivative& combination);
  void remember_coordinates(const State& projected);
  /// Derivative of the inputs of a projection, see stage_inputs(), like add_residual().
  void add_projection(const std::vector<ProjectionStage>& stages, int column,
                      std::vector<Eigen::Triplet<double>>& entries);
  /// Derivative of the gap of a row at a fixed state, the end of the step to which the memories
  /// have been taken.
  [[nodiscard]] double of_gap(const InstantRow& row, const State& state);
  /// Derivative of the margin of an event at a fixed state. @param slope  Of the margin there.
  [[nodiscard]] double of_margin(std::size_t event, const OutcomeSlope& slope);
  /// Switches off in the memories what is off in a state of the run.
  void follow_switches(const State& state);
  /// Derivative of an outcome's value at a fixed state. @param slope  Of the value there.
  [[nodiscard]] double of_value(std::size_t outcome, const OutcomeSlope& slope);

 private:
  struct Neighbour {
    std::unique_ptr<Simulation> simulation;
    std::unique_ptr<InstantRows> rows;        ///< From the first impact on.
    std::unique_ptr<InteractionSweep> sweep;  ///< Of the interactions that may differ.
    std::unique_ptr<InteractionSweep> all;    ///< Of all, from the first projected velocity on.
    std::vector<double> history, residual;
    std::vector<std::vector<double>> kept;  ///< Memories at the start and behind each member.
    Vec terms;                              ///< Of a projection.
    std::vector<OutcomeReader> readers;
    std::vector<std::optional<EventMargin>> margins;  ///< By event.
  };
  template <class Value>
  [[nodiscard]] auto difference(const Value& of) const {
    using Number = std::decay_t<decltype(of(at_[0]))>;
    const Number near = of(at_[0]) - of(at_[1]), far = of(at_[2]) - of(at_[3]);
    return Number((2.0 / 3.0 * near - 1.0 / 12.0 * far) / step_);
  }

  void set_items(const System& system, const ChangedItems& changed);
  void add_items_with_other_memories();
  /// Whether interactions that count as equal are so, bit for bit.
  [[nodiscard]] bool others_are_equal(const Trial& step, std::span<const BodyStep> steps) const;
  void keep_memories();
  /// Derivative of a value by what its projection takes from the parameter.
  [[nodiscard]] double of_projection(const OutcomeSlope& slope);
  /// The row of a neighbour.
  [[nodiscard]] InstantRow row_of(Neighbour& n, const InstantRow& row, const State& state) const;
  void evaluate(Neighbour& n, const State& from, const Trial& step,
                std::span<const BodyStep> steps) const;

  const System* system_;
  std::string path_;
  double step_ = 0.0;
  bool checked_ = false;
  std::vector<int> bodies_, interactions_;  ///< That may differ.
  /// Residuals that may differ: their places among the inputs of a step, and by body and row the
  /// number among these, or −1.
  std::vector<int> places_, of_body_, of_row_;
  std::size_t first_stored_ = 0;  ///< Of these the first ḣ of bodies_, if accelerations are stored.
  bool stores_ = false;
  std::array<Neighbour, 4> at_;  ///< At +1, −1, +2, −2 steps.
};

}  // namespace polhode
