// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/fe/contact/solid_contact.hpp>

namespace polhode {

/// Positions, or moves, of nodes and of the vertices of a surface.
struct SolidContact::Field {
  const double* nodes;
  std::vector<Vec3> vertices;

  Field(const MeshSurface& surface, const double* x) : nodes(x) {
    vertices.reserve(surface.vertices.size());
    for (const MeshPoint& v : surface.vertices) vertices.push_back(v.at(x));
  }
};

/// Friction of a point over a step.
struct SolidContact::Slide {
  int triangle = -1;               ///< Nearest in the middle of the step.
  Vec3 friction = Vec3::Zero();    ///< On the point, per area.
  Vec3 slid = Vec3::Zero();        ///< Tangential displacement.
  Vec3 bristle = Vec3::Zero();     ///< In the middle of the step.
  Vec3 bristle_n1 = Vec3::Zero();  ///< In the axes of its end.
  bool slips = false;
  Eigen::Matrix<double, 12, 1> force = Eigen::Matrix<double, 12, 1>::Zero();  ///< On the four.
  Eigen::Matrix<double, 12, 12> K = Eigen::Matrix<double, 12, 12>::Zero();
  Eigen::Matrix<double, 12, 1> by_pressure = Eigen::Matrix<double, 12, 1>::Zero();
};

}  // namespace polhode
