// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>

#include <polhode/core/source_location.hpp>
#include <polhode/core/types.hpp>
#include <polhode/model/side.hpp>

namespace polhode {

/// Description of a probe or a channel: columns of numbers of one object.
struct ProbeSpec {
  std::string name;
  SourceLocation place;
  std::string kind;             ///< body, joint, load, solid, beam, cable, contact, controller.
  std::string target;           ///< Its name.
  std::array<Side, 2> pair{};   ///< Of a contact probe: sides.
  Vec3 point = Vec3::Zero();    ///< Of a body probe: from the centre of mass, body axes; of a
                                ///< solid probe: in the mesh's own coordinates [m].
  std::optional<int> node;      ///< Of a solid probe, instead of point: the first node is 0.
  int element = 0;              ///< Of a beam, or segment of a cable: the first is 0.
  std::string reaction_of;      ///< Of a solid probe: the bonded body or prescribed nodes whose
                                ///< reaction is recorded.
  bool stress = false;          ///< Of a point or node of a solid: stress too.
  std::optional<double> every;  ///< [s]; else output.every.
  std::string axes = "world";   ///< Of reactions: world or joint.
  // Of a body probe: further columns.
  std::string rotation;     ///< quaternion, vector, matrix or an Euler sequence; "" for none.
  bool angular = false;     ///< Angular velocity and acceleration.
  std::string helical;      ///< instantaneous or finite; "" for none.
  int seen_from = kGround;  ///< Reference body of relative motion: index into Model::bodies.
};

}  // namespace polhode
