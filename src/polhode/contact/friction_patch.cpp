// SPDX-License-Identifier: Apache-2.0
// Static friction above kinetic friction, a property of the contact patch of two bodies.
#include <algorithm>
#include <cmath>
#include <vector>

#include <polhode/contact/contact_set.hpp>

namespace polhode::contact {

namespace {

/// Relative distance to its friction bound at which a patch starts to slide.
constexpr double kNearlyAll = 1e-3;

/// Part of the patch's load by which loads of points change while bodies settle in the band, in the
/// settling time or in a longer step. Above it they count as settling.
constexpr double kSettles = 1e-2;

/// Part of its bound that a patch carries, as the mean of two steps, when it starts to slide: with
/// long steps the normal forces alternate from step to step.
constexpr double kMostlyAll = 0.99;

/// Speeds over that of a fall into the equilibrium depth: oscillating bodies are below the first,
/// standing bodies under an oscillating load below the second.
constexpr double kSwings = 0.6, kStands = 3e-3;
/// Smallest relative change of a patch's load, in the settling time, that counts as an oscillation.
/// A patch with a steadier load slips at its bound.
constexpr double kStill = 1e-4;

/// Friction bound and load of the points between two bodies.
struct Patch {
  double limit = 0.0;    ///< Σ μ_s λ [N].
  double held = 0.0;     ///< Σ |F_T| [N].
  double load = 0.0;     ///< Σ λ [N].
  double change = 0.0;   ///< Σ |Δλ| over the step [N].
  double fastest = 0.0;  ///< Largest mean slip speed of a point over the step [m/s].
  double depth = 0.0;    ///< Equilibrium depth, see NormalLaw [m].
  bool slips = false, all_slip = true;
};

/// Mean slip speed of a point over the step [m/s].
double slip_speed(const PointReport& r, const BodyStep& a, const BodyStep& b, double dt) {
  const Vec3 u = a.u + a.theta.cross(r.point - a.r_n - 0.5 * a.u) - b.u -
                 b.theta.cross(r.point - b.r_n - 0.5 * b.u);
  return (u - r.normal.dot(u) * r.normal).norm() / dt;
}

bool belongs(const PointData& d) {
  const FrictionLaw& f = d.friction;
  const bool round = f.mu_across <= 0.0 || f.mu_across == f.mu;
  return f.mu > 0.0 && f.mu_static > f.mu && round;
}

double held_by(const PointData& d) { return d.friction.stiffness * d.history.bristle.norm(); }

}  // namespace

/// Distributes the friction bound of each patch. A point keeps what it holds at t_n and gets its
/// part, by normal force, of what the patch has left: the bounds add up to that of the patch.
/// @eq{contact-patch}
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
    if (patch.slips || patch.limit == 0.0) {  // the law's own: sliding, or new contact
      share.mu = patch.slips ? p.data.friction.mu : p.data.friction.mu_static;
      continue;
    }
    share.mu = p.data.friction.mu_static * std::max(0.0, 1.0 - patch.held / patch.limit);
    if (!p.data.history.closed) continue;
    share.held = held_by(p.data) * std::min(1.0, patch.limit / std::max(patch.held, 1e-300));
  }
}

/// Updates sticking and sliding of patches. A sticking patch starts to slide as a whole; a sliding
/// one sticks again once none of its points slides. A patch whose load is still growing, so that
/// its points give way in turn, does not slide before it is faster than a body pressed into its
/// band from rest. @eq{contact-patch}
void ContactSet::release_patches(std::span<const BodyStep> steps, double dt) {
  std::vector<Patch> before(pairs_.size()), after(pairs_.size());
  const double gravity = system_->gravity().norm();
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
    const NormalLaw at_rest = p.data.normal.with_stiffness(p.rest_stiffness);
    patch.depth = std::max(patch.depth, at_rest.depth_under(p.mass * gravity));
    before[p.pair].slips = before[p.pair].slips || p.data.share.slides;
    before[p.pair].limit += p.data.friction.mu_static * p.data.share.load;
    before[p.pair].held += p.data.share.held;
  }
  if (!any) return;
  for (Point& p : points_) {
    if (!belongs(p.data) || p.sensor) continue;
    const Patch &patch = after[p.pair], &last = before[p.pair];
    const bool free = patch.limit == 0.0;
    // Bodies fall to their equilibrium depth in a time √(h/g), and oscillate there for a few of
    // these.
    const double step = gravity * std::abs(dt), falls = std::sqrt(gravity * patch.depth);
    const bool slow = patch.fastest < std::max(kSlowReboundSteps * step, kSwings * falls);
    const double swing = std::max(step, falls) * patch.change;
    const bool settles = !last.slips && slow && swing > kSettles * patch.load * step;
    const bool stands =
        step < falls && patch.fastest < kStands * falls && swing > kStill * patch.load * step;
    const bool all = patch.all_slip || patch.held >= (1.0 - kNearlyAll) * patch.limit;
    const bool mostly = patch.held + last.held >= kMostlyAll * (patch.limit + last.limit);
    const bool goes = all && !stands && (mostly || !slow);
    const bool slips = !free && !settles && (last.slips ? patch.slips : goes);
    p.data.history.slips = slips;
    if (p.touched) p.report.after.slips = slips;
  }
}

}  // namespace polhode::contact
