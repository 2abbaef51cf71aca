// SPDX-License-Identifier: Apache-2.0
// Impacts of points of surfaces among those that SettleImpacts knows.
#include <cmath>

#include <polhode/stepping/settle_impacts.hpp>

namespace polhode {

/// Speed after the turn, as of bodies: what a point flew beyond its band was under gravity alone.
/// @eq{surface-turn}
double SettleImpacts::wanted_of(const SurfaceImpact& impact, double speed) const {
  const double e = impact.restitution;
  if (e == 1.0) return speed;
  double falls = 0.0;
  for (const auto& [node, N] : impact.nodes)
    if (system_->nodes()[node].body != kGround) falls += N;
  const double lost = -2.0 * falls * impact.normal.dot(system_->gravity()) * impact.beyond;
  return std::sqrt(std::max(e * e * (speed * speed + lost) - lost, 0.0));
}

/// @eq{surface-turn}
Work SettleImpacts::find_turns(State& state) {
  Work work;
  for (const auto& [g, group, hit] : surfaces_) {
    double* history = state.element_history.data() + system_->nodes().first_history(g);
    Vec3 v = Vec3::Zero();
    for (const auto& [node, N] : hit.nodes) v += N * velocity_of_node(state, node);
    PairImpact& row = rows_.emplace_back();
    Impact& impact = row.impact;
    const double speed = hit.normal.dot(v);
    impact.wanted = speed;
    impact.given = hit.given;
    impact.mu = impact.mu_across = hit.mu;
    if (hit.mu > 0.0) {
      const Vec3 slip = v - speed * hit.normal;
      impact.along = slip.norm() > 0.0 ? Vec3(slip.normalized()) : hit.normal.unitOrthogonal();
      impact.across = hit.normal.cross(impact.along);
    }
    const bool turns = hit.turned ? speed <= 0.0 : speed >= 0.0;
    if (!turns) continue;
    if (!hit.turned) impact.wanted = wanted_of(hit, speed);
    const double released = group->turn(hit, history);
    work.stored -= released;
    work.dissipated += released;
  }
  before_contacts_ = rows_.size();
  return work;
}

const SurfaceImpact* SettleImpacts::surface(int row) const {
  const int k = row - static_cast<int>(of_joints_);
  return k >= 0 && row < static_cast<int>(before_contacts_) ? &surfaces_[k].impact : nullptr;
}

Vec3 SettleImpacts::velocity_of_node(const State& state, int node) const {
  const NodeData& data = system_->nodes()[node];
  if (data.body == kGround) return Vec3::Zero();
  if (data.body == kFreeNode) return at_node(state.node_v, node);
  const BodyMotion m = system_->motion(state, data.body);
  return m.v + m.omega().cross(m.q * data.Z);
}

void SettleImpacts::tell_surfaces(State& state) const {
  for (std::size_t k = 0; k < surfaces_.size(); ++k) {
    const SettledImpact& s = settled_[of_joints_ + k];
    if (s.normal == 0.0 && s.friction.isZero(0.0)) continue;
    const auto& [g, group, impact] = surfaces_[k];
    group->settled(impact, s, dt_,
                   state.element_history.data() + system_->nodes().first_history(g));
  }
}

double SettleImpacts::speed(const State& state, int row) const {
  const SurfaceImpact* hit = surface(row);
  if (!hit) return speed(state, rows_[row]);
  double sum = 0.0;
  for (const auto& [node, N] : hit->nodes)
    sum += N * hit->normal.dot(velocity_of_node(state, node));
  return sum;
}

}  // namespace polhode
