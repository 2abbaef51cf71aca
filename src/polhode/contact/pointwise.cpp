// SPDX-License-Identifier: Apache-2.0
// Forces and springs of contacts point by point, for iterative solvers.
#include <cmath>
#include <limits>

#include <polhode/contact/contact_set.hpp>

namespace polhode::contact {

namespace {

/// Share of the lagged stiffness for a point that began to slide or reversed, and the part of it
/// that remains at the next iterate.
constexpr double kTurnedBack = 0.5, kShareFades = 0.25;

}  // namespace

/// Damping of reversing slides. Along a slide the force is constant, so Newton moves the point
/// until it slides the other way; the lagged stiffness, force over deflection, bounds the force
/// from above and stops the point in between. @eq{contact-slide-damping}
void ContactSet::damp_slide(Slide& before, PointForce& f) {
  if (f.lag == 0.0) {
    before = {Vec3::Zero(), 0.0, true};
    return;
  }
  const bool turned_back = before.known && !(before.stretch.dot(f.slide) > 0.0);
  before.share = turned_back ? kTurnedBack : kShareFades * before.share;
  before.stretch = f.slide;
  before.known = true;
  f.C += (before.share * f.lag / f.slide.squaredNorm()) * f.slide * f.slide.transpose();
}

std::span<const ActingPoint> ContactSet::evaluate_pointwise(std::span<const BodyStep> steps,
                                                            const StepContext& context,
                                                            std::span<const char> moved) {
  const bool all = moved.empty() || renewed_;
  renewed_ = false;
  std::swap(acting_, acting_before_);
  acting_.clear();
  pointwise_ = true;
  if (all && slides_.size() != points_.size()) slides_.assign(points_.size(), {});
  double least = std::numeric_limits<double>::infinity();
  auto before = acting_before_.begin();
  for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
    const SpherePairCache& balls = balls_[i];
    if (!all && !moved[balls.a] && !moved[balls.b]) {
      while (before != acting_before_.end() && before->point < i) ++before;
      if (before != acting_before_.end() && before->point == i) acting_.push_back(*before);
      continue;
    }
    const BodyStep &a = steps[balls.a], &b = steps[balls.b];
    double gap_1 = 0.0;
    if (balls.holds) {  // most points are only near: only contiguous data are read for them
      gap_1 = balls.gap_n1(a, b);
      if (balls.gap_n >= balls.reach && gap_1 >= balls.reach) continue;
    } else {
      if (least_gap_at_end(points_[i], a, b) >= points_[i].data.normal.reach()) continue;
      gap_1 = gap_at_end(i, a, b);
    }
    if (!acts(i, gap_1, least)) continue;
    const Point& p = points_[i];
    PointForce f = p.plain ? closed_form_force(p.data, p.gap_n, gap_1, a, b, context)
                           : point_force(p.data, a, b, context);
    damp_slide(slides_[i], f);
    acting_.push_back(
        {i,
         {shapes_[p.a].body, shapes_[p.b].body, f.arm_a, f.arm_b, f.C, f.friction_slope, f.normal},
         f.force,
         f.moment_a,
         f.moment_b});
  }
  return acting_;
}

}  // namespace polhode::contact
