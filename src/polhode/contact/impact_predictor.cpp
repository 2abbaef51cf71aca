// SPDX-License-Identifier: Apache-2.0
// Newton predictor for balls in contact.
#include <algorithm>
#include <vector>

#include <polhode/contact/contact_set.hpp>

namespace polhode::contact {

namespace {

/// Maximum number of Gauss-Seidel sweeps over all points. They end when no gap changes by more than
/// this part of its clearance, and no friction force by more than this part of its bound.
constexpr int kSweeps = 100, kMaxIterations = 30;
constexpr double kAgreed = 0.1;
constexpr double kExactEnough = 1e-3;  ///< Part of the clearance that remains.
/// Displacement over distance above which balls may pass each other: then the gap along the line of
/// centres counts.
constexpr double kFar = 0.5;

/// A point between two balls, or a ball and a plane, and the effect of its contact on their motion.
struct PredictedContact {
  const PointData* data = nullptr;
  const SpherePairCache* balls = nullptr;
  Vec3 along = Vec3::Zero();                          ///< Line of centres at t_n.
  double inverse_mass_a = 0.0, inverse_mass_b = 0.0;  ///< [1/kg]
  double inverse_inertia_a = 0.0,
         inverse_inertia_b = 0.0;         ///< Inverse moments of inertia, on the mean [1/(kg m²)].
  double radius_a = 0.0, radius_b = 0.0;  ///< [m]
  double normal_force = 0.0;              ///< Over K [kg m].
  bool has_friction = false;     ///< Outside impacts, whose friction is an impulse at their end.
  Vec3 bristle = Vec3::Zero();   ///< At t_n, in the tangent plane [m].
  Vec3 friction = Vec3::Zero();  ///< On a, over K [kg m].

  [[nodiscard]] double inverse_mass() const { return inverse_mass_a + inverse_mass_b; }
  /// Displacement of the points of contact relative to each other, by a friction force over K.
  [[nodiscard]] double tangential_inverse_mass() const {
    return inverse_mass() + radius_a * radius_a * inverse_inertia_a +
           radius_b * radius_b * inverse_inertia_b;
  }
  /// Adds the displacements by a change of the forces over K.
  void move(std::span<Vec6> increments, int ground, double normal_change,
            const Vec3& friction_change) const {
    const Vec3 force = normal_change * along + friction_change,
               moment = along.cross(friction_change);
    Vec6& of_a = increments[balls->a];
    of_a.head<3>() += inverse_mass_a * force;
    of_a.tail<3>() -= radius_a * inverse_inertia_a * moment;
    if (balls->b == ground) return;
    Vec6& of_b = increments[balls->b];
    of_b.head<3>() -= inverse_mass_b * force;
    of_b.tail<3>() -= radius_b * inverse_inertia_b * moment;
  }
  /// Slip of a relative to b.
  [[nodiscard]] Vec3 slip(std::span<const Vec6> increments, int ground) const {
    const Vec6& of_a = increments[balls->a];
    Vec3 u = of_a.head<3>() + radius_a * along.cross(Vec3(of_a.tail<3>()));
    if (balls->b != ground) {
      const Vec6& of_b = increments[balls->b];
      u -= of_b.head<3>() - radius_b * along.cross(Vec3(of_b.tail<3>()));
    }
    return u - along.dot(u) * along;
  }
};

/// Gap at the end of the step if only this contact acts additionally: the root of K(g − free) =
/// λ(g_0, g), whose sides increase and decrease with g.
/// @param free  Gap without this contact's force [m]. @param now  First guess [m].
/// @param K  Of both masses [N/m].
double gap_with(const PredictedContact& m, double free, double now, double K, double dt) {
  const double reach = m.balls->reach, least = m.balls->least_gap, gap_n = m.balls->gap_n;
  if (free >= reach) return free;
  double low = std::max(least, free), high = std::max(reach, low);
  double g = now > low && now < high ? now : 0.5 * (low + std::clamp(gap_n, low, high));
  for (int k = 0; k < kMaxIterations; ++k) {
    const double enough = kExactEnough * (g - least);
    const NormalForce f = normal_force(*m.data, gap_n, g, dt);
    const double rest = K * (g - free) - f.lambda;
    (rest < 0.0 ? low : high) = g;
    const double next = g - rest / (K + std::max(0.0, f.stiffness));
    if (std::abs(next - g) < enough) return next > low && next < high ? next : g;
    g = next > low && next < high ? next : 0.5 * (low + high);
  }
  return g;
}

/// Friction force over K on a, if only this contact acts additionally. @eq{contact-bristle}
/// @param free  Slip without this contact's friction [m].
Vec3 friction_with(const PredictedContact& m, const Vec3& free, double K, double dt) {
  const FrictionLaw& f = m.data->friction;
  const double limit = friction_limit(*m.data, K * m.normal_force), k = f.stiffness;
  const double factor = 0.5 + f.damping / (k * dt);
  Vec3 bristle = m.bristle;
  if (const double size = k * bristle.norm(); size > limit) bristle *= limit / size;
  const Vec3 force =
      -k * (bristle + factor * free) / (1.0 + k * factor * m.tangential_inverse_mass() / K);
  const double size = force.norm();
  return (size > limit ? limit / size : 1.0) / K * force;
}

}  // namespace

/// Predictor of contact by Gauss-Seidel iteration over the points of balls, with the laws of the
/// step itself, linear only in the rotations. Without it the fastest pair would limit the step of
/// all bodies, and Newton's method would find in many iterations which points slide.
/// @eq{contact-impact-predictor}
void ContactSet::place_impacts(std::span<const BodyStep> steps, const StepContext& context,
                               std::span<const FreeMotion> free, std::span<Vec6> increments) const {
  const double K = context.ga.alpha_m / (context.ga.beta * context.dt * context.dt);
  const auto ground = static_cast<int>(steps.size()) - 1;
  // Predictions contain all forces of t_n. Where those of points below replace them, bodies start
  // from their motion without contact.
  std::vector<char> from_free(steps.size(), 0);
  for (int b = 0; b < ground; ++b) from_free[b] = free[b].known;
  for (std::size_t i = 0; i < points_.size(); ++i)
    if (points_[i].data.history.closed && !points_[i].sensor && !balls_[i].holds)
      from_free[balls_[i].a] = from_free[balls_[i].b] = 0;
  for (int b = 0; b < ground; ++b)
    if (from_free[b]) increments[b] = free[b].increment;

  std::vector<PredictedContact> contacts;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const SpherePairCache& balls = balls_[i];
    if (!balls.holds || points_[i].sensor) continue;
    const PointData& data = points_[i].data;
    PredictedContact m;
    m.data = &data;
    m.balls = &balls;
    m.along = balls.offset.normalized();
    const auto take = [&](int body, double radius, double& inverse_mass, double& inverse_inertia,
                          double& arm) {
      if (body == ground) return;
      inverse_mass = 1.0 / system_->bodies()[body].mass;
      inverse_inertia = 3.0 / system_->bodies()[body].inertia.trace();
      arm = radius;
    };
    take(balls.a, data.a->rounding, m.inverse_mass_a, m.inverse_inertia_a, m.radius_a);
    take(balls.b, data.b->rounding, m.inverse_mass_b, m.inverse_inertia_b, m.radius_b);
    m.has_friction = data.friction.mu > 0.0 && !data.history.in_impact();
    if (data.history.closed) {
      m.normal_force = data.history.force / K;
      if (m.has_friction) {
        m.bristle = data.history.bristle - m.along.dot(data.history.bristle) * m.along;
        m.friction = -data.friction.stiffness / K * m.bristle;
      }
      PredictedContact start = m;  // moves only the bodies that start without contact forces
      if (!from_free[balls.a]) start.inverse_mass_a = start.inverse_inertia_a = 0.0;
      if (balls.b == ground || !from_free[balls.b])
        start.inverse_mass_b = start.inverse_inertia_b = 0.0;
      start.move(increments, ground, m.normal_force, m.friction);
    }
    contacts.push_back(m);
  }
  const auto gap_of = [&](const SpherePairCache& balls) {
    const Vec3 u_a = increments[balls.a].head<3>();
    const Vec3 moved = balls.b == ground ? u_a : Vec3(u_a - increments[balls.b].head<3>());
    return moved.norm() > kFar * balls.distance && balls.distance > 0.0
               ? balls.gap_n + balls.offset.dot(moved) / balls.distance
               : balls.gap_after(moved);
  };
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double max_change = 0.0;
    for (PredictedContact& m : contacts) {
      const double now = gap_of(*m.balls), gap_without = now - m.inverse_mass() * m.normal_force;
      if (gap_without >= m.balls->reach && m.normal_force == 0.0) continue;
      const double gap = gap_with(m, gap_without, now, K / m.inverse_mass(), context.dt);
      const double normal = (gap - gap_without) / m.inverse_mass(),
                   normal_change = normal - m.normal_force;
      const double clearance = std::min(gap, m.balls->reach) - m.balls->least_gap;
      max_change = std::max(max_change, m.inverse_mass() * std::abs(normal_change) / clearance);
      m.normal_force = normal;
      Vec3 friction_change = Vec3::Zero();
      if (m.has_friction) {
        const Vec3 slip = m.slip(increments, ground) - m.tangential_inverse_mass() * m.friction;
        const Vec3 friction = friction_with(m, slip, K, context.dt);
        friction_change = friction - m.friction;
        if (normal > 0.0)
          max_change = std::max(max_change,
                                K * friction_change.norm() / friction_limit(*m.data, K * normal));
        m.friction = friction;
      }
      m.move(increments, ground, normal_change, friction_change);
    }
    if (max_change < kAgreed) break;
  }
}

}  // namespace polhode::contact
