// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/engines/projected_gauss_seidel.hpp>

namespace polhode {

/// The sweeps of ProjectedGaussSeidel for bodies with isotropic inertia and points whose lever arms
/// are along the normal, as of balls: a third of the arithmetic, half the memory.
class SphereGaussSeidel {
 public:
  [[nodiscard]] static bool suit(const ProjectedGaussSeidel& from);
  void take(const ProjectedGaussSeidel& from);
  /// @returns the largest change of a point's speed, squared [m²/s²].
  double sweep(bool backwards);
  void give_back(ProjectedGaussSeidel& to) const;

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
  };

  std::vector<Body> bodies_;
  std::vector<Point> points_;
};

}  // namespace polhode
