// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/fe/contact/plane_friction.hpp>
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
struct SolidContact::Slide : FourSlide {
  int triangle = -1;  ///< Nearest in the middle of the step.
};

}  // namespace polhode
