// SPDX-License-Identifier: Apache-2.0
// What contacts tell about the last step, and about a state before a run.
#include <algorithm>
#include <limits>

#include <polhode/base/format.hpp>
#include <polhode/contact/contact_set.hpp>

namespace polhode::contact {

std::vector<ShapePairReport> ContactSet::reports() const {
  std::map<std::pair<int, int>, ShapePairReport> by_pair;
  for (const Point& p : points_) {
    const bool turned = p.a > p.b;
    const std::pair<int, int> key = std::minmax(p.a, p.b);
    const auto [at, fresh] = by_pair.try_emplace(key);
    ShapePairReport& r = at->second;
    if (fresh) {
      r.a = key.first, r.b = key.second;
      r.gap = std::numeric_limits<double>::infinity();
    }
    r.gap = std::min(r.gap, p.report.gap_n1);
    if (!p.touched) continue;
    const double sign = turned ? -1.0 : 1.0;
    r.force += sign * p.report.force;
    r.friction += sign * p.report.friction_force;
    r.normal_force += p.report.normal_force;
    r.point += p.report.normal_force * p.report.point;
    r.dissipated += p.report.work.dissipated + p.impact_loss;
    ++r.points;
    if (p.report.after.slips)
      r.status = ContactStatus::slip;
    else if (r.status == ContactStatus::open)
      r.status = ContactStatus::stick;
  }
  std::vector<ShapePairReport> list;
  for (auto& [key, r] : by_pair) {
    if (r.normal_force > 0.0) r.point /= r.normal_force;
    list.push_back(r);
  }
  return list;
}

std::vector<std::string> ContactSet::overlaps(std::span<const BodyStep> instants) {
  StepContext context;
  context.dt = 1e-2;
  State none;
  begin_step(none, instants, context);
  std::map<std::pair<int, int>, double> deepest;
  for (const Point& p : points_)
    if (p.gap_n <= -p.data.normal.tolerance) {
      double& depth = deepest[std::minmax(p.a, p.b)];
      depth = std::max(depth, -p.gap_n);
    }
  std::vector<std::string> list;
  for (const auto& [key, depth] : deepest)
    list.push_back(format("'{}' in '{}' by {:.3g} m", shapes_[key.first].name,
                          shapes_[key.second].name, depth));
  return list;
}

std::string ContactSet::tightest() const {
  if (tightest_ < 0) return {};
  const Point& p = points_[tightest_];
  return format("contact of '{}' and '{}'", shapes_[p.a].name, shapes_[p.b].name);
}

}  // namespace polhode::contact
