// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <polhode/core/time_function.hpp>
#include <polhode/system/element_group.hpp>

namespace polhode {

/// Faces of one shape: tri3, tri6, quad4, quad8, quad9. Seen from outside the solid, their corners
/// are counterclockwise.
struct LoadedFaces {
  std::string shape;
  std::vector<int> nodes;  ///< Numbers of nodes, face after face.
};

/// Evaluation of a follower pressure over a step.
enum class FollowerRule : unsigned char {
  /// At the positions at t_{n+αf}: forces on a closed surface have no moment, so angular momentum
  /// is exact. Work differs from p ΔV by terms of third order in the step.
  kMomentum,
  /// Simpson's mean of both ends and the middle: at ρ∞ = 1 work is exactly p ΔV; moments on a
  /// closed surface vanish only to second order in the step.
  kWork
};

// Loads are ElementGroups. Values are taken at t_{n+αf}, times StepContext::load_factor. Loads with
// a constant value that are no follower loads have a potential, which counts as stored; the work of
// others over a step is external.
//
// name: path of the load in the user's model. X: reference positions of all nodes [m].

/// The same force on each node [N]; absent components are zero.
[[nodiscard]] std::unique_ptr<ElementGroup> make_nodal_force(std::string name,
                                                             const std::vector<int>& nodes,
                                                             std::span<const Vec3> X,
                                                             TimeVector force);

/// Force per undeformed area, fixed in the world [Pa].
/// @throws InputError if there are no faces, or faces of an unknown shape.
[[nodiscard]] std::unique_ptr<ElementGroup> make_traction(std::string name,
                                                          std::span<const LoadedFaces> faces,
                                                          std::span<const Vec3> X,
                                                          TimeVector traction);

/// Pressure against the outward normals and areas of the undeformed faces [Pa].
[[nodiscard]] std::unique_ptr<ElementGroup> make_dead_pressure(std::string name,
                                                               std::span<const LoadedFaces> faces,
                                                               std::span<const Vec3> X,
                                                               TimeFunctionPtr pressure);

/// Pressure against the present outward normals and areas [Pa]: one group for each shape of face.
[[nodiscard]] std::vector<std::unique_ptr<ElementGroup>> make_follower_pressure(
    const std::string& name, std::span<const LoadedFaces> faces, const TimeFunctionPtr& pressure,
    FollowerRule rule = FollowerRule::kMomentum);

/// Force per undeformed volume [N/m³] on solid elements.
/// @param element       A kind of element_kinds(); its rule for the mass is used.
/// @param connectivity  Numbers of nodes, element after element.
/// @param factor        Multiplies the value, e.g. by a density, if the value is an acceleration.
[[nodiscard]] std::unique_ptr<ElementGroup> make_body_force(std::string name,
                                                            const std::string& element,
                                                            std::span<const int> connectivity,
                                                            std::span<const Vec3> X,
                                                            TimeVector force, double factor = 1.0);

}  // namespace polhode
