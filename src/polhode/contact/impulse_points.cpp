// SPDX-License-Identifier: Apache-2.0
// Contact points that act by impulses: the non-smooth contact law.
#include <algorithm>
#include <cmath>

#include <polhode/contact/contact_set.hpp>
#include <polhode/contact/crossing_edges.hpp>
#include <polhode/contact/impulse_places.hpp>
#include <polhode/contact/point_weight.hpp>
#include <polhode/contact/surface_features.hpp>
#include <polhode/contact/tube.hpp>
#include <polhode/contact_laws/exit_speed.hpp>
#include <polhode/geometry/triangle_tree.hpp>

namespace polhode::contact {

namespace {

/// Rotations and displacements (as a part of the size) below these have no direction.
constexpr double kMinTurn = 1e-6, kMinMove = 1e-6;
/// Largest shift of a point, as a part of the size, and largest rotation of a normal.
constexpr double kMaxShift = 0.1, kMaxTilt = 0.1;
/// Displacement of two edges in a step, as a part of the size, above which they are followed.
constexpr double kFast = 0.02;

/// Placement at the middle of a step. The mean of both orientations is not a rotation, but carries
/// points by exactly u + θ × z̄ over the step. Half the rotation keeps the sizes of round parts, for
/// their distances from edges.
struct Middle {
  Vec3 r;
  Mat3 Lambda;

  Middle(const BodyStep& s, bool keeps_size) : r(s.r_n + 0.5 * s.u) {
    const double half = 1.0 + std::sqrt(1.0 + 0.25 * s.theta.squaredNorm());
    Lambda = keeps_size ? Mat3(cay(Vec3(s.theta / half)) * s.Lambda_n)
                        : Mat3(0.5 * (s.Lambda_n + s.Lambda_n1));
  }
};

/// Shifts the point, or rotates the normal, so that the relative displacement along the normal
/// equals the change of the gap: permanent contact then does no work. @eq{contact-direction}
void follow_gap(const PointData& d, double change, const BodyStep& a, const BodyStep& b,
                ImpulsePoint& at) {
  const Vec3 turn = a.theta - b.theta, across = at.normal.cross(turn);
  const Vec3 u = apart(a, b, at.place);
  const double miss = change - at.normal.dot(u), angle = across.norm();
  if (angle > kMinTurn && std::abs(miss) < kMaxShift * d.length * angle) {
    at.place += miss / (angle * angle) * across;
  } else if (u.norm() > kMinMove * d.length && std::abs(miss) < kMaxTilt * u.norm()) {
    at.normal = (at.normal + miss / u.squaredNorm() * u).normalized();
  }
}

/// Whether a segment passes through a triangle.
bool passes_through(const Vec3& p, const Vec3& q, const Vec3& x, const Vec3& y, const Vec3& z) {
  const Vec3 u = y - x, v = z - x, w = q - p, across = w.cross(v);
  const double volume = u.dot(across);
  if (volume == 0.0) return false;
  const Vec3 from = p - x, other = from.cross(u);
  const double s = from.dot(across) / volume, t = w.dot(other) / volume, k = v.dot(other) / volume;
  return s > 0.0 && t > 0.0 && s + t < 1.0 && k > 0.0 && k < 1.0;
}

/// Whether an edge of a passes through the surface of b. Cores of bodies in contact are apart by
/// their roundings.
bool pierces(const geometry::Shape& a, int edge, const geometry::Shape& b,
             const Placement<double>& at_a, const Placement<double>& at_b) {
  const Vec3 p = at_b.to_body(value(at_a.point(a.corners[a.edges[edge].i]))),
             q = at_b.to_body(value(at_a.point(a.corners[a.edges[edge].j])));
  bool found = false;
  const auto take = [&](int t) {
    const auto& c = b.triangles[t];
    found = found || passes_through(p, q, b.corners[c[0]], b.corners[c[1]], b.corners[c[2]]);
  };
  if (!b.tree) {
    for (int t = 0; t < static_cast<int>(b.triangles.size()); ++t) take(t);
    return found;
  }
  const Vec3 low = p.cwiseMin(q), high = p.cwiseMax(q);
  b.tree->visit(
      [&](const auto& box) {
        return !found && (box.low.array() <= high.array()).all() &&
               (low.array() <= box.high.array()).all();
      },
      take);
  return found;
}

Vec3 relative(const Vec3& v_a, const Vec3& w_a, const Vec3& arm_a, const Vec3& v_b, const Vec3& w_b,
              const Vec3& arm_b) {
  return v_a + w_a.cross(arm_a) - v_b - w_b.cross(arm_b);
}

}  // namespace

bool ContactSet::covers(std::span<const BodyStep> steps) const {
  for (int body = 0; body < static_cast<int>(references_.size()); ++body)
    if (reach_of_body_[body] > 0.0 &&
        !(moved(body, steps[body].r_n1, steps[body].Lambda_n1) < references_[body].margin))
      return false;
  return true;
}

/// Whether the surfaces overlap at the end of a step although the points that were nearest at its
/// start have not approached: the nearest point of a spinning body moves over it.
bool ContactSet::rolls_in(int point, const BodyStep& a, const BodyStep& b) const {
  const Point& p = points_[point];
  return !balls_[point].holds && p.data.pair.kind != GapKind::edge_edge &&
         least_gap_at_end(p, a, b) < 0.0 && gap_at_end(point, a, b) < std::min(0.0, p.gap_n);
}

ImpulsePoint ContactSet::impulse_point(int point, const Gap<double>& at,
                                       std::span<const BodyStep> steps) const {
  const Point& p = points_[point];
  const BodyStep &a = steps[balls_[point].a], &b = steps[balls_[point].b];
  ImpulsePoint made;
  made.a = shapes_[p.a].body;
  made.b = shapes_[p.b].body;
  made.gap = at.distance;
  made.normal = made.normal_n = value(at.normal);
  made.place = made.place_n = value(at.point);
  made.velocity = relative(a.v_n, a.Lambda_n * a.W_n, made.place - a.r_n, b.v_n, b.Lambda_n * b.W_n,
                           made.place - b.r_n);
  made.rate = made.normal.dot(made.velocity);
  made.restitution = p.restitution;
  const FrictionLaw& f = p.data.friction;
  made.friction = made.friction_across = f.mu;
  if (acts_by_rows()) {
    // At the start there is no history: what does not move sticks.
    const bool still =
        (made.velocity - made.rate * made.normal).norm() * longest_step_ < touching_gap();
    const bool sticks = p.data.history.closed ? !p.data.history.slips : still;
    if (f.mu_across > 0.0) made.friction_across = f.mu_across;
    if (sticks && f.mu_static > f.mu && made.friction_across == f.mu)
      made.friction = made.friction_across = f.mu_static;
    made.along = a.Lambda_n * f.direction;
    made.kept = p.data.history.kept;
  }
  made.rolling = f.rolling;
  made.torsion = f.torsion;
  made.size = std::min(p.data.a->detail, p.data.b->detail);
  made.number = point;
  return made;
}

/// Whether a point would approach faster than contact allows if it did not act.
bool ContactSet::must_act(const ImpulsePoint& at, const BodyStep& a, const BodyStep& b,
                          double dt) const {
  if (acts_by_rows())
    return at.gap <= touching_gap() || at.gap + at.normal.dot(apart(a, b, at.place)) < 0.0;
  const double slow = kSlowReboundSteps * system_->gravity().norm() * std::abs(dt);
  const Vec3& n = at.normal;
  // Either of both bodies may be stopped by another contact.
  const double of_a = n.dot(a.u + a.theta.cross(at.place - a.r_n)),
               of_b = n.dot(b.u + b.theta.cross(at.place - b.r_n));
  const double way = std::min({of_a - of_b, of_a, -of_b});
  return 2.0 * way / dt - at.rate < least_exit_speed(at.gap, at.rate, at.restitution, dt, slow);
}

int ContactSet::find_points(std::span<const BodyStep> steps, const StepContext& context,
                            std::vector<ImpulsePoint>& list) {
  const double dt = context.dt;
  if (list.empty()) {
    for (Point& p : points_) p.listed = false;
    start_places_.clear();
  }
  const std::size_t before = list.size();
  for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
    Point& p = points_[i];
    if (p.listed || p.sensor) continue;
    const BodyStep &a = steps[balls_[i].a], &b = steps[balls_[i].b];
    const bool acted = !p.data.history.impulse.isZero(0.0) && before == 0;
    if (is_over_surface(p.data.pair.kind)) {
      find_places(i, steps, dt, acted, list);
      continue;
    }
    Gap<double> at;
    at.distance = p.gap_n;
    at.normal = constant<double>(p.normal_n);
    at.point = constant<double>(p.place_n);
    const Placement<double> at_a(a.r_n, a.Lambda_n, 0), at_b(b.r_n, b.Lambda_n, 6);
    bool enters = acts_by_rows() && gap_at_end(i, a, b) < 0.0;
    if (is_of_edges(p.data.pair.kind)) {
      if (!acted && least_gap_at_end(p, a, b) > 0.0) continue;
      at = gap(p.data.pair, *p.data.a, *p.data.b, at_a, at_b);
      if (!acts_by_rows()) {
        if (!correct_edges(p.data, {at_a, at_b}, at)) continue;
      } else if (p.data.pair.kind == GapKind::edge_edge) {
        enters = have_met(p.data, a, b);
        const std::optional<Crossing> start = crossing(p.data, {at_a, at_b});
        if (!acted && !enters && !(start && start->in_front)) continue;
      }
    }
    ImpulsePoint point = impulse_point(i, at, steps);
    if (!acted && !enters && !must_act(point, a, b, dt) && !rolls_in(i, a, b)) continue;
    if (!balls_[i].holds && !(acts_by_rows() ? is_row_at(p.data, at_a, at_b)
                                             : weight_at(p.data, at_a, at_b) >= kMinWeight))
      continue;
    point.impulse = p.data.history.impulse;
    point.turning = p.data.history.turning;
    p.listed = true;
    list.push_back(point);
  }
  return static_cast<int>(list.size() - before);
}

void ContactSet::place_points(std::span<const BodyStep> steps, std::span<ImpulsePoint> list) const {
  for (ImpulsePoint& at : list) {
    const Point& p = points_[at.number];
    const SpherePairCache& balls = balls_[at.number];
    const BodyStep &a = steps[balls.a], &b = steps[balls.b];
    if (balls.holds) {
      const Vec3 r = a.r_n + 0.5 * a.u;
      double gap_m = 0.0;
      if (balls.distance == 0.0) {
        gap_m = balls.gap_n + 0.5 * balls.offset.dot(a.u);
      } else {
        const Vec3 w = balls.offset + 0.5 * (a.u - b.u);
        const double length = w.norm();
        const Vec3 n = w / length;
        at.normal = n.dot(p.normal_n) > kPasses ? n : p.normal_n;
        gap_m = balls.gap_n + (length - balls.distance);
      }
      at.place = r - (p.data.a->rounding + 0.5 * gap_m) * at.normal;
      continue;
    }
    const GapKind kind = p.data.pair.kind;
    const bool round = !is_of_corner(kind) && kind != GapKind::edge_edge;
    const Middle m_a(a, round), m_b(b, round);
    const Placement<double> at_a(m_a.r, m_a.Lambda, 0), at_b(m_b.r, m_b.Lambda, 6);
    Gap<double> g;
    g.normal = constant<double>(Vec3::Zero());
    if (is_over_surface(p.data.pair.kind)) {
      const double way = p.gap_n - least_gap_at_end(p, a, b);
      const double reach = surface_reach(*p.data.a, *p.data.b) + std::max(0.0, at.gap) + 0.25 * way;
      const auto places = places_over_surface(at.number, reach, {at_a, at_b});
      if (const Gap<double>* same = same_contact(places, at.normal_n)) g = *same;
    } else {
      g = gap(p.data.pair, *p.data.a, *p.data.b, at_a, at_b);
    }
    if (is_of_edges(kind) && !acts_by_rows()) correct_edges(p.data, BothPlaced::at_start(a, b), g);
    const Vec3 n = value(g.normal);
    if (n.dot(at.normal_n) > kPasses) {
      at.normal = n.normalized();
      at.place = value(g.point);
    } else {
      at.normal = at.normal_n;
      at.place = at.place_n + 0.5 * a.u;
      continue;
    }
    if (kind == GapKind::edge_edge && !acts_by_rows()) continue;
    if (const std::optional<double> end = gap_at_end_of(at, steps))
      follow_gap(p.data, *end - at.gap, a, b, at);
  }
}

double ContactSet::gap_after(std::span<const BodyStep> steps, const ImpulsePoint& point) const {
  const SpherePairCache& balls = balls_[point.number];
  const BodyStep &a = steps[balls.a], &b = steps[balls.b];
  if (balls.holds) return gap_at_end(point.number, a, b);
  if (points_[point.number].data.pair.kind != GapKind::edge_edge || acts_by_rows())
    if (const std::optional<double> end = gap_at_end_of(point, steps)) return *end;
  return point.gap + point.normal.dot(apart(a, b, point.place));
}

std::pair<Vec3, Vec3> ContactSet::direction_after(std::span<const BodyStep> steps,
                                                  const ImpulsePoint& at) const {
  const Point& p = points_[at.number];
  const BodyStep &a = steps[balls_[at.number].a], &b = steps[balls_[at.number].b];
  const Vec3 moved = at.place_n + a.u;
  if (is_over_surface(p.data.pair.kind)) return {at.normal, moved};
  const BothPlaced end = BothPlaced::at_end(a, b);
  const Gap<double> g = gap(p.data.pair, *p.data.a, *p.data.b, end.a, end.b);
  const Vec3 n = value(g.normal);
  if (n.dot(at.normal_n) > kPasses) return {n.normalized(), value(g.point)};
  return {at.normal, moved};
}

std::optional<std::pair<int, int>> ContactSet::passed(std::span<const BodyStep> steps) const {
  if (acts_by_rows()) {
    const std::optional<std::pair<int, int>> deepest = overlapping(steps);
    return deepest ? deepest : passing(steps);
  }
  int last = -1;  // edge of the last pair
  for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
    const Point& p = points_[i];
    // The wall of a tube is penetrated from its mouth as well.
    const bool by_tube = p.data.pair.kind == GapKind::round_edge && is_tube(*p.data.a);
    if ((p.data.pair.kind != GapKind::edge_edge && !by_tube) || p.sensor) continue;
    const BodyStep &a = steps[balls_[i].a], &b = steps[balls_[i].b];
    const double least = least_gap_at_end(p, a, b);
    if (least > 0.0 || p.gap_n - least < kFast * std::min(p.data.a->detail, p.data.b->detail))
      continue;
    const BothPlaced from = BothPlaced::at_start(a, b), to = BothPlaced::at_end(a, b);
    const geometry::Shape &A = *p.data.a, &B = *p.data.b;
    const auto [e, f] = std::pair(p.data.pair.i, p.data.pair.j);
    const bool again =
        last >= 0 && points_[last].key[0] == p.key[0] && points_[last].data.pair.i == e;
    if (!by_tube) last = i;
    if ((!again && !by_tube && pierces(A, e, B, to.a, to.b) && !pierces(A, e, B, from.a, from.b)) ||
        (pierces(B, f, A, to.b, to.a) && !pierces(B, f, A, from.b, from.a)))
      return std::pair(shapes_[p.a].body, shapes_[p.b].body);
  }
  return std::nullopt;
}

/// Adds an impulse to the report of its point, which may touch a surface at several places: normal
/// and point are their means by force.
void ContactSet::report_impulse(Point& p, const ImpulsePoint& at, const ImpulseLoss& loss,
                                double dt) {
  PointReport& r = p.report;
  const double push = std::max(0.0, at.normal.dot(at.impulse)) / dt;
  const Vec3 friction = at.impulse / dt - push * at.normal;
  const double part = push > 0.0 ? push / (r.normal_force + push) : p.touched ? 0.0 : 1.0;
  r.normal = ((1.0 - part) * r.normal + part * at.normal).normalized();
  r.point = (1.0 - part) * r.point + part * at.place;
  r.normal_force += push;
  r.force += at.impulse / dt;
  r.friction_force += friction;
  r.work.dissipated += loss.normal + loss.friction;
  r.normal_loss += loss.normal;
  const bool at_bound = push > 0.0 && friction.norm() >= (1.0 - 1e-9) * at.friction * push;
  const bool slips = r.after.slips || (acts_by_rows() ? at.slip > touching_gap() : at_bound);
  r.after = p.data.history;
  r.after.slips = slips;
  p.touched = p.touched || push > 0.0;
}

Work ContactSet::commit_impulses(State& state, std::span<const BodyStep> steps,
                                 const StepContext& context, std::span<const ImpulsePoint> list,
                                 std::span<const ImpulseLoss> losses, const ImpulseSearch& search) {
  Work work;
  search_ = search;
  for (Vec6& w : wrenches_) w.setZero();
  for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
    Point& p = points_[i];
    p.impact_loss = p.friction_loss = p.absorbed = 0.0;
    p.touched = false;
    p.report = {};
    p.report.gap_n = p.gap_n;
    p.report.gap_n1 = p.gap_after = nearest_at_end(i, steps);
    p.data.history.impulse.setZero();
    p.data.history.turning.setZero();
    if (p.gap_after > touching_gap()) p.data.history.kept = 0.0;
  }
  for (std::size_t k = 0; k < list.size(); ++k) {
    const ImpulsePoint& at = list[k];
    Point& p = points_[at.number];
    if (acts_by_rows()) p.gap_after = std::min(p.gap_after, gap_after(steps, at));
    if (at.impulse.isZero(0.0)) continue;
    p.data.history.impulse += at.impulse;
    p.data.history.turning += at.turning;
    const SpherePairCache& balls = balls_[static_cast<std::size_t>(at.number)];
    p.turned = steps[balls.a].theta - steps[balls.b].theta;
    report_impulse(p, at, losses[k], context.dt);
    p.absorbed += losses[k].normal;
    const auto add = [&](int shape, double sign) {
      const int body = shapes_[shape].body;
      if (body == kGround) return;
      const Vec3 arm = at.place - steps[body].r_n - 0.5 * steps[body].u;
      wrenches_[body].head<3>() += sign / context.dt * at.impulse;
      wrenches_[body].tail<3>() += sign / context.dt * (arm.cross(at.impulse) + at.turning);
    };
    add(p.a, 1.0);
    add(p.b, -1.0);
    lost_in_impacts_ += losses[k].normal;
    lost_by_friction_ += losses[k].friction;
    work.dissipated += losses[k].normal + losses[k].friction;
  }
  step_length_ = context.dt;
  touched_ = acts_by_rows() && std::any_of(points_.begin(), points_.end(), [&](const Point& p) {
               return p.data.history.closed || touches(p);
             });
  if (touched_) return work;  // find_rows() follows
  // Energy added by Gauss-Seidel sweeps that ended early appears as an error of the balance.
  work.dissipated = std::max(0.0, work.dissipated);
  save(state);
  return work;
}

}  // namespace polhode::contact
