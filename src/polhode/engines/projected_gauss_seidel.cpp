// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/engines/projected_gauss_seidel.hpp>
#include <polhode/math/hat.hpp>

namespace polhode {

void ProjectedGaussSeidel::apply(const Point& p, const Vec3& impulse) {
  Body &a = bodies[p.a], &b = bodies[p.b];
  a.v += a.inverse_mass * impulse;
  b.v -= b.inverse_mass * impulse;
  a.w += a.inverse_inertia * p.arm_a.cross(impulse);
  b.w -= b.inverse_inertia * p.arm_b.cross(impulse);
}

void ProjectedGaussSeidel::turn(const Point& p, const Vec3& impulse) {
  Body &a = bodies[p.a], &b = bodies[p.b];
  a.w += a.inverse_inertia * impulse;
  b.w -= b.inverse_inertia * impulse;
}

void ProjectedGaussSeidel::prepare(Point& p) {
  const Body &a = bodies[p.a], &b = bodies[p.b];
  const Mat3 r_a = hat(p.arm_a), r_b = hat(p.arm_b);
  Mat3 D = -r_a * a.inverse_inertia * r_a - r_b * b.inverse_inertia * r_b;
  D.diagonal().array() += a.inverse_mass + b.inverse_mass;
  const Vec3 Dn = D * p.normal;
  p.per_normal = p.normal.dot(Dn);
  p.across = Dn - p.per_normal * p.normal;
  // Half the trace and the radius of Mohr's circle of the 2 × 2 block in the tangent plane.
  const Vec3 t = p.normal.unitOrthogonal(), s = p.normal.cross(t);
  const double tt = t.dot(D * t), ss = s.dot(D * s), ts = t.dot(D * s);
  p.per_friction = 0.5 * (tt + ss) + std::hypot(0.5 * (tt - ss), ts);
  p.free_normal = 1.0 / p.per_normal;
  p.free_friction = 1.0 / p.per_friction;
}

void ProjectedGaussSeidel::prepare() {
  for (Point& p : points) prepare(p);
  for (Turn& t : turns) {
    const Point& p = points[t.point];
    const Mat3 D = bodies[p.a].inverse_inertia + bodies[p.b].inverse_inertia;
    t.per_impulse = D.lpNorm<1>();  // an upper bound of the largest eigenvalue
    t.length = std::sqrt(p.per_normal / t.per_impulse);
  }
}

ProjectedGaussSeidel::Change ProjectedGaussSeidel::Point::projected(const Vec3& y) {
  const double y_n = normal.dot(y);
  const double next = std::max(0.0, normal_impulse - (y_n - least) * free_normal);
  const double more = next - normal_impulse;
  if (next == 0.0 && more == 0.0) return {};
  const Vec3 slip = y - y_n * normal + more * across - wanted;
  Vec3 friction_next = friction_impulse - free_friction * slip;
  const double limit = friction * next, square = friction_next.squaredNorm();
  if (square > limit * limit) friction_next *= limit / std::sqrt(square);
  const Vec3 turned = friction_next - friction_impulse;
  normal_impulse = next;
  friction_impulse = friction_next;
  const double by_normal = more * per_normal;
  return {more * normal + turned,
          std::max(by_normal * by_normal, turned.squaredNorm() * per_friction * per_friction),
          false};
}

/// @eq{nonsmooth-projection}
double ProjectedGaussSeidel::sweep(bool backwards) {
  double most = 0.0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    Point& p = points[backwards ? points.size() - 1 - k : k];
    const Body &a = bodies[p.a], &b = bodies[p.b];
    const Change change = p.projected(a.v + a.w.cross(p.arm_a) - b.v - b.w.cross(p.arm_b));
    if (change.nothing) continue;
    this->apply(p, change.impulse);
    most = std::max(most, change.speed_squared);
  }
  return turns.empty() ? most : std::max(most, sweep_turns());
}

double ProjectedGaussSeidel::sweep_turns() {
  double most = 0.0;
  for (Turn& t : turns) {
    const Point& p = points[t.point];
    Body &a = bodies[p.a], &b = bodies[p.b];
    const Vec3 wanted = t.impulse - (a.w - b.w - t.wanted) / t.per_impulse;
    const double spin = p.normal.dot(wanted), torsion = t.torsion * p.normal_impulse;
    Vec3 roll = wanted - spin * p.normal;
    const double rolling = t.rolling * p.normal_impulse, length = roll.norm();
    if (length > rolling) roll *= rolling / length;
    const Vec3 impulse = roll + std::clamp(spin, -torsion, torsion) * p.normal;
    const Vec3 change = impulse - t.impulse;
    t.impulse = impulse;
    a.w += a.inverse_inertia * change;
    b.w -= b.inverse_inertia * change;
    const double speed = t.length * t.per_impulse;
    most = std::max(most, change.squaredNorm() * speed * speed);
  }
  return most;
}

}  // namespace polhode
