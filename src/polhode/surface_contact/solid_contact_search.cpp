// SPDX-License-Identifier: Apache-2.0
// Search for the triangles near points of a solid's surface, and limits of node displacements until
// the search has to be repeated.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <polhode/geometry/broad_phase.hpp>
#include <polhode/geometry/nearest.hpp>
#include <polhode/surface_contact/conservative_advancement.hpp>
#include <polhode/surface_contact/solid_contact.hpp>
#include <polhode/surface_contact/solid_contact_field.hpp>

namespace polhode::surface_contact {

namespace {

/// Depth, as a part of the tolerance, below which surfaces count as in contact, not as overlapping.
constexpr double kRounding = 1e-6;
/// Clearance, in bands, above which all are equal.
constexpr double kFar = 10.0;
/// Part of a cable's radius: a smaller distance on the straight displacement of a step is a
/// pass-through.
constexpr double kThrough = 0.5;
/// Part of an increment that remains where it would lead around.
constexpr double kShorter = 0.25;

double distance_to(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  return (p - geometry::nearest_on_triangle(p, a, b, c).nearest).norm();
}

}  // namespace

std::size_t SolidContact::history_size() const { return totals() + SurfaceTotals::kCount; }

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

/// Whether a point and a triangle may be in contact: not if it belongs to the triangle or moves
/// with it, nor, on one surface, if they are near at the start.
bool SolidContact::may_meet(int point, int triangle) const {
  if (!of_cable() && !patch_of_.empty()) {
    const SurfacePatch& patch =
        patches_[static_cast<std::size_t>(patch_of_[static_cast<std::size_t>(triangle)])];
    for (int t = 0; t < patch.triangles(); ++t)
      if (!may_meet_triangle(point, patch.first_triangle + t)) return false;
    return true;
  }
  return may_meet_triangle(point, triangle);
}

bool SolidContact::may_meet_triangle(int point, int triangle) const {
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
  const double look = nodes_.look(s.key.data()) + centre_ + law_.normal.tolerance;
  const auto place = [&](const MeshPoint& at) { return nodes_.place(at, s.key.data()); };
  std::vector<Vec3> vertices;
  for (const MeshPoint& v : surface_.vertices) vertices.push_back(place(v));
  const auto triangles = static_cast<int>(surface_.triangles.size());
  std::vector<geometry::Bounds> boxes;
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
    // Bounding boxes of points are small, but not so small that they need a grid of their own.
    const Vec3 half = Vec3::Constant(1e-3 * size);
    boxes.push_back({at.back() - half, at.back() + half});
  }
  std::vector<std::pair<int, int>> pairs, met;
  geometry::BroadPhase().find(boxes, pairs);
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
      if (of_cable()) continue;
      const auto t = static_cast<std::size_t>(met[k].second);
      for (const int v : patches_[static_cast<std::size_t>(patch_of_[t])].vertex)
        if (v >= 0) add(surface_.vertices[static_cast<std::size_t>(v)]);
    }
    s.first[p + 1] = static_cast<int>(s.triangle.size());
    if (!together.empty()) sets.push_back(std::move(together));
  }
  s.blocks = nodes_.blocks(sets);
}

void SolidContact::initialize(double* history) const {
  std::fill_n(history, history_size(), 0.0);
  nodes_.write_start(history);
  write_start(history);
}

void SolidContact::begin_at(const NodeStep& instant, double* history) const {
  nodes_.write_instant(instant.x_n1, history);
  write_start(history);
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
    const double d = n.triangle < 0 ? kFar : clearance(n.distance) / (2.0 * law_.normal.tolerance);
    list.push_back(std::min(kFar, d));
  }
}

struct SolidContact::Way {
  struct Corner {
    Vec3 at, move;
  };
  struct OnPatch {
    const SurfacePatch* patch;
    std::array<Corner, SurfacePatch::kSize> corner;
  };
  Corner point;
  std::vector<std::array<Corner, 3>> triangles;
  std::vector<OnPatch> patches;
  double width = 0.0;
  double length = 0.0;  ///< Largest relative displacement of a corner and the point.

  Way(const SolidContact& c, const Field& from, const Field& to, std::span<const int> list, int p) {
    const MeshPoint& own = c.points_[static_cast<std::size_t>(p)];
    point.at = own.at(from.nodes);
    point.move = own.at(to.nodes) - point.at;
    if (!c.of_cable()) {
      width = c.width_[static_cast<std::size_t>(p)];
      int last = -1;
      for (const int t : list) {
        const int k = c.patch_of_[static_cast<std::size_t>(t)];
        if (k == last) continue;
        last = k;
        OnPatch& on = patches.emplace_back();
        on.patch = &c.patches_[static_cast<std::size_t>(k)];
        for (std::size_t a = 0; a < on.corner.size(); ++a) {
          if (on.patch->vertex[a] < 0) {
            on.corner[a] = {Vec3::Zero(), Vec3::Zero()};
            continue;
          }
          const auto v = static_cast<std::size_t>(on.patch->vertex[a]);
          on.corner[a] = {from.vertices[v], to.vertices[v] - from.vertices[v]};
          length = std::max(length, on.patch->stretch() * (on.corner[a].move - point.move).norm());
        }
      }
      return;
    }
    for (const int t : list) {
      auto& triangle = triangles.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const auto v =
            static_cast<std::size_t>(c.surface_.triangles[static_cast<std::size_t>(t)][k]);
        triangle[k] = {from.vertices[v], to.vertices[v] - from.vertices[v]};
        length = std::max(length, (triangle[k].move - point.move).norm());
      }
    }
  }
  [[nodiscard]] double distance(double part) const {
    const auto at = [&](const Corner& c) { return Vec3(c.at + part * c.move); };
    double least = std::numeric_limits<double>::infinity();
    const Vec3 p = at(point);
    for (const OnPatch& on : patches) {
      Vec3 x[SurfacePatch::kSize];
      for (std::size_t a = 0; a < on.corner.size(); ++a) x[a] = at(on.corner[a]);
      if (least_distance(*on.patch, p, x) < least)
        least = std::min(least, nearest_of_patch(*on.patch, p, x, width).distance);
    }
    for (const auto& t : triangles)
      least = std::min(least, distance_to(at(point), at(t[0]), at(t[1]), at(t[2])));
    return least;
  }
  /// Whether the point comes nearer than this on the displacement.
  [[nodiscard]] bool comes_nearer(double least) const {
    if (length < least) return false;
    double part = 0.0;
    for (int k = 0; k < kMaxAdvances && part < 1.0; ++k) {
      const double left = distance(part) - least;
      if (left <= kLeave * least) return true;
      part += left / length;
    }
    return false;
  }
};

/// Admissible part of a displacement. The distance of a point to a triangle changes by at most the
/// largest relative displacement of a corner and the point. For cables the displacement of the
/// whole step is checked as well, since iterates could be led around them, see SurfaceContact.
double SolidContact::free_part(const NodeStep& from, const NodeStep& to,
                               const double* history) const {
  double most = nodes_.free_part(from.x_n1, to.x_n1, history);
  for (const RoundLine::Span& span : cable_.spans)
    most = std::min(most, free_of_stretch(span, cable_.most_apart, from, to));
  const Search& s = search(history);
  if (s.triangle.empty()) return most;
  const Field x(surface_, from.x_n1), x_to(surface_, to.x_n1), x_n(surface_, from.x_n);
  const double band = 2.0 * law_.normal.tolerance;
  for (int p = 0; p < static_cast<int>(points_.size()); ++p) {
    const std::span<const int> triangles = found(s, p);
    if (triangles.empty()) continue;
    const Way way(*this, x, x_to, triangles, p);
    if (of_cable() && from.x_n != from.x_n1) {
      const double through = kThrough * cable_.radius;
      const bool beside = !Way(*this, x_n, x, triangles, p).comes_nearer(through);
      if (beside && Way(*this, x_n, x_to, triangles, p).comes_nearer(through))
        most = std::min(most, kShorter);
    }
    const double now = clearance(nearest(x, triangles, p).distance);
    if (now <= 0.0) continue;
    most = conservative_advancement(most, now, kLeave * std::min(now, band), way.length,
                                    [&](double part) { return clearance(way.distance(part)); });
  }
  return most;
}

/// Signed distance of a point, negative if it is behind its nearest triangle, inside the other
/// solid.
double SolidContact::signed_distance(const Field& field, std::span<const int> triangles, int point,
                                     const Nearest& nearest) const {
  // Of triangles with the same nearest point, the one most nearly facing the point decides.
  double side = -std::numeric_limits<double>::infinity();
  for (const int t : triangles) {
    Vec3 at[4];
    four_points(field, point, t, at);
    if (nearest_of_triangle(at).distance > nearest.four.distance * (1.0 + 1e-9)) continue;
    side = std::max(side, (at[2] - at[1]).cross(at[3] - at[1]).dot(at[0] - at[1]));
  }
  return side < 0.0 ? -nearest.four.distance : nearest.four.distance;
}

/// Direction of exit along the distance, or, where that is zero, along the normal of the triangle.
Vec3 SolidContact::way_out(const Field& field, const Nearest& nearest, int point,
                           double signed_distance) const {
  if (nearest.four.distance > kRounding * law_.normal.tolerance)
    return std::copysign(1.0, signed_distance) *
           normal(field, MeshGap::of(nearest.triangle, nearest.four), point);
  Vec3 at[4];
  four_points(field, point, nearest.triangle, at);
  return (at[2] - at[1]).cross(at[3] - at[1]).normalized();
}

std::optional<SurfaceOverlap> SolidContact::overlap(const NodeStep& instant) const {
  std::vector<double> history(nodes_.key_size());
  nodes_.write_instant(instant.x_n1, history.data());
  const Search& s = search(history.data());
  const Field x(surface_, instant.x_n1);
  std::optional<SurfaceOverlap> deepest;
  const auto note = [&](double depth, const Vec3& out) {
    if (!deepest || depth > deepest->depth) deepest = {depth, out};
  };
  for (int p = 0; p < static_cast<int>(points_.size()); ++p) {
    const std::span<const int> triangles = found(s, p);
    const Nearest n = nearest_triangle(x, triangles, p);
    if (n.triangle < 0) continue;
    const double d = signed_distance(x, triangles, p, n);
    const Vec3 out = way_out(x, n, p, d);
    if (of_cable()) {
      const double gap = d - cable_.radius;
      if (gap <= -law_.normal.tolerance) note(-gap, out);
      continue;
    }
    if (n.four.distance < 0.5 * law_.normal.tolerance) note(0.0, out);
    if (!self_ && d < 0.0 && n.four.distance > kRounding * law_.normal.tolerance)
      note(n.four.distance, out);
  }
  return deepest;
}

std::vector<double> SolidContact::gaps_at_start() const {
  std::vector<double> history(nodes_.key_size());
  nodes_.write_start(history.data());
  const std::vector<double> places = nodes_.positions(history.data());
  const Search& s = search(history.data());
  const Field x(surface_, places.data());
  std::vector<double> list;
  for (int p = 0; p < static_cast<int>(points_.size()); ++p) {
    const std::span<const int> triangles = found(s, p);
    const Nearest n = nearest_triangle(x, triangles, p);
    list.push_back(n.triangle < 0 ? std::numeric_limits<double>::quiet_NaN()
                                  : signed_distance(x, triangles, p, n) - cable_.radius);
  }
  return list;
}

}  // namespace polhode::surface_contact
