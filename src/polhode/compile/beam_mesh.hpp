// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/model/model.hpp>

namespace polhode {

/// Meshes a beam: adds its nodes to the bodies (`mast.0`, `mast.1`, ...), with half of the mass and
/// rotary inertia of each adjacent element, a fixed joint for every bond (`mast.start`,
/// `mast.end`), and the beam to Model::beams. @returns its index there.
/// @throws InputError if points coincide, elements are too few or bent too much, or a section has
/// no mass.
int add_beam(Model& model, BeamSpec beam);

/// Divides a cable into its segments, and adds it to Model::cables. A cable with mass gets nodes,
/// point masses `stay.0`, `stay.1`, ..., of which those at its points are attached by spherical
/// joints (`stay.0`, ...). @returns its index there.
/// @throws InputError if points coincide or values are out of range.
int add_cable(Model& model, CableLineSpec cable);

/// For each body of the model whether it is a node of a beam or of a cable with mass, not a body
/// named by the user.
[[nodiscard]] std::vector<bool> are_nodes(const Model& model);

/// Coupled part m_ab of the translational mass of an element: 1/6 of the mass if it is consistent,
/// zero if lumped. @param part  Consistent part [-].
[[nodiscard]] inline double coupled_part(double mass, double part) { return part * mass / 6.0; }

}  // namespace polhode
