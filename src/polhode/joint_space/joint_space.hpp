// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <polhode/dynamics/body_motion.hpp>
#include <polhode/model/model.hpp>

namespace polhode {

/// A coordinate along which a joint lets its bodies move, or along which a free body moves.
///
/// Coordinates of joints are those that joints report. A free body has x, y, z, the position of its
/// centre of mass, and rx, ry, rz, the rotation vector of its orientation. Three free rotations
/// have as rates the components of the angular velocity in the axes of the first body, as in
/// reports.
struct IndependentCoordinate {
  /// Name of the joint, with the coordinate if it has several: "elbow", "wrist.rx", "hull.x".
  std::string name;
  int joint = -1;          ///< Index into Model::joints; -1: of a free body.
  int body = kGround;      ///< Of a free body: index into Model::bodies.
  std::string coordinate;  ///< x, y, z, rx, ry, rz.
  bool turns = false;      ///< [rad]; else [m].
};

/// Independent coordinates of rigid bodies connected by joints, and the equations of motion in
/// them,
///
///   M(q) q̈ + c(q, q̇) + g(q) = τ.
///
/// Bodies are placed along a spanning tree, whose coordinates are exact. Where joints close loops,
/// or rows couple coordinates, some of the tree's coordinates depend on the others: the independent
/// ones are chosen at the model's position, and the equations are projected onto them. Loads are
/// not part of the equations, except inerters, whose inertance is part of M.
/// @eq{joint-space}
class JointSpace {
 public:
  /// Motions of all bodies of a model in its order, fixed ones included.
  using Motions = std::vector<BodyMotion>;

  /// @param model      Its joints must be assembled, unless it has no loops.
  /// @param preferred  Names of coordinates that are to be independent; others are so if these do
  /// not determine the position, in the order of the joints.
  /// @param released   Names of joints, and of loads with rows, that an event has switched off.
  /// @throws InputError for solids, beams, joints that move as prescribed, unknown names.
  explicit JointSpace(const Model& model, std::span<const std::string> preferred = {},
                      std::span<const std::string> released = {});
  ~JointSpace();
  JointSpace(JointSpace&&) noexcept;

  /// The independent coordinates, in the order of joints, then of free bodies.
  [[nodiscard]] const std::vector<IndependentCoordinate>& coordinates() const;
  [[nodiscard]] int size() const { return static_cast<int>(coordinates().size()); }
  /// Motions as the model describes them.
  [[nodiscard]] const Motions& model_motions() const;

  /// Coordinates of a position [rad, m]. @param near  Angles have the number of turns that brings
  /// them nearest to these; empty: between -π and π.
  [[nodiscard]] std::vector<double> positions(const Motions& motions,
                                              std::span<const double> near = {}) const;
  /// Rates that are nearest to the bodies' velocities, measured by the kinetic energy [rad/s, m/s].
  [[nodiscard]] std::vector<double> rates(const Motions& motions) const;
  /// Second derivatives that are nearest to given accelerations, measured likewise.
  /// @param linear, angular  By body, of centres of mass [m/s²], world [rad/s²].
  [[nodiscard]] std::vector<double> second_rates(const Motions& motions,
                                                 std::span<const Vec3> linear,
                                                 std::span<const Vec3> angular) const;
  /// Motions at given coordinates and rates. Loops are followed from a position that is assembled.
  /// @param from   That position; model_motions() itself need not be assembled.
  /// @param rates  Empty: at rest.
  /// @throws InputError if a loop cannot be closed there; the message names its joint.
  [[nodiscard]] Motions place(const Motions& from, std::span<const double> positions,
                              std::span<const double> rates = {}) const;

  /// M, symmetric, row by row. [kg m², kg m, kg]
  [[nodiscard]] std::vector<double> mass_matrix(const Motions& motions) const;
  /// c: forces along the coordinates that keep the rates constant, without gravity [N m, N].
  [[nodiscard]] std::vector<double> velocity_forces(const Motions& motions) const;
  /// g: forces along the coordinates that hold the bodies at rest against gravity [N m, N].
  [[nodiscard]] std::vector<double> gravity_forces(const Motions& motions) const;
  /// τ of given second derivatives [N m, N].
  [[nodiscard]] std::vector<double> inverse_dynamics(const Motions& motions,
                                                     std::span<const double> second) const;
  /// Velocity of a point of a body and its angular velocity by the rates, 6 rows, row by row.
  /// @param point  From the centre of mass, body axes [m].
  [[nodiscard]] std::vector<double> jacobian(const Motions& motions, int body,
                                             const Vec3& point) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace polhode
