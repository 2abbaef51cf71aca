// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/engines/compact_gauss_seidel.hpp>

namespace polhode {

namespace {

/// Relative difference below which inertias and lever arms are those of balls.
constexpr double kSweepsRoundOff = 1e-12;
/// Number of copies of fixed bodies, so that points do not wait for each other.
constexpr int kGrounds = 16;

bool is_round(const Mat3& m) {
  return (m - m(0, 0) * Mat3::Identity()).lpNorm<Eigen::Infinity>() <= kSweepsRoundOff * m(0, 0);
}

bool is_central(const std::vector<char>& round, const ProjectedGaussSeidel::Point& p) {
  if (!round[p.a] || !round[p.b]) return false;
  for (const Vec3& arm : {p.arm_a, p.arm_b})
    if (arm.cross(p.normal).squaredNorm() > kSweepsRoundOff * kSweepsRoundOff * arm.squaredNorm())
      return false;
  return true;
}

}  // namespace

bool CompactGaussSeidel::take(ProjectedGaussSeidel& from) {
  if (!from.turns.empty()) return false;
  round_.clear();
  for (const ProjectedGaussSeidel::Body& b : from.bodies)
    round_.push_back(is_round(b.inverse_inertia));
  points_.resize(from.points.size());
  bool any = false;
  all_central_ = true;
  for (std::size_t k = 0; k < points_.size(); ++k) {
    points_[k].central = is_central(round_, from.points[k]);
    any = any || points_[k].central;
    all_central_ = all_central_ && points_[k].central;
  }
  if (!any) return false;
  from_ = &from;
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
  for (std::size_t k = 0; k < points_.size(); ++k) {
    ProjectedGaussSeidel::Point& p = from.points[k];
    Point& q = points_[k];
    const auto own = [&](int body) {
      return from.bodies[body].inverse_mass > 0.0 ? body : static_cast<int>(n + k % kGrounds);
    };
    q.a = own(p.a);
    q.b = own(p.b);
    if (!q.central) {
      from.prepare(p);
      continue;
    }
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
  return true;
}

/// @eq{nonsmooth-projection}
double CompactGaussSeidel::sweep(bool backwards) {
  double most = 0.0;
  const std::size_t n = points_.size();
  if (all_central_) {
    for (std::size_t k = 0; k < n; ++k)
      most = std::max(most, sweep_central(points_[backwards ? n - 1 - k : k]));
    return most;
  }
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t at = backwards ? n - 1 - k : k;
    Point& p = points_[at];
    most = std::max(most, p.central ? sweep_central(p) : sweep_general(p, from_->points[at]));
  }
  return most;
}

/// Largest change of a speed at a central point, squared.
inline double CompactGaussSeidel::sweep_central(Point& p) {
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
  if (normal_impulse == 0.0 && more == 0.0) return 0.0;
  double r0 =
      p.friction_impulse[0] - p.free_friction * (v0 - y_n * n0 + (n1 * s2 - n2 * s1) - p.wanted[0]);
  double r1 =
      p.friction_impulse[1] - p.free_friction * (v1 - y_n * n1 + (n2 * s0 - n0 * s2) - p.wanted[1]);
  double r2 =
      p.friction_impulse[2] - p.free_friction * (v2 - y_n * n2 + (n0 * s1 - n1 * s0) - p.wanted[2]);
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
  return std::max(by_normal * by_normal, (t0 * t0 + t1 * t1 + t2 * t2) * by_friction * by_friction);
}

/// Largest change of a speed at a point that is not central, squared. @param full  Its constants.
double CompactGaussSeidel::sweep_general(Point& p, ProjectedGaussSeidel::Point& full) {
  Body &a = bodies_[p.a], &b = bodies_[p.b];
  const ProjectedGaussSeidel::Body &full_a = from_->bodies[full.a], &full_b = from_->bodies[full.b];
  Eigen::Map<Vec3> v_a(a.v), w_a(a.w), v_b(b.v), w_b(b.w);
  const Vec3 y = v_a + w_a.cross(full.arm_a) - v_b - w_b.cross(full.arm_b);
  const ProjectedGaussSeidel::Change change = full.projected(y);
  if (change.nothing) return 0.0;
  v_a += a.inverse_mass * change.impulse;
  v_b -= b.inverse_mass * change.impulse;
  w_a += full_a.inverse_inertia * full.arm_a.cross(change.impulse);
  w_b -= full_b.inverse_inertia * full.arm_b.cross(change.impulse);
  return change.speed_squared;
}

void CompactGaussSeidel::give_back() {
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const Point& q = points_[k];
    if (!q.central) continue;  // swept in place
    ProjectedGaussSeidel::Point& p = from_->points[k];
    p.normal_impulse = q.normal_impulse;
    p.friction_impulse = Vec3(q.friction_impulse[0], q.friction_impulse[1], q.friction_impulse[2]);
  }
  for (std::size_t b = 0; b < from_->bodies.size(); ++b) {
    ProjectedGaussSeidel::Body& body = from_->bodies[b];
    if (body.inverse_mass == 0.0) continue;
    body.v = Vec3(bodies_[b].v[0], bodies_[b].v[1], bodies_[b].v[2]);
    body.w = Vec3(bodies_[b].w[0], bodies_[b].w[1], bodies_[b].w[2]);
  }
}

}  // namespace polhode
