// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/contact/plain_point.hpp>

namespace polhode::contact {

namespace {

/// A point carried by a body at both ends of the step.
struct Ends {
  Vec3 at_n, at_n1;
};

Ends carried(const BodyStep& s, const Vec3& Z) {
  if (Z.isZero(0.0)) return {s.r_n, s.r_n1};
  return {s.r_n + s.Lambda_n * Z, s.r_n1 + s.Lambda_n1 * Z};
}

Ends turned(const BodyStep& s, const Vec3& Z) {
  if (!s.moves) return {Z, Z};
  return {s.Lambda_n * Z, s.Lambda_n1 * Z};
}

Vec3 in_disc(const Vec3& s, double radius) {
  const double square = s.squaredNorm();
  return square <= radius * radius ? s : Vec3(radius / std::sqrt(square) * s);
}

/// The bristle of t_n in the tangent plane of the step, as the general formula has it.
Vec3 transported(const Vec3& bristle, const Vec3& before, const Vec3& n, double spin) {
  if (before.isZero(0.0)) return Vec3::Zero();
  const double cosine = before.dot(n);
  Vec3 turned = bristle;
  if (cosine > -0.5) {
    const Vec3 axis = before.cross(n), once = axis.cross(bristle);
    turned += once + axis.cross(once) / (1.0 + cosine);
  }
  turned -= n.dot(turned) * n;
  const double square = 0.25 * spin * spin, scale = 1.0 / (1.0 + square);
  return scale * ((1.0 - square) * turned + spin * n.cross(turned));
}

}  // namespace

bool is_plain(const PointData& data) {
  const FrictionLaw& f = data.friction;
  return data.pair.kind == GapKind::point_solid && data.pair.fade == Fade::none &&
         (data.b->solid == Solid::ball || data.b->solid == Solid::half_space) && f.rolling == 0.0 &&
         f.torsion == 0.0 && (f.mu_across <= 0.0 || f.mu_across == f.mu);
}

double plain_gap_n1(const PointData& data, const BodyStep& a, const BodyStep& b) {
  const Shape &A = *data.a, &B = *data.b;
  const Vec3& Z = A.corners[data.pair.i];
  const Vec3 p = Z.isZero(0.0) ? a.r_n1 : Vec3(a.r_n1 + a.Lambda_n1 * Z);
  const Vec3 q = B.centre.isZero(0.0) ? b.r_n1 : Vec3(b.r_n1 + b.Lambda_n1 * B.centre);
  const double rho = A.rounding + B.rounding;
  if (B.solid == Solid::ball) return (p - q).norm() - rho;
  const Vec3 n = b.moves ? Vec3(b.Lambda_n1 * B.axes.col(2)) : Vec3(B.axes.col(2));
  return n.dot(p - q) - rho;
}

/// @eq{contact-point-plane} @eq{contact-sphere-sphere} @eq{contact-plastic} @eq{contact-bristle}
/// @eq{contact-spring}
PointForce plain_force(const PointData& data, double gap_n, double gap_n1, const BodyStep& a,
                       const BodyStep& b, const StepContext& context, PointReport* report) {
  const Shape &A = *data.a, &B = *data.b;
  const Ends p = carried(a, A.corners[data.pair.i]), q = carried(b, B.centre);
  const Vec3 point = 0.5 * (p.at_n + p.at_n1);
  const Vec3 r_a = a.r_n + 0.5 * a.u, r_b = b.r_n + 0.5 * b.u;
  Vec3 N, n, c;
  if (B.solid == Solid::half_space) {
    const Ends normal = turned(b, B.axes.col(2));
    N = 0.5 * (normal.at_n + normal.at_n1);
    n = N.normalized();
    const double more = A.rounding - B.rounding;
    c = point - 0.25 * ((normal.at_n.dot(p.at_n - q.at_n) + more) * normal.at_n +
                        (normal.at_n1.dot(p.at_n1 - q.at_n1) + more) * normal.at_n1);
  } else {
    const Vec3 w_0 = p.at_n - q.at_n, w_1 = p.at_n1 - q.at_n1;
    const double l_0 = w_0.norm(), l_1 = w_1.norm();
    N = (w_0 + w_1) / (l_0 + l_1);
    const Vec3 sum = w_0 / l_0 + w_1 / l_1;
    n = sum.normalized();
    c = 0.5 * (point + 0.5 * (q.at_n + q.at_n1)) + 0.25 * (B.rounding - A.rounding) * sum;
  }

  const NormalLaw& law = data.normal;
  const double quotient = law.quotient(gap_n, gap_n1);
  double lambda = quotient;
  if (data.rate_damping > 0.0)
    lambda *= std::max(0.0, 1.0 - data.rate_damping / context.dt * (gap_n1 - gap_n));
  if (data.history.plastic)
    lambda = (1.0 - kPlasticShare) * lambda + kPlasticShare * law.force(gap_n1);
  lambda *= data.pair.weight;

  PointForce out;
  out.arm_a = c - r_a;
  out.arm_b = c - r_b;
  out.force = lambda * N;
  out.moment_a = (point - r_a).cross(out.force);
  out.moment_b = -(point - r_b).cross(out.force);
  const double k = std::max(0.0, normal_stiffness(data, gap_n, gap_n1, context.dt));
  out.C = k * n * n.transpose();
  if (report) {
    *report = {};
    report->gap_n = gap_n;
    report->gap_n1 = gap_n1;
    report->normal_force = lambda;
    report->normal = n;
    report->point = c;
    report->after = data.history;
    report->after.bristle.setZero();
    report->after.normal.setZero();
    report->after.rolling.setZero();
    report->after.torsion = 0.0;
    report->after.slips = false;
    report->work.stored = data.pair.weight * law.energy(gap_n1);
    report->work.dissipated = (lambda - data.pair.weight * quotient) * (gap_n - gap_n1);
    report->normal_loss = report->work.dissipated;
  }

  const FrictionLaw& f = data.friction;
  const double normal_force = data.friction_share * lambda;
  if (f.mu > 0.0 && normal_force > 0.0) {
    const Vec3 u = a.u + a.theta.cross(out.arm_a) - b.u - b.theta.cross(out.arm_b);
    const Vec3 u_T = u - n.dot(u) * n;
    const double spin = 0.5 * n.dot(a.theta + b.theta);
    const double mu = !data.history.slips && f.mu_static > 0.0 ? f.mu_static : f.mu;
    const double radius = mu / f.stiffness * normal_force;
    const Vec3 s_0 =
        in_disc(transported(data.history.bristle, data.history.normal, n, spin), radius);
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
    out.C.diagonal().array() += k_T;
    out.C -= k_T * n * n.transpose();
    if (slides) out.C -= (k_T / square) * middle * middle.transpose();
    if (report) {
      report->friction_force = F;
      const Vec3 after = in_disc(s_0 + u_T, radius);
      report->after.bristle = after;
      report->after.slips = (s_0 + u_T).squaredNorm() > radius * radius;
      report->after.normal = n;
      report->work.stored += 0.5 * f.stiffness * after.squaredNorm();
      report->work.dissipated +=
          -F.dot(u_T) -
          0.5 * f.stiffness * (after.squaredNorm() - data.history.bristle.squaredNorm());
    }
  } else if (report && f.mu > 0.0) {
    report->after.normal = n;
    report->work.dissipated += 0.5 * f.stiffness * data.history.bristle.squaredNorm();
  }
  if (report) report->force = out.force;
  return out;
}

}  // namespace polhode::contact
