// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <polhode/core/source_location.hpp>
#include <polhode/core/types.hpp>
#include <polhode/model/side.hpp>

namespace polhode {

/// Contact settings of a shape; absent ones are the body's, then the model's. Also of the surface
/// of a solid, or of a whole beam or cable.
struct ContactSideSpec {
  std::optional<bool> touches;                     ///< False: the shape has no contact.
  std::optional<std::string> material;             ///< Name of a contact material.
  std::optional<std::vector<std::string>> groups;  ///< Its groups; none: 'default'.
  std::optional<std::vector<std::string>> meets;   ///< Groups with which it has contact; none: all.
  SourceLocation place;
};

/// Contact law of two surfaces. Zero, unless another meaning is given: chosen from the bodies.
struct ContactLawSpec {
  std::string potential = "barrier";    ///< A word of contact::kPotentialWords, rigid or nonsmooth.
  double gap_tolerance = 0.0;           ///< Half the band of the barrier [m].
  double stiffness = 0.0;               ///< [N/m]; hertz [N/m^1.5].
  double reference_load = 0.0;          ///< At which the gap of the barrier is zero [N].
  double reference_pressure = 0.0;      ///< Of surfaces of solids, at which the gap is zero [Pa].
  double restitution = 0.0;             ///< 0 to 1.
  std::string rebound = "exit";         ///< exit | damped.
  double friction = 0.0;                ///< Coefficient.
  double static_friction = 0.0;         ///< While sticking; 0: as friction.
  double friction_across = 0.0;         ///< Across `direction`; 0: as friction.
  Vec3 direction = Vec3::UnitX();       ///< Of `friction`, in coordinates of the first body.
  double rolling = 0.0, torsion = 0.0;  ///< Moment over normal force [m].
  double friction_stiffness = 0.0;      ///< Of the bristle [N/m].
  double friction_damping = 0.0;        ///< Of the sticking bristle [N s/m].
};

/// A contact material.
struct ContactMaterialSpec {
  std::string name;
  SourceLocation place;
  double friction = 0.0, restitution = 0.0;
};

/// A pair of sides or of materials with its own law, or a sensor between two bodies.
struct ContactPairSpec {
  std::string name;
  SourceLocation place;
  bool of_materials = false;
  Side a, b;                       ///< Of a pair of sides.
  std::array<int, 2> materials{};  ///< Of a pair of materials: into ContactsSpec::materials.
  bool sensor = false;
  ContactLawSpec law;
};

/// Rules that combine a property of two materials.
enum class Combination { geometric_mean, mean, minimum, maximum, product };

/// Description of the contact between the shapes of bodies, surfaces of solids and cables.
struct ContactsSpec {
  bool present = false;
  SourceLocation place;
  ContactLawSpec standard;
  std::vector<ContactMaterialSpec> materials;
  Combination friction = Combination::geometric_mean;
  Combination restitution = Combination::minimum;
  std::vector<ContactPairSpec> pairs;         ///< Including sensors.
  std::vector<std::array<Side, 2>> excluded;  ///< Sides without contact.
  /// Contact also between bodies with a common joint, and between solids and the bodies they are
  /// bonded to.
  bool joint_neighbours = false;
  bool resolve_overlaps = false;  ///< Separate bodies that overlap at the start.
  /// Results of every pair of bodies; absent: if there are few pairs.
  std::optional<bool> record;
  /// Of the non-smooth law, largest number in a step; 0: the default.
  int sweeps = 0;
  double sweep_tolerance = 0.0;  ///< Of the non-smooth law, see docs/reference; 0: the default.

  /// Whether impulses replace forces; a law of all pairs, as it determines the integration.
  [[nodiscard]] bool nonsmooth() const { return present && standard.potential == "nonsmooth"; }
  /// Whether contacts are rows of the step, likewise a law of all pairs.
  [[nodiscard]] bool rigid() const { return present && standard.potential == "rigid"; }
};

}  // namespace polhode
