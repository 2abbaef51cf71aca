// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <polhode/dynamics/composition.hpp>
#include <polhode/gradient/event_margin.hpp>
#include <polhode/gradient/instant_rows.hpp>
#include <polhode/gradient/step_sequence.hpp>
#include <polhode/simulation/method.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <polhode/stepping/extrapolation_table.hpp>
#include <polhode/stepping/single_step.hpp>

namespace polhode {

/// Equal or composed single steps from the start of a whole step.
struct TapeMember {
  std::vector<double> lengths;  ///< [s]
  /// States after each of them; the last one of a step that is not extrapolated is the end of the
  /// whole step, and not repeated here.
  std::vector<State> states;
};

/// A run: the states between its whole steps, and the single steps within these.
struct RunTape {
  std::vector<State> ends;                       ///< The start, and the ends of all whole steps.
  std::vector<std::vector<TapeMember>> members;  ///< By whole step: one, or those extrapolated.
  StepSequence sequence;
  /// Rows that close at the ends of steps, which are as long as it takes their gaps to become zero,
  /// and events there, −1 for none; empty for models without unilateral rows and events.
  std::vector<std::optional<InstantRow>> closings;
  std::vector<int> events;
  std::vector<std::optional<EventMargin>> margins;  ///< By event.

  /// Whether ends of steps were located.
  [[nodiscard]] bool located() const { return !closings.empty(); }
  /// Event with a condition at an end, −1: none.
  [[nodiscard]] int event_at(std::size_t end) const {
    return located() && end > 0 ? events[end - 1] : -1;
  }
  /// Whether the time of an end depends on the motion.
  [[nodiscard]] bool moves(std::size_t end) const {
    return closing_at(end) != nullptr || event_at(end) >= 0;
  }
  /// Row that closes at an end; null: none.
  [[nodiscard]] const InstantRow* closing_at(std::size_t end) const {
    return located() && end > 0 && closings[end - 1] ? &*closings[end - 1] : nullptr;
  }
  /// State after a single step of a whole step.
  [[nodiscard]] const State& after(std::size_t step, std::size_t member, std::size_t k) const {
    const std::vector<State>& states = members[step][member].states;
    return k < states.size() ? states[k] : ends[step + 1];
  }
  /// State before it.
  [[nodiscard]] const State& before(std::size_t step, std::size_t member, std::size_t k) const {
    return k == 0 ? ends[step] : after(step, member, k - 1);
  }
  [[nodiscard]] std::int64_t single_steps() const;
};

/// Takes given whole steps without step control, and records single steps.
class TapeRecorder {
 public:
  explicit TapeRecorder(const Simulation& simulation);

  [[nodiscard]] const GeneralizedAlpha& method() const { return ga_; }
  /// Single steps of a whole one. @throws SolveError if one is not accepted.
  [[nodiscard]] std::vector<TapeMember> record(const State& from, const TakenStep& step);
  /// Takes a whole step. @throws SolveError if it is not accepted.
  void take(State& state, const TakenStep& step);
  /// Whether a unilateral row touched in the last step, or a velocity jumped at its end.
  [[nodiscard]] bool touched() const;

 private:
  [[nodiscard]] TapeMember chain(const State& from, const std::vector<double>& lengths,
                                 SingleStep::Predictor predictor, std::size_t kept);

  const System* system_;
  GeneralizedAlpha ga_;
  StepControl control_;
  std::vector<double> stages_{1.0};
  SingleStep single_;
  std::unique_ptr<ExtrapolationTable> table_;
};

/// Memory of a tape so far, which is limited.
class TapeMemory {
 public:
  explicit TapeMemory(const State& state);
  /// Number of states that a step of fixed length has.
  void expect(double states) const;
  void add(const std::vector<TapeMember>& members);

 private:
  double bytes_, states_ = 1.0;
};

/// Runs a simulation from its start to its end.
/// @param stops  Times at which automatic steps end, in ascending order [s].
/// @throws SolveError if a step is not accepted; InputError if the states need too much memory.
[[nodiscard]] RunTape run_onto_tape(Simulation& simulation, const std::vector<double>& stops = {});

/// Repeats a sequence of steps from the start of a simulation, whatever their errors are.
/// @throws SolveError and InputError as run_onto_tape().
[[nodiscard]] RunTape replay(const Simulation& simulation, const StepSequence& sequence);

/// Each step as two of half the length.
[[nodiscard]] StepSequence halved(const StepSequence& sequence);

}  // namespace polhode
