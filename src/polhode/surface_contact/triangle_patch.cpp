// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include <Eigen/Geometry>

#include <polhode/surface_contact/triangle_patch.hpp>

namespace polhode::surface_contact {

namespace {

using Plane2 = Eigen::Vector2d;

/// Largest number of faces that a triangle is blended with, and of nodes of all their vertices: a
/// MeshPoint holds two patches and a point of a face.
constexpr std::size_t kMostBeside = 30;
constexpr std::size_t kMostPatchNodes = 28;
/// Most faces about a corner.
constexpr int kMostAbout = 32;
/// Iterations, a step in ξ that is rounding, and one below which Newton's method converges without
/// a search, as of quadrilaterals.
constexpr int kMostTriangleSteps = 60;
constexpr double kNoTriangleStep = 1e-15, kTriangleNewton = 1e-6;
/// Barycentric coordinate that is rounding.
constexpr double kAtSide = 1e-14;

/// Barycentric coordinates c + a ξ + b η of the triangle itself.
constexpr double kOwn[3][3] = {{1.0, -1.0, -1.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
/// Directions along the sides λ_k = 0.
const Plane2 kAlong[3] = {{-1.0, 1.0}, {0.0, -1.0}, {1.0, 0.0}};

double barycentric(const double (&of)[3], const Plane2& xi) {
  return of[0] + of[1] * xi[0] + of[2] * xi[1];
}

/// A function of ξ, η and its derivatives by ξ, η, ξξ, ξη, ηη.
struct Jet {
  double v[6] = {1.0, 0.0, 0.0, 0.0, 0.0, 0.0};
};

Jet product(const Jet& a, const Jet& b) {
  Jet p;
  p.v[0] = a.v[0] * b.v[0];
  for (int i = 1; i < 3; ++i) p.v[i] = a.v[i] * b.v[0] + a.v[0] * b.v[i];
  p.v[3] = a.v[3] * b.v[0] + 2.0 * a.v[1] * b.v[1] + a.v[0] * b.v[3];
  p.v[4] = a.v[4] * b.v[0] + a.v[1] * b.v[2] + a.v[2] * b.v[1] + a.v[0] * b.v[4];
  p.v[5] = a.v[5] * b.v[0] + 2.0 * a.v[2] * b.v[2] + a.v[0] * b.v[5];
  return p;
}

/// Step from 0 at λ = −ω to 1 at λ = ω.
Jet step_at(const double (&of)[3], double lambda, double width) {
  Jet s;
  const double t = lambda / width;
  if (t >= 1.0) return s;
  const double d = 0.75 * (1.0 - t * t) / width, dd = -1.5 * t / (width * width);
  s.v[0] = 0.25 * (2.0 - t) * (1.0 + t) * (1.0 + t);
  s.v[1] = d * of[1];
  s.v[2] = d * of[2];
  s.v[3] = dd * of[1] * of[1];
  s.v[4] = dd * of[1] * of[2];
  s.v[5] = dd * of[2] * of[2];
  return s;
}

/// A face at a point, with its b_n.
struct Blend {
  const int* at;
  const double (*of)[3];
  double lambda[3];
  Jet share;
};

/// Share of a face at a point. @returns whether it has one.
bool shares(const int* at, const double (&of)[3][3], const Plane2& xi, double width, Blend& b) {
  b.at = at;
  b.of = of;
  for (int k = 0; k < 3; ++k) {
    b.lambda[k] = barycentric(of[k], xi);
    if (b.lambda[k] <= -width) return false;
  }
  b.share = Jet{};
  for (int k = 0; k < 3; ++k)
    if (b.lambda[k] < width) b.share = product(b.share, step_at(of[k], b.lambda[k], width));
  return b.share.v[0] > 0.0;
}

/// Triangles by the direction in which they run along an edge; −1 where two do.
using Edges = std::map<std::pair<int, int>, int>;

/// Faces in the plane of the first: positions of vertices by their place about a corner.
class Unfolding {
 public:
  Unfolding(const MeshSurface& surface, const std::vector<Vec3>& x, const Edges& edges,
            double smooth)
      : surface_(surface), x_(x), edges_(edges), smooth_(smooth) {}

  struct Flat {
    int face;
    std::array<int, 3> vertex;
    std::array<Plane2, 3> at;
  };

  [[nodiscard]] Flat first(int face) const {
    const auto& v = surface_.faces[static_cast<std::size_t>(face)].vertex;
    Flat f{face, {v[0], v[1], v[2]}, {}};
    f.at[0].setZero();
    const Vec3 e = at(v[1]) - at(v[0]);
    f.at[1] = {e.norm(), 0.0};
    f.at[2] = third(v[0], v[1], v[2], f.at[0], f.at[1]);
    return f;
  }
  /// The face beyond the side from corner k to k + 1, unless the edge is sharp or a border.
  [[nodiscard]] std::optional<Flat> beyond(const Flat& f, std::size_t k) const {
    const int a = f.vertex[k], b = f.vertex[(k + 1) % 3];
    const auto own = edges_.find({a, b}), other = edges_.find({b, a});
    if (own == edges_.end() || own->second < 0 || other == edges_.end() || other->second < 0)
      return {};
    if (normal(f.face).dot(normal(other->second)) < smooth_) return {};
    const auto& v = surface_.faces[static_cast<std::size_t>(other->second)].vertex;
    const int c = v[0] != a && v[0] != b ? v[0] : v[1] != a && v[1] != b ? v[1] : v[2];
    const Plane2 &p = f.at[(k + 1) % 3], &q = f.at[k];
    return Flat{other->second, {b, a, c}, {p, q, third(b, a, c, p, q)}};
  }
  [[nodiscard]] Vec3 normal(int face) const {
    const auto& v = surface_.faces[static_cast<std::size_t>(face)].vertex;
    return (at(v[1]) - at(v[0])).cross(at(v[2]) - at(v[0])).normalized();
  }

 private:
  [[nodiscard]] const Vec3& at(int v) const { return x_[static_cast<std::size_t>(v)]; }
  /// Place of c on the left of the way from a to b, which are at p and q.
  [[nodiscard]] Plane2 third(int a, int b, int c, const Plane2& p, const Plane2& q) const {
    const Vec3 e = (at(b) - at(a)).normalized(), d = at(c) - at(a);
    const double along = d.dot(e), aside = (d - along * e).norm();
    const Plane2 way = (q - p).normalized();
    return p + along * way + aside * Plane2(-way[1], way[0]);
  }

  const MeshSurface& surface_;
  const std::vector<Vec3>& x_;
  const Edges& edges_;
  double smooth_;
};

/// Faces about corner k of a face that no sharp edge parts from it, from both sides of it: about an
/// inner vertex half of them each.
std::vector<Unfolding::Flat> faces_about(const Unfolding& unfolding, const Unfolding::Flat& own,
                                         std::size_t k) {
  const int corner = own.vertex[k];
  std::vector<Unfolding::Flat> ways[2];
  for (int way = 0; way < 2; ++way) {
    Unfolding::Flat f = own;
    while (static_cast<int>(ways[way].size()) < kMostAbout) {
      const auto c = static_cast<std::size_t>(std::find(f.vertex.begin(), f.vertex.end(), corner) -
                                              f.vertex.begin());
      // The side that leaves the corner, or the one that leads to it.
      std::optional<Unfolding::Flat> next = unfolding.beyond(f, way == 0 ? c : (c + 2) % 3);
      if (!next) break;
      if (next->face == own.face) {  // all around
        ways[way].resize(way == 0 ? (ways[way].size() + 1) / 2 : ways[way].size() / 2);
        break;
      }
      f = *next;
      ways[way].push_back(f);
    }
  }
  ways[0].insert(ways[0].end(), ways[1].begin(), ways[1].end());
  return ways[0];
}

}  // namespace

/// @eq{patch-triangles}
PatchWeights triangle_weights(const SurfacePatch& patch, const Plane2& xi, double width) {
  PatchWeights w{};
  width = std::min(width, kRoundedTriangle);
  constexpr int kCorners[3] = {0, 1, 2};
  std::array<Blend, kMostBeside + 1> blends;
  std::size_t count = 0;
  if (width > 0.0) {
    if (shares(kCorners, kOwn, xi, width, blends[0])) count = 1;
    for (const SurfacePatch::Beside& b : patch.beside)
      if (shares(b.at.data(), b.of, xi, width, blends[count])) ++count;
  }
  if (count <= 1) {
    for (std::size_t k = 0; k < 3; ++k) {
      w.of[0][k] = barycentric(kOwn[k], xi);
      w.of[1][k] = kOwn[k][1];
      w.of[2][k] = kOwn[k][2];
    }
    return w;
  }
  double B[6] = {};
  for (std::size_t n = 0; n < count; ++n)
    for (int i = 0; i < 6; ++i) B[i] += blends[n].share.v[i];
  for (std::size_t n = 0; n < count; ++n) {
    const Blend& b = blends[n];
    Jet s;  // b/B
    s.v[0] = b.share.v[0] / B[0];
    for (int i = 1; i < 3; ++i) s.v[i] = (b.share.v[i] - s.v[0] * B[i]) / B[0];
    s.v[3] = (b.share.v[3] - 2.0 * s.v[1] * B[1] - s.v[0] * B[3]) / B[0];
    s.v[4] = (b.share.v[4] - s.v[1] * B[2] - s.v[2] * B[1] - s.v[0] * B[4]) / B[0];
    s.v[5] = (b.share.v[5] - 2.0 * s.v[2] * B[2] - s.v[0] * B[5]) / B[0];
    for (int k = 0; k < 3; ++k) {
      Jet lambda;
      lambda.v[0] = b.lambda[k];
      lambda.v[1] = b.of[k][1];
      lambda.v[2] = b.of[k][2];
      const Jet m = product(s, lambda);
      for (int i = 0; i < 6; ++i) w.of[i][static_cast<std::size_t>(b.at[k])] += m.v[i];
    }
  }
  return w;
}

/// Newton's method with a line search. Each of its steps is the minimum of the quadratic model in
/// the triangle's directions, among those free, along a side, and none.
int descend_triangle(const SurfacePatch& patch, const Vec3 (&from)[SurfacePatch::kSize],
                     double width, double rounding, Plane2& xi, Plane2 (&free)[2],
                     double& outwards) {
  const auto sum = [&](const PatchFoot::Weights& w) {
    Vec3 s = Vec3::Zero();
    for (std::size_t a = 0; a < w.size(); ++a)
      if (w[a] != 0.0) s += w[a] * from[a];
    return s;
  };
  const auto change = [&](int k, const Plane2& s) { return kOwn[k][1] * s[0] + kOwn[k][2] * s[1]; };
  bool held[3] = {false, false, false};
  double tangential = 0.0, size = 0.0;
  for (int iteration = 0; iteration < kMostTriangleSteps; ++iteration) {
    double lambda[3];
    for (double& t : xi) t = std::abs(t) < kAtSide ? 0.0 : t;
    for (int k = 0; k < 3; ++k) {
      lambda[k] = barycentric(kOwn[k], xi);
      if (lambda[k] < kAtSide) lambda[k] = 0.0;
    }
    const PatchWeights w = triangle_weights(patch, xi, width);
    const Vec3 r = sum(w.of[0]), r_x = sum(w.of[1]), r_y = sum(w.of[2]);
    const Plane2 g(r.dot(r_x), r.dot(r_y));
    Eigen::Matrix2d H, bend;
    H << r_x.squaredNorm(), r_x.dot(r_y), r_x.dot(r_y), r_y.squaredNorm();
    tangential = std::sqrt(std::max(0.0, g.dot(H.inverse() * g)));
    size = std::sqrt(H.trace());
    const double mixed = r.dot(sum(w.of[4]));
    bend << r.dot(sum(w.of[3])), mixed, mixed, r.dot(sum(w.of[5]));
    const Eigen::Matrix2d whole = H + bend;
    if (whole(0, 0) > 0.0 && whole.determinant() > 0.0) H = whole;
    // The least value of the model.
    Plane2 step = Plane2::Zero();
    double least = 0.0;
    for (int k = 0; k < 3; ++k) held[k] = lambda[k] == 0.0;
    const auto propose = [&](const Plane2& s, int side) {
      for (int k = 0; k < 3; ++k)
        if (k != side && lambda[k] == 0.0 && change(k, s) < 0.0) return;
      const double value = g.dot(s) + 0.5 * s.dot(H * s);
      if (!(value < least)) return;
      least = value;
      step = s;
      for (int k = 0; k < 3; ++k)
        held[k] = lambda[k] == 0.0 && (k == side || (side < 0 && change(k, s) == 0.0));
    };
    propose(-H.inverse() * g, -1);
    for (int k = 0; k < 3; ++k)
      if (lambda[k] == 0.0)
        propose(-g.dot(kAlong[k]) / kAlong[k].dot(H * kAlong[k]) * kAlong[k], k);
    double most = 1.0;
    for (int k = 0; k < 3; ++k)
      if (const double d = change(k, step); !held[k] && d < -lambda[k])
        most = std::min(most, -lambda[k] / d);
    step *= most;
    const double length = step.lpNorm<Eigen::Infinity>();
    if (!(length > kNoTriangleStep)) break;
    double part = 1.0;
    if (length > kTriangleNewton) {
      const double here = r.squaredNorm();
      const auto square = [&](const Plane2& at) {
        return sum(triangle_weights(patch, at, width).of[0]).squaredNorm();
      };
      while (part > kTriangleNewton && !(square(xi + part * step) < here)) part *= 0.5;
      if (!(part > kTriangleNewton)) break;
    }
    xi += part * step;
  }
  int sides = 0, side = 0;
  bool smooth = true;
  for (int k = 0; k < 3; ++k)
    if (held[k]) {
      ++sides;
      side = k;
      smooth = smooth && patch.goes_on[static_cast<std::size_t>(k)];
    }
  if (sides > 0 && smooth) {
    outwards = tangential;
    if (tangential <= rounding + kAtSide * size) sides = 0;
  }
  if (sides == 0) {
    free[0] = Plane2::UnitX();
    free[1] = Plane2::UnitY();
    return 2;
  }
  free[0] = kAlong[side];
  return sides == 1 ? 1 : 0;
}

void add_faces_beside(const MeshSurface& surface, const std::vector<Vec3>& x, double smooth,
                      std::vector<SurfacePatch>& patches) {
  Edges edges;
  for (std::size_t f = 0; f < surface.faces.size(); ++f)
    for (std::size_t k = 0; surface.faces[f].corners == 3 && k < 3; ++k) {
      const auto& v = surface.faces[f].vertex;
      const auto [it, fresh] = edges.try_emplace({v[k], v[(k + 1) % 3]}, static_cast<int>(f));
      if (!fresh) it->second = -1;
    }
  const Unfolding unfolding(surface, x, edges, smooth);
  for (std::size_t f = 0; f < patches.size(); ++f) {
    SurfacePatch& patch = patches[f];
    if (patch.corners != 3) continue;
    std::vector<int> nodes;
    const auto nodes_with = [&](int vertex) {
      std::vector<int> all = nodes;
      if (surface.vertices.empty()) return all;
      const MeshPoint& v = surface.vertices[static_cast<std::size_t>(vertex)];
      for (int a = 0; a < v.count; ++a)
        if (std::find(all.begin(), all.end(), v.node[a]) == all.end()) all.push_back(v.node[a]);
      return all;
    };
    for (std::size_t k = 0; k < 3; ++k) nodes = nodes_with(patch.vertex[k]);
    const Unfolding::Flat own = unfolding.first(static_cast<int>(f));
    Eigen::Matrix2d J;
    J << own.at[1] - own.at[0], own.at[2] - own.at[0];
    std::vector<int> known{own.face};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto edge = unfolding.beyond(own, (k + 1) % 3);  // opposite to corner k
      patch.goes_on[k] = edge.has_value();
    }
    for (std::size_t k = 0; k < 3; ++k)
      for (const Unfolding::Flat& other : faces_about(unfolding, own, k)) {
        if (std::find(known.begin(), known.end(), other.face) != known.end()) continue;
        known.push_back(other.face);
        SurfacePatch::Beside b;
        std::array<int, SurfacePatch::kSize> vertex = patch.vertex;
        const std::vector<int> before = nodes;
        bool fits = patch.beside.size() < kMostBeside;
        for (std::size_t c = 0; fits && c < 3; ++c) {
          auto at = std::find(vertex.begin(), vertex.end(), other.vertex[c]);
          if (at == vertex.end()) at = std::find(vertex.begin(), vertex.end(), -1);
          fits = at != vertex.end();
          if (!fits) break;
          *at = other.vertex[c];
          nodes = nodes_with(other.vertex[c]);
          fits = nodes.size() <= kMostPatchNodes;
          b.at[c] = static_cast<int>(at - vertex.begin());
        }
        if (!fits) {
          nodes = before;
          continue;
        }
        // λ of the other face at own.at[0] + J ξ.
        Eigen::Matrix2d L;
        L << other.at[1] - other.at[0], other.at[2] - other.at[0];
        const Eigen::Matrix2d inverse = L.inverse();
        const Plane2 c = inverse * (own.at[0] - other.at[0]);
        const Eigen::Matrix2d A = inverse * J;
        const double of[3][3] = {{1.0 - c[0] - c[1], -A(0, 0) - A(1, 0), -A(0, 1) - A(1, 1)},
                                 {c[0], A(0, 0), A(0, 1)},
                                 {c[1], A(1, 0), A(1, 1)}};
        std::copy(&of[0][0], &of[0][0] + 9, &b.of[0][0]);
        patch.vertex = vertex;
        patch.beside.push_back(b);
      }
  }
}

}  // namespace polhode::surface_contact
