// SPDX-License-Identifier: Apache-2.0
// Contacts that were rows of a step, at its end: which of them close, stick and open.
#include <algorithm>
#include <cmath>

#include <polhode/contact/contact_set.hpp>
#include <polhode/contact/crossing_edges.hpp>
#include <polhode/contact/impulse_places.hpp>
#include <polhode/contact/point_weight.hpp>

namespace polhode::contact {

double ContactSet::touching_gap() const { return system_->touching_gap(); }

/// The bodies that overlap most at the end of a step, by more than the accuracy of rows.
std::optional<std::pair<int, int>> ContactSet::overlapping(std::span<const BodyStep> steps) const {
  double deepest = -kOverlapGaps * touching_gap();
  std::optional<std::pair<int, int>> pair;
  for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
    const Point& p = points_[static_cast<std::size_t>(i)];
    const BodyStep &a = steps[balls_[i].a], &b = steps[balls_[i].b];
    if (p.sensor || least_gap_at_end(p, a, b) > deepest) continue;
    const BothPlaced end = BothPlaced::at_end(a, b);
    if (!balls_[i].holds && !is_row_at(p.data, end.a, end.b)) continue;
    double gap = nearest_at_end(i, steps);
    if (p.data.pair.kind == GapKind::edge_edge && gap >= 0.0 && have_met(p.data, a, b)) gap = -gap;
    gap -= p.data.history.kept;
    if (gap >= deepest) continue;
    deepest = gap;
    pair = {shapes_[p.a].body, shapes_[p.b].body};
  }
  return pair;
}

/// Whether two edges are a row of their own.
bool ContactSet::crosses_now(const Point& p, const State& state) const {
  const auto motion = [&](int body) {
    return body == kGround ? BodyMotion{} : system_->motion(state, body);
  };
  const BodyMotion a = motion(shapes_[p.a].body), b = motion(shapes_[p.b].body);
  const Mat3 Lambda_a = a.Lambda(), Lambda_b = b.Lambda();  // placements refer to these
  const std::optional<Crossing> found = crossing(p.data, {{a.r, Lambda_a, 0}, {b.r, Lambda_b, 6}});
  return found && found->in_front;
}

/// Adds the torsional and rolling friction of a contact to its row.
/// @returns whether one of them has begun to stick: the bodies have not rotated in the step, but
/// the midpoint rule has reversed their angular velocity.
bool ContactSet::add_turning(const Point& p, const State& state, const Vec3& n,
                             StepRow& row) const {
  const FrictionLaw& f = p.data.friction;
  if (f.torsion == 0.0 && f.rolling == 0.0) return false;
  TurningRow& t = row.turning;
  t.torsion = f.torsion;
  t.rolling = f.rolling;
  t.size = std::min(p.data.a->detail, p.data.b->detail);
  t.impulse = p.data.history.turning;
  const auto omega = [&](int shape) {
    const int body = shapes_[static_cast<std::size_t>(shape)].body;
    return body == kGround ? Vec3(Vec3::Zero()) : system_->motion(state, body).omega();
  };
  const Vec3 turns = (omega(p.a) - omega(p.b)) * step_length_;
  const auto is_zero = [&](double angle) { return std::abs(angle) * t.size <= touching_gap(); };
  const auto across = [&](const Vec3& x) { return Vec3(x - n.dot(x) * n).norm(); };
  const bool acted = row.was_closed && p.touched;
  const bool still = acted && f.torsion > 0.0 && is_zero(n.dot(p.turned)),
             rolls_not = acted && f.rolling > 0.0 && is_zero(across(p.turned));
  t.torsion_stuck = still && is_zero(n.dot(turns));
  t.rolling_stuck = rolls_not && is_zero(across(turns));
  return (still && !t.torsion_stuck) || (rolls_not && !t.rolling_stuck);
}

/// Lists the rows that were closed at t_n or touch at t_{n+1}, if any of them, or one that is
/// listed already, closes or begins to stick: nothing changes otherwise. @eq{velocity-problem}
void ContactSet::find_rows(State& state, std::vector<PairImpact>& list) {
  const std::size_t first = list.size();
  bool changes = std::any_of(list.begin(), list.end(),
                             [](const PairImpact& r) { return r.row && r.row->changes(); });
  for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
    Point& p = points_[static_cast<std::size_t>(i)];
    const PointHistory& h = p.data.history;
    const bool touch = touches(p);
    if (p.sensor || !(touch || h.closed)) continue;
    if (!p.touched && p.data.pair.kind == GapKind::edge_edge && !crosses_now(p, state)) continue;
    PairImpact r = row_at(p, state);
    r.impact.wanted = 0.0;
    r.impact.given = std::abs(step_length_) * p.report.normal_force;
    r.impact.friction_impulse = step_length_ * p.report.friction_force;
    const bool sticks = p.touched && !p.report.after.slips;
    r.row = StepRow{.was_closed = h.closed,
                    .stuck = h.closed && !h.slips && sticks,
                    .stops = h.closed && h.slips && sticks && r.impact.mu > 0.0,
                    .touches = touch,
                    .restitution = p.restitution,
                    .absorbed = p.gap_n <= touching_gap() ? 0.0 : std::max(0.0, p.absorbed)};
    if (add_turning(p, state, r.impact.on_a.head<3>(), *r.row)) r.row->stops = true;
    changes = changes || r.row->changes();
    settling_.push_back(i);
    list.push_back(std::move(r));
  }
  if (changes) return;
  list.erase(list.begin() + static_cast<std::ptrdiff_t>(first), list.end());
  const std::vector<ResolvedImpact> none(settling_.size());
  close_rows(state, none);
  settling_.clear();
}

/// Stores which rows are closed and which stick.
void ContactSet::close_rows(State& state, std::span<const ResolvedImpact> impacts) {
  std::vector<char> listed(points_.size(), 0);
  for (std::size_t k = 0; k < settling_.size(); ++k) {
    const auto i = static_cast<std::size_t>(settling_[k]);
    Point& p = points_[i];
    PointHistory& h = p.data.history;
    listed[i] = 1;
    const ResolvedImpact& s = impacts[k];
    p.touched = p.touched || s.normal > 0.0;
    if (s.solved) {
      h.closed = s.closed;
      h.slips = s.closed && !s.sticks;
    } else {
      h.closed = h.closed && touches(p);
      h.slips = h.closed && p.report.after.slips;
    }
    h.point = p.report.point;
    h.normal = p.report.normal;
    h.pressed = std::abs(step_length_) * p.report.normal_force;
    const FrictionLaw& law = p.data.friction;
    const double most = std::max(law.mu, law.mu_static) * p.report.normal_force;
    h.held = most > 0.0 ? p.report.friction_force.norm() / most : 0.0;
    p.report.after.closed = h.closed;
    p.report.after.slips = h.slips;
  }
  for (std::size_t i = 0; i < points_.size(); ++i)
    if (!listed[i]) points_[i].data.history.closed = points_[i].data.history.slips = false;
  save(state);
}

}  // namespace polhode::contact
