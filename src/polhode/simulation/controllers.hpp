// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <polhode/simulation/channel_reader.hpp>

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
  /// Evaluates the controllers that are due.
  Acted act(const Simulation& simulation, State& state) const;
  /// Target, measured value and output of a controller at the instant.
  [[nodiscard]] std::array<double, 3> report(int controller, const Simulation& simulation) const;
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
    int memory = 0;  ///< Offset of its numbers in State::history.
  };
  [[nodiscard]] static StateSpace state_space(const ControllerSpec& spec);
  /// @param y  Measured value. @returns whether its output jumps.
  static bool act(const Item& item, double y, const Simulation& simulation, State& state);
  static void set_output(const Item& item, const double* memory);

  std::vector<Item> items_;
};

}  // namespace polhode
