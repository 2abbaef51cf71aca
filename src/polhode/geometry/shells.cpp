// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>

#include <polhode/geometry/ray.hpp>
#include <polhode/geometry/shells.hpp>

namespace polhode::geometry {
namespace {

/// A connected part of a surface.
struct Shell {
  std::vector<std::array<int, 3>> triangles;
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  std::array<int, 6> extremes{};  ///< Its corners furthest along the axes, both ways.
  double six_volumes = 0.0;

  [[nodiscard]] bool may_hold(const Vec3& x) const {
    return (x.array() >= low.array()).all() && (x.array() <= high.array()).all();
  }
};

/// Representative of each point: one number for all points that triangles connect.
std::vector<int> connected(const TriangleSurface& surface) {
  std::vector<int> parent(surface.points.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int i) {
    while (parent[static_cast<std::size_t>(i)] != i)
      i = parent[static_cast<std::size_t>(i)] =
          parent[static_cast<std::size_t>(parent[static_cast<std::size_t>(i)])];
    return i;
  };
  for (const auto& t : surface.triangles)
    for (const int corner : {t[1], t[2]})
      parent[static_cast<std::size_t>(std::max(root(t[0]), root(corner)))] =
          std::min(root(t[0]), root(corner));
  for (std::size_t i = 0; i < parent.size(); ++i) parent[i] = root(static_cast<int>(i));
  return parent;
}

std::vector<Shell> shells_of(const TriangleSurface& surface) {
  const std::vector<int> of = connected(surface);
  std::vector<int> number(of.size(), -1);
  std::vector<Shell> shells;
  const Vec3 origin = surface.points.front();
  for (const auto& t : surface.triangles) {
    int& shell = number[static_cast<std::size_t>(of[static_cast<std::size_t>(t[0])])];
    if (shell < 0) {
      shell = static_cast<int>(shells.size());
      shells.emplace_back();
      shells.back().extremes.fill(t[0]);
    }
    Shell& s = shells[static_cast<std::size_t>(shell)];
    s.triangles.push_back(t);
    std::array<Vec3, 3> x;
    for (std::size_t k = 0; k < 3; ++k) {
      x[k] = surface.points[static_cast<std::size_t>(t[k])];
      for (int axis = 0; axis < 3; ++axis) {
        if (x[k][axis] < s.low[axis]) s.extremes[static_cast<std::size_t>(2 * axis)] = t[k];
        if (x[k][axis] > s.high[axis]) s.extremes[static_cast<std::size_t>(2 * axis + 1)] = t[k];
      }
      s.low = s.low.cwiseMin(x[k]);
      s.high = s.high.cwiseMax(x[k]);
      x[k] -= origin;
    }
    s.six_volumes += x[0].dot(x[1].cross(x[2]));
  }
  return shells;
}

}  // namespace

std::optional<Vec3> misplaced_shell(const TriangleSurface& surface) {
  if (surface.triangles.empty()) return std::nullopt;
  const std::vector<Shell> shells = shells_of(surface);
  if (shells.size() == 1) return std::nullopt;
  double whole = 0.0;
  for (const Shell& s : shells) whole += s.six_volumes;
  const int sign = whole < 0.0 ? -1 : 1;  // of a surface that faces inward as a whole
  for (const Shell& own : shells) {
    const int right = own.six_volumes * sign < 0.0 ? 1 : 0;
    const auto misplaced = [&](int corner) {
      const Vec3& x = surface.points[static_cast<std::size_t>(corner)];
      int winding = 0;
      for (const Shell& other : shells) {
        if (&other == &own || !other.may_hold(x)) continue;
        for (const auto& t : other.triangles)
          winding += crossing(kAnyRay, surface.points[static_cast<std::size_t>(t[0])] - x,
                              surface.points[static_cast<std::size_t>(t[1])] - x,
                              surface.points[static_cast<std::size_t>(t[2])] - x);
      }
      return winding * sign != right;
    };
    if (std::all_of(own.extremes.begin(), own.extremes.end(), misplaced))
      return surface.points[static_cast<std::size_t>(own.extremes[0])];
  }
  return std::nullopt;
}

}  // namespace polhode::geometry
