// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <Eigen/Geometry>

#include <polhode/geometry/nearest.hpp>
#include <polhode/surface_contact/surface_patch.hpp>
#include <polhode/surface_contact/triangle_patch.hpp>

namespace polhode::surface_contact {

namespace {

using Point2 = Eigen::Vector2d;

/// Largest cosine of the angle between face normals at a sharp edge: 30 degrees.
constexpr double kSharpPatch = 0.8660254037844387;
/// Position in the grid of the corners of a quadrilateral.
constexpr int kCornerAt[4] = {5, 6, 10, 9};
/// By side from corner k to k + 1: position in the grid of the vertices beyond its two ends.
constexpr int kBeyond[4][2] = {{1, 2}, {7, 11}, {14, 13}, {8, 4}};
/// Place of side k in SurfacePatch::ratio.
constexpr int kRatioOf[4] = {2, 1, 3, 0};
/// Position in the grid of the vertex beyond corner k.
constexpr int kDiagonal[4] = {0, 3, 15, 12};
/// Parameters of the corners of a quadrilateral.
const Point2 kCornerXi[4] = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}};
/// Largest bulge of a patch beyond the ball about its corners, over the ball's radius.
constexpr double kBulge = 0.1;
/// Iterations of the nearest point; a step in ξ that is rounding; one up to which Newton's method
/// converges without a search.
constexpr int kMostSteps = 60;
constexpr double kNoStep = 1e-15, kNewtonStep = 1e-6;
/// Distance of ξ from an end of the face that is rounding.
constexpr double kAtEnd = 1e-14;
/// Rounding of a sum of the weighted positions of a patch, over the largest of them.
constexpr double kPlaceRounding = 16.0 * std::numeric_limits<double>::epsilon();

/// Weights of four points in a row and their derivatives. @eq{patch-weights}
struct Row {
  double m[4], d[4], dd[4];
};

Row row_of(double t, double before, double after, double width) {
  Row r{{0.0, 1.0 - t, t, 0.0}, {0.0, -1.0, 1.0, 0.0}, {0.0, 0.0, 0.0, 0.0}};
  // Half of what the slope differs from that of the neighbour, from s = 0 at the edge.
  const auto round = [&](double ratio, double s, double way, int outer, int near, int far) {
    if (!(ratio > 0.0) || !(s < width)) return;
    const double a = s / width;
    const double psi[3] = {0.5 * s * (1.0 - a) * (1.0 - a), 0.5 * way * (1.0 - a) * (1.0 - 3.0 * a),
                           (3.0 * a - 2.0) / width};
    double* const out[3] = {r.m, r.d, r.dd};
    for (int k = 0; k < 3; ++k) {
      out[k][outer] -= ratio * psi[k];
      out[k][near] += (ratio + 1.0) * psi[k];
      out[k][far] -= psi[k];
    }
  };
  round(before, t, 1.0, 0, 1, 2);
  round(after, 1.0 - t, -1.0, 3, 2, 1);
  return r;
}

PatchWeights weights_at(const SurfacePatch& patch, const Point2& xi, double width) {
  if (patch.corners == 3) return triangle_weights(patch, xi, width);
  PatchWeights w{};
  const Row a = row_of(xi[0], patch.ratio[0], patch.ratio[1], width),
            b = row_of(xi[1], patch.ratio[2], patch.ratio[3], width);
  const double* const by_a[6] = {a.m, a.d, a.m, a.dd, a.d, a.m};
  const double* const by_b[6] = {b.m, b.m, b.d, b.m, b.d, b.dd};
  for (int k = 0; k < 6; ++k) {
    PatchFoot::Weights& out = w.of[k];
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t i = 0; i < 4; ++i) out[4 * j + i] = by_a[k][i] * by_b[k][j];
    // Without a fourth face about a corner its vertex completes a parallelogram.
    for (std::size_t c = 0; c < 4; ++c) {
      const auto at = static_cast<std::size_t>(kDiagonal[c]);
      if (patch.vertex[at] >= 0) continue;
      const std::size_t before = (c + 3) % 4;
      out[static_cast<std::size_t>(kBeyond[c][0])] += out[at];
      out[static_cast<std::size_t>(kBeyond[before][1])] += out[at];
      out[static_cast<std::size_t>(kCornerAt[c])] -= out[at];
      out[at] = 0.0;
    }
  }
  return w;
}

Vec3 sum(const PatchFoot::Weights& w, const Vec3 (&x)[SurfacePatch::kSize]) {
  Vec3 s = Vec3::Zero();
  for (std::size_t a = 0; a < w.size(); ++a)
    if (w[a] != 0.0) s += w[a] * x[a];
  return s;
}

/// Nearest point of the triangles that a face is divided into.
struct Start {
  Point2 xi;
  int triangle = 0;
};

Start nearest_triangle(const SurfacePatch& patch, const Vec3 (&from)[SurfacePatch::kSize]) {
  Start best;
  double least = std::numeric_limits<double>::infinity();
  Vec3 middle = Vec3::Zero();
  for (const int at : kCornerAt) middle += 0.25 * from[at];
  for (int k = 0; k < patch.triangles(); ++k) {
    const bool fan = patch.corners == 4;
    const Vec3 &a = fan ? from[kCornerAt[k]] : from[0],
               &b = fan ? from[kCornerAt[(k + 1) % 4]] : from[1], &c = fan ? middle : from[2];
    const geometry::TriangleRegion region = geometry::nearest_on_triangle(Vec3::Zero(), a, b, c);
    const double d = region.nearest.squaredNorm();
    if (!(d < least)) continue;
    least = d;
    best.triangle = k;
    const Vec3 e = b - a, f = c - a, q = region.nearest - a;
    const double ee = e.squaredNorm(), ef = e.dot(f), ff = f.squaredNorm();
    const double scale = 1.0 / (ee * ff - ef * ef);
    const double u = scale * (ff * e.dot(q) - ef * f.dot(q)),
                 v = scale * (ee * f.dot(q) - ef * e.dot(q));
    if (fan)
      best.xi = (1.0 - u - v) * kCornerXi[k] + u * kCornerXi[(k + 1) % 4] + v * Point2(0.5, 0.5);
    else
      best.xi = {u, v};
  }
  return best;
}

/// Minimum of the distance over a square, by Newton's method with a line search.
/// @param from  Positions of vertices relative to the point.
/// @param rounding  Of these.
/// @param outwards  See PatchFoot.
/// @returns the number of directions in which the minimum is free. Over a rounded edge the surface
/// goes on smoothly: a minimum there is one across it, too.
int descend(const SurfacePatch& patch, const Vec3 (&from)[SurfacePatch::kSize], double width,
            double rounding, Point2& xi, Point2 (&free)[2], double& outwards) {
  const auto half_square = [&](const Point2& at) {
    return 0.5 * sum(weights_at(patch, at, width).of[0], from).squaredNorm();
  };
  bool held[2] = {false, false}, across[2] = {false, false};
  double over[2] = {0.0, 0.0};
  for (int k = 0; k < kMostSteps; ++k) {
    for (double& t : xi) t = t < kAtEnd ? 0.0 : t > 1.0 - kAtEnd ? 1.0 : t;
    const PatchWeights w = weights_at(patch, xi, width);
    const Vec3 r = sum(w.of[0], from), r_x = sum(w.of[1], from), r_y = sum(w.of[2], from);
    const Point2 g(r.dot(r_x), r.dot(r_y));
    Eigen::Matrix2d H;
    H << r_x.squaredNorm(), r_x.dot(r_y), r_x.dot(r_y), r_y.squaredNorm();
    Eigen::Matrix2d bend;
    const double mixed = r.dot(sum(w.of[4], from));
    bend << r.dot(sum(w.of[3], from)), mixed, mixed, r.dot(sum(w.of[5], from));
    for (int i = 0; i < 2; ++i) {
      held[i] = (xi[i] <= 0.0 && g[i] >= 0.0) || (xi[i] >= 1.0 && g[i] <= 0.0);
      const double ratio = patch.ratio[static_cast<std::size_t>(2 * i + (xi[i] > 0.5 ? 1 : 0))];
      const Vec3& r_i = i == 0 ? r_x : r_y;
      const double size = r_i.norm();
      over[i] = held[i] && ratio > 0.0 ? std::abs(g[i]) / size : 0.0;
      across[i] = held[i] && ratio > 0.0 && over[i] <= rounding + kAtEnd * size;
    }
    const Eigen::Matrix2d whole = H + bend;
    const auto definite = [&] {
      for (int i = 0; i < 2; ++i)
        if (!held[i] && !(whole(i, i) > 0.0)) return false;
      return held[0] || held[1] || whole.determinant() > 0.0;
    };
    if (definite()) H = whole;
    const auto newton = [&](bool hold_x, bool hold_y) -> Point2 {
      if (hold_x && hold_y) return Point2::Zero();
      if (hold_y) return {-g[0] / H(0, 0), 0.0};
      if (hold_x) return {0.0, -g[1] / H(1, 1)};
      return -H.inverse() * g;
    };
    Point2 step = newton(held[0], held[1]);
    // A parameter at its end that should move inwards, but is drawn outwards by the other one,
    // waits for that.
    for (int i = 0; i < 2; ++i) {
      const bool leaves = (xi[i] <= 0.0 && step[i] < 0.0) || (xi[i] >= 1.0 && step[i] > 0.0);
      if (held[i] || !leaves) continue;
      step = newton(held[0] || i == 0, held[1] || i == 1);
      if (!(step.lpNorm<Eigen::Infinity>() > kNoStep)) step = -g[i] / H(i, i) * Point2::Unit(i);
      break;
    }
    Point2 to = (xi + step).cwiseMax(0.0).cwiseMin(1.0);
    const double length = (to - xi).lpNorm<Eigen::Infinity>();
    if (!(length > kNoStep)) break;
    if (length > kNewtonStep) {
      const double here = 0.5 * r.squaredNorm();
      double part = 1.0;
      while (part > kNewtonStep && !(half_square(to) < here)) {
        part *= 0.5;
        to = (xi + part * step).cwiseMax(0.0).cwiseMin(1.0);
      }
      if (!(part > kNewtonStep)) break;
    }
    xi = to;
  }
  outwards = std::max(over[0], over[1]);
  int count = 0;
  for (int i = 0; i < 2; ++i)
    if (!held[i] || across[i]) free[count++] = Point2::Unit(i);
  return count;
}

}  // namespace

/// A row's weights have the sum of absolute values 1 + (ratio + 1) ψ per side, ψ ≤ 4 ω/27.
/// Those of a triangle are means of barycentric coordinates above −ω, two of them negative at most.
double SurfacePatch::stretch() const {
  if (corners == 3) return 1.0 + 4.0 * kRoundedTriangle;
  const double most = *std::max_element(ratio.begin(), ratio.end());
  const double row = most > 0.0 ? 1.0 + 2.0 * (most + 1.0) * 4.0 / 27.0 * kRoundedEdge : 1.0;
  return row * row;
}

double clear_width(const SurfacePatch& patch, double xi, double eta, double rounding) {
  double width = kRoundedEdge;
  if (patch.corners == 4) {
    for (const double side : {xi, 1.0 - xi, eta, 1.0 - eta})
      if (side > rounding) width = std::min(width, side);
    return width;
  }
  for (const SurfacePatch::Beside& b : patch.beside) {
    double outside = 0.0;
    for (const auto& of : b.of) outside = std::max(outside, -(of[0] + of[1] * xi + of[2] * eta));
    if (outside > rounding) width = std::min(width, outside);
  }
  return width;
}

double least_distance(const SurfacePatch& patch, const Vec3& p,
                      const Vec3 (&x)[SurfacePatch::kSize]) {
  Vec3 middle = Vec3::Zero();
  const auto at = [&](int k) -> const Vec3& { return patch.corners == 4 ? x[kCornerAt[k]] : x[k]; };
  for (int k = 0; k < patch.corners; ++k) middle += at(k) / patch.corners;
  double radius = 0.0;
  for (int k = 0; k < patch.corners; ++k) radius = std::max(radius, (at(k) - middle).norm());
  return (p - middle).norm() - (1.0 + kBulge) * radius;
}

PatchFoot nearest_of_patch(const SurfacePatch& patch, const Vec3& p,
                           const Vec3 (&x)[SurfacePatch::kSize], double width) {
  Vec3 from[SurfacePatch::kSize];
  for (int a = 0; a < SurfacePatch::kSize; ++a) from[a] = x[a] - p;
  const Start start = nearest_triangle(patch, from);
  Point2 xi = start.xi, free[2];
  PatchFoot foot;
  foot.triangle = patch.first_triangle + start.triangle;
  double place = p.lpNorm<Eigen::Infinity>();
  for (int a = 0; a < SurfacePatch::kSize; ++a)
    if (patch.vertex[static_cast<std::size_t>(a)] >= 0)
      place = std::max(place, x[a].lpNorm<Eigen::Infinity>());
  foot.rounding = kPlaceRounding * place;
  foot.free_count =
      patch.corners == 4
          ? descend(patch, from, width, foot.rounding, xi, free, foot.outwards)
          : descend_triangle(patch, from, width, foot.rounding, xi, free, foot.outwards);
  const PatchWeights w = weights_at(patch, xi, width);
  foot.xi = xi[0];
  foot.eta = xi[1];
  foot.M = w.of[0];
  foot.distance = sum(foot.M, from).norm();
  for (int k = 0; k < foot.free_count; ++k)
    for (std::size_t a = 0; a < foot.M.size(); ++a)
      foot.along[k][a] = free[k][0] * w.of[1][a] + free[k][1] * w.of[2][a];
  for (int k = 0; k < foot.free_count; ++k)
    for (int l = k; l < foot.free_count; ++l)
      for (std::size_t a = 0; a < foot.M.size(); ++a)
        foot.bend[k + l][a] = free[k][0] * free[l][0] * w.of[3][a] +
                              (free[k][0] * free[l][1] + free[k][1] * free[l][0]) * w.of[4][a] +
                              free[k][1] * free[l][1] * w.of[5][a];
  return foot;
}

/// Order of feet by distance, and by the gradient where distances differ by rounding: they do so
/// over an edge, for feet on both of its faces that are off by the root of rounding.
bool is_nearer(const PatchFoot& a, const PatchFoot& b) {
  if (std::abs(a.distance - b.distance) > std::max(a.rounding, b.rounding))
    return a.distance < b.distance;
  return a.outwards != b.outwards ? a.outwards < b.outwards : a.distance < b.distance;
}

std::vector<SurfacePatch> smooth_patches(const MeshSurface& surface, const std::vector<Vec3>& x) {
  using Face = MeshSurface::Face;
  const auto at = [&](int v) -> const Vec3& { return x[static_cast<std::size_t>(v)]; };
  const auto corner = [](const Face& f, int k) {
    return f.vertex[static_cast<std::size_t>(k % 4)];
  };
  struct Side {
    const Face* face;
    int side;
  };
  // By the direction in which a quadrilateral runs along an edge; a null face where two do.
  std::map<std::pair<int, int>, Side> sides;
  for (const Face& f : surface.faces)
    for (int k = 0; f.corners == 4 && k < 4; ++k) {
      const auto [it, fresh] = sides.try_emplace({corner(f, k), corner(f, k + 1)}, Side{&f, k});
      if (!fresh) it->second.face = nullptr;
    }
  const auto beside = [&](int from, int to) -> const Side* {
    const auto own = sides.find({from, to}), other = sides.find({to, from});
    if (own == sides.end() || !own->second.face) return nullptr;
    return other == sides.end() || !other->second.face ? nullptr : &other->second;
  };
  const auto normal = [&](const Face& f) -> Vec3 {
    return (at(corner(f, 2)) - at(corner(f, 0)))
        .cross(at(corner(f, 3)) - at(corner(f, 1)))
        .normalized();
  };
  const auto across = [&](const Face& f, int k) {
    return (at(corner(f, k)) - at(corner(f, k + 3))).norm() +
           (at(corner(f, k + 1)) - at(corner(f, k + 2))).norm();
  };
  std::vector<SurfacePatch> patches;
  for (const Face& f : surface.faces) {
    SurfacePatch& p = patches.emplace_back();
    p.vertex.fill(-1);
    p.corners = f.corners;
    p.first_triangle = f.first_triangle;
    for (std::size_t k = 0; k < static_cast<std::size_t>(f.corners); ++k)
      p.vertex[f.corners == 4 ? static_cast<std::size_t>(kCornerAt[k]) : k] = f.vertex[k];
    if (f.corners == 3) continue;
    for (int k = 0; k < 4; ++k) {
      const Side* const s = beside(corner(f, k), corner(f, k + 1));
      if (!s || normal(f).dot(normal(*s->face)) < kSharpPatch) continue;
      p.ratio[static_cast<std::size_t>(kRatioOf[k])] = across(f, k) / across(*s->face, s->side);
      for (int end = 0; end < 2; ++end)
        p.vertex[static_cast<std::size_t>(kBeyond[k][end])] = corner(*s->face, s->side + 2 + end);
    }
    for (int k = 0; k < 4; ++k) {
      const int before = (k + 3) % 4;
      const int right = p.vertex[static_cast<std::size_t>(kBeyond[k][0])],
                left = p.vertex[static_cast<std::size_t>(kBeyond[before][1])];
      if (right < 0 || left < 0) continue;
      // The face beyond the corner runs from the vertex on the right over the corner to the left.
      const auto to = sides.find({right, corner(f, k)});
      if (to == sides.end() || !to->second.face ||
          corner(*to->second.face, to->second.side + 2) != left)
        continue;
      p.vertex[static_cast<std::size_t>(kDiagonal[k])] =
          corner(*to->second.face, to->second.side + 3);
    }
  }
  add_faces_beside(surface, x, kSharpPatch, patches);
  return patches;
}

}  // namespace polhode::surface_contact
