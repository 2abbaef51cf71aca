// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/compile/build_system.hpp>
#include <polhode/gradient/projection_derivative.hpp>

namespace polhode {

/// A measured value of a channel.
struct Measured {
  std::string channel;
  double time = 0.0, value = 0.0;  ///< [s], SI
};

/// Outcome of a run: a channel at one time, its mean, integral, maximum or minimum over the run, or
/// the sum of the squares of the differences from measured values.
struct Outcome {
  enum class At { end, time, mean, integral, maximum, minimum, misfit };
  std::string text;     ///< As given: "bodies.rod.position.x@end".
  std::string channel;  ///< Without the time.
  At at = At::end;
  double time = 0.0;                 ///< Of At::time [s].
  std::vector<Measured> measured{};  ///< Of At::misfit.
};

/// Derivative of the value of a channel at a state.
struct OutcomeSlope {
  Vec by_state;  ///< See kStateNumbers.
  State at;      ///< With the velocities that are read.
  /// Projection of the velocities, and the weights of its inputs: empty for positions.
  std::vector<ProjectionStage> stages{};
  Vec by_inputs{};
};

/// Outcome from its text: CHANNEL, CHANNEL@end, CHANNEL@mean, CHANNEL@integral, CHANNEL@max,
/// CHANNEL@min, or CHANNEL@0.25 with a time [s]. @throws InputError
[[nodiscard]] Outcome parse_outcome(const std::string& text);

/// Reads a channel of positions or velocities from a state, and its derivative.
///
/// Channels: bodies.NAME.position.x, .velocity.x and .angular_velocity.x of the centre of mass;
/// probes.NAME.x and .vx of a probe of a body; joints.NAME.COORDINATE, by its name, or its number
/// as joints.NAME.coordinates.0. Velocities are projected
/// onto the constraints, as they are reported.
class OutcomeReader {
 public:
  /// @throws InputError if there is no such channel, or it is none of these.
  OutcomeReader(const Model& model, const SystemMap& map, const std::string& channel);

  [[nodiscard]] const std::string& unit() const { return unit_; }
  [[nodiscard]] bool of_velocity() const { return what_ == What::velocity || what_ == What::turn; }
  [[nodiscard]] double value(const System& system, const State& state) const;
  /// The value without a projection of the velocities.
  [[nodiscard]] double value_there(const System& system, const State& state) const;
  /// Derivative of the value: closed for positions and velocities, whose projection is an implicit
  /// function, and by central differences of order four for coordinates of joints. Differences of
  /// projections would be wrong in redundant loops, where they begin off the constraints.
  /// @eq{projection-derivative}
  [[nodiscard]] OutcomeSlope slope(const System& system, const State& state) const;

 private:
  enum class What { position, velocity, turn, coordinate };
  void set_body(const Model& model, const SystemMap& map, const std::string& name);
  void set_joint(const Model& model, const SystemMap& map, const std::string& name,
                 const std::string& coordinate);
  void set_number(const Model& model, const std::string& number);
  [[nodiscard]] double coordinate(const System& system, const State& state) const;
  [[nodiscard]] Vec coordinate_by_state(const System& system, const State& state) const;
  [[nodiscard]] Vec by_state_there(const System& system, const State& state) const;

  What what_ = What::position;
  int body_ = kGround, component_ = 0;
  int joint_ = -1;
  Vec3 Z_ = Vec3::Zero();
  std::string channel_, coordinate_, unit_;
};

/// Readers of outcomes, one for each; those of one channel are alike.
[[nodiscard]] std::vector<OutcomeReader> readers_of(const Model& model, const SystemMap& map,
                                                    const std::vector<Outcome>& outcomes);

}  // namespace polhode
