// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/contact/contact_set.hpp>
#include <polhode/core/assert.hpp>

namespace polhode::contact {

namespace {

/// Number of corners above which a shape is bounded by a ball.
constexpr std::size_t kManyCorners = 64;

/// Bounding box of a shape, grown by `margin`.
geometry::Bounds bounds_of(const geometry::Shape& s, const Vec3& r, const Mat3& Lambda,
                           double margin) {
  if (s.corners.empty() || s.corners.size() > kManyCorners || s.round()) {
    const Vec3 centre = r + Lambda * s.bound_centre;
    const Vec3 half = Vec3::Constant(s.bound_radius + margin);
    return {centre - half, centre + half};
  }
  geometry::Bounds b{Vec3::Constant(std::numeric_limits<double>::infinity()),
                     Vec3::Constant(-std::numeric_limits<double>::infinity())};
  for (const Vec3& X : s.corners) {
    const Vec3 x = r + Lambda * X;
    b.low = b.low.cwiseMin(x);
    b.high = b.high.cwiseMax(x);
  }
  const Vec3 more = Vec3::Constant(s.rounding + margin);
  return {b.low - more, b.high + more};
}

}  // namespace

/// Upper bound of the displacement of any point of the body since its reference placement [m]. A
/// rotation counts by its chord, which is shorter than the arc.
double ContactSet::moved(int body, const Vec3& r, const Mat3& Lambda) const {
  const Reference& from = references_[body];
  if (from.margin < 0.0) return std::numeric_limits<double>::infinity();
  return (r - from.r).norm() +
         (Lambda - from.Lambda).norm() * std::sqrt(0.5) * reach_of_body_[body];
}

void ContactSet::add_points(int a, int b, double dt, std::vector<Point>& points) {
  const geometry::Shape &A = shapes_[a].shape, &B = shapes_[b].shape;
  Point sample;
  sample.a = a, sample.b = b;
  complete_law(sample, dt);
  const auto margin = [&](int shape) {
    return shapes_[shape].body == kGround ? 0.0 : references_[shapes_[shape].body].margin;
  };
  const double near = sample.data.normal.reach() + margin(a) + margin(b);
  const Reference ground, &r_a = reference_of(a, ground), &r_b = reference_of(b, ground);
  const Placement<double> at_a(r_a.r, r_a.Lambda, 0), at_b(r_b.r, r_b.Lambda, 6);
  std::vector<OrderedPair> found;
  near_feature_pairs(A, B, at_a, at_b, near, found);
  for (const OrderedPair& f : found) {
    Point p = sample;
    if (f.swapped) std::swap(p.a, p.b);
    p.data.pair = f.pair;
    p.data.a = &shapes_[p.a].shape;
    p.data.b = &shapes_[p.b].shape;
    p.key = {(static_cast<std::uint64_t>(a) << 32) | static_cast<std::uint64_t>(b), f.key()};
    p.data.history = {};
    p.data.history.stiffness = p.data.normal.stiffness;
    p.data.history.bristle_stiffness = p.data.friction.stiffness;
    p.may_be_closed_form = is_closed_form_point(p.data);
    points.push_back(p);
  }
}

/// Margin of a body: an estimate of its displacement in a few steps of length dt [m].
double ContactSet::margin_of(int body, const BodyStep& s, double dt) const {
  const double ahead = std::abs(dt) * (s.v_n.norm() + s.W_n.norm() * reach_of_body_[body]) +
                       dt * dt * system_->gravity().norm();
  const double size = std::isfinite(size_of_body_[body]) ? size_of_body_[body] : 0.0;
  return std::max(4.0 * ahead, 0.05 * size);
}

/// Stores the placements at t_n as references, with the margins within which candidates stay valid.
void ContactSet::refer(std::span<const BodyStep> steps, const StepContext& context) {
  for (int body = 0; body < static_cast<int>(references_.size()); ++body) {
    Reference& ref = references_[body];
    const BodyStep& s = steps[body];
    ref.margin = std::max(ref.margin, margin_of(body, s, context.dt));
    ref.r = s.r_n;
    ref.Lambda = s.Lambda_n;
  }
}

/// Finds the candidate pairs from the references alone, so that a restarted run is equal bit for
/// bit.
void ContactSet::find_candidates(double dt) {
  const auto margin = [&](const PlacedShape& s) {
    return s.body == kGround ? 0.0 : references_[s.body].margin;
  };
  // Unbounded shapes are paired with all others.
  double widest = default_law_.tolerance;
  for (const auto& [key, law] : laws_) widest = std::max(widest, law.tolerance);
  std::vector<int> bounded, unbounded;
  const Reference ground;
  bounds_.clear();
  for (int i = 0; i < static_cast<int>(shapes_.size()); ++i) {
    const PlacedShape& s = shapes_[i];
    (s.shape.bounded() ? bounded : unbounded).push_back(i);
    if (!s.shape.bounded()) continue;
    const Reference& step = reference_of(i, ground);
    const double tolerance = std::max(widest, 1e-3 * s.shape.detail);
    bounds_.push_back(bounds_of(s.shape, step.r, step.Lambda, margin(s) + tolerance));
  }
  broad_.find(bounds_, near_);
  std::vector<std::pair<int, int>> shape_pairs;
  for (const auto& [i, j] : near_) shape_pairs.emplace_back(bounded[i], bounded[j]);
  for (int u : unbounded)
    for (int i : bounded) {
      const Reference &step = reference_of(i, ground), &base = reference_of(u, ground);
      const geometry::Shape &s = shapes_[i].shape, &plane = shapes_[u].shape;
      const Vec3 centre = step.r + step.Lambda * s.bound_centre;
      const Vec3 normal = base.Lambda * plane.axes.col(2);
      const double height = normal.dot(centre - base.r - base.Lambda * plane.centre);
      if (height < s.bound_radius + margin(shapes_[i]) + 2e-3 * s.size + widest ||
          shapes_[u].body != kGround)
        shape_pairs.emplace_back(std::min(i, u), std::max(i, u));
    }
  std::erase_if(shape_pairs, [&](const auto& p) {
    const PlacedShape &a = shapes_[p.first], &b = shapes_[p.second];
    return !may_meet(a, b) || is_off(a, b);
  });
  std::sort(shape_pairs.begin(), shape_pairs.end());
  POLHODE_ASSERT(is_strictly_ascending(shape_pairs));

  // Pairs of bodies are ordered; the ground is always second.
  const auto bodies = [&](int a, int b) {
    int x = shapes_[a].body, y = shapes_[b].body;
    if (x == kGround || (y != kGround && y < x)) std::swap(x, y);
    return std::pair(x, y);
  };
  std::vector<std::pair<int, int>> body_pairs;
  body_pairs.reserve(shape_pairs.size());
  for (const auto& [a, b] : shape_pairs) body_pairs.push_back(bodies(a, b));
  std::sort(body_pairs.begin(), body_pairs.end());
  body_pairs.erase(std::unique(body_pairs.begin(), body_pairs.end()), body_pairs.end());
  pairs_.clear();
  for (const auto& [a, b] : body_pairs) pairs_.push_back({a, b});
  std::vector<Point> points;
  for (const auto& [a, b] : shape_pairs) {
    const std::size_t first = points.size();
    add_points(a, b, dt, points);
    const auto key = bodies(a, b);
    const auto pair = static_cast<int>(std::lower_bound(body_pairs.begin(), body_pairs.end(), key) -
                                       body_pairs.begin());
    POLHODE_ASSERT(body_pairs[static_cast<std::size_t>(pair)] == key);
    for (std::size_t k = first; k < points.size(); ++k) {
      points[k].pair = pair;
      points[k].swapped = shapes_[points[k].a].body != key.first;
    }
  }
  // Histories are carried over to the new list.
  const auto name = [](const Point& p) {
    return std::array<int, 5>{p.a, p.b, static_cast<int>(p.data.pair.kind), p.data.pair.i,
                              p.data.pair.j};
  };
  std::vector<std::pair<std::array<int, 5>, const Point*>> old;
  for (const Point& p : points_)
    if (p.data.history.remembers()) old.emplace_back(name(p), &p);
  std::sort(old.begin(), old.end());
  if (!old.empty())
    for (Point& p : points) {
      const std::array<int, 5> wanted = name(p);
      const auto found =
          std::lower_bound(old.begin(), old.end(), wanted,
                           [](const auto& entry, const auto& key) { return entry.first < key; });
      if (found == old.end() || found->first != wanted) continue;
      p.data.history = found->second->data.history;
      complete_law(p, dt);
    }
  points_ = std::move(points);
}

bool ContactSet::cover(std::span<const BodyStep> steps, const StepContext& context,
                       std::span<const Vec6> increments) {
  bool leaves = false;
  // The search of statics bounds its increments itself.
  const double part = acts_by_rows() && !context.conserving ? 1.0 : sensible_part(increments);
  const auto ahead = [&](int body) {
    return part * (increments[body].head<3>().norm() +
                   increments[body].tail<3>().norm() * reach_of_body_[body]);
  };
  const auto bodies = static_cast<int>(references_.size());
  for (int body = 0; body < bodies && !leaves; ++body)  // no increment: already checked
    leaves = reach_of_body_[body] > 0.0 && !increments[body].isZero(0.0) &&
             !(moved(body, steps[body].r_n1, steps[body].Lambda_n1) + ahead(body) <
               references_[body].margin);
  if (!leaves) return false;
  const std::vector<Participants> before = pairs_;
  refer(steps, context);
  // The references are now those of t_n; margins count from there, for every body.
  for (int body = 0; body < bodies; ++body) {
    const BodyStep& s = steps[body];
    const double span = moved(body, s.r_n1, s.Lambda_n1) + ahead(body);
    references_[body].margin = std::max(references_[body].margin, 1.5 * span);
  }
  find_candidates(longest_step_);
  open_or_close(steps, context);
  return !std::equal(
      before.begin(), before.end(), pairs_.begin(), pairs_.end(),
      [](const Participants& x, const Participants& y) { return x.a == y.a && x.b == y.b; });
}

}  // namespace polhode::contact
