// SPDX-License-Identifier: Apache-2.0
// Where Newton starts in a step that bodies would end inside each other.
#include <algorithm>

#include <polhode/contact/contact_set.hpp>

namespace polhode::contact {

namespace {

/// Points that keep more than this part of their room are left where they are predicted.
constexpr double kRoomKept = 0.65;
constexpr int kSweeps = 5, kMostIterations = 30;
constexpr double kExactEnough = 1e-3;  ///< Part of the room that is left.
/// Balls that move by more than this part of their distance may pass: the gap along the line of
/// their centres counts.
constexpr double kFar = 0.5;

/// The gap at which two masses that approach each other freely by `free` in the step would end it
/// if their contact alone acted: root of K(g_1 − g_0 − free) = λ(g_0, g_1), which grows with g_1.
double stopped_gap(const PointData& data, double gap_n, double free, double K, double least_gap,
                   double dt) {
  const double reach = data.normal.reach();
  double low = std::max(least_gap, gap_n + free), high = std::max(reach, low);
  double g = 0.5 * (low + std::min(high, gap_n));
  for (int k = 0; k < kMostIterations; ++k) {
    const double enough = kExactEnough * (g - least_gap);
    const NormalForce f = normal_force(data, gap_n, g, dt);
    const double rest = K * (g - gap_n - free) - f.lambda;
    (rest < 0.0 ? low : high) = g;
    const double next = g - rest / (K + std::max(0.0, f.stiffness));
    if (std::abs(next - g) < enough) return next > low && next < high ? next : g;
    g = next > low && next < high ? next : 0.5 * (low + high);
  }
  return g;
}

}  // namespace

/// One point after the other, as if each pair of balls was alone: most impacts are fresh ones of
/// two bodies. Without it the whole crowd would be held back by its fastest pair.
/// @eq{contact-impact-guess}
void ContactSet::place_impacts(std::span<const BodyStep> steps, const StepContext& context,
                               std::span<Vec6> increments) const {
  const double K = context.ga.alpha_m / (context.ga.beta * context.dt * context.dt);
  const auto ground = static_cast<int>(steps.size()) - 1;
  const auto share = [&](int body) {
    return body == ground ? 0.0 : 1.0 / system_->bodies()[body].mass;
  };
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const ApproachOfBalls& balls = balls_[i];
      if (!balls.holds) continue;
      const Vec3 u_a = increments[balls.a].head<3>();
      const Vec3 moved = balls.b == ground ? u_a : Vec3(u_a - increments[balls.b].head<3>());
      const double gap_1 = moved.norm() > kFar * balls.distance && balls.distance > 0.0
                               ? balls.gap_n + balls.offset.dot(moved) / balls.distance
                               : balls.gap_after(moved);
      const double room = std::min(balls.gap_n, balls.reach) - balls.least_gap;
      if (!(gap_1 - balls.least_gap < kRoomKept * room) || points_[i].sensor) continue;
      const double share_a = share(balls.a), share_b = share(balls.b);
      const double back = stopped_gap(points_[i].data, balls.gap_n, gap_1 - balls.gap_n,
                                      K / (share_a + share_b), balls.least_gap, context.dt) -
                          gap_1;
      if (!(back > 0.0)) continue;
      const Vec3 push = back / (share_a + share_b) * balls.offset.normalized();
      increments[balls.a].head<3>() += share_a * push;
      if (balls.b != ground) increments[balls.b].head<3>() -= share_b * push;
    }
}

}  // namespace polhode::contact
