// SPDX-License-Identifier: Apache-2.0
// Which triangles a point of a solid's surface may meet, and how far nodes may move until these
// have to be looked for again.
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/contact/broad_phase.hpp>
#include <polhode/contact/nearest.hpp>
#include <polhode/fe/contact/free_way.hpp>
#include <polhode/fe/contact/solid_contact.hpp>
#include <polhode/fe/contact/solid_contact_field.hpp>

namespace polhode {

namespace {

/// Less deep than this part of the tolerance is rounding: surfaces touch.
constexpr double kRounding = 1e-6;
/// Clearances beyond this many bands are all alike.
constexpr double kFar = 10.0;

double distance_to(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  return (p - contact::nearest_on_triangle(p, a, b, c).nearest).norm();
}

}  // namespace

std::size_t SolidContact::history_size() const {
  return nodes_.key_size() + kMemory * points_.size() + SurfaceTotals::kCount;
}

std::span<const int> SolidContact::found(const Search& s, int point) const {
  const auto p = static_cast<std::size_t>(point);
  return std::span(s.triangle)
      .subspan(static_cast<std::size_t>(s.first[p]),
               static_cast<std::size_t>(s.first[p + 1] - s.first[p]));
}

int SolidContact::candidates(const double* history) const {
  return static_cast<int>(search(history).triangle.size());
}

const SolidContact::Search& SolidContact::search(const double* history) const {
  const std::size_t n = nodes_.key_size();
  if (search_.key.size() != n || !std::equal(history, history + n, search_.key.begin())) {
    search_.key.assign(history, history + n);
    find(search_);
  }
  return search_;
}

/// Not a triangle that it belongs to, nor one that moves with it, nor, of one surface, what was
/// together from the start.
bool SolidContact::may_meet(int point, int triangle) const {
  const MeshPoint& p = points_[static_cast<std::size_t>(point)];
  const auto corner = [&](int k) -> const MeshPoint& { return this->corner(point, triangle, k); };
  if (nodes_.carried_together({&p, &corner(1), &corner(2), &corner(3)})) return false;
  if (!self_) return true;
  Vec3 x[4];
  for (int k = 0; k < 4; ++k) {
    x[k] = nodes_.start(corner(k));
    for (int a = 0; k > 0 && a < p.count; ++a)
      for (int b = 0; b < corner(k).count; ++b)
        if (p.node[a] == corner(k).node[b]) return false;
  }
  return distance_to(x[0], x[1], x[2], x[3]) >= kTogether * law_.normal.tolerance;
}

void SolidContact::find(Search& s) const {
  const double look = nodes_.look(s.key.data()) + 2.0 * law_.normal.tolerance;
  const auto place = [&](const MeshPoint& at) { return nodes_.place(at, s.key.data()); };
  std::vector<Vec3> vertices;
  for (const MeshPoint& v : surface_.vertices) vertices.push_back(place(v));
  const auto triangles = static_cast<int>(surface_.triangles.size());
  std::vector<contact::Bounds> boxes;
  double size = std::numeric_limits<double>::infinity();
  for (const auto& t : surface_.triangles) {
    const Vec3 &a = vertices[static_cast<std::size_t>(t[0])],
               &b = vertices[static_cast<std::size_t>(t[1])],
               &c = vertices[static_cast<std::size_t>(t[2])];
    const Vec3 margin = Vec3::Constant(look);
    boxes.push_back({a.cwiseMin(b).cwiseMin(c) - margin, a.cwiseMax(b).cwiseMax(c) + margin});
    size = std::min(size, (boxes.back().high - boxes.back().low).maxCoeff());
  }
  std::vector<Vec3> at;
  for (const MeshPoint& p : points_) {
    at.push_back(place(p));
    // Boxes of points are small, but not so small that they would want a grid of their own.
    const Vec3 half = Vec3::Constant(1e-3 * size);
    boxes.push_back({at.back() - half, at.back() + half});
  }
  std::vector<std::pair<int, int>> pairs, met;
  contact::BroadPhase().find(boxes, pairs);
  for (const auto& [i, j] : pairs) {
    const int triangle = std::min(i, j), point = std::max(i, j) - triangles;
    if (triangle >= triangles || point < 0 || !may_meet(point, triangle)) continue;
    const auto& t = surface_.triangles[static_cast<std::size_t>(triangle)];
    if (distance_to(at[static_cast<std::size_t>(point)], vertices[static_cast<std::size_t>(t[0])],
                    vertices[static_cast<std::size_t>(t[1])],
                    vertices[static_cast<std::size_t>(t[2])]) <= look)
      met.emplace_back(point, triangle);
  }
  std::sort(met.begin(), met.end());

  s.first.assign(points_.size() + 1, 0);
  s.triangle.clear();
  std::vector<std::vector<int>> sets;
  for (std::size_t p = 0, k = 0; p < points_.size(); ++p) {
    std::vector<int> together;
    const auto add = [&](const MeshPoint& m) {
      together.insert(together.end(), m.node, m.node + m.count);
    };
    for (; k < met.size() && met[k].first == static_cast<int>(p); ++k) {
      if (together.empty()) add(points_[p]);
      s.triangle.push_back(met[k].second);
      for (int c = 1; c < 4; ++c) add(corner(static_cast<int>(p), met[k].second, c));
    }
    s.first[p + 1] = static_cast<int>(s.triangle.size());
    if (!together.empty()) sets.push_back(std::move(together));
  }
  s.blocks = nodes_.blocks(sets);
}

void SolidContact::initialize(double* history) const {
  std::fill_n(history, history_size(), 0.0);
  nodes_.write_start(history);
  note_gap_at_start(history);
}

void SolidContact::clearances(const NodeStep& step, const double* history,
                              std::vector<double>& list) const {
  const Search& s = search(history);
  if (s.triangle.empty()) {
    list.insert(list.end(), points_.size(), kFar);
    return;
  }
  const Field x(surface_, step.x_n1);
  for (int p = 0; p < static_cast<int>(points_.size()); ++p) {
    const Nearest n = nearest(x, found(s, p), p);
    const double d = n.triangle < 0 ? kFar : n.four.distance / (2.0 * law_.normal.tolerance);
    list.push_back(std::min(kFar, d));
  }
}

/// The distance of a point to a triangle changes by no more than the largest way of one of the
/// triangle's corners against the point.
double SolidContact::free_part(const NodeStep& from, const NodeStep& to,
                               const double* history) const {
  double most = nodes_.free_part(from.x_n1, to.x_n1, history);
  const Search& s = search(history);
  if (s.triangle.empty()) return most;
  const Field x(surface_, from.x_n1), x_to(surface_, to.x_n1);
  for (int p = 0; p < static_cast<int>(points_.size()); ++p) {
    const std::span<const int> triangles = found(s, p);
    if (triangles.empty()) continue;
    const MeshPoint& point = points_[static_cast<std::size_t>(p)];
    const Vec3 start = point.at(x.nodes), way = point.at(x_to.nodes) - start;
    double length = 0.0;
    for (const int t : triangles)
      for (const int v : surface_.triangles[static_cast<std::size_t>(t)]) {
        const auto k = static_cast<std::size_t>(v);
        length = std::max(length, (x_to.vertices[k] - x.vertices[k] - way).norm());
      }
    const double room = nearest(x, triangles, p).four.distance;
    const double least = kLeave * std::min(room, 2.0 * law_.normal.tolerance);
    most = free_way(most, room, least, length, [&](double part) {
      double distance = std::numeric_limits<double>::infinity();
      for (const int t : triangles) {
        Vec3 at[3];
        for (std::size_t c = 0; c < 3; ++c) {
          const auto i =
              static_cast<std::size_t>(surface_.triangles[static_cast<std::size_t>(t)][c]);
          at[c] = x.vertices[i] + part * (x_to.vertices[i] - x.vertices[i]);
        }
        distance = std::min(distance, distance_to(Vec3(start + part * way), at[0], at[1], at[2]));
      }
      return distance;
    });
  }
  return most;
}

/// A point that is behind the triangle nearest to it is in the other solid.
double SolidContact::overlap(const NodeStep& instant) const {
  std::vector<double> history(nodes_.key_size());
  nodes_.write_instant(instant.x_n1, history.data());
  const Search& s = search(history.data());
  const Field x(surface_, instant.x_n1);
  double deepest = -1.0;
  for (int p = 0; p < static_cast<int>(points_.size()); ++p) {
    const std::span<const int> triangles = found(s, p);
    const Nearest n = nearest(x, triangles, p);
    if (n.triangle < 0) continue;
    // Of triangles with the same nearest point, the one that is seen most from the front.
    double side = -std::numeric_limits<double>::infinity();
    for (const int t : triangles) {
      Vec3 at[4];
      four_points(x, p, t, at);
      if (nearest_of_triangle(at).distance > n.four.distance * (1.0 + 1e-9)) continue;
      side = std::max(side, (at[2] - at[1]).cross(at[3] - at[1]).dot(at[0] - at[1]));
    }
    if (n.four.distance < 0.5 * law_.normal.tolerance) deepest = std::max(deepest, 0.0);
    if (!self_ && side < 0.0 && n.four.distance > kRounding * law_.normal.tolerance)
      deepest = std::max(deepest, n.four.distance);
  }
  return deepest;
}

}  // namespace polhode
