// SPDX-License-Identifier: Apache-2.0
// Friction of a point on a triangle of another mesh.
#include <limits>

#include <polhode/surface_contact/plane_friction.hpp>
#include <polhode/surface_contact/round_friction.hpp>
#include <polhode/surface_contact/solid_contact.hpp>
#include <polhode/surface_contact/solid_contact_field.hpp>

namespace polhode::surface_contact {

namespace {

using contact::V3;

/// Relative difference below which distances are equal: the first triangle counts.
constexpr double kAlike = 1e-9;

/// Forces on the point and on the corners of the triangle.
template <class T>
struct PointOnTriangle {
  V3<T> force[4], slid;
  PlaneSliding<T> sliding;
};

template <class T>
SlidePlane<T> slide_plane(const V3<T>& a, const V3<T>& b, const V3<T>& c) {
  return {b - a, c - a};
}

/// @param seeded  Derivatives by x_{n+1}; else by the pressure. @eq{mesh-friction}
template <class T>
PointOnTriangle<T> triangle_friction(const FourMoves& moves, double alpha, const SurfaceLaw& law,
                                     const T& pressure, const Vec3& kept, bool seeded) {
  const FourPoints<T> at(moves, alpha, seeded);
  const SlidePlane<T> here = slide_plane(at.x[1], at.x[2], at.x[3]);
  const V3<T> n = unit(cross(here.e, here.f)), p = at.x[0] - at.x[1];
  const T d = dot(n, p), w_e = dot(here.grad_e, p), w_f = dot(here.grad_f, p);
  const T w[3] = {1.0 - w_e - w_f, w_e, w_f};
  const V3<T> gradient[3] = {-(here.grad_e + here.grad_f), here.grad_e, here.grad_f};
  V3<T> way = at.u[0];
  for (int k = 0; k < 3; ++k)
    way = way - w[k] * at.u[k + 1] + (d * dot(n, at.u[k + 1])) * gradient[k];
  const V3<T> slid = way - dot(n, way) * n;
  const SlidePlane<double> before =
      slide_plane(contact::v3(at.x_n[1]), contact::v3(at.x_n[2]), contact::v3(at.x_n[3]));
  PointOnTriangle<T> r{{}, slid, {here, before, law, pressure, kept, slid, alpha}};
  const V3<T>& f = r.sliding.friction;
  r.force[0] = f;
  for (int k = 0; k < 3; ++k) r.force[k + 1] = (d * dot(f, gradient[k])) * n - w[k] * f;
  return r;
}

}  // namespace

SolidContact::Slide SolidContact::slide(const NodeStep& step, const Field& x_n1, const Field& u,
                                        std::span<const int> triangles, int point, double pressure,
                                        const PointMemory& memory, bool tangent) const {
  // The triangle at t_n is used: a change of the nearest triangle within the step would make the
  // friction plane jump, and with it a force that depends on the iterate.
  Slide slide;
  FourMoves moves;
  double least = std::numeric_limits<double>::infinity();
  for (const int t : triangles) {
    const FourMoves m = this->moves(x_n1, u, point, t);
    Vec3 x[4];
    m.at(0.0, x);
    const double distance = nearest_of_triangle(x).distance;
    if (distance >= (1.0 - kAlike) * least) continue;
    least = distance;
    slide.triangle = t;
    moves = m;
  }
  const Vec3 kept(memory.bristle);
  if (of_cable()) {
    static_cast<FourSlide&>(slide) =
        round_friction(moves, step.alpha_f, law_, pressure, kept, tangent);
    return slide;
  }
  const auto sliding = [&](const auto& p, bool seeded) {
    return triangle_friction(moves, step.alpha_f, law_, p, kept, seeded);
  };
  const auto& x = moves.x_n1;
  const SlidePlane<double> end =
      slide_plane(contact::v3(x[1]), contact::v3(x[2]), contact::v3(x[3]));
  static_cast<FourSlide&>(slide) = FourSlide(sliding, end, pressure, tangent);
  return slide;
}

}  // namespace polhode::surface_contact
