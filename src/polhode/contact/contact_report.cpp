// SPDX-License-Identifier: Apache-2.0
// Reports of contacts: over the last step, and of a state before a run.
#include <algorithm>
#include <limits>
#include <tuple>

#include <polhode/contact/contact_set.hpp>
#include <polhode/contact/fully_enclosed.hpp>
#include <polhode/core/format.hpp>

namespace polhode::contact {

std::vector<ShapePairReport> ContactSet::reports() const {
  // The points of a pair of shapes are consecutive.
  std::vector<ShapePairReport> list;
  std::uint64_t last = 0;
  for (const Point& p : points_) {
    const bool turned = p.a > p.b;
    if (list.empty() || p.key[0] != last) {
      list.emplace_back();
      std::tie(list.back().a, list.back().b) = std::minmax(p.a, p.b);
      list.back().gap = std::numeric_limits<double>::infinity();
      last = p.key[0];
    }
    ShapePairReport& r = list.back();
    r.gap = std::min(r.gap, p.touched || p.report.gap_n1 != 0.0 ? p.report.gap_n1 : p.gap_n);
    if (!p.touched) continue;
    const double sign = turned ? -1.0 : 1.0;
    r.force += sign * p.report.force;
    r.friction += sign * p.report.friction_force;
    r.normal_force += p.report.normal_force;
    r.point += p.report.normal_force * p.report.point;
    r.dissipated += p.report.work.dissipated + p.impact_loss + p.friction_loss;
    r.impact_loss += p.report.normal_loss + p.impact_loss;
    if (p.unresolved) ++r.unresolved;
    if (!p.open_stiffness && p.data.normal.is_near_floor(p.report.gap_n1)) r.near_floor = true;
    if (p.report.normal_force == 0.0) continue;
    ++r.points;
    if (p.report.after.slips)
      r.status = ContactStatus::slip;
    else if (r.status == ContactStatus::open)
      r.status = ContactStatus::stick;
  }
  for (ShapePairReport& r : list)
    if (r.normal_force > 0.0) r.point /= r.normal_force;
  return list;
}

std::vector<TouchingPoint> ContactSet::touching() const {
  std::vector<TouchingPoint> list;
  for (const Point& p : points_)
    if (p.touched && p.report.normal_force != 0.0)
      list.push_back({p.a, p.b, p.report.point, p.report.normal, p.report.force,
                      p.report.friction_force, p.report.gap_n1});
  return list;
}

namespace {

using Overlaps = std::map<std::pair<int, int>, ShapeOverlap>;

/// Shapes that are fully enclosed by surfaces of triangles without being near any triangle.
/// @param touch  (shape, shape) → whether contact between them is allowed.
/// @param at  (shape) → its placement.
template <class Touch, class At>
void add_fully_enclosed(const std::vector<PlacedShape>& shapes, Touch&& touch, At&& at,
                        Overlaps& deepest) {
  const int n = static_cast<int>(shapes.size());
  for (int b = 0; b < n; ++b) {
    const geometry::Shape& B = shapes[b].shape;
    if (B.solid != geometry::Solid::surface) continue;
    for (int a = 0; a < n; ++a) {
      const geometry::Shape& A = shapes[a].shape;
      if (a == b || !A.bounded() || deepest.contains(std::minmax(a, b)) || !touch(a, b)) continue;
      const Placement<double> at_a = at(a), at_b = at(b);
      const Vec3 between = value(at_a.point(A.bound_centre)) - value(at_b.point(B.bound_centre));
      if (between.norm() > A.bound_radius + B.bound_radius) continue;
      const std::optional<FullyEnclosed> found = fully_enclosed(A, B, at_a, at_b);
      if (!found) continue;
      deepest[std::minmax(a, b)] = {std::min(a, b), std::max(a, b), found->depth,
                                    a < b ? found->normal : Vec3(-found->normal)};
    }
  }
}

}  // namespace

std::vector<ShapeOverlap> ContactSet::deepest_overlaps(std::span<const BodyStep> instants) {
  return overlaps_at(State(), instants);
}

std::vector<ShapeOverlap> ContactSet::overlaps_at(const State& state,
                                                  std::span<const BodyStep> instants) {
  StepContext context;
  context.dt = 1e-2;
  begin_step(state, instants, context);
  Overlaps deepest;
  for (const Point& p : points_) {
    if (p.sensor || p.gap_n > -p.data.normal.tolerance) continue;
    ShapeOverlap& found = deepest[std::minmax(p.a, p.b)];
    if (found.depth >= -p.gap_n) continue;
    const BodyStep &a = step_of(p.a, instants), &b = step_of(p.b, instants);
    const Gap<double> g =
        gap(p.data.pair, *p.data.a, *p.data.b, Placement<double>(a.r_n, a.Lambda_n, 0),
            Placement<double>(b.r_n, b.Lambda_n, 6));
    const double sign = p.a < p.b ? 1.0 : -1.0;
    found = {std::min(p.a, p.b), std::max(p.a, p.b), -p.gap_n, sign * value(g.normal)};
  }
  add_fully_enclosed(
      shapes_,
      [&](int a, int b) {
        return may_meet(shapes_[a], shapes_[b]) && !is_off(shapes_[a], shapes_[b]) &&
               !law(a, b).sensor;
      },
      [&](int shape) {
        const BodyStep& step = step_of(shape, instants);
        return Placement<double>(step.r_n, step.Lambda_n, 0);
      },
      deepest);
  std::vector<ShapeOverlap> list;
  list.reserve(deepest.size());
  for (const auto& [key, overlap] : deepest) list.push_back(overlap);
  // Cleared before steps begin: stiffnesses are frozen while points are closed.
  points_.clear();
  pairs_.clear();
  for (Reference& r : references_) r.margin = -1.0;
  loaded_ = false;
  return list;
}

std::vector<std::string> ContactSet::overlaps(std::span<const BodyStep> instants) {
  std::vector<std::string> list;
  for (const ShapeOverlap& o : deepest_overlaps(instants)) list.push_back(words_of(o));
  return list;
}

std::string ContactSet::words_of(const ShapeOverlap& o) const {
  return format("'{}' in '{}' by {:.3g} m", shapes_[o.a].name, shapes_[o.b].name, o.depth);
}

std::string ContactSet::tightest() const {
  if (tightest_ < 0) return {};
  const Point& p = points_[tightest_];
  return format("contact of '{}' and '{}'", shapes_[p.a].name, shapes_[p.b].name);
}

}  // namespace polhode::contact
