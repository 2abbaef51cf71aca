// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/engines/projected_gauss_seidel.hpp>

namespace polhode {

/// The sweeps of ProjectedGaussSeidel with less arithmetic for central points, those between bodies
/// with isotropic inertia whose lever arms are along the normal, as of balls: a third of the
/// operations. All other points are swept as there, in the same order.
class CompactGaussSeidel {
 public:
  /// @param from  Must outlive the sweeps; its points that are not central are prepared here.
  /// @returns false if it has no central points, or rolling or torsional friction.
  [[nodiscard]] bool take(ProjectedGaussSeidel& from);
  /// @returns the largest change of a point's speed, squared [m²/s²].
  double sweep(bool backwards);
  /// Returns impulses and velocities to the solver that take() got.
  void give_back();

 private:
  struct Body {
    double v[3], inverse_mass;
    double w[3], inverse_inertia;
  };
  struct Point {
    int a, b;
    double n[3];
    double radius_a, radius_b;  ///< Arms are −radius_a n and radius_b n.
    double least, wanted[3];
    double normal_impulse, friction_impulse[3];
    double free_normal, free_friction, friction;
    bool central;
  };

  double sweep_central(Point& p);
  double sweep_general(Point& p, ProjectedGaussSeidel::Point& full);

  ProjectedGaussSeidel* from_ = nullptr;
  std::vector<Body> bodies_;
  std::vector<Point> points_;
  std::vector<char> round_;  ///< By body: whether its inertia is isotropic.
  bool all_central_ = true;
};

}  // namespace polhode
