// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/contact/closed_form_point.hpp>
#include <polhode/contact_laws/bristle.hpp>

namespace polhode::contact {

namespace {

/// A point carried by a body at both ends of the step, and its displacement.
struct Ends {
  Vec3 at_n, at_n1, moved;
};

Ends carried(const BodyStep& s, const Vec3& Z) {
  if (Z.isZero(0.0)) return {s.r_n, s.r_n1, s.u};
  const Vec3 z_n = s.Lambda_n * Z, z_n1 = s.Lambda_n1 * Z;
  return {s.r_n + z_n, s.r_n1 + z_n1, s.u + s.theta.cross(0.5 * (z_n + z_n1))};
}

Ends turned(const BodyStep& s, const Vec3& Z) {
  if (!s.moves) return {Z, Z, Vec3::Zero()};
  const Vec3 z_n = s.Lambda_n * Z, z_n1 = s.Lambda_n1 * Z;
  return {z_n, z_n1, s.theta.cross(0.5 * (z_n + z_n1))};
}

V3<double> in_disc(const V3<double>& s, double radius) {
  return Cone<double>{radius, 1.0, {}, {}}.nearest(s);
}

}  // namespace

bool is_closed_form_point(const PointData& data) {
  const FrictionLaw& f = data.friction;
  return has_closed_form(data) && data.pair.fade == Fade::none && f.rolling == 0.0 &&
         f.torsion == 0.0 && (f.mu_across <= 0.0 || f.mu_across == f.mu);
}

SpherePairCache sphere_pair_cache(const PointData& data, const BodyStep& a, const BodyStep& b) {
  const geometry::Shape &A = *data.a, &B = *data.b;
  SpherePairCache s;
  const bool plane = B.solid == geometry::Solid::half_space;
  s.holds = A.corners[data.pair.i].isZero(0.0) && (plane ? !b.moves : B.centre.isZero(0.0));
  if (!s.holds) return s;
  const double rho = A.rounding + B.rounding;
  if (plane) {
    s.offset = B.axes.col(2);
    s.gap_n = s.offset.dot(a.r_n - B.centre) - rho;
  } else {
    s.offset = a.r_n - b.r_n;
    s.distance = s.offset.norm();
    s.gap_n = s.distance - rho;
  }
  return s;
}

double SpherePairCache::part(const BodyStep& on_a, const BodyStep& on_b, const Vec3& change,
                             double kept) const {
  if (!std::isfinite(least_gap)) return 1.0;
  const Vec3 w = distance == 0.0 ? offset : Vec3(offset + (on_a.u - on_b.u));
  const double along = w.dot(change);
  if (along >= 0.0) return 1.0;
  const double gap = gap_n1(on_a, on_b), clearance = gap - least_gap;
  const double use = clearance - kept * std::min(clearance, reach - least_gap);
  if (distance == 0.0) return std::min(1.0, use / -along);
  // |w + part·change| = |w| − use
  const double length = w.norm(), square = change.squaredNorm(), rest = use * (2.0 * length - use);
  const double root = along * along - square * rest;
  return root > 0.0 ? std::min(1.0, rest / (-along + std::sqrt(root))) : 1.0;
}

double closed_form_gap_n1(const PointData& data, double gap_n, const BodyStep& a,
                          const BodyStep& b) {
  const geometry::Shape &A = *data.a, &B = *data.b;
  const Ends p = carried(a, A.corners[data.pair.i]), q = carried(b, B.centre);
  const Vec3 w_n = p.at_n - q.at_n, w_n1 = p.at_n1 - q.at_n1, moved = p.moved - q.moved;
  if (B.solid == geometry::Solid::ball)
    return gap_n + (w_n + w_n1).dot(moved) / (w_n.norm() + w_n1.norm());
  const Ends normal = turned(b, B.axes.col(2));
  return gap_n + 0.5 * ((normal.at_n + normal.at_n1).dot(moved) + normal.moved.dot(w_n + w_n1));
}

/// @eq{contact-point-plane} @eq{contact-sphere-sphere} @eq{contact-bristle} @eq{contact-spring}
PointForce closed_form_force(const PointData& data, double gap_n, double gap_n1, const BodyStep& a,
                             const BodyStep& b, const StepContext& context, PointReport* report) {
  const geometry::Shape &A = *data.a, &B = *data.b;
  const Ends p = carried(a, A.corners[data.pair.i]), q = carried(b, B.centre);
  const Vec3 point = 0.5 * (p.at_n + p.at_n1);
  const Vec3 r_a = a.r_n + 0.5 * a.u, r_b = b.r_n + 0.5 * b.u;
  Vec3 N, n, c;
  Vec3 spring_normal;
  if (B.solid == geometry::Solid::half_space) {
    const Ends normal = turned(b, B.axes.col(2));
    N = 0.5 * (normal.at_n + normal.at_n1);
    n = N.normalized();
    spring_normal = normal.at_n1;
    const double more = A.rounding - B.rounding;
    c = point - 0.25 * ((normal.at_n.dot(p.at_n - q.at_n) + more) * normal.at_n +
                        (normal.at_n1.dot(p.at_n1 - q.at_n1) + more) * normal.at_n1);
  } else {
    const Vec3 w_0 = p.at_n - q.at_n, w_1 = p.at_n1 - q.at_n1;
    const double l_0 = w_0.norm(), l_1 = w_1.norm();
    N = (w_0 + w_1) / (l_0 + l_1);
    const Vec3 sum = w_0 / l_0 + w_1 / l_1;
    n = sum.normalized();
    spring_normal = w_1 / l_1;
    c = 0.5 * (point + 0.5 * (q.at_n + q.at_n1)) + 0.25 * (B.rounding - A.rounding) * sum;
  }

  const NormalForce normal = normal_force(data, gap_n, gap_n1, context.dt);
  PointForce out;
  out.arm_a = c - r_a;
  out.arm_b = c - r_b;
  out.force = normal.lambda * N;
  out.moment_a = (point - r_a).cross(out.force);
  out.moment_b = -(point - r_b).cross(out.force);
  const double k = std::max(0.0, normal.stiffness);
  const bool of_end = has_spring_of_end(data, k, n, spring_normal, context.dt);
  if (!of_end) spring_normal = n;
  if (report) {
    *report = {};
    report->gap_n = gap_n;
    report->gap_n1 = gap_n1;
    report->normal_force = normal.lambda;
    report->normal = n;
    report->point = c;
    report->after = data.history.without_bristles();
    report->work.stored = data.normal.energy(gap_n1);
    report->work.dissipated = (normal.lambda - normal.elastic) * (gap_n - gap_n1);
    report->normal_loss = report->work.dissipated;
  }

  const FrictionLaw& f = data.friction;
  const double normal_force = data.history.in_impact() ? 0.0 : normal.lambda;
  if (f.mu > 0.0 && normal_force > 0.0) {
    const Vec3 u = a.u + a.theta.cross(out.arm_a) - b.u - b.theta.cross(out.arm_b);
    const Vec3 u_T = u - n.dot(u) * n;
    const double spin = 0.5 * n.dot(a.theta + b.theta);
    const double radius = friction_limit(data, normal_force) / f.stiffness;
    const Vec3 s_0 = value(in_disc(
        transported<double>(data.history.bristle, data.history.normal, v3(n), spin), radius));
    const double factor = 0.5 + f.damping / (f.stiffness * context.dt);
    const Vec3 middle = s_0 + factor * u_T;
    const double square = middle.squaredNorm();
    const bool slides = square > radius * radius;
    const double part = slides ? radius / std::sqrt(square) : 1.0;
    const Vec3 F = -f.stiffness * part * middle;
    out.force += F;
    out.moment_a += out.arm_a.cross(F);
    out.moment_b -= out.arm_b.cross(F);
    const double k_T = f.stiffness * factor * part;
    out.C = k * spring_normal * spring_normal.transpose() - k_T * n * n.transpose();
    out.C.diagonal().array() += k_T;
    if (slides) {
      out.C -= (k_T / square) * middle * middle.transpose();
      out.normal = spring_normal;
      out.slide = middle;
      out.lag = k_T;
      out.friction_slope = (k * friction_slope(data, normal_force) / std::sqrt(square)) * middle;
    }
    if (report) {
      report->friction_force = F;
      const Vec3 after = value(in_disc(v3(s_0 + u_T), radius));
      report->after.bristle = after;
      report->after.slips = (s_0 + u_T).squaredNorm() > radius * radius;
      report->after.normal = n;
      report->work.stored += 0.5 * f.stiffness * after.squaredNorm();
      report->work.dissipated +=
          -F.dot(u_T) -
          0.5 * f.stiffness * (after.squaredNorm() - data.history.bristle.squaredNorm());
    }
  } else {
    out.C = k * spring_normal * spring_normal.transpose();
    if (report && f.mu > 0.0) {
      report->after.normal = n;
      if (!data.history.in_impact())
        report->work.dissipated += 0.5 * f.stiffness * data.history.bristle.squaredNorm();
    }
  }
  if (of_end) {
    const Vec3 end_point = p.at_n1 - (A.rounding + 0.5 * gap_n1) * spring_normal;
    out.arm_a = end_point - a.r_n - a.u;
    out.arm_b = end_point - b.r_n - b.u;
  }
  if (report) report->force = out.force;
  return out;
}

}  // namespace polhode::contact
