// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/compile/cable_contact.hpp>
#include <polhode/surface_contact/edge_contact.hpp>

namespace polhode {

/// A cable as one side of a pair of cables in contact.
struct CableSide {
  const CableLineSpec& cable;
  const CableLine& line;
};

/// Two cables, or one with itself, as lines of round edges. Excluded are pairs of segments of one
/// cable that are nearer to each other along it than half a turn about a bar of its own radius, and
/// segments of two cables near attachments to one body; both extended along the cables as long as
/// these overlap at the start.
/// @param X  Positions at the start by the system's node numbers [m].
/// @param tolerance  Of the gap between crossing edges [m].
[[nodiscard]] surface_contact::EdgeContact::Sides cable_sides(const Model& model,
                                                              const CableSide& a,
                                                              const CableSide& b,
                                                              const std::vector<Vec3>& X,
                                                              double tolerance);

/// Mean unstressed length of the segments [m].
[[nodiscard]] double mean_piece(const CableLine& line);

}  // namespace polhode
