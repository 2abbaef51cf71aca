// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include <polhode/core/types.hpp>

namespace polhode {

/// Position of frame b in frame a: its point, along the axes of a [m], and its axes.
struct RelativePose {
  Vec3 d = Vec3::Zero();
  Mat3 R = Mat3::Identity();
};

/// World placement of the frames of a joint, for its motion vectors.
struct PlacedFrames {
  Mat3 R_a = Mat3::Identity(), R_b = Mat3::Identity();  ///< Axes.
  Vec3 x_b = Vec3::Zero();                              ///< Point of b [m].
};

/// A motion of one body relative to another, as velocity of the point of b that is at the world's
/// origin, and angular velocity.
struct MotionVector {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();

  MotionVector& operator+=(const MotionVector& m) {
    linear += m.linear;
    angular += m.angular;
    return *this;
  }
  friend MotionVector operator*(double f, const MotionVector& m) {
    return {f * m.linear, f * m.angular};
  }
  /// Velocity of a point at x.
  [[nodiscard]] Vec3 at(const Vec3& x) const { return linear + angular.cross(x); }
};

/// The motion of frame b relative to frame a that a joint leaves free, by its coordinates:
/// displacements along axes of a, then rotations.
///
/// One rotation is about the common axis; of two, the first is about an axis of a and the second
/// about one of b; two of equal turns, and three, are a rotation vector. The rates of three are the
/// components of the angular velocity in the axes of a. @eq{joint-space}
class FreeMotion {
 public:
  FreeMotion() = default;
  /// @param names  Of the coordinates, as Joint::coordinate_names(). @param equal_turns  The two
  /// rotations are a rotation vector without third component.
  FreeMotion(const std::vector<std::string>& names, bool equal_turns);

  [[nodiscard]] int size() const { return static_cast<int>(slides_.size() + turns_.size()); }
  /// Whether a coordinate is a rotation whose turns are counted.
  [[nodiscard]] bool counts_turns(int k) const;
  [[nodiscard]] RelativePose pose(const double* q) const;
  /// Coordinates of a pose; angles between −π and π.
  void read(const RelativePose& pose, double* q) const;
  /// Whether its rates are those of a rotation vector's angular velocity, see spin().
  [[nodiscard]] bool has_spin() const { return turns_.size() == 3; }
  /// Rates of its last three coordinates by the changes of the rotation vector.
  [[nodiscard]] Mat3 spin(const double* q) const;
  /// Motion vectors by coordinate.
  void directions(const PlacedFrames& at, const double* q, MotionVector* s) const;
  /// Their rates of change as the bodies move. @param of_a, of_b  Motions of both bodies.
  void direction_rates(const PlacedFrames& at, const double* q, const double* rates,
                       const MotionVector& of_a, const MotionVector& of_b, MotionVector* s) const;

 private:
  [[nodiscard]] bool is_rotation_vector() const { return equal_turns_ || turns_.size() == 3; }

  std::vector<int> slides_, turns_;  ///< Axes.
  bool equal_turns_ = false;
};

}  // namespace polhode
