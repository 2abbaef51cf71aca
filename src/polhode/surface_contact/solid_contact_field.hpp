// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/surface_contact/plane_friction.hpp>
#include <polhode/surface_contact/solid_contact.hpp>

namespace polhode::surface_contact {

/// Positions, or displacements, of nodes and of the vertices of a surface.
struct SolidContact::Field {
  const double* nodes;
  std::vector<Vec3> vertices;

  Field(const MeshSurface& surface, const double* x) : nodes(x) {
    vertices.reserve(surface.vertices.size());
    for (const MeshPoint& v : surface.vertices) vertices.push_back(v.at(x));
  }
};

/// Calls use(gap, at) with the PatchGap, or of a cable the CentralGapOf, of a point over a step and
/// the MeshPoint of each block of its results.
template <class Use>
void SolidContact::with_gap(const NodeStep& step, const Field& x_n1, const Field& u, int point,
                            const Action& a, Use&& use) const {
  if (!of_cable()) {
    const PatchVector from = vector_to(point, a.foot_n), to = vector_to(point, a.foot_n1);
    const PatchGap gap(step, from, to, a.foot_n.distance, a.foot_n1.distance);
    use(gap, [&](int k) -> const MeshPoint& { return gap.at(k); });
    return;
  }
  const auto of = [&](int triangle) { return moves(x_n1, u, point, triangle); };
  if (a.at_n.single() && a.at_n1.single()) {
    const MeshGap::Part &from = a.at_n.parts.front(), &to = a.at_n1.parts.front();
    const bool other = from.triangle != to.triangle;
    const FourMoves at_from = of(from.triangle), at_to = other ? of(to.triangle) : at_from;
    const CentralGap gap(at_from, from.four, other ? &at_to : nullptr, to.four, step.alpha_f,
                         step.context.conserving);
    use(gap, [&](int k) -> const MeshPoint& {
      return corner(point, k < 4 ? from.triangle : to.triangle, k % 4);
    });
    return;
  }
  const MeshGapStep over(a.at_n, a.at_n1, of);
  const CentralGapOf<kMaxTriangles> gap(over.over, step.alpha_f, step.context.conserving);
  use(gap, [&](int k) -> const MeshPoint& {
    return corner(point, over.triangles[static_cast<std::size_t>(k / 4)], k % 4);
  });
}

/// Friction of a point over a step.
struct SolidContact::Slide : FourSlide {
  int triangle = -1;  ///< Nearest at t_n.
};

}  // namespace polhode::surface_contact
