// SPDX-License-Identifier: Apache-2.0
// Impacts of points of surfaces among those that SettleImpacts knows.
#include <cmath>

#include <polhode/stepping/impact_rows.hpp>

namespace polhode {

namespace {

/// Sweeps that find what presses points on end when no impulse changes by more than this part of
/// the largest one, or after so many.
constexpr double kHeldConverged = 1e-10;
constexpr int kMostHeldSweeps = 200;
/// An impact is over before it turns where others press the point on by this part of what it
/// presses back, and it has no more than this part of what it stores as kinetic energy.
constexpr double kHeldOn = 0.9, kNoImpact = 1e-2;

}  // namespace

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
void SettleImpacts::find_turns(const State& state) {
  for (Surface& surface : surfaces_) {
    const SurfaceImpact& hit = surface.impact;
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
    surface.turns = hit.turned ? speed <= 0.0 : speed >= 0.0;
    if (surface.turns && !hit.turned) impact.wanted = wanted_of(hit, speed);
  }
  before_contacts_ = rows_.size();
}

/// Forces that hold points in place: what changed normal speeds over the step, but for the impacts.
/// An impact is over where they press as much as the point presses back and it has little speed
/// left. @eq{surface-held}
void SettleImpacts::find_held(const std::vector<Row>& rows, std::vector<Vec6> v) {
  std::vector<Row> normals;
  bool find = false;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i > 0 && rows[i - 1].rubs) continue;
    const SurfaceImpact* hit = surface(rows[i].impact);
    if (!hit) continue;
    find = find || !hit->turned;
    normals.push_back(rows[i]);
    normals.back().impulse = 0.0;
  }
  if (!find) return;
  for (int sweep = 0; sweep < kMostHeldSweeps; ++sweep) {
    double change = 0.0, largest = 0.0;
    for (Row& row : normals) {
      if (!(row.mobility > 0.0)) continue;
      const double p = (surface(row.impact)->before - row.speed(v)) / row.mobility;
      row.push(p, v);
      change = std::max(change, std::abs(p));
      largest = std::max(largest, std::abs(row.impulse));
    }
    if (!(change > kHeldConverged * largest)) break;
  }
  for (const Row& row : normals) {
    Surface& of = of_surface(row.impact);
    of.held = std::max(0.0, of.impact.given + row.impulse) / dt_;
    if (of.impact.turned || of.turns || !(row.mobility > 0.0)) continue;
    const double speed = rows_[row.impact].impact.wanted;
    of.turns = of.held * dt_ >= kHeldOn * of.impact.given &&
               0.5 * speed * speed / row.mobility <= kNoImpact * of.impact.stored;
  }
}

/// @eq{surface-turn}
Work SettleImpacts::turn_surfaces(State& state) const {
  Work work;
  for (const Surface& surface : surfaces_) {
    if (!surface.turns) continue;
    const double released = surface.group->turn(
        surface.impact, surface.held,
        state.element_history.data() + system_->nodes().first_history(surface.number));
    work.stored -= released;
    work.dissipated += released;
  }
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
    const Surface& of = surfaces_[k];
    of.group->settled(of.impact, s, dt_,
                      state.element_history.data() + system_->nodes().first_history(of.number));
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
