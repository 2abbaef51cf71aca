// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/geometry/shells.hpp>
#include <polhode/geometry/triangle_surface.hpp>

namespace polhode::geometry {
namespace {

/// One side of a triangle, named by its lower and higher corner.
struct HalfEdge {
  int low, high;
  bool ascending;  ///< Whether the triangle runs from the lower to the higher corner.
};

std::vector<HalfEdge> sorted_half_edges(const TriangleSurface& surface) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * surface.triangles.size());
  for (const auto& corners : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const int from = corners[k];
      const int to = corners[(k + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), from < to});
    }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return std::tie(a.low, a.high) < std::tie(b.low, b.high);
  });
  return edges;
}

std::string point_text(const Vec3& x) {
  return format("({:.6g}, {:.6g}, {:.6g})", x[0], x[1], x[2]);
}

/// A point in the middle of the surface, the origin that avoids loss of digits for distant
/// coordinates.
Vec3 middle(const TriangleSurface& surface) {
  if (surface.points.empty()) return Vec3::Zero();
  Vec3 least = surface.points.front();
  Vec3 most = least;
  for (const Vec3& x : surface.points) {
    least = least.cwiseMin(x);
    most = most.cwiseMax(x);
  }
  return 0.5 * (least + most);
}

}  // namespace

EdgeReport edge_report(const TriangleSurface& surface) {
  EdgeReport report;
  const std::vector<HalfEdge> edges = sorted_half_edges(surface);
  for (std::size_t begin = 0; begin < edges.size();) {
    std::size_t end = begin + 1;
    while (end < edges.size() && edges[end].low == edges[begin].low &&
           edges[end].high == edges[begin].high)
      ++end;
    const std::size_t users = end - begin;
    const bool sound = users == 2 && edges[begin].ascending != edges[begin + 1].ascending;
    if (users == 1)
      ++report.open;
    else if (users > 2)
      ++report.shared;
    else if (!sound)
      ++report.opposed;
    if (!sound && report.first.empty())
      report.first = format(
          "from {} to {}", point_text(surface.points[static_cast<std::size_t>(edges[begin].low)]),
          point_text(surface.points[static_cast<std::size_t>(edges[begin].high)]));
    begin = end;
  }
  return report;
}

void check_closed(std::string_view where, const TriangleSurface& surface) {
  if (surface.triangles.empty())
    throw InputError(where, "the surface has no triangles", "Export it again as a triangle mesh");
  const EdgeReport report = edge_report(surface);
  const char* hint =
      "A density needs a closed surface: repair it in the program that made it, or give mass and "
      "inertia";
  if (report.open + report.shared > 0)
    throw InputError(where,
                     format("the surface is not closed: {} of its edges belong to one triangle "
                            "only and {} to more than two, the first {}",
                            report.open, report.shared, report.first),
                     hint);
  if (report.opposed > 0)
    throw InputError(where,
                     format("the triangles are not oriented consistently: at {} edges neighbours "
                            "have opposite orientations, the first {}",
                            report.opposed, report.first),
                     hint);
  double area = 0.0;
  for (const auto& [a, b, c] : surface.triangles) {
    const Vec3& origin = surface.points[static_cast<std::size_t>(a)];
    area += 0.5 * (surface.points[static_cast<std::size_t>(b)] - origin)
                      .cross(surface.points[static_cast<std::size_t>(c)] - origin)
                      .norm();
  }
  // A solid of volume V has at least the area of the sphere of V; a folded sheet has area and no
  // volume.
  if (std::abs(signed_volume(surface)) <= 1e-12 * std::pow(area, 1.5))
    throw InputError(where, format("the surface encloses no volume (its area is {:.6g} m²)", area),
                     hint);
  if (const auto corner = misplaced_shell(surface))
    throw InputError(
        where,
        format("the surface has a shell at {} that lies inside another one and faces the same "
               "way, so its volume would count twice",
               point_text(*corner)),
        "Remove it, or turn its triangles over if it is a cavity");
}

double signed_volume(const TriangleSurface& surface) {
  const Vec3 origin = middle(surface);
  double six_volumes = 0.0;
  for (const auto& [i, j, k] : surface.triangles) {
    const Vec3 a = surface.points[static_cast<std::size_t>(i)] - origin;
    const Vec3 b = surface.points[static_cast<std::size_t>(j)] - origin;
    const Vec3 c = surface.points[static_cast<std::size_t>(k)] - origin;
    six_volumes += a.dot(b.cross(c));
  }
  return six_volumes / 6.0;
}

bool orient_outward(TriangleSurface& surface) {
  if (signed_volume(surface) >= 0.0) return false;
  for (auto& corners : surface.triangles) std::swap(corners[1], corners[2]);
  return true;
}

MassProperties mass_properties(const TriangleSurface& surface, double density) {
  // Over the tetrahedron (0, a, b, c) of volume V and with s = a + b + c:
  //   ∫ dV = V,  ∫ x dV = V s/4,  ∫ x⊗x dV = V (a⊗a + b⊗b + c⊗c + s⊗s)/20.
  const Vec3 origin = middle(surface);
  double volume = 0.0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (const auto& [i, j, k] : surface.triangles) {
    const Vec3 a = surface.points[static_cast<std::size_t>(i)] - origin;
    const Vec3 b = surface.points[static_cast<std::size_t>(j)] - origin;
    const Vec3 c = surface.points[static_cast<std::size_t>(k)] - origin;
    const Vec3 s = a + b + c;
    const double V = a.dot(b.cross(c)) / 6.0;
    volume += V;
    first += V / 4.0 * s;
    second +=
        V / 20.0 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose());
  }
  const Vec3 centroid = first / volume;
  const Mat3 central = second - volume * centroid * centroid.transpose();
  return {.mass = density * volume,
          .com = origin + centroid,
          .inertia = density * (central.trace() * Mat3::Identity() - central)};
}

TriangleSurface scaled(TriangleSurface surface, double factor) {
  for (Vec3& x : surface.points) x *= factor;
  return surface;
}

void join_equal_points(TriangleSurface& surface) {
  const auto less = [&](int a, int b) {
    const Vec3& x = surface.points[static_cast<std::size_t>(a)];
    const Vec3& y = surface.points[static_cast<std::size_t>(b)];
    return std::tie(x[0], x[1], x[2]) < std::tie(y[0], y[1], y[2]);
  };
  std::vector<int> order(surface.points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::stable_sort(order.begin(), order.end(), less);

  // Each point is represented by the first of its equals, so the order of the file is kept.
  std::vector<int> representative(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool new_group = i == 0 || less(order[i - 1], order[i]);
    representative[static_cast<std::size_t>(order[i])] =
        new_group ? order[i] : representative[static_cast<std::size_t>(order[i - 1])];
  }
  std::vector<Vec3> points;
  std::vector<int> renumbered(order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    if (representative[i] == static_cast<int>(i)) {
      renumbered[i] = static_cast<int>(points.size());
      points.push_back(surface.points[i]);
    }
  for (auto& corners : surface.triangles)
    for (int& corner : corners)
      corner =
          renumbered[static_cast<std::size_t>(representative[static_cast<std::size_t>(corner)])];
  std::erase_if(surface.triangles, [](const std::array<int, 3>& t) {
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
  });
  surface.points = std::move(points);
}

}  // namespace polhode::geometry
