// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <utility>

#include <polhode/surface_contact/edge_lines.hpp>

namespace polhode::surface_contact {

namespace {

/// Largest cosine of the angle between face normals at a sharp edge: 30 degrees.
constexpr double kSharp = 0.8660254037844387;

}  // namespace

std::vector<double> EdgeLines::shared() const {
  std::vector<double> part(vertices.size(), 0.0);
  for (const auto& edge : edges)
    for (const int end : edge) part[static_cast<std::size_t>(end)] += 1.0;
  for (double& n : part) n = n > 0.0 ? (n - 1.0) / n : 0.0;
  return part;
}

EdgeLines sharp_edges(const MeshSurface& surface, const std::vector<Vec3>& X) {
  std::vector<Vec3> at;
  for (const MeshPoint& v : surface.vertices) {
    Vec3 x = Vec3::Zero();
    for (int a = 0; a < v.count; ++a) x += v.N[a] * X[static_cast<std::size_t>(v.node[a])];
    at.push_back(x);
  }
  struct Side {
    Vec3 normal, opposite;
  };
  std::map<std::pair<int, int>, std::vector<Side>> sides;
  for (const auto& t : surface.triangles) {
    const auto x = [&](std::size_t k) -> const Vec3& {
      return at[static_cast<std::size_t>(t[k % 3])];
    };
    const Vec3 normal = (x(1) - x(0)).cross(x(2) - x(0)).normalized();
    for (std::size_t k = 0; k < 3; ++k)
      sides[std::minmax(t[k], t[(k + 1) % 3])].push_back({normal, x(k + 2)});
  }
  EdgeLines lines;
  std::map<int, int> known;
  const auto vertex = [&](int v) {
    const auto [it, fresh] = known.try_emplace(v, static_cast<int>(lines.vertices.size()));
    if (fresh) lines.vertices.push_back(surface.vertices[static_cast<std::size_t>(v)]);
    return it->second;
  };
  for (const auto& [ends, around] : sides) {
    if (around.size() == 2) {
      const Vec3& from = at[static_cast<std::size_t>(ends.first)];
      const bool outwards = around[0].normal.dot(around[1].opposite - from) < 0.0;
      if (!outwards || around[0].normal.dot(around[1].normal) > kSharp) continue;
    }
    const int a = vertex(ends.first), b = vertex(ends.second);
    lines.edges.push_back({a, b});
  }
  return lines;
}

}  // namespace polhode::surface_contact
