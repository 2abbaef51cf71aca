// SPDX-License-Identifier: Apache-2.0
// Contact points that act by impulses: the non-smooth contact law.
#include <algorithm>
#include <cmath>

#include <polhode/contact/contact_set.hpp>
#include <polhode/contact/tube.hpp>
#include <polhode/geometry/triangle_tree.hpp>

namespace polhode {

namespace {

/// Largest part of the approach speed that an overlapping point may return to separate. With at
/// most half of it the next step dissipates at least what this one adds.
constexpr double kComesFree = 0.5;

}  // namespace

/// Smallest normal speed after an impulse. A landing point is slowed down so that it reaches gap 0
/// in the next step. A rebounding point does so in the step after which it would be too close. Both
/// keep p_n (w_n + w_{n+1}) from being positive.
double least_exit_speed(double gap, double w, double restitution, double dt, double slow) {
  const double land = -0.5 * w - gap / dt;
  if (w >= 0.0) return std::min(land, -w);
  const double back = -restitution * w;
  if (restitution == 0.0 || (restitution < 1.0 && back < slow))
    return std::min(land, -kComesFree * w);
  return gap < -(1.5 - 0.5 * restitution) * w * dt ? back : -w - 2.0 * gap / dt;
}

namespace contact {

namespace {

/// Weight of a potential below which a neighbouring point acts instead.
constexpr double kMinWeight = 0.5;
/// Cosine of the angle between the normals at the middle and the start of the step below which the
/// bodies would pass each other.
constexpr double kPasses = 0.5;
/// Rotations and displacements (as a part of the size) below these have no direction.
constexpr double kMinTurn = 1e-6, kMinMove = 1e-6;
/// Largest shift of a point, as a part of the size, and largest rotation of a normal.
constexpr double kMaxShift = 0.1, kMaxTilt = 0.1;
/// Displacement of two edges in a step, as a part of the size, above which they are followed.
constexpr double kFast = 0.02;
/// Distance, as a part of the rounding, below which points of one surface are the same.
constexpr double kSamePlace = 1e-6;

/// Weight of a feature pair's potential, see Fade.
double weight_of(const PointData& d, const Placement<double>& at_a, const Placement<double>& at_b) {
  if (d.pair.fade == Fade::none) return 1.0;
  const FadeDirections<double> f = fade_directions(d.pair, *d.a, *d.b, at_a, at_b);
  const Vec3 e = value(f.a), g = value(f.b);
  const double y = e.dot(g) / std::sqrt(e.squaredNorm() * g.squaredNorm());
  const double x = std::min(1.0, (1.0 - y * y) / d.pair.fade_square), m = x * (2.0 - x);
  if (d.pair.fade == Fade::parallel) return m;
  return y < 0.0 ? 1.0 - m : 0.0;
}

/// Corrects the gap of two edges. Edges are in contact where they cross; their ends are corners,
/// which are paired with the whole solid. Whether the cores have passed through each other follows
/// from the outward sides of the edges.
bool mend_edges(const PointData& d, const BodyStep& a, const BodyStep& b, Gap<double>& g) {
  const Shape::Edge &e = d.a->edges[d.pair.i], &f = d.b->edges[d.pair.j];
  const auto inner = [](const Shape& s, const Shape::Edge& edge, const BodyStep& step,
                        const Vec3& x) {
    const Vec3 p = step.r_n + step.Lambda_n * s.corners[edge.i];
    const Vec3 u = step.Lambda_n * (s.corners[edge.j] - s.corners[edge.i]);
    const double t = (x - p).dot(u) / u.squaredNorm();
    return t > 0.0 && t < 1.0;
  };
  const Vec3 n = value(g.normal), c = value(g.point);
  if (!inner(*d.a, e, a, c) || !inner(*d.b, f, b, c)) return false;
  if (n.dot(b.Lambda_n * f.out - a.Lambda_n * e.out) >= 0.0) return true;
  g.distance = -g.distance - 2.0 * (d.a->rounding + d.b->rounding);
  g.normal = -1.0 * g.normal;
  return true;
}

/// Drops points that cancel. Neighbouring triangles are equally near at a common edge; a point that
/// does not remain after the weights −1 of edges is not a point of the surface.
void drop_cancelled(std::vector<ImpulsePoint>& list, std::size_t first,
                    std::vector<double>& weights) {
  std::size_t kept = first;
  for (std::size_t k = 0; k < weights.size(); ++k)
    if (weights[k] > 0.5) list[kept++] = list[first + k];
  if (!weights.empty()) list.resize(kept);
  weights.clear();
}

/// Placement at the middle of a step. The mean of both orientations is not a rotation, but carries
/// points by exactly u + θ × z̄ over the step.
struct Middle {
  Vec3 r;
  Mat3 Lambda;

  explicit Middle(const BodyStep& s)
      : r(s.r_n + 0.5 * s.u), Lambda(0.5 * (s.Lambda_n + s.Lambda_n1)) {}
};

/// Whether a pair consists of flat pieces: points over triangles, and edges that cross. A contact
/// that rotates involves several such features, and a body that leaves one of them has not left the
/// surface.
bool of_flat_pieces(GapKind kind) {
  return kind == GapKind::edge_edge || kind == GapKind::point_triangle ||
         kind == GapKind::point_edge || kind == GapKind::point_corner;
}

/// Shifts the point, or rotates the normal, so that the relative displacement along the normal
/// equals the change of the gap: permanent contact then does no work. @eq{contact-direction}
void follow_gap(const PointData& d, double change, const BodyStep& a, const BodyStep& b,
                ImpulsePoint& at) {
  const Vec3 turn = a.theta - b.theta, across = at.normal.cross(turn);
  const auto apart = [&] {
    return Vec3(a.u + a.theta.cross(at.place - a.r_n - 0.5 * a.u) - b.u -
                b.theta.cross(at.place - b.r_n - 0.5 * b.u));
  };
  const Vec3 u = apart();
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
bool pierces(const Shape& a, int edge, const Shape& b, const Placement<double>& at_a,
             const Placement<double>& at_b) {
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
  return !balls_[point].holds && !of_flat_pieces(p.data.pair.kind) &&
         least_gap_at_end(p, a, b) < 0.0 && gap_at_end(point, a, b) < std::min(0.0, p.gap_n);
}

int ContactSet::find_points(std::span<const BodyStep> steps, const StepContext& context,
                            std::vector<ImpulsePoint>& list) {
  const double dt = context.dt, slow = kSlowReboundSteps * system_->gravity().norm() * std::abs(dt);
  if (list.empty())
    for (Point& p : points_) p.listed = false;
  const std::size_t before = list.size();
  std::size_t of_pair = before;  // first point of the present pair of shapes
  std::uint64_t last = 0;
  std::vector<double> weights;  // of the points of a pair with a surface of triangles
  for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
    Point& p = points_[i];
    if (p.key[0] != last) {
      drop_cancelled(list, of_pair, weights);
      of_pair = list.size();
      last = p.key[0];
    }
    if (p.listed || p.sensor) continue;
    const BodyStep &a = steps[balls_[i].a], &b = steps[balls_[i].b];
    const bool acted = !p.data.history.impulse.isZero(0.0) && before == 0;
    ImpulsePoint point;
    point.gap = p.gap_n;
    point.normal = p.normal_n;
    point.place = p.place_n;
    const Placement<double> at_a(a.r_n, a.Lambda_n, 0), at_b(b.r_n, b.Lambda_n, 6);
    if (p.data.pair.kind == GapKind::edge_edge) {
      if (!acted && least_gap_at_end(p, a, b) > 0.0) continue;
      Gap<double> g = gap(p.data.pair, *p.data.a, *p.data.b, at_a, at_b);
      if (!mend_edges(p.data, a, b, g)) continue;
      point.gap = g.distance;
      point.normal = value(g.normal);
      point.place = value(g.point);
    }
    const Vec3 &n = point.normal, arm_a = point.place - a.r_n, arm_b = point.place - b.r_n;
    point.velocity = relative(a.v_n, a.Lambda_n * a.W_n, arm_a, b.v_n, b.Lambda_n * b.W_n, arm_b);
    const double w = point.rate = n.dot(point.velocity);
    // Either of them may be stopped by another contact.
    const double of_a = n.dot(a.u + a.theta.cross(arm_a)), of_b = n.dot(b.u + b.theta.cross(arm_b));
    const double way = std::min({of_a - of_b, of_a, -of_b});
    const double least = least_exit_speed(point.gap, w, p.restitution, dt, slow);
    if (!acted && 2.0 * way / dt - w >= least && !rolls_in(i, a, b)) continue;
    if (!balls_[i].holds && weight_of(p.data, at_a, at_b) < kMinWeight) continue;
    point.a = shapes_[p.a].body;
    point.b = shapes_[p.b].body;
    point.restitution = p.restitution;
    const FrictionLaw& f = p.data.friction;
    point.friction = f.mu;
    point.rolling = f.rolling;
    point.torsion = f.torsion;
    point.impulse = p.data.history.impulse;
    point.turning = p.data.history.turning;
    point.size = std::min(p.data.a->detail, p.data.b->detail);
    point.number = i;
    p.listed = true;
    if (p.data.b->solid == Solid::surface) {
      const double near = kSamePlace * (p.data.a->rounding + p.data.b->rounding);
      weights.resize(list.size() - of_pair, 1.0);
      std::size_t k = 0;
      while (k < weights.size() && (list[of_pair + k].place - point.place).norm() > near) ++k;
      if (k < weights.size()) {
        weights[k] += p.data.pair.weight;
        continue;
      }
      weights.push_back(p.data.pair.weight);
    }
    list.push_back(point);
  }
  drop_cancelled(list, of_pair, weights);
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
    const Middle m_a(a), m_b(b);
    Gap<double> g = gap(p.data.pair, *p.data.a, *p.data.b, Placement<double>(m_a.r, m_a.Lambda, 0),
                        Placement<double>(m_b.r, m_b.Lambda, 6));
    if (p.data.pair.kind == GapKind::edge_edge) mend_edges(p.data, a, b, g);
    const Vec3 n = value(g.normal);
    // A point that slides off its triangle belongs to the next one, not to the edge between them.
    const bool leaves = p.data.pair.kind == GapKind::point_triangle && g.feature != 0;
    // The side of edges that have passed through each other follows from their outward sides.
    const Vec3 before = p.data.pair.kind == GapKind::edge_edge ? at.normal : p.normal_n;
    if (!leaves && n.dot(before) > kPasses) {
      at.normal = n.normalized();
      at.place = value(g.point);
    } else {
      at.normal = before;
      at.place = p.place_n + 0.5 * a.u;
      continue;
    }
    if (!of_flat_pieces(p.data.pair.kind))
      follow_gap(p.data, gap_at_end(at.number, a, b) - p.gap_n, a, b, at);
  }
}

double ContactSet::gap_after(std::span<const BodyStep> steps, const ImpulsePoint& point) const {
  const SpherePairCache& balls = balls_[point.number];
  const BodyStep &a = steps[balls.a], &b = steps[balls.b];
  if (balls.holds || !of_flat_pieces(points_[point.number].data.pair.kind))
    return gap_at_end(point.number, a, b);
  // A piece that is left has a gap to the edge of the surface: its plane counts.
  const Vec3 apart = a.u + a.theta.cross(point.place - a.r_n - 0.5 * a.u) - b.u -
                     b.theta.cross(point.place - b.r_n - 0.5 * b.u);
  return point.gap + point.normal.dot(apart);
}

std::optional<std::pair<int, int>> ContactSet::passed(std::span<const BodyStep> steps) const {
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
    const Placement<double> from_a(a.r_n, a.Lambda_n, 0), from_b(b.r_n, b.Lambda_n, 6),
        to_a(a.r_n1, a.Lambda_n1, 0), to_b(b.r_n1, b.Lambda_n1, 6);
    const Shape &A = *p.data.a, &B = *p.data.b;
    const auto [e, f] = std::pair(p.data.pair.i, p.data.pair.j);
    const bool again =
        last >= 0 && points_[last].key[0] == p.key[0] && points_[last].data.pair.i == e;
    if (!by_tube) last = i;
    if ((!again && !by_tube && pierces(A, e, B, to_a, to_b) && !pierces(A, e, B, from_a, from_b)) ||
        (pierces(B, f, A, to_b, to_a) && !pierces(B, f, A, from_b, from_a)))
      return std::pair(shapes_[p.a].body, shapes_[p.b].body);
  }
  return std::nullopt;
}

void ContactSet::report_impulse(Point& p, const ImpulsePoint& at, const ImpulseLoss& loss,
                                double dt) {
  PointReport& r = p.report;
  const double push = at.normal.dot(at.impulse);
  r.normal_force = push / dt;
  r.force = at.impulse / dt;
  r.normal = at.normal;
  r.point = at.place;
  r.friction_force = (at.impulse - push * at.normal) / dt;
  r.work.dissipated = loss.normal + loss.friction;
  r.normal_loss = loss.normal;
  r.after = p.data.history;
  r.after.slips = r.friction_force.norm() >= (1.0 - 1e-9) * at.friction * r.normal_force;
  p.touched = push > 0.0;
}

Work ContactSet::commit_impulses(State& state, std::span<const BodyStep> steps,
                                 const StepContext& context, std::span<const ImpulsePoint> list,
                                 std::span<const ImpulseLoss> losses, const ImpulseSearch& search) {
  Work work;
  search_ = search;
  for (Vec6& w : wrenches_) w.setZero();
  for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
    Point& p = points_[i];
    const BodyStep &a = steps[balls_[i].a], &b = steps[balls_[i].b];
    p.impact_loss = p.friction_loss = 0.0;
    p.touched = false;
    p.report = {};
    p.report.gap_n = p.gap_n;
    p.report.gap_n1 = gap_at_end(i, a, b);
    p.data.history.impulse.setZero();
    p.data.history.turning.setZero();
  }
  for (std::size_t k = 0; k < list.size(); ++k) {
    const ImpulsePoint& at = list[k];
    if (at.impulse.isZero(0.0)) continue;
    Point& p = points_[at.number];
    p.data.history.impulse = at.impulse;
    p.data.history.turning = at.turning;
    report_impulse(p, at, losses[k], context.dt);
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
  // Energy added by Gauss-Seidel sweeps that ended early appears as an error of the balance.
  work.dissipated = std::max(0.0, work.dissipated);
  save(state);
  return work;
}

}  // namespace contact

}  // namespace polhode
