// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <polhode/core/source_location.hpp>
#include <polhode/core/types.hpp>

namespace polhode {

// A side of contact is a body, by its index into Model::bodies, the surface of a solid, or a cable:
/// More solids than a model has: the sides of cables come behind theirs.
inline constexpr int kMaxSolids = 1 << 24;
/// The side of a solid, by its index into Model::solids.
[[nodiscard]] constexpr int side_of_solid(int solid) { return kGround - 1 - solid; }
/// The side of a cable, by its index into Model::cables.
[[nodiscard]] constexpr int side_of_cable(int cable) { return kGround - 1 - kMaxSolids - cable; }
/// No body: a solid or a cable.
[[nodiscard]] constexpr bool is_surface_side(int side) { return side < kGround; }
[[nodiscard]] constexpr bool is_cable_side(int side) { return side < kGround - kMaxSolids; }
[[nodiscard]] constexpr bool is_solid_side(int side) {
  return is_surface_side(side) && !is_cable_side(side);
}
/// Index into Model::solids of a side that is a solid's.
[[nodiscard]] constexpr int solid_of_side(int side) { return kGround - 1 - side; }
/// Index into Model::cables of a side that is a cable's.
[[nodiscard]] constexpr int cable_of_side(int side) { return kGround - 1 - kMaxSolids - side; }

/// How a shape takes part in contact; what is absent is as the body's, then as the model's. Of a
/// solid: how its surface does. Of a beam or cable: how all of it does.
struct ContactSideSpec {
  std::optional<bool> touches;                     ///< False: the shape meets nothing.
  std::optional<std::string> material;             ///< Name of a contact material.
  std::optional<std::vector<std::string>> groups;  ///< Belongs to these; none: to 'default'.
  std::optional<std::vector<std::string>> meets;   ///< Meets shapes of these; none: of all.
  SourceLocation place;
};

/// What two surfaces do to each other. Zero, where no other meaning is told: chosen from the
/// bodies.
struct ContactLawSpec {
  std::string potential = "barrier";    ///< barrier, linear, hertz, nonsmooth.
  double gap_tolerance = 0.0;           ///< Half the band of the barrier [m].
  double stiffness = 0.0;               ///< [N/m]; hertz [N/m^1.5].
  double reference_load = 0.0;          ///< At which the gap of the barrier is zero [N].
  double reference_pressure = 0.0;      ///< Of surfaces of solids, at which the gap is zero [Pa].
  double restitution = 0.0;             ///< 0 to 1.
  std::string rebound = "exit";         ///< exit | damped.
  double friction = 0.0;                ///< Coefficient.
  double static_friction = 0.0;         ///< While it sticks; 0: as friction.
  double friction_across = 0.0;         ///< Across `direction`; 0: as friction.
  Vec3 direction = Vec3::UnitX();       ///< Of `friction`, in coordinates of the first body.
  double rolling = 0.0, torsion = 0.0;  ///< Moment over normal force [m].
  double friction_stiffness = 0.0;      ///< Of the bristle [N/m].
  double friction_damping = 0.0;        ///< Of the bristle while it sticks [N s/m].
};

/// A surface that pairs are made of.
struct ContactMaterialSpec {
  std::string name;
  SourceLocation place;
  double friction = 0.0, restitution = 0.0;
};

/// A pair of sides or of materials with a law of its own, or a sensor between two bodies.
struct ContactPairSpec {
  std::string name;
  SourceLocation place;
  bool of_materials = false;
  int a = 0, b = 0;  ///< Sides, or indices into ContactsSpec::materials.
  bool sensor = false;
  ContactLawSpec law;
};

/// How a property of a pair follows from its two materials.
enum class Combination { geometric_mean, mean, minimum, maximum, product };

/// Contact between the shapes of bodies, and of surfaces of solids and cables with them, as
/// described.
struct ContactsSpec {
  bool present = false;
  SourceLocation place;
  ContactLawSpec standard;
  std::vector<ContactMaterialSpec> materials;
  Combination friction = Combination::geometric_mean;
  Combination restitution = Combination::minimum;
  std::vector<ContactPairSpec> pairs;        ///< Sensors too.
  std::vector<std::array<int, 2>> excluded;  ///< Sides that do not meet.
  bool joint_neighbours = false;             ///< Bodies with a common joint meet, solids and the
                                             ///< bodies they are bonded to, too.
  bool resolve_overlaps = false;             ///< Move bodies that overlap at the start.
  std::optional<bool> record;    ///< Results of every pair of bodies; absent: if there are few.
  int sweeps = 0;                ///< Of the non-smooth law, most in a step; 0: the default.
  double sweep_tolerance = 0.0;  ///< Of the non-smooth law, see docs/reference; 0: the default.

  /// Impulses instead of forces; a law of all pairs, as it decides how steps are taken.
  [[nodiscard]] bool nonsmooth() const { return present && standard.potential == "nonsmooth"; }
};

}  // namespace polhode
