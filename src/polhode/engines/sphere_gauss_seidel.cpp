// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/engines/sphere_gauss_seidel.hpp>

namespace polhode {

namespace {

/// Relative difference below which inertias and lever arms are those of balls.
constexpr double kSweepsRoundOff = 1e-12;
/// Number of copies of fixed bodies, so that points do not wait for each other.
constexpr int kGrounds = 16;

bool is_round(const Mat3& m) {
  return (m - m(0, 0) * Mat3::Identity()).lpNorm<Eigen::Infinity>() <= kSweepsRoundOff * m(0, 0);
}

}  // namespace

bool SphereGaussSeidel::suit(const ProjectedGaussSeidel& from) {
  if (!from.turns.empty()) return false;
  for (const ProjectedGaussSeidel::Body& b : from.bodies)
    if (!is_round(b.inverse_inertia)) return false;
  for (const ProjectedGaussSeidel::Point& p : from.points)
    for (const Vec3& arm : {p.arm_a, p.arm_b})
      if (arm.cross(p.normal).squaredNorm() > kSweepsRoundOff * kSweepsRoundOff * arm.squaredNorm())
        return false;
  return true;
}

void SphereGaussSeidel::take(const ProjectedGaussSeidel& from) {
  const std::size_t n = from.bodies.size();
  bodies_.assign(n + kGrounds, {});
  for (std::size_t b = 0; b < n; ++b) {
    const ProjectedGaussSeidel::Body& body = from.bodies[b];
    for (int i = 0; i < 3; ++i) {
      bodies_[b].v[i] = body.v[i];
      bodies_[b].w[i] = body.w[i];
    }
    bodies_[b].inverse_mass = body.inverse_mass;
    bodies_[b].inverse_inertia = body.inverse_inertia(0, 0);
  }
  points_.resize(from.points.size());
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const ProjectedGaussSeidel::Point& p = from.points[k];
    Point& q = points_[k];
    const auto own = [&](int body) {
      return from.bodies[body].inverse_mass > 0.0 ? body : static_cast<int>(n + k % kGrounds);
    };
    q.a = own(p.a);
    q.b = own(p.b);
    for (int i = 0; i < 3; ++i) {
      q.n[i] = p.normal[i];
      q.wanted[i] = p.wanted[i];
      q.friction_impulse[i] = p.friction_impulse[i];
    }
    q.radius_a = -p.normal.dot(p.arm_a);
    q.radius_b = p.normal.dot(p.arm_b);
    q.least = p.least;
    q.normal_impulse = p.normal_impulse;
    const Body &a = bodies_[q.a], &b = bodies_[q.b];
    const double mass = a.inverse_mass + b.inverse_mass;
    q.free_normal = 1.0 / mass;
    q.free_friction = 1.0 / (mass + a.inverse_inertia * q.radius_a * q.radius_a +
                             b.inverse_inertia * q.radius_b * q.radius_b);
    q.friction = p.friction;
  }
}

/// @eq{nonsmooth-projection}
double SphereGaussSeidel::sweep(bool backwards) {
  double most = 0.0;
  const std::ptrdiff_t way = backwards ? -1 : 1;
  Point* next = backwards ? points_.data() + points_.size() - 1 : points_.data();
  for (std::size_t k = 0; k < points_.size(); ++k, next += way) {
    Point& p = *next;
    Body &a = bodies_[p.a], &b = bodies_[p.b];
    const double n0 = p.n[0], n1 = p.n[1], n2 = p.n[2];
    // y = v_a − v_b + n × (ρ_a ω_a + ρ_b ω_b)
    const double s0 = p.radius_a * a.w[0] + p.radius_b * b.w[0];
    const double s1 = p.radius_a * a.w[1] + p.radius_b * b.w[1];
    const double s2 = p.radius_a * a.w[2] + p.radius_b * b.w[2];
    const double v0 = a.v[0] - b.v[0], v1 = a.v[1] - b.v[1], v2 = a.v[2] - b.v[2];
    const double y_n = n0 * v0 + n1 * v1 + n2 * v2;
    const double normal_impulse = std::max(0.0, p.normal_impulse - (y_n - p.least) * p.free_normal);
    const double more = normal_impulse - p.normal_impulse;
    if (normal_impulse == 0.0 && more == 0.0) continue;
    double r0 = p.friction_impulse[0] -
                p.free_friction * (v0 - y_n * n0 + (n1 * s2 - n2 * s1) - p.wanted[0]);
    double r1 = p.friction_impulse[1] -
                p.free_friction * (v1 - y_n * n1 + (n2 * s0 - n0 * s2) - p.wanted[1]);
    double r2 = p.friction_impulse[2] -
                p.free_friction * (v2 - y_n * n2 + (n0 * s1 - n1 * s0) - p.wanted[2]);
    const double limit = p.friction * normal_impulse, square = r0 * r0 + r1 * r1 + r2 * r2;
    if (square > limit * limit) {
      const double part = limit / std::sqrt(square);
      r0 *= part, r1 *= part, r2 *= part;
    }
    const double t0 = r0 - p.friction_impulse[0], t1 = r1 - p.friction_impulse[1],
                 t2 = r2 - p.friction_impulse[2];
    p.normal_impulse = normal_impulse;
    p.friction_impulse[0] = r0, p.friction_impulse[1] = r1, p.friction_impulse[2] = r2;
    const double c0 = more * n0 + t0, c1 = more * n1 + t1, c2 = more * n2 + t2;
    a.v[0] += a.inverse_mass * c0, a.v[1] += a.inverse_mass * c1, a.v[2] += a.inverse_mass * c2;
    b.v[0] -= b.inverse_mass * c0, b.v[1] -= b.inverse_mass * c1, b.v[2] -= b.inverse_mass * c2;
    const double m0 = n1 * t2 - n2 * t1, m1 = n2 * t0 - n0 * t2, m2 = n0 * t1 - n1 * t0;
    const double of_a = a.inverse_inertia * p.radius_a, of_b = b.inverse_inertia * p.radius_b;
    a.w[0] -= of_a * m0, a.w[1] -= of_a * m1, a.w[2] -= of_a * m2;
    b.w[0] -= of_b * m0, b.w[1] -= of_b * m1, b.w[2] -= of_b * m2;
    const double by_normal = more / p.free_normal, by_friction = 1.0 / p.free_friction;
    most = std::max(
        {most, by_normal * by_normal, (t0 * t0 + t1 * t1 + t2 * t2) * by_friction * by_friction});
  }
  return most;
}

void SphereGaussSeidel::give_back(ProjectedGaussSeidel& to) const {
  for (std::size_t k = 0; k < points_.size(); ++k) {
    ProjectedGaussSeidel::Point& p = to.points[k];
    const Point& q = points_[k];
    p.normal_impulse = q.normal_impulse;
    p.friction_impulse = Vec3(q.friction_impulse[0], q.friction_impulse[1], q.friction_impulse[2]);
  }
  for (std::size_t b = 0; b < to.bodies.size(); ++b) {
    if (to.bodies[b].inverse_mass == 0.0) continue;
    to.bodies[b].v = Vec3(bodies_[b].v[0], bodies_[b].v[1], bodies_[b].v[2]);
    to.bodies[b].w = Vec3(bodies_[b].w[0], bodies_[b].w[1], bodies_[b].w[2]);
  }
}

}  // namespace polhode
