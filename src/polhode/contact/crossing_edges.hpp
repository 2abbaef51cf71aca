// SPDX-License-Identifier: Apache-2.0
// Contact of two edges: where they cross, and on which side of each other they are.
#pragma once

#include <optional>

#include <polhode/contact/contact_point.hpp>
#include <polhode/contact/impulse_places.hpp>

namespace polhode::contact {

/// Whether a feature pair is of two edges, or of an edge and a rim.
[[nodiscard]] inline bool is_of_edges(GapKind kind) {
  return kind == GapKind::edge_edge || kind == GapKind::rim_edge;
}

/// Corrects the gap of two edges, or of the inner rim of a tube and an edge. Whether the cores have
/// passed through each other follows from the outward sides of the edges.
/// @returns whether they cross; their ends are corners, which are paired with the whole solid.
bool correct_edges(const PointData& d, const BothPlaced& at, Gap<double>& g);

/// Two edges that cross: the nearest points of both are between their ends.
struct Crossing {
  Gap<double> gap;
  /// Whether the direction of the gap, or its opposite, lies in the cones of normals of both edges:
  /// no other features of the two bodies are nearer there.
  bool in_front = false, behind = false;
};

/// Crossing of the edges of a pair; none: they are no contact of their own, whatever their
/// distance, as a corner is nearer to the other body. @eq{contact-edges}
[[nodiscard]] std::optional<Crossing> crossing(const PointData& d, const BothPlaced& at);

/// Whether two edges that cross at the end of a step have passed through each other in it, as each
/// lies on the other side of the other one. @eq{contact-edges}
[[nodiscard]] bool passed_through(const PointData& d, const BodyStep& a, const BodyStep& b);

/// Whether two edges are a contact at the end of a step that was none at its start: they overlap,
/// or have passed through each other.
[[nodiscard]] bool have_met(const PointData& d, const BodyStep& a, const BodyStep& b);

}  // namespace polhode::contact
