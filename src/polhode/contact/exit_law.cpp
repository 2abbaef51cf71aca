// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include <polhode/contact/contact_set.hpp>

namespace polhode::contact {

/// Speed along the normal that a point shall have after the step, if it jumps. @eq{exit-law}
std::optional<double> ContactSet::exit_speed(const Point& p) const {
  if (!p.touched || p.data.pair.weight < 0.0 || p.restitution >= 1.0) return {};
  if (!(p.elastic_force > 0.0) || !(p.speed_n1 > 0.0)) return {};
  const PointHistory& h = p.data.history;
  if (h.plastic) {  // midpoint kinematics would throw it back
    if (!h.fresh || p.speed_n >= 0.0) return {};
    return 0.0;
  }
  if (h.closed) return {};
  // The gap beyond the surface was flown under the pull of gravity alone.
  const double height = p.report.gap_n1 - p.data.normal.reach();
  Vec3 pull = Vec3::Zero();
  if (shapes_[p.a].body != kGround) pull += system_->gravity();
  if (shapes_[p.b].body != kGround) pull -= system_->gravity();
  const double a = -p.report.normal.dot(pull);
  const double at_surface = p.speed_n1 * p.speed_n1 + 2.0 * a * height;
  return std::sqrt(std::max(p.restitution * p.restitution * at_surface - 2.0 * a * height, 0.0));
}

void ContactSet::impacts(State& state, std::vector<PairImpact>& list) {
  settling_.clear();
  bool remembered = false;
  for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
    Point& p = points_[i];
    const std::optional<double> wanted = exit_speed(p);
    if (!wanted) continue;
    if (p.data.history.plastic) {
      p.data.history.fresh = false;
      remembered = true;
    }
    PairImpact r;
    r.bodies = {shapes_[p.a].body, shapes_[p.b].body};
    double speed = 0.0;
    const auto side = [&](int body, double sign) {
      Vec6 J = Vec6::Zero();
      if (body == kGround) return J;
      const BodyMotion m = system_->motion(state, body);
      const Vec3 n = sign * p.report.normal;
      J << n, (p.report.point - m.r).cross(n);
      speed += J.head<3>().dot(m.v) + J.tail<3>().dot(m.omega());
      return J;
    };
    r.impact.on_a = side(r.bodies.a, 1.0);
    r.impact.on_b = side(r.bodies.b, -1.0);
    if (!(speed > 0.0)) continue;
    r.impact.wanted = std::min(*wanted, speed);
    settling_.push_back(i);
    list.push_back(r);
  }
  if (remembered) save(state);
}

void ContactSet::settled(std::span<const double> impulses, std::span<const double> losses) {
  for (std::size_t k = 0; k < settling_.size(); ++k) {
    Point& p = points_[settling_[k]];
    p.impact_impulse += impulses[k];
    p.impact_loss += losses[k];
    lost_in_impacts_ += losses[k];
  }
}

}  // namespace polhode::contact
