// SPDX-License-Identifier: Apache-2.0
// Which triangles a point of a solid's surface may meet, and how far nodes may move until these
// have to be looked for again.
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/assembly/nodes.hpp>
#include <polhode/contact/broad_phase.hpp>
#include <polhode/contact/nearest.hpp>
#include <polhode/fe/contact/solid_contact.hpp>
#include <polhode/fe/contact/solid_contact_field.hpp>

namespace polhode {

namespace {

/// Triangles are looked for as far as this part of an edge, at least, ...
constexpr double kLook = 0.3;
/// ... and as far as surfaces went against each other in this many steps like the last one.
constexpr double kLookSteps = 5.0;
/// They are looked for again if fewer steps like the last one are left.
constexpr double kStepsLeft = 2.0;
/// What is left in front of a surface at the end of a way, of what there was at its start.
constexpr double kLeave = 0.1;
/// Ways are followed by advances of the distance's own size, at most so many.
constexpr int kMostAdvances = 200;
/// Less deep than this part of the tolerance is rounding: surfaces touch.
constexpr double kRounding = 1e-6;
/// Clearances beyond this many bands are all alike.
constexpr double kFar = 10.0;
/// Of one surface, places nearer than so many gap tolerances from the start on do not meet.
constexpr double kTogether = 4.0;

double distance_to(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  return (p - contact::nearest_on_triangle(p, a, b, c).nearest).norm();
}

}  // namespace

std::size_t SolidContact::history_size() const {
  return places_size() + kMemory * points_.size() + SurfaceTotals::kCount;
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
  const std::size_t n = places_size();
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
  bool carried = true;
  int carrier = 0, count = 0;
  const auto look = [&](const MeshPoint& at) {
    for (int a = 0; a < at.count; ++a) {
      const auto k = std::lower_bound(reach_.begin(), reach_.end(), at.node[a]) - reach_.begin();
      const int body = carriers_[static_cast<std::size_t>(k)];
      if (count++ == 0) carrier = body;
      carried = carried && body == carrier && body != kFreeNode;
    }
  };
  look(p);
  for (int k = 1; k < 4; ++k) look(corner(point, triangle, k));
  if (carried) return false;
  if (!self_) return true;
  for (int k = 1; k < 4; ++k) {
    const MeshPoint& v = corner(point, triangle, k);
    for (int a = 0; a < p.count; ++a)
      for (int b = 0; b < v.count; ++b)
        if (p.node[a] == v.node[b]) return false;
  }
  Vec3 x[4];
  for (int k = 0; k < 4; ++k) {
    const MeshPoint& at = corner(point, triangle, k);
    x[k].setZero();
    for (int a = 0; a < at.count; ++a) {
      const auto n = std::lower_bound(reach_.begin(), reach_.end(), at.node[a]) - reach_.begin();
      x[k] += at.N[a] * NodeStep::at(start_.data(), static_cast<int>(n));
    }
  }
  return distance_to(x[0], x[1], x[2], x[3]) >= kTogether * law_.normal.tolerance;
}

/// The key holds the places of the nodes of reach_, then how far is looked.
void SolidContact::find(Search& s) const {
  const double look = s.key.back() + 2.0 * law_.normal.tolerance;
  const auto place = [&](const MeshPoint& at) {
    Vec3 x = Vec3::Zero();
    for (int a = 0; a < at.count; ++a) {
      const auto k = std::lower_bound(reach_.begin(), reach_.end(), at.node[a]) - reach_.begin();
      x += at.N[a] * NodeStep::at(s.key.data(), static_cast<int>(k));
    }
    return x;
  };
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
  std::vector<std::vector<int>> columns(reach_.size());
  std::vector<int> together;
  for (std::size_t p = 0, k = 0; p < points_.size(); ++p) {
    together.clear();
    const auto add = [&](const MeshPoint& m) {
      for (int a = 0; a < m.count; ++a) together.push_back(m.node[a]);
    };
    for (; k < met.size() && met[k].first == static_cast<int>(p); ++k) {
      if (together.empty()) add(points_[p]);
      s.triangle.push_back(met[k].second);
      for (int c = 1; c < 4; ++c) add(corner(static_cast<int>(p), met[k].second, c));
    }
    s.first[p + 1] = static_cast<int>(s.triangle.size());
    std::sort(together.begin(), together.end());
    together.erase(std::unique(together.begin(), together.end()), together.end());
    for (const int i : together) {
      auto& row = columns[static_cast<std::size_t>(
          std::lower_bound(reach_.begin(), reach_.end(), i) - reach_.begin())];
      row.insert(row.end(), together.begin(), together.end());
    }
  }
  s.blocks = {};
  s.row_start.assign(1, 0);
  for (std::size_t r = 0; r < reach_.size(); ++r) {
    std::sort(columns[r].begin(), columns[r].end());
    columns[r].erase(std::unique(columns[r].begin(), columns[r].end()), columns[r].end());
    s.blocks.row.insert(s.blocks.row.end(), columns[r].size(), reach_[r]);
    s.blocks.column.insert(s.blocks.column.end(), columns[r].begin(), columns[r].end());
    s.row_start.push_back(static_cast<int>(s.blocks.column.size()));
  }
}

void SolidContact::add_blocks(const Search& s, const MeshPoint& row, const MeshPoint& column,
                              const Mat3& K, double* tangent) const {
  for (int a = 0; a < row.count; ++a) {
    const auto r = static_cast<std::size_t>(
        std::lower_bound(reach_.begin(), reach_.end(), row.node[a]) - reach_.begin());
    const auto first = s.blocks.column.begin() + s.row_start[r],
               last = s.blocks.column.begin() + s.row_start[r + 1];
    for (int b = 0; b < column.count; ++b) {
      const auto slot = std::lower_bound(first, last, column.node[b]) - s.blocks.column.begin();
      Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> block(tangent + 9 * slot);
      block += row.N[a] * column.N[b] * K;
    }
  }
}

void SolidContact::deviations(const double* x, const double* places,
                              std::vector<double>& far) const {
  const auto n = static_cast<int>(reach_.size());
  const auto moved = [&](int k) -> Vec3 {
    return NodeStep::at(x, reach_[static_cast<std::size_t>(k)]) - NodeStep::at(places, k);
  };
  Vec3 mean = Vec3::Zero();
  for (int k = 0; k < n; ++k) mean += moved(k);
  mean /= n;
  far.clear();
  for (int k = 0; k < n; ++k) far.push_back((moved(k) - mean).norm());
}

void SolidContact::initialize(double* history) const {
  std::fill_n(history, history_size(), 0.0);
  std::copy(start_.begin(), start_.end(), history);
  history[start_.size()] = std::max(kLook * edge_, kLookSteps * way_);
  note_gap_at_start(history);
}

void SolidContact::renew_search(const NodeStep& step, double* history) const {
  std::vector<double> far, last;
  deviations(step.x_n1, history, far);
  std::vector<double> before;
  for (const int i : reach_)
    for (int c = 0; c < 3; ++c) before.push_back(step.x_n[3 * i + c]);
  deviations(step.x_n1, before.data(), last);
  const double moved = *std::max_element(far.begin(), far.end());
  const double way = *std::max_element(last.begin(), last.end());
  double& look = history[start_.size()];
  if (moved + kStepsLeft * way <= 0.5 * look) return;
  for (std::size_t k = 0; k < reach_.size(); ++k)
    for (int c = 0; c < 3; ++c)
      history[3 * k + static_cast<std::size_t>(c)] = step.x_n1[3 * reach_[k] + c];
  look = std::max(kLook * edge_, kLookSteps * way);
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
  double most = 1.0;
  std::vector<double> far_from, far_to;
  deviations(from.x_n1, history, far_from);
  deviations(to.x_n1, history, far_to);
  const double room_to_move = 0.5 * history[start_.size()];
  for (std::size_t k = 0; k < far_to.size(); ++k)
    if (far_to[k] > room_to_move && far_to[k] > far_from[k])
      most = std::min(most, std::max(0.0, room_to_move - far_from[k]) / (far_to[k] - far_from[k]));

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
    double room = nearest(x, triangles, p).four.distance;
    const double least = kLeave * std::min(room, 2.0 * law_.normal.tolerance);
    if (room - least >= length * most) continue;
    double part = 0.0;
    for (int k = 0; k < kMostAdvances && part < most; ++k) {
      part += (room - least) / length;
      const double a = std::min(part, most);
      room = std::numeric_limits<double>::infinity();
      for (const int t : triangles) {
        const auto& v = surface_.triangles[static_cast<std::size_t>(t)];
        Vec3 corner[3];
        for (std::size_t c = 0; c < 3; ++c) {
          const auto i = static_cast<std::size_t>(v[c]);
          corner[c] = x.vertices[i] + a * (x_to.vertices[i] - x.vertices[i]);
        }
        room = std::min(room, distance_to(Vec3(start + a * way), corner[0], corner[1], corner[2]));
      }
      if (room <= least) break;
    }
    most = std::min(most, part);
  }
  return most;
}

/// A point that is behind the triangle nearest to it is in the other solid.
double SolidContact::overlap(const NodeStep& instant) const {
  std::vector<double> history(places_size());
  for (std::size_t k = 0; k < reach_.size(); ++k)
    for (int c = 0; c < 3; ++c)
      history[3 * k + static_cast<std::size_t>(c)] = instant.x_n1[3 * reach_[k] + c];
  history.back() = kLook * edge_;
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
