// SPDX-License-Identifier: Apache-2.0
// Static friction above that of sliding, which belongs to the patch of two bodies.
#include <algorithm>
#include <cmath>
#include <vector>

#include <polhode/contact/contact_set.hpp>

namespace polhode::contact {

namespace {

/// A patch whose friction is this close to its bound, as part of it, lets go.
constexpr double kNearlyAll = 1e-3;

/// Loads of points that change over a step by more than this part of the patch's: bodies settle.
constexpr double kSettles = 1e-2;

/// Bound and load of the points between two bodies.
struct Patch {
  double limit = 0.0;    ///< Σ μ_s λ [N].
  double held = 0.0;     ///< Σ |F_T| [N].
  double load = 0.0;     ///< Σ λ [N].
  double change = 0.0;   ///< Σ |Δλ| over the step [N].
  double fastest = 0.0;  ///< Mean slip of a point over the step [m/s].
  bool slips = false, all_slip = true;
};

/// Mean slip of a point over the step [m/s].
double slip_speed(const PointReport& r, const BodyStep& a, const BodyStep& b, double dt) {
  const Vec3 u = a.u + a.theta.cross(r.point - a.r_n - 0.5 * a.u) - b.u -
                 b.theta.cross(r.point - b.r_n - 0.5 * b.u);
  return (u - r.normal.dot(u) * r.normal).norm() / dt;
}

bool belongs(const PointData& d) {
  const FrictionLaw& f = d.friction;
  const bool round = f.mu_across <= 0.0 || f.mu_across == f.mu;
  return f.mu > 0.0 && f.mu_static > f.mu && round && d.pair.weight > 0.0;
}

double held_by(const PointData& d) { return d.friction.stiffness * d.history.bristle.norm(); }

}  // namespace

/// Each point keeps what it holds at t_n, and of what the patch has left its part by normal force:
/// the bounds add up to that of the patch. @eq{contact-patch}
void ContactSet::share_friction() {
  std::vector<Patch> patches(pairs_.size());
  bool any = false;
  for (Point& p : points_) {
    p.data.share = {};
    const PointHistory& h = p.data.history;
    if (!belongs(p.data) || p.sensor) continue;
    any = true;
    if (!h.closed) continue;
    Patch& patch = patches[p.pair];
    patch.limit += p.data.friction.mu_static * h.force;
    patch.held += held_by(p.data);
    patch.slips = patch.slips || h.slips;
  }
  if (!any) return;
  for (Point& p : points_) {
    if (!belongs(p.data) || p.sensor) continue;
    const Patch& patch = patches[p.pair];
    FrictionShare& share = p.data.share;
    share.slides = patch.slips;
    if (p.data.history.closed) share.load = p.data.history.force;
    if (patch.slips || patch.limit == 0.0) {  // the law's own: sliding, or met for the first time
      share.mu = patch.slips ? p.data.friction.mu : p.data.friction.mu_static;
      continue;
    }
    share.mu = p.data.friction.mu_static * std::max(0.0, 1.0 - patch.held / patch.limit);
    if (!p.data.history.closed) continue;
    share.held = held_by(p.data) * std::min(1.0, patch.limit / std::max(patch.held, 1e-300));
  }
}

/// A patch that stuck lets go as a whole; one that slid sticks again once no point of it slides.
/// One that is just being pressed on, whose points give way in turn as their load grows, does not
/// let go before it moves faster than gravity could have made it.
void ContactSet::release_patches(std::span<const BodyStep> steps, double dt) {
  std::vector<Patch> before(pairs_.size()), after(pairs_.size());
  bool any = false;
  for (const Point& p : points_) {
    if (!belongs(p.data) || p.sensor || !p.touched || !(p.report.normal_force > 0.0)) continue;
    any = true;
    const double load = p.report.normal_force;
    Patch& patch = after[p.pair];
    patch.limit += p.data.friction.mu_static * load;
    patch.held += held_by(p.data);
    patch.load += load;
    patch.fastest =
        std::max(patch.fastest, slip_speed(p.report, step_of(p.a, steps), step_of(p.b, steps), dt));
    patch.change += std::abs(load - p.data.share.load);
    patch.slips = patch.slips || p.data.history.slips;
    patch.all_slip = patch.all_slip && p.data.history.slips;
    before[p.pair].slips = before[p.pair].slips || p.data.share.slides;
  }
  if (!any) return;
  const double slow = kSlowReboundSteps * system_->gravity().norm() * std::abs(dt);
  for (Point& p : points_) {
    if (!belongs(p.data) || p.sensor) continue;
    const Patch& patch = after[p.pair];
    const bool free = patch.limit == 0.0;
    const bool settles =
        !before[p.pair].slips && patch.fastest < slow && patch.change > kSettles * patch.load;
    const bool slips =
        !free && !settles &&
        (before[p.pair].slips ? patch.slips
                              : patch.all_slip || patch.held >= (1.0 - kNearlyAll) * patch.limit);
    p.data.history.slips = slips;
    if (p.touched) p.report.after.slips = slips;
  }
}

}  // namespace polhode::contact
