// SPDX-License-Identifier: Apache-2.0
// Newton predictor for steps in which bodies would interpenetrate at the end.
#include <algorithm>
#include <vector>

#include <polhode/contact/contact_set.hpp>

namespace polhode::contact {

namespace {

/// Maximum number of Gauss-Seidel sweeps over all points. They end when no gap changes by more than
/// this part of its clearance.
constexpr int kSweeps = 100, kMaxIterations = 30;
constexpr double kAgreed = 0.1;
constexpr double kExactEnough = 1e-3;  ///< Part of the clearance that remains.
/// Displacement over distance above which balls may pass each other: then the gap along the line of
/// centres counts.
constexpr double kFar = 0.5;

/// A point between two balls, or a ball and a plane, and the effect of its contact on their motion.
struct Meeting {
  const PointData* data;
  const SpherePairCache* balls;
  Vec3 along;               ///< Line of centres at t_n.
  double share_a, share_b;  ///< Inverse masses [1/kg].
  double held;  ///< Contact force that the prediction contains already: of resting bodies [N].
  double push = 0.0;  ///< Relative displacement by the contact, times mass [kg m].

  [[nodiscard]] double shares() const { return share_a + share_b; }
};

/// Gap at the end of the step if only this contact acts additionally: the root of K(g − free) =
/// λ(g_0, g) − held, whose sides increase and decrease with g.
/// @param free  Gap without this contact's impulse [m]. @param K  Of both masses [N/m].
double gap_with(const Meeting& m, double free, double K, double dt) {
  const double reach = m.balls->reach, least = m.balls->least_gap, gap_n = m.balls->gap_n;
  const double apart = free - m.held / K;
  if (apart >= reach) return apart;
  double low = std::max(least, apart), high = std::max({reach, low, free});
  double g = 0.5 * (low + std::min(high, std::max(low, gap_n)));
  for (int k = 0; k < kMaxIterations; ++k) {
    const double enough = kExactEnough * (g - least);
    const NormalForce f = normal_force(*m.data, gap_n, g, dt);
    const double rest = K * (g - apart) - f.lambda;
    (rest < 0.0 ? low : high) = g;
    const double next = g - rest / (K + std::max(0.0, f.stiffness));
    if (std::abs(next - g) < enough) return next > low && next < high ? next : g;
    g = next > low && next < high ? next : 0.5 * (low + high);
  }
  return g;
}

}  // namespace

/// Predictor of impacts by Gauss-Seidel iteration over the points. Friction and rotations are
/// neglected, as they matter little to impacts of balls. Without it the fastest pair would limit
/// the step of all bodies. @eq{contact-impact-predictor}
void ContactSet::place_impacts(std::span<const BodyStep> steps, const StepContext& context,
                               std::span<Vec6> increments) const {
  const double K = context.ga.alpha_m / (context.ga.beta * context.dt * context.dt);
  const auto ground = static_cast<int>(steps.size()) - 1;
  const auto share = [&](int body) {
    return body == ground ? 0.0 : 1.0 / system_->bodies()[body].mass;
  };
  const auto gap_of = [&](const SpherePairCache& balls) {
    const Vec3 u_a = increments[balls.a].head<3>();
    const Vec3 moved = balls.b == ground ? u_a : Vec3(u_a - increments[balls.b].head<3>());
    return moved.norm() > kFar * balls.distance && balls.distance > 0.0
               ? balls.gap_n + balls.offset.dot(moved) / balls.distance
               : balls.gap_after(moved);
  };
  std::vector<Meeting> meetings;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const SpherePairCache& balls = balls_[i];
    if (!balls.holds || points_[i].sensor) continue;
    const PointData& data = points_[i].data;
    Meeting m{&data, &balls, balls.offset.normalized(), share(balls.a), share(balls.b), 0.0};
    if (data.history.closed) {
      m.held = data.history.force;
      const double gap = gap_of(balls);
      if (gap > balls.least_gap)
        m.held = std::min(m.held, normal_force(data, balls.gap_n, gap, context.dt).lambda);
    }
    meetings.push_back(m);
  }
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double most = 0.0;
    for (Meeting& m : meetings) {
      const double free = gap_of(*m.balls) - m.shares() * m.push;
      if (free >= m.balls->reach && m.push == 0.0 && m.held == 0.0) continue;
      const double gap = gap_with(m, free, K / m.shares(), context.dt);
      const double push = (gap - free) / m.shares(), more = push - m.push;
      const double clearance = std::min(gap, m.balls->reach) - m.balls->least_gap;
      most = std::max(most, m.shares() * std::abs(more) / clearance);
      m.push = push;
      increments[m.balls->a].head<3>() += m.share_a * more * m.along;
      if (m.balls->b != ground) increments[m.balls->b].head<3>() -= m.share_b * more * m.along;
    }
    if (most < kAgreed) break;
  }
}

}  // namespace polhode::contact
