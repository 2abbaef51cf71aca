// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/core/types.hpp>

namespace polhode::contact {

enum class ContactStatus { open, stick, slip };

/// Contact of two shapes over the last step.
struct ShapePairReport {
  int a = 0, b = 0;              ///< Shapes.
  double gap = 0.0;              ///< Smallest, at t_{n+1} [m].
  Vec3 force = Vec3::Zero();     ///< On a, friction included [N].
  double normal_force = 0.0;     ///< Sum of all points [N].
  Vec3 friction = Vec3::Zero();  ///< On a [N].
  Vec3 point = Vec3::Zero();     ///< Mean of the points, weighted by normal force [m].
  int points = 0;
  ContactStatus status = ContactStatus::open;
  double dissipated = 0.0;   ///< In the step, impacts included [J].
  double impact_loss = 0.0;  ///< The part of it due to impacts [J].
  int unresolved = 0;       ///< Points that closed in an impact of fewer than twenty steps although
                            ///< their law has a given stiffness or damper.
  bool near_floor = false;  ///< A spring of given stiffness is stiffer there than stated.
};

/// Two shapes that overlap.
struct ShapeOverlap {
  int a = 0, b = 0;
  double depth = 0.0;          ///< [m]
  Vec3 normal = Vec3::Zero();  ///< From b to a, at the deepest point.
};

/// A point that carried force in the last step.
struct TouchingPoint {
  int a = 0, b = 0;              ///< Shapes.
  Vec3 point = Vec3::Zero();     ///< [m]
  Vec3 normal = Vec3::Zero();    ///< From b to a.
  Vec3 force = Vec3::Zero();     ///< On a, friction included [N].
  Vec3 friction = Vec3::Zero();  ///< On a [N].
  double gap = 0.0;              ///< [m]
};

}  // namespace polhode::contact
