// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/impulses/row_problem.hpp>

namespace polhode {

/// Torsional friction, one row of a contact, or rolling friction, two rows.
struct TurningRows {
  Eigen::Index first = -1;  ///< −1: none.
  double length = 0.0;      ///< Largest angular impulse per unit normal impulse [m].
  double used = 0.0;        ///< Of the step: |p|/length [N s].
  bool stuck = false;       ///< At t_n: without relative rotation.
};

/// A contact or stop at the end of a step in which it was a unilateral row, with its friction.
struct ContactRows {
  Eigen::Index normal = 0;     ///< Row of the normal velocity, positive: separating.
  Eigen::Index tangents = -1;  ///< First of two rows of the slip; −1: no friction.
  Vec3 half_axes =
      Vec3::Zero();         ///< Of the friction cone per unit normal impulse, of two rows [-].
  bool was_closed = false;  ///< At t_n.
  bool stuck = false;       ///< At t_n, or over the step of a closed row: its slip was zero.
  bool touches = true;      ///< The gap at t_{n+1} is zero to round-off.
  double restitution = 0.0;
  double impulse = 0.0;   ///< Of the step along the normal, not negative [N s].
  double friction = 0.0;  ///< Of the step, as a part of the cone's axes: |p_t|/μ [N s].
  double absorbed = 0.0;  ///< D = −p Δg/h: work of the normal impulse of a closing row [J].
  TurningRows torsion = {}, rolling = {};

  /// Whether it closes in the step.
  [[nodiscard]] bool closes() const { return !was_closed && touches; }
};

/// Velocity problem of the bodies that share contacts, at the end of a step in which some of these
/// close: the state before the impact, then compression and restitution.
///
/// In the step a closing row stops its bodies at a gap of zero; the work D it absorbs there is
/// known exactly. The velocities before the impact are those that the bodies would have without the
/// closing rows at the same place, with the energy that the rows have absorbed. Compression stops
/// the closing rows, in proportion, with friction by Coulomb's law along the course; restitution
/// returns e² of the work of compression, never more than all. Energy cannot rise, whatever the
/// masses, and the result does not depend on the order of the rows. @eq{velocity-problem}
struct VelocityProblem {
  Mat A;        ///< Symmetric: velocities of rows by unit impulses; joints included [1/kg].
  Vec w;        ///< Velocities of the rows at the end of the step, by drives as well [m/s].
  Vec lengths;  ///< As those of RowProblem; empty: all 1.
  std::vector<ContactRows> contacts;
  double rounding = 0.0;  ///< Of velocities [m/s].
  /// Rounding of positions over the step: rows that separate no faster than that stay closed [m/s].
  double noise = 0.0;
  /// Energy of the velocities of the step that joints do not admit, by which it exceeds that of w.
  double projected = 0.0;

  struct Result {
    Vec impulses;      ///< Change the velocities of the step to those after the impact [N s].
    Vec work;          ///< Of each row's impulses on the bodies, along the course [J].
    RowReport report;  ///< Worst of all row problems.
    std::vector<char> closed;  ///< By contact: in contact from now on.
    std::vector<char> sticks;  ///< Likewise: with zero slip.
  };
  /// Impact of an island with closing rows.
  [[nodiscard]] Result impact() const;
  /// Ends the slip of closed rows that began to stick in the step, without an impact.
  [[nodiscard]] Result stop_slip() const;
};

/// Number of sub-steps of an impact with friction in each of compression and restitution. One gives
/// Newton's law; with many a single row tends to Routh's and Stronge's solution.
inline constexpr int kImpactSubsteps = 4;

}  // namespace polhode
