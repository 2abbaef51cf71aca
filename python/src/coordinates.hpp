// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include <polhode/joint_space/inverse_kinematics.hpp>
#include <polhode/joint_space/joint_space.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::python {

/// Joint coordinates of the states of a simulation in which the same joints act.
class Coordinates {
 public:
  /// @param state      Joints and other rows that are switched off in it have no part.
  /// @param preferred  See JointSpace.
  Coordinates(const Model& model, const System& system, const State& state,
              const std::vector<std::string>& preferred);

  /// Whether the same joints and rows are switched off in a state.
  [[nodiscard]] bool are_of(const System& system, const State& state) const;

  [[nodiscard]] const JointSpace& space() const { return space_; }
  [[nodiscard]] const CoordinateLimits& limits() const { return limits_; }
  /// Distance beyond its limits at which a coordinate may be set [rad, m].
  [[nodiscard]] double play(std::size_t coordinate) const { return play_[coordinate]; }
  [[nodiscard]] std::size_t size() const { return space_.coordinates().size(); }

  /// Motions of all bodies of the model. Velocities are those of the state, not projected.
  [[nodiscard]] JointSpace::Motions motions(const System& system, const State& state) const;
  /// Positions with counted turns.
  [[nodiscard]] std::vector<double> positions(const System& system, const State& state,
                                              const JointSpace::Motions& motions) const;
  /// Sets the counted turns of joints in a state to those of given positions.
  void set_turns(const System& system, State& state, const std::vector<double>& positions) const;

 private:
  /// An angle with counted turns.
  struct Angle {
    std::size_t coordinate = 0;
    int interaction = 0;
    int history = 0;  ///< Into the history of the joint.
  };

  std::vector<int> switched_;  ///< Interactions with rows that can be switched off.
  std::vector<int> off_;       ///< Those of them that are off.
  JointSpace space_;
  CoordinateLimits limits_;
  std::vector<double> play_;
  JointSpace::Motions fixed_;
  std::vector<int> body_;  ///< By body of the model: of the system; kGround: fixed.
  std::vector<Angle> angles_;
};

}  // namespace polhode::python
