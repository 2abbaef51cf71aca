// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <polhode/beams/bar_strain.hpp>
#include <polhode/beams/hill_muscle.hpp>
#include <polhode/beams/section.hpp>
#include <polhode/core/source_location.hpp>
#include <polhode/core/types.hpp>
#include <polhode/model/contact_spec.hpp>

namespace polhode {

/// A cross-section with its material.
struct SectionSpec {
  std::string name;
  SourceLocation place;
  BeamSection section;
  double relaxation_time = 0.0;      ///< Kelvin-Voigt viscosity [s].
  double height = 0.0, width = 0.0;  ///< Extent along y and z, for pictures [m]; 0: not known.
};

/// An end of a beam that is fixed to a body.
struct BeamBondSpec {
  int body = kGround;  ///< Index into Model::bodies, or kGround.
  bool at_end = false;
};

/// Contact of a beam as a round bar about its centre line.
struct BeamContactSpec {
  double radius = 0.0;   ///< [m]; 0: half the section's height or width, whichever is smaller.
  ContactSideSpec side;  ///< Of all its nodes.
};

/// Description of a beam. add_beam() converts it to nodes, which are bodies, and elements.
struct BeamSpec {
  std::string name;
  SourceLocation place;
  /// Stress-free polyline, world at the start [m]; corners are rigid. If arc: a circle's start, a
  /// point on it and its end.
  std::vector<Vec3> points;
  bool arc = false;
  int elements = 1;  ///< Total number, distributed to the segments by length.
  SectionSpec section;
  std::optional<Vec3> up;  ///< Approximate direction of the section's y, world at the start.
  bool residual_bending_flexibility = true;  ///< See BeamElementSpec.
  double consistent_mass = 0.5;  ///< Part of the mass that is consistent, the rest lumped [-].
  Vec3 velocity = Vec3::Zero();  ///< Of the first point at the start, world [m/s].
  Vec3 angular_velocity = Vec3::Zero();  ///< Of the whole, as a rigid body [rad/s].
  std::vector<BeamBondSpec> bonds;
  std::optional<BeamContactSpec> contact;  ///< None: bodies pass through the beam.

  /// A straight or circular element between nodes k and k + 1.
  struct Element {
    double length = 0.0;                                          ///< [m]
    Quat frame_1 = Quat::Identity(), frame_2 = Quat::Identity();  ///< World at the start.
  };
  int first_node = -1;        ///< Index into Model::bodies; the others follow.
  std::vector<Element> mesh;  ///< Filled in by add_beam().

  [[nodiscard]] int node_count() const { return static_cast<int>(mesh.size()) + 1; }
  [[nodiscard]] double length() const;  ///< Of all elements, undeformed [m].
  [[nodiscard]] double mass() const {
    return length() * section.section.mass_per_length;
  }  ///< [kg]
};

/// A point at which a cable is attached.
struct AttachmentSpec {
  int body = kGround;     ///< Index into Model::bodies, or kGround.
  Vec3 Z = Vec3::Zero();  ///< From the centre of mass, body axes; ground: world [m].
};

/// A sphere, cylinder or ellipsoid fixed to a body, which a cable runs around.
struct ObstacleSpec {
  std::string name;
  SourceLocation place;
  AttachmentSpec at;              ///< Its centre, or a point of the cylinder's axis.
  Mat3 axes = Mat3::Identity();   ///< As columns, body components (ground: world).
  Vec3 semi_axes = Vec3::Zero();  ///< Along these; infinite along the axis of a cylinder [m].
  std::optional<Vec3> side{};  ///< Direction to the side of the cable, as axes; none: the shorter.
  int after = 0;               ///< It is between this point of the cable and the next.
};

/// Contact of a cable as a round rope about its centre line.
struct CableContactSpec {
  double radius = 0.0;   ///< [m]
  bool self = false;     ///< Self-contact.
  ContactSideSpec side;  ///< Of the whole cable.
};

/// Description of a cable, rope, rod or truss member: straight segments from point to point. Each
/// segment has its own elongation, unless the cable runs over its points.
struct CableLineSpec {
  std::string name;
  SourceLocation place;
  std::vector<AttachmentSpec> through;
  double stiffness = 0.0;             ///< EA [N].
  std::optional<double> free_length;  ///< Of the whole [m]; if absent: the length at the start.
  double damping = 0.0;               ///< Of the whole, force per rate of elongation [N s/m].
  bool tension_only = true;
  BarStrain strain = BarStrain::engineering;
  double mass_per_length = 0.0;  ///< [kg/m]; 0: none, then segments go from point to point.
  int elements = 1;              ///< With mass: segments from one point to the next.
  std::optional<CableContactSpec> contact;  ///< None: bodies pass through the cable.
  /// It runs over its points: without friction one tension in all segments.
  bool slides = false;
  double friction = 0.0;  ///< Of a running cable, on the points between the ends [-].
  /// Whole turns about these points in addition to the change of direction there [-].
  std::vector<double> wraps;
  TimeFunctionPtr tension;           ///< Of a running cable, in addition to its elastic one [N].
  std::optional<HillMuscle> muscle;  ///< Active force of a muscle; the cable runs over its points.
  std::vector<ObstacleSpec> around;  ///< Obstacles of a running cable, one between two points.

  /// Segments, filled in by add_cable().
  struct Piece {
    AttachmentSpec a, b;
    double free_length = 0.0;  ///< [m]
    double mass = 0.0;         ///< [kg]
  };
  std::vector<Piece> pieces;
  [[nodiscard]] double length() const;  ///< Unstressed, of all segments [m].
  [[nodiscard]] double mass() const;    ///< Of all segments [kg].
};

}  // namespace polhode
