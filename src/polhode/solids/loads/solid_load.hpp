// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <polhode/core/time_function.hpp>
#include <polhode/solids/loads/loaded_faces.hpp>
#include <polhode/system/element_group.hpp>
#include <polhode/system/parameter.hpp>

namespace polhode::solids {

// Loads on solids are ElementGroups. Values are taken at t_{n+αf}, times StepContext::load_factor.
// Loads with a constant value that are no follower loads have a potential, which counts as stored;
// the work of others over a step is external.

using ElementGroups = std::vector<std::unique_ptr<ElementGroup>>;

/// Part of a solid on which a kind of load acts, which determines its selection in the model file.
enum class SolidLoadPlace : unsigned char {
  faces,    ///< Faces of the boundary: `surface`; left out: all.
  nodes,    ///< Nodes: `nodes`.
  elements  ///< All elements, without a selection.
};

/// Evaluation of a follower load over a step.
enum class FollowerRule : unsigned char {
  /// At the positions at t_{n+αf}: forces on a closed surface have no moment, so angular momentum
  /// is exact. Work differs from p ΔV by terms of third order in the step.
  kMomentum,
  /// Simpson's mean of both ends and the middle: at ρ∞ = 1 work is exactly p ΔV; moments on a
  /// closed surface vanish only to second order in the step.
  kWork
};

/// Elements of one kind.
struct LoadedElements {
  std::string element;     ///< A kind of element_kinds().
  std::vector<int> nodes;  ///< Numbers of nodes, element after element.
};

/// Input for any kind of load on a solid. Nodes have the numbers of the System.
struct SolidLoadDescription {
  std::string name{};                      ///< Path of the load in the user's model.
  TimeFunctionPtr value{};                 ///< Of SolidLoadKind::value, SI.
  TimeVector vector{};                     ///< Of SolidLoadKind::vector, SI; empty is zero.
  std::optional<FollowerRule> follower{};  ///< None: on the undeformed faces.
  std::map<std::string, double> values{};  ///< Parameters by name, SI, with their defaults.
  std::vector<Vec3> X{};                   ///< Reference positions of all nodes [m].
  std::vector<LoadedFaces> faces{};        ///< Of SolidLoadPlace::faces, by shape.
  std::vector<int> nodes{};                ///< Of SolidLoadPlace::nodes.
  std::vector<LoadedElements> elements{};  ///< Of SolidLoadPlace::elements.
  double density = 0.0;                    ///< Of the solid [kg/m³].
};

/// A type of load on solids in the model file.
struct SolidLoadKind {
  std::string name;     ///< "type" in the model file.
  std::string meaning;  ///< One line.
  SolidLoadPlace place = SolidLoadPlace::faces;
  std::optional<TimeParameter> value{};   ///< Number, function of time.
  std::optional<TimeParameter> vector{};  ///< Components along the world's axes, functions of time.
  bool can_follow = false;                ///< Has the keys `follower` and `keeps`.
  std::vector<Parameter> parameters{};
  /// The groups of elements that apply the load.
  /// @throws InputError if there is nothing to load.
  ElementGroups (*make)(const SolidLoadDescription&) = nullptr;
};

/// A list of one group.
[[nodiscard]] inline ElementGroups one_group(std::unique_ptr<ElementGroup> group) {
  ElementGroups groups;
  groups.push_back(std::move(group));
  return groups;
}

}  // namespace polhode::solids
