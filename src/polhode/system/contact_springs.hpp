// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <polhode/system/pair_terms.hpp>

namespace polhode {

/// Equivalent spring of a contact point: the change of its force as a and b move, by a spring C
/// between the points of both bodies, symmetric positive semidefinite, and by the friction that
/// follows the normal force where the point slides. The rest of the tangent is left out.
struct ContactSpring {
  int a = kGround, b = kGround;
  Vec3 arm_a = Vec3::Zero(), arm_b = Vec3::Zero();  ///< From the centres of mass, world [m].
  Mat3 C = Mat3::Zero();                            ///< World, symmetric [N/m].
  /// Force on a by the displacement of a relative to b along the normal: friction_slope (normal·u)
  /// [N/m].
  Vec3 friction_slope = Vec3::Zero(), normal = Vec3::Zero();
};

/// An active contact point.
struct ActingPoint {
  int point = 0;  ///< Its number, ascending.
  ContactSpring spring;
  Vec3 force = Vec3::Zero();                              ///< On a; on b the opposite [N].
  Vec3 moment_a = Vec3::Zero(), moment_b = Vec3::Zero();  ///< [N m]
};

/// Interface of contacts for iterative solvers: forces by body and springs by point.
class PointwiseContacts {
 public:
  virtual ~PointwiseContacts() = default;
  /// Active points, valid until the next call.
  /// @param moved  By body, the ground last: which bodies have moved since the last call of this
  /// step; empty for all. Forces between others are those of that call.
  virtual std::span<const ActingPoint> evaluate_pointwise(std::span<const BodyStep> steps,
                                                          const StepContext& context,
                                                          std::span<const char> moved) = 0;
  /// Motion of a body in a step without contact forces, and its response to them.
  struct FreeMotion {
    Vec6 increment = Vec6::Zero();
    bool has_loads = false;  ///< Its response is not that of its inertia alone.
    Mat6 response;           ///< With loads: increment by a wrench.
  };
  /// Exact constraint rows of an interaction: g + G_a Δx_a + G_b Δx_b, with the changes of both
  /// increments; further rows are zero.
  struct FreeRows {
    int a = kGround, b = kGround;
    std::vector<int> numbers;  ///< Of the multipliers.
    Eigen::Matrix<double, kMaxRows, 6> G_a = Mat6::Zero(), G_b = Mat6::Zero();
    Vec6 g = Vec6::Zero();
    Vec6 change = Vec6::Zero();  ///< Of the multipliers, a result.
  };
  /// Predicts the increments that contacts and rows leave the bodies.
  /// @param steps  Without any motion yet. @param free  By body.
  /// @param increments  By body. In: about which rows are linear.
  virtual void predict(std::span<const BodyStep> steps, const StepContext& context,
                       std::span<const FreeMotion> free, std::span<FreeRows> rows,
                       std::vector<Vec6>& increments) const = 0;
};

}  // namespace polhode
