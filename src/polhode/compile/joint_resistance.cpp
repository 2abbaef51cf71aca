// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <tuple>

#include <polhode/compile/joint_resistance.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>

namespace polhode {

namespace {

/// Deflection of a bristle under the weight of the joint's bodies [rad, or part of a length].
constexpr double kPresliding = 1e-5;
/// Damping ratio of the bristle.
constexpr double kBristleDamping = 0.7;
/// Width of a stop's barrier [rad, or part of a length].
constexpr double kBand = 1e-3;
/// k d̂ over the reference load, for a barrier that carries it at a twentieth of its band; and k
/// Δt² over the inertia, so that resting contact settles within a few steps.
constexpr double kBarrier = 373.0, kBarrierByStep = 10.0;
/// Gravity for reference loads of models without gravity [m/s²].
constexpr double kEarth = 9.81;

/// Typical loads and inertias of the joint.
struct Scales {
  double mass = 0.0, inertia = 0.0;  ///< Reduced, of the joint's bodies; about the joint.
  double about_axis = 0.0;           ///< Reduced inertia of the rotation about the joint's axis.
  double weight = 0.0;               ///< Of the heavier body [N].
  double length = 1.0;               ///< Radius of gyration about the joint [m].
};

/// Inertia of a body about its point of a joint, body axes; zero if it does not move [kg m²].
Mat3 inertia_about(const Model& model, int body, const Vec3& Z) {
  if (body == kGround) return Mat3::Zero();
  const BodySpec& b = model.bodies[static_cast<std::size_t>(body)];
  if (b.fixed || !(b.mass > 0.0)) return Mat3::Zero();
  return b.inertia + b.mass * (Z.squaredNorm() * Mat3::Identity() - Z * Z.transpose());
}

Scales scales_of(const Model& model, const JointSpec& joint) {
  const double g = model.gravity.norm() > 0.0 ? model.gravity.norm() : kEarth;
  Scales s;
  double per_mass = 0.0, per_inertia = 0.0, per_axis = 0.0;
  for (const auto& [body, Z, R] :
       {std::tuple(joint.a, joint.Z_a, joint.R_a), std::tuple(joint.b, joint.Z_b, joint.R_b)}) {
    if (body == kGround) continue;
    const BodySpec& b = model.bodies[static_cast<std::size_t>(body)];
    if (b.fixed || !(b.mass > 0.0)) continue;
    const double inertia = b.mass * Z.squaredNorm() + b.inertia.trace() / 3.0;
    per_mass += 1.0 / b.mass;
    if (inertia > 0.0) per_inertia += 1.0 / inertia;
    const Vec3 axis = R.col(2);
    const double turned = b.mass * axis.cross(Z).squaredNorm() + axis.dot(b.inertia * axis);
    if (turned > 0.0) per_axis += 1.0 / turned;
    s.weight = std::max(s.weight, b.mass * g);
  }
  s.mass = per_mass > 0.0 ? 1.0 / per_mass : 1.0;
  s.inertia = per_inertia > 0.0 ? 1.0 / per_inertia : s.mass;
  s.about_axis = per_axis > 0.0 ? 1.0 / per_axis : s.inertia;
  s.length = std::sqrt(s.inertia / s.mass);
  return s;
}

/// @param length  Radius of gyration; 1 for an angle. @param radius  Of an angle's rows.
JointLimits limits_of(const JointLimitsSpec& spec, const Model& model, double load, double inertia,
                      double length, double radius) {
  const AnalysisSpec& analysis = model.analysis;
  JointLimits limits;
  if (spec.lower) limits.lower = *spec.lower;
  if (spec.upper) limits.upper = *spec.upper;
  limits.restitution = spec.restitution;
  limits.by_rows = model.contacts.rigid();
  limits.radius = radius;
  const double band = spec.band.value_or(kBand * length);
  const double by_step =
      analysis.step ? kBarrierByStep * inertia / (*analysis.step * *analysis.step) : 0.0;
  limits.law.tolerance = band;
  limits.law.upper = 0.0;
  if (!spec.stiffness) limits.inertia = inertia;
  limits.law.stiffness = spec.stiffness.value_or(std::max(kBarrier * load / band, by_step));
  return limits;
}

}  // namespace

JointResistance joint_resistance(const Model& model, const JointSpec& joint) {
  JointResistance r;
  if (joint.type == "slack_link" && !joint.limits)
    throw InputError(format("joints.{}", joint.name), "a slack_link without limits has no effect",
                     "Give limits: {lower, upper}, distances of its points");
  if (!joint.friction && !joint.limits && !joint.angle_limits) return r;
  const Scales s = scales_of(model, joint);
  const bool slides =
      joint.type == "prismatic" || joint.type == "cylindrical" || joint.type == "slack_link";
  if (joint.friction) {
    const JointFrictionSpec& spec = *joint.friction;
    JointFriction f;
    f.mu = spec.mu;
    f.radius = spec.radius;
    f.face_radius = spec.face_radius;
    f.length = spec.length;
    f.constant = spec.constant;
    const double arm = slides ? 1.0 : std::max(f.radius, f.face_radius);
    const double most = f.constant + f.mu * arm * s.weight;
    const double way = kPresliding * (slides ? s.length : 1.0);
    f.stiffness = spec.stiffness.value_or(most > 0.0 ? most / way : 1.0);
    const double inertia = slides ? s.mass : s.inertia;
    f.damping = spec.damping.value_or(kBristleDamping * std::sqrt(f.stiffness * inertia));
    f.mass = s.mass;
    f.inertia = {inertia_about(model, joint.a, joint.Z_a),
                 inertia_about(model, joint.b, joint.Z_b)};
    r.friction = f;
  }
  if (slides && joint.limits)
    r.slide = limits_of(*joint.limits, model, s.weight, s.mass, s.length, 1.0);
  const auto& angle = slides ? joint.angle_limits : joint.limits;
  if (angle) r.turn = limits_of(*angle, model, s.weight * s.length, s.about_axis, 1.0, s.length);
  return r;
}

}  // namespace polhode
