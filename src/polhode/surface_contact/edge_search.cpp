// SPDX-License-Identifier: Apache-2.0
// Search for edges that may cross, and limits of their displacements.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <polhode/geometry/broad_phase.hpp>
#include <polhode/surface_contact/conservative_advancement.hpp>
#include <polhode/surface_contact/edge_contact.hpp>

namespace polhode::surface_contact {

namespace {

/// Clearance, in bands, above which all are equal.
constexpr double kFarEdge = 10.0;
/// Factor of 1/a + 1/b for edges of lengths a and b: times their relative displacement it bounds
/// the part of the retraction that their potential advances.
constexpr double kTurn = 25.0;

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
  if (!sides_.left_out.empty())
    for (const auto& [first, last] : sides_.left_out[static_cast<std::size_t>(e)])
      if (f >= first && f <= last) return false;
  if (!self_) return true;
  if (e >= f) return false;
  Vec3 x[4];
  for (int k = 0; k < 4; ++k) x[k] = nodes_.start(end(e, f, k));
  for (int i = 0; i < 2; ++i)
    for (int j = 2; j < 4; ++j)
      if (x[i] == x[j]) return false;
  return of_cables() || nearest_of_edges(x).distance - centre_ + law_.normal.tolerance >=
                            kTogether * law_.normal.tolerance;
}

/// Clearance of two edges: of sharp edges that are not parallel; for round ones to where the
/// potential of the edges and that of their points is infinite.
double EdgeContact::clearance(int e, int f, const Vec3 (&x)[4]) const {
  const EdgePairData own = data(e, f);
  const double m = crossing(x[1] - x[0], x[3] - x[2], own.squares);
  const double left = law_.normal.tolerance - centre_;
  if (!(own.retreat > 0.0))
    return m > 0.0 ? nearest_of_edges(x).distance + left : std::numeric_limits<double>::infinity();
  const double bare = nearest_of_edges(x).distance + left;
  if (m == 1.0 || bare > own.retreat) return bare;
  double least = bare + own.retreat * (1.0 - m);
  for (int side = 0; side < 2; ++side)
    for (int k = 0; k <= own.points[side].parts; ++k) {
      const double place = static_cast<double>(k) / own.points[side].parts;
      const double distance = side == 0 ? nearest_of_edges(x, place, -1.0).distance
                                        : nearest_of_edges(x, -1.0, place).distance;
      least = std::min(least, distance + left + own.behind);
    }
  return least;
}

void EdgeContact::find(Search& s) const {
  const double look = nodes_.look(s.key.data()) + centre_ + law_.normal.tolerance;
  std::vector<geometry::Bounds> boxes;
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
  geometry::BroadPhase().find(boxes, near);
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
  write_start(history);
}

void EdgeContact::begin_at(const NodeStep& instant, double* history) const {
  nodes_.write_instant(instant.x_n1, history);
  write_start(history);
}

/// Writes the start of a history: the node positions of the search. @eq{surface-start}
void EdgeContact::write_start(double* history) const {
  const std::vector<double> x = nodes_.positions(history);
  auto t = read_record<Totals>(history + totals());
  t.sums.gap = least_gap(x.data(), history);
  t.lowered = lowered_for(law_, least_of_terms(x.data(), history));
  write_record(t, history + totals());
}

double EdgeContact::least_of_terms(const double* x, const double* history) const {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [e, f] : search(history).pairs) {
    Vec3 at[4];
    four_ends(e, f, x, at);
    least = std::min(least, clearance(e, f, at) - law_.normal.tolerance);
  }
  return least;
}

/// Smallest gap of round edges, and of sharp edges that are not parallel; NaN if none is near.
double EdgeContact::least_gap(const double* x, const double* history) const {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [e, f] : search(history).pairs) {
    Vec3 at[4];
    four_ends(e, f, x, at);
    if (of_cables() || crossing(at[1] - at[0], at[3] - at[2], data(e, f).squares) > 0.0)
      least = std::min(least, nearest_of_edges(at).distance - sides_.radius);
  }
  return std::isfinite(least) ? least : std::numeric_limits<double>::quiet_NaN();
}

void EdgeContact::clearances(const NodeStep& step, const double* history,
                             std::vector<double>& list) const {
  const std::size_t first = list.size();
  list.resize(first + sides_.first.edges.size(), kFarEdge);
  for (const auto& [e, f] : search(history).pairs) {
    Vec3 x[4];
    four_ends(e, f, step.x_n1, x);
    double& least = list[first + static_cast<std::size_t>(e)];
    least = std::min(least, clearance(e, f, x) / (2.0 * law_.normal.tolerance));
  }
}

/// Admissible part of a displacement. The distance of two edges changes by at most the largest
/// relative displacement of an end of one and one of the other.
double EdgeContact::free_part(const NodeStep& from, const NodeStep& to,
                              const double* history) const {
  double most = nodes_.free_part(from.x_n1, to.x_n1, history);
  for (const auto& [e, f] : search(history).pairs) {
    Vec3 x[4], way[4];
    four_ends(e, f, from.x_n1, x);
    four_ends(e, f, to.x_n1, way);
    const double squares = data(e, f).squares;
    const bool sharp = !of_cables();
    if (sharp && crossing(x[1] - x[0], x[3] - x[2], squares) == 0.0 &&
        crossing(way[1] - way[0], way[3] - way[2], squares) == 0.0)
      continue;
    const auto shortest = [&](int k) {
      return std::min((x[k + 1] - x[k]).norm(), (way[k + 1] - way[k]).norm());
    };
    const double turn =
        sharp ? 0.0 : kTurn * sides_.retreat * (1.0 / shortest(0) + 1.0 / shortest(2));
    for (int k = 0; k < 4; ++k) way[k] -= x[k];
    double length = 0.0;
    for (int i = 0; i < 2; ++i)
      for (int j = 2; j < 4; ++j) length = std::max(length, (way[i] - way[j]).norm());
    // A sharp edge that becomes active only at the end of the displacement is kept away at once.
    const auto clearance_at = [&, e = e, f = f](const Vec3(&at)[4]) {
      return sharp ? nearest_of_edges(at).distance - centre_ + law_.normal.tolerance
                   : clearance(e, f, at);
    };
    length *= 1.0 + turn;
    const double now = clearance_at(x);
    if (now <= 0.0) continue;
    const double least = kLeave * std::min(now, 2.0 * law_.normal.tolerance);
    most = conservative_advancement(most, now, least, length, [&](double part) {
      Vec3 at[4];
      for (int k = 0; k < 4; ++k) at[k] = x[k] + part * way[k];
      return clearance_at(at);
    });
  }
  return most;
}

std::optional<SurfaceOverlap> EdgeContact::overlap(const NodeStep& instant) const {
  std::vector<double> key(nodes_.key_size());
  nodes_.write_instant(instant.x_n1, key.data());
  double deepest = -1.0;
  for (const auto& [e, f] : search(key.data()).pairs) {
    Vec3 x[4];
    four_ends(e, f, instant.x_n1, x);
    const double left = clearance(e, f, x);
    if (of_cables() && !(left > 0.0))
      deepest = std::max(deepest, sides_.radius - nearest_of_edges(x).distance);
    else if (!of_cables() && left < 0.5 * law_.normal.tolerance)
      deepest = std::max({deepest, 0.0, -left});
  }
  if (deepest < 0.0) return {};
  return SurfaceOverlap{.depth = deepest};
}

}  // namespace polhode::surface_contact
