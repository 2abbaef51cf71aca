// SPDX-License-Identifier: Apache-2.0
// Obstacles of a running cable.
#include <polhode/beams/running_cable.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>

namespace polhode {

std::string RunningCable::kind() const {
  std::string kind = "running cable";
  const char* between = " around ";
  for (const WindingSpec& w : spec_.windings) {
    kind += format("{}'{}'", between, w.name);
    between = ", ";
  }
  return kind;
}

void RunningCable::add_windings() {
  nodes_ = spec_.nodes;
  winding_of_.assign(spec_.nodes.size() - 1, -1);
  for (std::size_t k = 0; k < spec_.windings.size(); ++k) {
    const WindingSpec& w = spec_.windings[k];
    const std::string where = format("cables.{}.around.{}", spec_.name, w.name);
    if (friction_)
      throw InputError(where, "cannot be combined with friction",
                       "A cable slides on its obstacles freely: leave friction out");
    if (w.span < 0 || w.span >= static_cast<int>(winding_of_.size()))
      throw InputError(where, "is not between two points of the cable", "Number points from 1");
    int& of = winding_of_[static_cast<std::size_t>(w.span)];
    if (of >= 0)
      throw InputError(where,
                       format("is between the same points as '{}'",
                              spec_.windings[static_cast<std::size_t>(of)].name),
                       "Add a point between the two obstacles");
    of = static_cast<int>(k);
    nodes_.insert(nodes_.end(), w.frame.begin(), w.frame.end());
  }
}

WoundNodes RunningCable::wound_nodes(int winding) const {
  WoundNodes nodes{};
  const WoundNodes places = wound_places(winding);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    nodes[i] = nodes_[static_cast<std::size_t>(places[i])];
  return nodes;
}

WoundNodes RunningCable::wound_places(int winding) const {
  const int span = spec_.windings[static_cast<std::size_t>(winding)].span;
  const int frame = static_cast<int>(spec_.nodes.size()) + 4 * winding;
  return {span, frame, frame + 1, frame + 2, frame + 3, span + 1};
}

void RunningCable::add_wound(const NodeStep& step, bool tangents, Course& c) const {
  c.wound_of.assign(winding_of_.size(), -1);
  for (std::size_t k = 0; k < winding_of_.size(); ++k) {
    const int winding = winding_of_[k];
    if (winding < 0) continue;
    const WoundSpan span = wound_span(spec_.windings[static_cast<std::size_t>(winding)],
                                      wound_nodes(winding), step, tangents);
    if (span.outcome == WoundSpan::Outcome::straight) continue;
    if (span.outcome != WoundSpan::Outcome::wound) {
      c.refused = true;
      return;
    }
    c.wound_of[k] = static_cast<int>(c.wound.size());
    c.wound.push_back({winding, span});
  }
}

CableLineNow RunningCable::line(const NodeStep& instant) const {
  CableLineNow line;
  const auto add = [&](const Vec3& x, int winding) {
    line.points.push_back(x);
    line.winding.push_back(winding);
  };
  add(NodeStep::at(instant.x_n1, spec_.nodes[0]), CableLineNow::kPoint);
  for (std::size_t k = 0; k < winding_of_.size(); ++k) {
    const int winding = winding_of_[k];
    const Vec3 next = NodeStep::at(instant.x_n1, spec_.nodes[k + 1]);
    if (winding < 0) {
      line.lengths.push_back((next - line.points.back()).norm());
      add(next, CableLineNow::kPoint);
      continue;
    }
    const WindingSpec& w = spec_.windings[static_cast<std::size_t>(winding)];
    const Vec6 pi = wound_coordinates(w, wound_nodes(winding), instant.x_n1);
    const auto way = wrap(w.roller, pi.head<3>(), pi.tail<3>(), false);
    const Vec3 middle = NodeStep::at(instant.x_n1, w.frame[0]);
    Mat3 axes;
    for (int i = 0; i < 3; ++i)
      axes.col(i) =
          (NodeStep::at(instant.x_n1, w.frame[static_cast<std::size_t>(i + 1)]) - middle) / w.arm;
    const geometry::Wrapping none;
    const geometry::Wrapping& course = way ? *way : none;
    const std::vector<Vec3> points =
        course.points(w.roller, pi.head<3>(), pi.tail<3>(), geometry::kArcPieces);
    for (std::size_t i = 1; i < points.size(); ++i) {
      const bool on_surface = course.touches && i > 1 && i + 1 < points.size();
      line.lengths.push_back(on_surface ? course.arc / geometry::kArcPieces
                                        : (points[i] - points[i - 1]).norm());
      if (i + 1 < points.size())
        add(middle + axes * points[i], course.touches ? winding : CableLineNow::kFree);
      else
        add(next, CableLineNow::kPoint);
    }
  }
  return line;
}

}  // namespace polhode
