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

/// Gives what the loads and cables of a model follow to outputs of this model alone: copies of a
/// model share their functions.
[[nodiscard]] ControllerOutputs own_outputs(Model& model);

/// The controllers of a model while it runs: they read channels at the ends of steps and set what
/// acts over the next one. Sampled ones hold it until the next sample; continuous ones go on along
/// the straight line through their last two outputs, and integrate their own states by the
/// trapezoidal rule. What they remember is in the State. @eq{controller} @eq{controller-steps}
class Controllers {
 public:
  /// @param order  Of the method.
  /// @throws InputError if a channel does not exist, or a controller is continuous at order 4 or
  /// above or on a mean over the step.
  Controllers(const Simulation& simulation, const SystemMap& map, ControllerOutputs outputs,
              int order);

  /// The first time after the state's at which a step must end [s].
  [[nodiscard]] double next_time(const State& state, double until) const;
  struct Acted {
    bool any = false;     ///< The time of a controller has come.
    bool jumps = false;   ///< What it sets jumps: forces before tell nothing of those to come.
    std::string blind{};  ///< A controller whose channel is not known, in words.
  };
  /// Lets those act whose time has come.
  Acted act(const Simulation& simulation, State& state) const;
  /// What a controller aims at, sees, and sets at the instant.
  [[nodiscard]] std::array<double, 3> report(int controller, const Simulation& simulation) const;
  /// Puts the outputs where a state left them.
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
    std::optional<ChannelReader> rate;  ///< If the derivative counts.
    StateSpace filter;
    std::shared_ptr<ControllerOutput> output;
    int memory = 0;  ///< Where its numbers are in State::history.
  };
  [[nodiscard]] static StateSpace state_space(const ControllerSpec& spec);
  /// @param y  What it reads. @returns whether its output jumps.
  static bool act(const Item& item, double y, const Simulation& simulation, State& state);
  static void set_output(const Item& item, const double* memory);

  std::vector<Item> items_;
};

}  // namespace polhode
