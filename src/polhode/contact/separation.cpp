// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>

#include <polhode/contact/round_solids/round_solid.hpp>
#include <polhode/contact/separation.hpp>

namespace polhode::contact {

namespace {

/// Factor of the blur from one search to the next.
constexpr double kSharpening = 1e-2;

/// Support point in the world from the centre, with its derivative by the direction.
CurvedSupport curved_support(const geometry::Shape& s, const Mat3& axes, const Vec3& direction,
                             double blur) {
  const CurvedSupport c = s.round_solid->curved_support(s, axes.transpose() * direction, blur);
  return {axes * c.x, axes * c.D * axes.transpose()};
}

/// Improves the direction at this blur.
/// @param between  From the centre of b to that of a.
void ascend(const geometry::Shape& a, const geometry::Shape& b, const Mat3& axes_a,
            const Mat3& axes_b, const Vec3& between, double blur, Separation& s) {
  const auto offset = [&](const Vec3& n, Mat3* D) {
    const CurvedSupport on_a = curved_support(a, axes_a, -n, blur),
                        on_b = curved_support(b, axes_b, n, blur);
    if (D) *D = on_a.D + on_b.D;
    return Vec3(between + on_a.x - on_b.x);
  };
  Mat3 D;
  Vec3 w = offset(s.n, &D);
  for (int k = 0; k < 200; ++k) {
    Vec3 e, f;
    tangents(s.n, e, f);
    const double F = s.n.dot(w), size = D.diagonal().sum() + std::abs(F);
    s.M << e.dot(D * e) + F, e.dot(D * f), f.dot(D * e), f.dot(D * f) + F;
    const Eigen::Vector2d slope(e.dot(w), f.dot(w));
    if (slope.norm() <= 1e-14 * size) break;
    // Newton step with absolute curvatures: an ascent also where F is not concave.
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> principal;
    principal.computeDirect(s.M);
    const Eigen::Vector2d curvature = principal.eigenvalues().cwiseAbs().cwiseMax(1e-12 * size);
    Eigen::Vector2d move = principal.eigenvectors() *
                           (principal.eigenvectors().transpose() * slope).cwiseQuotient(curvature);
    if (move.norm() > 0.5) move *= 0.5 / move.norm();
    bool better = false;
    for (int cut = 0; cut < 40 && !better; ++cut, move *= 0.5) {
      const Vec3 next = (s.n + move[0] * e + move[1] * f).normalized();
      Mat3 D_next;
      const Vec3 w_next = offset(next, &D_next);
      better = next.dot(w_next) > F || (move.norm() < 1e-6 && next.dot(w_next) >= F - 1e-15 * size);
      if (!better) continue;
      s.n = next, w = w_next, D = D_next;
    }
    if (!better) break;
  }
  s.distance = s.n.dot(w);
}

Separation separate_from(const geometry::Shape& a, const geometry::Shape& b, const Mat3& axes_a,
                         const Mat3& axes_b, const Vec3& between, const Vec3& start) {
  Separation s;
  s.n = start.squaredNorm() > 0.0 ? Vec3(start.normalized()) : Vec3::UnitZ();
  double blur = blur::coarse;
  ascend(a, b, axes_a, axes_b, between, blur, s);
  while (blur > blur::fine) {
    const double next = std::max(blur::fine, kSharpening * blur);
    for (const auto& [shape, axes] : {std::pair(&a, &axes_a), std::pair(&b, &axes_b)})
      s.n = *axes * shape->round_solid->sharpened(*shape, axes->transpose() * s.n, blur, next);
    s.n.normalize();
    blur = next;
    ascend(a, b, axes_a, axes_b, between, blur, s);
  }
  return s;
}

}  // namespace

void tangents(const Vec3& n, Vec3& e, Vec3& f) {
  e = n.unitOrthogonal();
  f = n.cross(e);
}

Separation separate(const geometry::Shape& a, const geometry::Shape& b, const Mat3& axes_a,
                    const Mat3& axes_b, const Vec3& between, const Vec3& start) {
  const Separation s = separate_from(a, b, axes_a, axes_b, between, start);
  if (s.distance >= -(a.rounding + b.rounding)) return s;
  // Overlapping slender solids have a maximum on either side; one of them may be false.
  const Separation opposite = separate_from(a, b, axes_a, axes_b, between, -s.n);
  return opposite.distance > s.distance ? opposite : s;
}

}  // namespace polhode::contact
