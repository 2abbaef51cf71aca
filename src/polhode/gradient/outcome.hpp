// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/compile/build_system.hpp>

namespace polhode {

/// Outcome of a run: a channel at one time, its mean or its maximum over the run.
struct Outcome {
  enum class At { end, time, mean, maximum };
  std::string text;     ///< As given: "bodies.rod.position.x@end".
  std::string channel;  ///< Without the time.
  At at = At::end;
  double time = 0.0;  ///< Of At::time [s].
};

/// Outcome from its text: CHANNEL, CHANNEL@end, CHANNEL@mean, CHANNEL@max, or CHANNEL@0.25 with a
/// time [s]. @throws InputError
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
  /// Derivative by the state, see kStateNumbers: closed for positions, else central differences of
  /// order four.
  [[nodiscard]] Vec by_state(const System& system, const State& state) const;

 private:
  enum class What { position, velocity, turn, coordinate };
  void set_body(const Model& model, const SystemMap& map, const std::string& name);
  void set_joint(const Model& model, const SystemMap& map, const std::string& name,
                 const std::string& coordinate);
  void set_number(const Model& model, const std::string& number);

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
