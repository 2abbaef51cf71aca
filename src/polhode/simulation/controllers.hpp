// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <polhode/simulation/event_watch.hpp>

namespace polhode {

class Simulation;

/// Outputs by controller, of one simulation.
using ControllerOutputs = std::vector<std::shared_ptr<ControllerOutput>>;

/// Replaces the controller outputs that loads and cables of a model refer to by outputs of this
/// model alone: copies of a model share their functions.
[[nodiscard]] ControllerOutputs own_outputs(Model& model);

/// Controllers of a running model: they read channels at the ends of steps and set outputs for the
/// next one. Sampled controllers hold their output until the next sample; continuous ones
/// extrapolate their last two outputs linearly, and integrate their own states by the trapezoidal
/// rule. Their memory is part of the State. @eq{controller} @eq{controller-steps}
class Controllers {
 public:
  /// @param order  Of the method.
  /// @throws InputError if a channel does not exist, or a controller is continuous at order 4 or
  /// above or on a mean over the step.
  Controllers(const Simulation& simulation, const SystemMap& map, ControllerOutputs outputs,
              int order);

  /// Next time after the state's at which a step must end [s].
  [[nodiscard]] double next_time(const State& state, double until) const;
  struct Acted {
    bool any = false;     ///< A controller has acted.
    bool jumps = false;   ///< Its output jumps: earlier forces do not predict later ones.
    std::string blind{};  ///< Description of a controller whose channel has no value.
  };
  /// Whether a controller has not acted yet, as at the start and where motions were set. The next
  /// sample of one that is sampled is then the first one after the state's time.
  [[nodiscard]] bool begin(State& state) const;
  /// Evaluates the controllers that are due.
  Acted act(const Simulation& simulation, State& state) const;
  /// Target, measured value and output of a controller at the instant.
  [[nodiscard]] std::array<double, 3> report(int controller, const Simulation& simulation) const;
  /// Switches controllers at an instant, before act(): the output of those that are off is zero;
  /// those switched on, also if they are on, begin with integrals and filters of zero.
  void switch_over(State& state, const SwitchedControllers& switched) const;
  /// Restores the outputs stored in a state.
  void resume(const State& state) const;

 private:
  /// A transfer function as ẋ = A x + B e, y = C x + D e, in controller canonical form.
  struct StateSpace {
    Mat A;
    Vec B, C;
    double D = 0.0;
  };
  struct Item {
    const ControllerSpec* spec = nullptr;
    ChannelReader channel;
    std::optional<ChannelReader> rate;  ///< If the derivative is used.
    StateSpace filter;
    std::shared_ptr<ControllerOutput> output;
    int memory = 0;            ///< Offset of its numbers in State::history.
    std::vector<int> loads{};  ///< Interactions that use the output.
    std::vector<int> inner{};  ///< Controllers whose setpoint it is.
    bool always_used = false;  ///< By what cannot be switched off.
  };
  /// Finds what uses the outputs.
  void find_users(const Model& model, const SystemMap& map);
  /// Whether nothing uses the output at present, or all that does is at a limit that a change of
  /// the output in this direction would exceed: the integral then stops (anti-windup).
  [[nodiscard]] bool idle(const Item& item, const State& state) const;
  [[nodiscard]] bool limited(const Item& item, const State& state, double change) const;
  [[nodiscard]] static StateSpace state_space(const ControllerSpec& spec);
  /// @param y  Measured value. @returns whether its output jumps.
  bool act(const Item& item, double y, const Simulation& simulation, State& state) const;
  static void set_output(const Item& item, const double* memory);
  /// Output just before the instant, which is another one where it jumps, if it has acted there.
  [[nodiscard]] static double value_before(const Item& item, const State& state, double otherwise);
  [[nodiscard]] static bool is_off(const Item& item, const State& state) {
    return state.history[static_cast<std::size_t>(item.memory + ControllerMemory::kOff)] != 0.0;
  }

  const System* system_;
  std::vector<Item> items_;
};

}  // namespace polhode
