// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/engines/impulse_sweeps.hpp>
#include <polhode/math/hat.hpp>

namespace polhode {

void ImpulseSweeps::push(const Point& p, const Vec3& impulse) {
  Body &a = bodies[p.a], &b = bodies[p.b];
  a.v += a.inverse_mass * impulse;
  b.v -= b.inverse_mass * impulse;
  a.w += a.inverse_inertia * p.arm_a.cross(impulse);
  b.w -= b.inverse_inertia * p.arm_b.cross(impulse);
}

void ImpulseSweeps::turn(const Point& p, const Vec3& impulse) {
  Body &a = bodies[p.a], &b = bodies[p.b];
  a.w += a.inverse_inertia * impulse;
  b.w -= b.inverse_inertia * impulse;
}

void ImpulseSweeps::prepare() {
  for (Point& p : points) {
    const Body &a = bodies[p.a], &b = bodies[p.b];
    const Mat3 r_a = hat(p.arm_a), r_b = hat(p.arm_b);
    Mat3 D = -r_a * a.inverse_inertia * r_a - r_b * b.inverse_inertia * r_b;
    D.diagonal().array() += a.inverse_mass + b.inverse_mass;
    const Vec3 Dn = D * p.normal;
    p.per_push = p.normal.dot(Dn);
    p.across = Dn - p.per_push * p.normal;
    // Of the 2 × 2 block in the tangent plane: half the trace and the radius of Mohr's circle.
    const Vec3 t = p.normal.unitOrthogonal(), s = p.normal.cross(t);
    const double tt = t.dot(D * t), ss = s.dot(D * s), ts = t.dot(D * s);
    p.per_rub = 0.5 * (tt + ss) + std::hypot(0.5 * (tt - ss), ts);
    p.free_push = 1.0 / p.per_push;
    p.free_rub = 1.0 / p.per_rub;
  }
  for (Turn& t : turns) {
    const Point& p = points[t.point];
    const Mat3 D = bodies[p.a].inverse_inertia + bodies[p.b].inverse_inertia;
    t.per_impulse = D.lpNorm<1>();  // not below the largest eigenvalue
    t.length = std::sqrt(p.per_push / t.per_impulse);
  }
}

/// @eq{nonsmooth-projection}
double ImpulseSweeps::sweep(bool backwards) {
  double most = 0.0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    Point& p = points[backwards ? points.size() - 1 - k : k];
    Body &a = bodies[p.a], &b = bodies[p.b];
    const Vec3 y = a.v + a.w.cross(p.arm_a) - b.v - b.w.cross(p.arm_b);
    const double y_n = p.normal.dot(y);
    const double push = std::max(0.0, p.push - (y_n - p.least) * p.free_push);
    const double more = push - p.push;
    if (push == 0.0 && more == 0.0) continue;
    const Vec3 slip = y - y_n * p.normal + more * p.across - p.wanted;
    Vec3 rub = p.rub - p.free_rub * slip;
    const double limit = p.friction * push, square = rub.squaredNorm();
    if (square > limit * limit) rub *= limit / std::sqrt(square);
    const Vec3 turned = rub - p.rub;
    p.push = push;
    p.rub = rub;
    this->push(p, more * p.normal + turned);
    const double by_push = more * p.per_push;
    most = std::max({most, by_push * by_push, turned.squaredNorm() * p.per_rub * p.per_rub});
  }
  return turns.empty() ? most : std::max(most, sweep_turns());
}

double ImpulseSweeps::sweep_turns() {
  double most = 0.0;
  for (Turn& t : turns) {
    const Point& p = points[t.point];
    Body &a = bodies[p.a], &b = bodies[p.b];
    const Vec3 wanted = t.impulse - (a.w - b.w - t.wanted) / t.per_impulse;
    const double drill = p.normal.dot(wanted), torsion = t.torsion * p.push;
    Vec3 roll = wanted - drill * p.normal;
    const double rolling = t.rolling * p.push, length = roll.norm();
    if (length > rolling) roll *= rolling / length;
    const Vec3 impulse = roll + std::clamp(drill, -torsion, torsion) * p.normal;
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
