// SPDX-License-Identifier: Apache-2.0
// Which edges may cross, and how far they may go.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <polhode/contact/broad_phase.hpp>
#include <polhode/fe/contact/edge_contact.hpp>
#include <polhode/fe/contact/free_way.hpp>

namespace polhode {

namespace {

/// Clearances beyond this many bands are all alike.
constexpr double kFar = 10.0;

}  // namespace

int EdgeContact::candidates(const double* history) const {
  return static_cast<int>(search(history).pairs.size());
}

const EdgeContact::Search& EdgeContact::search(const double* history) const {
  const std::size_t n = nodes_.key_size();
  if (search_.key.size() != n || !std::equal(history, history + n, search_.key.begin())) {
    search_.key.assign(history, history + n);
    find(search_);
  }
  return search_;
}

void EdgeContact::four_ends(int e, int f, const double* x, Vec3 (&at)[4]) const {
  for (int k = 0; k < 4; ++k) at[k] = end(e, f, k).at(x);
}

bool EdgeContact::may_meet(int e, int f) const {
  if (nodes_.carried_together({&end(e, f, 0), &end(e, f, 1), &end(e, f, 2), &end(e, f, 3)}))
    return false;
  if (!self_) return true;
  if (e >= f) return false;
  Vec3 x[4];
  for (int k = 0; k < 4; ++k) x[k] = nodes_.start(end(e, f, k));
  for (int i = 0; i < 2; ++i)
    for (int j = 2; j < 4; ++j)
      if (x[i] == x[j]) return false;
  return room(nearest_of_edges(x).distance) >= kTogether * law_.normal.tolerance;
}

void EdgeContact::find(Search& s) const {
  const double look = nodes_.look(s.key.data()) + centre_ + law_.normal.tolerance;
  std::vector<contact::Bounds> boxes;
  const auto add = [&](const EdgeLines& lines, double margin) {
    for (const auto& [a, b] : lines.edges) {
      const Vec3 x = nodes_.place(lines.vertices[static_cast<std::size_t>(a)], s.key.data()),
                 y = nodes_.place(lines.vertices[static_cast<std::size_t>(b)], s.key.data());
      boxes.push_back({x.cwiseMin(y).array() - margin, x.cwiseMax(y).array() + margin});
    }
  };
  add(sides_.first, 0.5 * look);
  add(sides_.second, 0.5 * look);
  const auto firsts = static_cast<int>(sides_.first.edges.size());
  std::vector<std::pair<int, int>> near;
  contact::BroadPhase().find(boxes, near);
  s.pairs.clear();
  std::vector<std::vector<int>> sets;
  for (const auto& [i, j] : near) {
    const int e = std::min(i, j), f = std::max(i, j) - firsts;
    if (e >= firsts || f < 0 || !may_meet(e, f)) continue;
    Vec3 x[4];
    for (int k = 0; k < 4; ++k) x[k] = nodes_.place(end(e, f, k), s.key.data());
    if (nearest_of_edges(x).distance <= look) s.pairs.emplace_back(e, f);
  }
  std::sort(s.pairs.begin(), s.pairs.end());
  for (const auto& [e, f] : s.pairs) {
    std::vector<int>& together = sets.emplace_back();
    for (int k = 0; k < 4; ++k) {
      const MeshPoint& p = end(e, f, k);
      together.insert(together.end(), p.node, p.node + p.count);
    }
  }
  s.blocks = nodes_.blocks(sets);
}

void EdgeContact::initialize(double* history) const {
  std::fill_n(history, history_size(), 0.0);
  nodes_.write_start(history);
  memory(history, slots())[offsetof(SurfaceTotals, gap) / sizeof(double)] =
      least_gap(nodes_.positions(history).data(), history);
}

/// Of edges that are not along each other; NaN if none is near.
double EdgeContact::least_gap(const double* x, const double* history) const {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [e, f] : search(history).pairs) {
    Vec3 at[4];
    four_ends(e, f, x, at);
    if (crossing(at[1] - at[0], at[3] - at[2], data(e, f).squares) > 0.0)
      least = std::min(least, nearest_of_edges(at).distance - sides_.radius);
  }
  return std::isfinite(least) ? least : std::numeric_limits<double>::quiet_NaN();
}

void EdgeContact::clearances(const NodeStep& step, const double* history,
                             std::vector<double>& list) const {
  const std::size_t first = list.size();
  list.resize(first + sides_.first.edges.size(), kFar);
  for (const auto& [e, f] : search(history).pairs) {
    Vec3 x[4];
    four_ends(e, f, step.x_n1, x);
    if (crossing(x[1] - x[0], x[3] - x[2], data(e, f).squares) == 0.0) continue;
    double& least = list[first + static_cast<std::size_t>(e)];
    least = std::min(least, room(nearest_of_edges(x).distance) / (2.0 * law_.normal.tolerance));
  }
}

/// The distance of two edges changes by no more than the largest way of an end of one against one
/// of the other.
double EdgeContact::free_part(const NodeStep& from, const NodeStep& to,
                              const double* history) const {
  double most = nodes_.free_part(from.x_n1, to.x_n1, history);
  for (const auto& [e, f] : search(history).pairs) {
    Vec3 x[4], way[4];
    four_ends(e, f, from.x_n1, x);
    four_ends(e, f, to.x_n1, way);
    const double squares = data(e, f).squares;
    if (crossing(x[1] - x[0], x[3] - x[2], squares) == 0.0 &&
        crossing(way[1] - way[0], way[3] - way[2], squares) == 0.0)
      continue;
    for (int k = 0; k < 4; ++k) way[k] -= x[k];
    double length = 0.0;
    for (int i = 0; i < 2; ++i)
      for (int j = 2; j < 4; ++j) length = std::max(length, (way[i] - way[j]).norm());
    const double now = room(nearest_of_edges(x).distance);
    const double least = kLeave * std::min(now, 2.0 * law_.normal.tolerance);
    most = free_way(most, now, least, length, [&](double part) {
      Vec3 at[4];
      for (int k = 0; k < 4; ++k) at[k] = x[k] + part * way[k];
      return room(nearest_of_edges(at).distance);
    });
  }
  return most;
}

double EdgeContact::overlap(const NodeStep& instant) const {
  std::vector<double> key(nodes_.key_size());
  nodes_.write_instant(instant.x_n1, key.data());
  double deepest = -1.0;
  for (const auto& [e, f] : search(key.data()).pairs) {
    Vec3 x[4];
    four_ends(e, f, instant.x_n1, x);
    if (crossing(x[1] - x[0], x[3] - x[2], data(e, f).squares) == 0.0) continue;
    const double left = room(nearest_of_edges(x).distance);
    if (left < 0.5 * law_.normal.tolerance) deepest = std::max({deepest, 0.0, -left});
  }
  return deepest;
}

}  // namespace polhode
