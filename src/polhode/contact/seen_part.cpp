// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <polhode/contact/seen_part.hpp>
#include <polhode/geometry/nearest.hpp>
#include <polhode/math/sign_change.hpp>

namespace polhode::contact {

namespace {

/// Number of places along an edge at which its distance from a ring, which may have two minima, is
/// compared.
constexpr int kPlaces = 32;

/// Largest depth of a ring below the triangle that it lies on, as a part of its radius.
constexpr double kShallow = 0.02;

/// Unit vector of a direction across the axis of a ring, in axes of the part.
Vec3 across_axis(const Vec3& y) {
  const double q = std::hypot(y.x(), y.y());
  return q > 0.0 ? Vec3(y.x() / q, y.y() / q, 0.0) : Vec3(Vec3::UnitX());
}

}  // namespace

double SeenPart::face(const geometry::Shape& b, int triangle, Sides sides, Nearest& best) const {
  const auto& c = b.triangles[triangle];
  const Vec3 &p = b.corners[c[0]], &q = b.corners[c[1]], &r = b.corners[c[2]];
  Vec3 n = b.planes[triangle].normal;
  double height = n.dot(centre_ - p);
  const bool behind = height < 0.0;
  if (sides != Sides::one && behind) n = -n, height = -height;
  Vec3 to_nearest;
  const double reach = extent(n, to_nearest), distance = height - reach;
  if (height < 0.0) return distance;
  // The lowest place of a ring below the plane may lie beyond the solid, within the ring.
  const bool through = sides == Sides::two_or_through && !behind;
  if (ring_ && distance < (through ? -kShallow * half_.x() : 0.0)) return distance;
  const double part = ring_ ? 1.0 : std::min(1.0, height / reach);
  const Vec3 x = centre_ + part * to_nearest;
  const Vec3 u = q - p, v = r - p, w = x - p, m = u.cross(v);
  const double size = m.squaredNorm(), s = w.cross(v).dot(m) / size, t = u.cross(w).dot(m) / size;
  if (s < 0.0 || t < 0.0 || s + t > 1.0) return distance;
  // Face of least penetration, where several are penetrated.
  if (best.kind != Nearest::face || !(best.distance > distance))
    best = {Nearest::face, triangle, 0.0, distance};
  return distance;
}

Nearest SeenPart::overlap(const geometry::Shape& b) const {
  using Arc = std::pair<double, double>;
  constexpr double kTurn = 2.0 * std::numbers::pi;
  std::vector<Arc> inside{{0.0, kTurn}}, left;
  for (const auto& plane : b.planes) {
    const Height h = height_above(plane);
    if (h.middle >= h.most) return {};
    if (h.middle <= -h.most) continue;
    // Angles of negative height.
    const double half = std::acos(-h.middle / h.most);
    double first = h.highest + half;
    first -= kTurn * std::floor(first / kTurn);
    const double last = first + kTurn - 2.0 * half;
    left.clear();
    for (const Arc& arc : inside)
      for (const double shift : {0.0, kTurn}) {
        const double low = std::max(arc.first, first - shift),
                     high = std::min(arc.second, last - shift);
        if (low < high) left.emplace_back(low, high);
      }
    inside.swap(left);
    if (inside.empty()) return {};
  }
  Nearest best;
  best.distance = -std::numeric_limits<double>::infinity();
  for (int f = 0; f < static_cast<int>(b.planes.size()); ++f) {
    const Height h = height_above(b.planes[f]);
    double lowest = std::numeric_limits<double>::infinity(), angle = 0.0;
    for (const Arc& arc : inside)
      for (double at : {arc.first, arc.second, h.highest + 0.5 * kTurn}) {
        at = arc.first + std::remainder(at - arc.first - 0.5 * kTurn, kTurn) + 0.5 * kTurn;
        if (at > arc.second) at = arc.second;
        const double height = h.middle + h.most * std::cos(at - h.highest);
        if (height < lowest) lowest = height, angle = at;
      }
    if (lowest > best.distance) best = {Nearest::overlap, f, angle, lowest};
  }
  return best;
}

double SeenPart::bound(const Vec3& low, const Vec3& high) const {
  const Vec3 y = axes_.transpose() * (0.5 * (low + high) - centre_);
  const double root = geometry::nearest_on_ellipsoid(half_, y);
  const Vec3 n = y.cwiseQuotient((half_.cwiseAbs2().array() + root).matrix()).normalized();
  if (!n.allFinite()) return -farthest_ - (high - low).norm();
  return n.dot(y) - half_.cwiseProduct(n).norm() - 0.5 * (axes_ * n).cwiseAbs().dot(high - low);
}

double SeenPart::from(const Vec3& y, Vec3& n) const {
  if (ring_) {
    const Vec3 outward = across_axis(y);
    n = y - half_.x() * outward;
    const double distance = n.norm();
    n = distance > 0.0 ? Vec3(n / distance) : outward;
    return distance;
  }
  const double root = geometry::nearest_on_ellipsoid(half_, y);
  n = y.cwiseQuotient((half_.cwiseAbs2().array() + root).matrix()).normalized();
  return n.dot(y) - half_.cwiseProduct(n).norm();
}

double SeenPart::corner(const Vec3& x) const {
  Vec3 n;
  return ring_ ? from(axes_.transpose() * (x - centre_), n) : bound(x, x);
}

void SeenPart::edge(const geometry::Shape& b, int index, Nearest& best) const {
  const Vec3 &p = b.corners[b.edges[index].i], v = b.corners[b.edges[index].j] - p;
  const double middle = std::clamp((centre_ - p).dot(v) / v.squaredNorm(), 0.0, 1.0);
  if ((centre_ - p - middle * v).norm() - farthest_ > best.distance) return;
  const Vec3 X = axes_.transpose() * (p - centre_), V = axes_.transpose() * v;
  const auto at = [&](double t, double& distance) {
    Vec3 n;
    distance = from(X + t * V, n);
    return n.dot(V);
  };
  // The distance from a convex part is convex along the edge: its slope changes sign once.
  const auto refine = [&](double low, double high) {
    double d_low = 0.0, d_high = 0.0;
    const double s_low = at(low, d_low), s_high = at(high, d_high);
    const auto take = [&](double t, double distance) {
      if (!(distance < best.distance)) return;
      if (t == 0.0 || t == 1.0)
        best = {Nearest::corner, t == 0.0 ? b.edges[index].i : b.edges[index].j, 0.0, distance};
      else
        best = {Nearest::edge, index, t, distance};
    };
    if (s_low >= 0.0) return take(low, d_low);
    if (s_high <= 0.0) return take(high, d_high);
    double distance = 0.0;
    const auto slope = [&](double t) { return at(t, distance); };
    const double t = sign_change(slope, low, high, s_low, s_high, 1e-13 * v.norm());
    take(t, distance);
  };
  if (ring_) return around_minima(X, V, middle, at, refine);
  // A convex function lies above its tangent.
  double d_middle = 0.0;
  const double slope = at(middle, d_middle);
  if (d_middle - std::max(slope * middle, -slope * (1.0 - middle)) >= best.distance) return;
  slope < 0.0 ? refine(middle, 1.0) : refine(0.0, middle);
}

SeenPart::Height SeenPart::height_above(const geometry::Shape::Plane& plane) const {
  const Vec3 n = half_.x() * (axes_.transpose() * plane.normal);
  return {plane.normal.dot(centre_) - plane.offset, std::hypot(n.x(), n.y()),
          std::atan2(n.y(), n.x())};
}

double SeenPart::extent(const Vec3& n, Vec3& to_nearest) const {
  const Vec3 along = axes_.transpose() * n;
  if (ring_) {
    to_nearest = -half_.x() * (axes_ * across_axis(along));
    return half_.x() * std::hypot(along.x(), along.y());
  }
  const Vec3 local = half_.cwiseProduct(along);
  const double reach = local.norm();
  to_nearest = -axes_ * half_.cwiseProduct(local) / reach;
  return reach;
}

template <class At, class Refine>
void SeenPart::around_minima(const Vec3& X, const Vec3& V, double middle, const At& at,
                             const Refine& refine) const {
  const double near = (X + middle * V).norm(), far = near + 2.0 * half_.x(),
               along = std::sqrt(far * far - near * near) / V.norm();
  const double first = std::max(0.0, middle - along), last = std::min(1.0, middle + along);
  const auto place = [&](int k) {
    return k == kPlaces ? last : first + (last - first) * k / kPlaces;
  };
  std::array<double, kPlaces + 1> distance{};
  for (int k = 0; k <= kPlaces; ++k) at(place(k), distance[k]);
  for (int k = 0; k <= kPlaces; ++k) {
    const int before = std::max(0, k - 1), after = std::min(kPlaces, k + 1);
    if (distance[k] <= distance[before] && distance[k] <= distance[after])
      refine(place(before), place(after));
  }
}

}  // namespace polhode::contact
