// SPDX-License-Identifier: Apache-2.0
// Friction of a point on a triangle of another mesh.
#include <limits>

#include <polhode/contact/bristle.hpp>
#include <polhode/fe/contact/solid_contact.hpp>
#include <polhode/fe/contact/solid_contact_field.hpp>

namespace polhode {

namespace {

using contact::Dual;
using contact::V3;

/// Distances that differ by less are alike: the first triangle counts.
constexpr double kAlike = 1e-9;

/// A triangle: edges from its first corner and the gradients of the weights of the other two.
template <class T>
struct Sides {
  V3<T> e, f, grad_e, grad_f;
  Sides(const V3<T>& a, const V3<T>& b, const V3<T>& c) : e(b - a), f(c - a) {
    const T ee = dot(e, e), ef = dot(e, f), ff = dot(f, f);
    const T scale = 1.0 / (ee * ff - ef * ef);
    grad_e = scale * (ff * e - ef * f);
    grad_f = scale * (ee * f - ef * e);
  }
  /// A vector given by its parts along the edges, as long as `length`.
  [[nodiscard]] V3<T> along(double on_e, double on_f, double length) const {
    const V3<T> s = on_e * e + on_f * f;
    const T square = dot(s, s);
    if (!(contact::value(square) > 0.0)) return 0.0 * s;
    return (length / sqrt(square)) * s;
  }
};

template <class T>
V3<T> number(const Vec3& x, int first) {
  V3<T> v = contact::constant<T>(x);
  if constexpr (std::is_same_v<T, Dual>)
    if (first >= 0) v.x.d[first] = v.y.d[first + 1] = v.z.d[first + 2] = 1.0;
  return v;
}

/// What acts on the point and on the corners of the triangle.
template <class T>
struct Friction {
  V3<T> force[4], slid, bristle, friction;
  bool slips = false;
  double parts[2]{};  ///< Of the bristle along the edges.
};

/// @param seeded  Derivatives by x_{n+1}; else by the pressure, the first of them.
/// @eq{mesh-friction}
template <class T>
Friction<T> friction(const FourMoves& moves, double alpha, const SurfaceLaw& law, const T& pressure,
                     const Vec3& kept, bool seeded) {
  V3<T> x[4], u[4];
  Vec3 x_n[4];
  for (int k = 0; k < 4; ++k) {
    const int first = seeded ? 3 * k : -1;
    u[k] = number<T>(moves.u[k], first);
    x[k] = number<T>(Vec3(moves.x_n1[k] - (1.0 - alpha) * moves.u[k]), -1);
    if (seeded) x[k] = x[k] + alpha * (u[k] - contact::v3(moves.u[k]));
    x_n[k] = moves.x_n1[k] - moves.u[k];
  }
  const Sides<T> here(x[1], x[2], x[3]);
  const V3<T> n = unit(cross(here.e, here.f)), p = x[0] - x[1];
  const T d = dot(n, p), w_e = dot(here.grad_e, p), w_f = dot(here.grad_f, p);
  const T w[3] = {1.0 - w_e - w_f, w_e, w_f};
  const V3<T> gradient[3] = {-(here.grad_e + here.grad_f), here.grad_e, here.grad_f};

  Friction<T> r;
  V3<T> way = u[0];
  for (int k = 0; k < 3; ++k) way = way - w[k] * u[k + 1] + (d * dot(n, u[k + 1])) * gradient[k];
  r.slid = way - dot(n, way) * n;
  const Sides<double> before(contact::v3(x_n[1]), contact::v3(x_n[2]), contact::v3(x_n[3]));
  const V3<double> s = contact::v3(kept);
  contact::Cone<T> cone;
  cone.radius = (law.mu / law.bristle) * pressure;
  const V3<T> start =
      cone.nearest(here.along(dot(before.grad_e, s), dot(before.grad_f, s), kept.norm()));
  r.slips = cone.outside(contact::value(start + r.slid));
  r.bristle = cone.nearest(start + r.slid);
  r.friction = -law.bristle * cone.nearest(start + alpha * r.slid);
  r.force[0] = r.friction;
  for (int k = 0; k < 3; ++k)
    r.force[k + 1] = (d * dot(r.friction, gradient[k])) * n - w[k] * r.friction;
  r.parts[0] = contact::value(dot(here.grad_e, r.bristle));
  r.parts[1] = contact::value(dot(here.grad_f, r.bristle));
  return r;
}

}  // namespace

SolidContact::Slide SolidContact::slide(const NodeStep& step, const Field& x_n1, const Field& u,
                                        std::span<const int> triangles, int point, double pressure,
                                        const double* memory, bool tangent) const {
  Slide slide;
  FourMoves moves;
  double least = std::numeric_limits<double>::infinity();
  for (const int t : triangles) {
    const FourMoves m = this->moves(x_n1, u, point, t);
    Vec3 x[4];
    m.at(step.alpha_f, x);
    const double distance = nearest_of_triangle(x).distance;
    if (distance >= (1.0 - kAlike) * least) continue;
    least = distance;
    slide.triangle = t;
    moves = m;
  }
  const Vec3 kept(memory[0], memory[1], memory[2]);
  const auto values = friction<double>(moves, step.alpha_f, law_, pressure, kept, false);
  slide.friction = contact::value(values.friction);
  slide.slid = contact::value(values.slid);
  slide.bristle = contact::value(values.bristle);
  slide.slips = values.slips;
  const auto& x = moves.x_n1;
  const Sides<double> end(contact::v3(x[1]), contact::v3(x[2]), contact::v3(x[3]));
  slide.bristle_n1 =
      contact::value(end.along(values.parts[0], values.parts[1], slide.bristle.norm()));
  for (int k = 0; k < 4; ++k) slide.force.segment<3>(3 * k) = contact::value(values.force[k]);
  if (!tangent) return slide;
  const auto by_x = friction<Dual>(moves, step.alpha_f, law_, Dual(pressure), kept, true);
  Dual seeded(pressure);
  seeded.d[0] = 1.0;
  const auto by_p = friction<Dual>(moves, step.alpha_f, law_, seeded, kept, false);
  for (int k = 0; k < 4; ++k) {
    const V3<Dual>& f = by_x.force[k];
    for (int j = 0; j < 12; ++j) {
      slide.K(3 * k, j) = f.x.d[j];
      slide.K(3 * k + 1, j) = f.y.d[j];
      slide.K(3 * k + 2, j) = f.z.d[j];
    }
    const V3<Dual>& g = by_p.force[k];
    slide.by_pressure.segment<3>(3 * k) = Vec3(g.x.d[0], g.y.d[0], g.z.d[0]);
  }
  return slide;
}

}  // namespace polhode
