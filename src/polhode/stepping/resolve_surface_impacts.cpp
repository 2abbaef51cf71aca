// SPDX-License-Identifier: Apache-2.0
// Surface points in the impacts of ImpactResolver.
#include <cmath>

#include <polhode/stepping/impact_rows.hpp>

namespace polhode {

namespace {

/// Reduction of the residual speeds at which the conjugate gradients for held-on forces end, and
/// the largest number of iterations.
constexpr double kHeldConverged = 1e-10;
constexpr int kMaxHeldSweeps = 200;
/// Limits for the end of an impact before its turn: the force of others on the point reaches this
/// part of the contact force, and its kinetic energy is below this part of the stored energy.
constexpr double kHeldOn = 0.9, kNoImpact = 1e-2;

}  // namespace

/// Target speed after the turn, as for bodies: beyond its band a point moved under gravity alone.
/// @eq{surface-turn}
double ImpactResolver::wanted_of(const SurfaceImpact& impact, double speed) const {
  const double e = impact.restitution;
  if (e == 1.0) return speed;
  Vec3 fall = Vec3::Zero();
  for (const auto& [node, J] : impact.nodes)
    if (system_->nodes()[node].body != kGround) fall += J * system_->gravity();
  const double lost = -2.0 * impact.normal.dot(fall) * impact.beyond;
  return std::sqrt(std::max(e * e * (speed * speed + lost) - lost, 0.0));
}

/// @eq{surface-turn}
void ImpactResolver::find_turns(const State& state) {
  for (Surface& surface : surfaces_) {
    const SurfaceImpact& hit = surface.impact;
    Vec3 v = Vec3::Zero();
    for (const auto& [node, J] : hit.nodes) v += J * velocity_of_node(state, node);
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

/// Impulses that restore the rows' speeds before the step, by conjugate gradients from zero in the
/// metric of the given impulses: points that no motion distinguishes share an impulse in that
/// proportion. @eq{surface-held}
void ImpactResolver::share_held(std::vector<Row>& rows, std::vector<Vec6> v) const {
  const auto n = static_cast<Eigen::Index>(rows.size());
  Vec scale(n), residual(n), direction, moved(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Row& row = rows[static_cast<std::size_t>(i)];
    scale[i] = row.mobility > 0.0 ? std::sqrt(surface(row.impact)->given) : 0.0;
    residual[i] = scale[i] * (surface(row.impact)->before - row.speed(v));
  }
  direction = residual;
  double square = residual.squaredNorm();
  const double end = kHeldConverged * kHeldConverged * square;
  for (int k = 0; k < kMaxHeldSweeps && square > end; ++k) {
    for (Vec6& x : v) x.setZero();
    for (Eigen::Index i = 0; i < n; ++i)
      for (const auto& [place, x] : rows[static_cast<std::size_t>(i)].answer)
        v[static_cast<std::size_t>(place)] += scale[i] * direction[i] * x;
    for (Eigen::Index i = 0; i < n; ++i)
      moved[i] = scale[i] * rows[static_cast<std::size_t>(i)].speed(v);
    const double work = direction.dot(moved);
    if (!(work > 0.0)) break;
    const double step = square / work;
    for (Eigen::Index i = 0; i < n; ++i)
      rows[static_cast<std::size_t>(i)].impulse += step * scale[i] * direction[i];
    residual -= step * moved;
    const double before = square;
    square = residual.squaredNorm();
    direction = residual + square / before * direction;
  }
}

/// Forces that hold points in place: those that changed normal speeds over the step, except
/// impacts. An impact ends where they balance the contact force and the point has little speed
/// left. @eq{surface-held}
void ImpactResolver::find_held(const std::vector<Row>& rows, std::vector<Vec6> v) {
  std::vector<Row> normals;
  bool find = false;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i > 0 && rows[i - 1].has_friction) continue;
    const SurfaceImpact* hit = surface(rows[i].impact);
    if (!hit) continue;
    find = find || !hit->turned;
    normals.push_back(rows[i]);
    normals.back().impulse = 0.0;
  }
  if (!find) return;
  share_held(normals, std::move(v));
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
Work ImpactResolver::turn_surfaces(State& state) const {
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

const SurfaceImpact* ImpactResolver::surface(int row) const {
  const int k = row - static_cast<int>(of_joints_);
  return k >= 0 && row < static_cast<int>(before_contacts_) ? &surfaces_[k].impact : nullptr;
}

Vec3 ImpactResolver::velocity_of_node(const State& state, int node) const {
  const NodeData& data = system_->nodes()[node];
  if (data.body == kGround) return Vec3::Zero();
  if (data.body == kFreeNode) return at_node(state.node_v, node);
  const BodyMotion m = system_->motion(state, data.body);
  return m.v + m.omega().cross(m.q * data.Z);
}

void ImpactResolver::tell_surfaces(State& state) const {
  for (std::size_t k = 0; k < surfaces_.size(); ++k) {
    const ResolvedImpact& s = settled_[of_joints_ + k];
    if (s.normal == 0.0 && s.friction.isZero(0.0)) continue;
    const Surface& of = surfaces_[k];
    of.group->settled(of.impact, s, dt_,
                      state.element_history.data() + system_->nodes().first_history(of.number));
  }
}

double ImpactResolver::speed(const State& state, int row) const {
  const SurfaceImpact* hit = surface(row);
  if (!hit) return speed(state, rows_[row]);
  double sum = 0.0;
  for (const auto& [node, J] : hit->nodes)
    sum += hit->normal.dot(J * velocity_of_node(state, node));
  return sum;
}

}  // namespace polhode
