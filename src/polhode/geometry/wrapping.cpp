// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/LU>
#include <Eigen/QR>

#include <polhode/geometry/wrapping.hpp>

namespace polhode::geometry {

namespace {

constexpr int kMaxIterations = 30, kMaxHalvings = 8;
/// Steps from a sphere to an ellipsoid.
constexpr int kDeformations = 8;
/// Residual of tangency below which Newton's method ends, and that of a line that was found [-].
constexpr double kTangent = 4e-15, kFound = 1e-11;
/// Largest correction of an iteration: of the start over the size, of angles [-].
constexpr double kLargestStep = 0.5;
/// Part of the distances below which points are in line with the middle [-].
constexpr double kInLine = 1e-12;

using Mat4 = Eigen::Matrix<double, 4, 4>;
using Vec4 = Eigen::Matrix<double, 4, 1>;
using Mat4x6 = Eigen::Matrix<double, 4, 6>;
using Mat3x6 = Eigen::Matrix<double, 3, 6>;
using Mat3x4 = Eigen::Matrix<double, 3, 4>;

/// Geodesic given by its start and length.
struct Course {
  Vec3 x = Vec3::Zero(), t = Vec3::Zero();
  double arc = 0.0;
};

/// The plane of both points and the middle, in the scale in which the roller is a unit sphere or
/// circle: angle β from each point to where its tangent touches, and angle between the points.
struct Around {
  Vec3 first = Vec3::UnitX(), second = Vec3::UnitY();  ///< Of the plane; first towards p.
  double beta_p = 0.0, beta_q = 0.0, angle = 0.0;
  bool longer = false;
  [[nodiscard]] double arc() const { return angle - beta_p - beta_q; }
  [[nodiscard]] Vec3 at(double phi) const { return std::cos(phi) * first + std::sin(phi) * second; }
};

Vec3 scaled(const Roller& roller, const Vec3& x) { return x.cwiseQuotient(roller.semi_axes); }

Vec3 any_across(const Vec3& e, bool in_plane) {
  if (in_plane) return {-e.y(), e.x(), 0.0};
  Eigen::Index least = 0;
  e.cwiseAbs().minCoeff(&least);
  return e.cross(Vec3(Vec3::Unit(least))).normalized();
}

Around around(const Roller& roller, const Vec3& p, const Vec3& q) {
  const Vec3 P = scaled(roller, p), Q = scaled(roller, q);
  const double at_p = P.norm(), at_q = Q.norm();
  Around a;
  a.first = P / at_p;
  a.beta_p = std::acos(1.0 / at_p);
  a.beta_q = std::acos(1.0 / at_q);
  const Vec3 across = Q - Q.dot(a.first) * a.first;
  const Vec3 side = roller.side ? scaled(roller, *roller.side) : Vec3(Vec3::Zero());
  if (across.norm() > kInLine * at_q) {
    a.second = across.normalized();
  } else {
    const Vec3 aside = side - side.dot(a.first) * a.first;
    a.second = aside.norm() > kInLine * side.norm() ? aside.normalized()
                                                    : any_across(a.first, roller.is_cylinder());
  }
  a.angle = std::atan2(across.norm(), Q.dot(a.first));
  // The longer way if the direction opposite to the side is between the points. @eq{wrap-side}
  const double x = -side.dot(a.first), y = -side.dot(a.second);
  if (std::hypot(x, y) > kInLine * side.norm()) {
    const double behind = std::atan2(y, x);
    if (behind > 0.0 && behind < a.angle) {
      a.longer = true;
      a.angle = 2.0 * std::numbers::pi - a.angle;
      a.second = -a.second;
    }
  }
  return a;
}

/// Exact on spheres and cylinders; on ellipsoids the curve in the plane of the points and the
/// middle, from which Newton's method starts.
Course start(const Roller& roller, const Around& a, const Vec3& p, const Vec3& q) {
  const Vec3 A = a.at(a.beta_p), T = a.at(a.beta_p + 0.5 * std::numbers::pi);
  Course c;
  if (roller.is_cylinder()) {
    const double radius = roller.semi_axes.x();
    const double before = radius * std::tan(a.beta_p), after = radius * std::tan(a.beta_q);
    const double flat = before + radius * a.arc() + after;
    const double slope = (q.z() - p.z()) / flat, stretch = std::hypot(1.0, slope);
    c.x = radius * A + (p.z() + slope * before) * Vec3::UnitZ();
    c.t = (T + slope * Vec3::UnitZ()) / stretch;
    c.arc = radius * a.arc() * stretch;
    return c;
  }
  c.x = roller.semi_axes.cwiseProduct(A);
  c.t = roller.semi_axes.cwiseProduct(T).normalized();
  const auto stretch = [&](double place) {
    const double phi = a.beta_p + place * a.arc() + 0.5 * std::numbers::pi;
    return roller.semi_axes.cwiseProduct(a.at(phi)).norm();
  };
  c.arc = a.arc() / 6.0 * (stretch(0.0) + 4.0 * stretch(0.5) + stretch(1.0));
  return c;
}

/// Frame of a line on the surface: along it, across it, normal; with the change of the normal.
struct Frame {
  Vec3 t, across, normal;
  Mat3 of_normal;  ///< Derivative of the normal by the point.
};

Frame frame(const Roller& roller, const Vec3& x, const Vec3& t) {
  const Vec3 D = roller.semi_axes.cwiseAbs2().cwiseInverse();
  const Vec3 y = D.cwiseProduct(x);
  Frame f;
  f.normal = y.normalized();
  f.t = (t - t.dot(f.normal) * f.normal).normalized();
  f.across = f.normal.cross(f.t);
  f.of_normal =
      (Mat3::Identity() - f.normal * f.normal.transpose()) * Mat3(D.asDiagonal()) / y.norm();
  return f;
}

/// Tangency at both ends of a geodesic, with derivatives by its variations: start along and across
/// it, direction, length. Scholz, Sherman, Stavness, Delp, Kecskeméthy, Multibody Syst. Dyn. 36
/// (2016) 195-219. @eq{wrap-tangency}
struct Tangency {
  Vec3 e_p, e_q, end;           ///< Directions of the straight parts; end of the geodesic.
  double l_p = 0.0, l_q = 0.0;  ///< Their lengths.
  Frame at_p, at_q;
  Vec4 residual;
  Mat4 J;
  Mat3x4 by_start, by_end;  ///< Of both ends of the geodesic.
  Mat4x6 by_points;
};

Tangency tangency(const Roller& roller, const Course& c, const Vec3& p, const Vec3& q) {
  Tangency T;
  T.at_p = frame(roller, c.x, c.t);
  const GeodesicEnd end = follow_geodesic(roller, c.x, T.at_p.t, c.arc);
  T.end = end.x;
  T.at_q = frame(roller, end.x, end.t);
  T.l_p = (c.x - p).norm();
  T.l_q = (q - end.x).norm();
  T.e_p = (c.x - p) / T.l_p;
  T.e_q = (q - end.x) / T.l_q;
  T.by_start << T.at_p.t, T.at_p.across, Vec3::Zero(), Vec3::Zero();
  T.by_end << T.at_q.t, end.across * T.at_q.across, end.turned * T.at_q.across, T.at_q.t;
  const Vec4 turn_p(0.0, 0.0, 1.0, 0.0), turn_q(0.0, end.across_rate, end.turned_rate, 0.0);
  const auto rows = [&](int row, const Frame& f, const Vec3& e, double l, double sign,
                        const Mat3x4& moved, const Vec4& turn) {
    const Mat3 across = (Mat3::Identity() - e * e.transpose()) / l;
    const Mat3x4 normal = f.of_normal * moved;
    const Mat3x4 binormal = -f.t * turn.transpose() - f.normal * (f.across.transpose() * normal);
    T.residual.segment<2>(row) << e.dot(f.normal), e.dot(f.across);
    T.J.row(row) = sign * f.normal.transpose() * across * moved + e.transpose() * normal;
    T.J.row(row + 1) = sign * f.across.transpose() * across * moved + e.transpose() * binormal;
    T.by_points.block<1, 3>(row, sign > 0.0 ? 0 : 3) = -sign * f.normal.transpose() * across;
    T.by_points.block<1, 3>(row + 1, sign > 0.0 ? 0 : 3) = -sign * f.across.transpose() * across;
    T.by_points.block<2, 3>(row, sign > 0.0 ? 3 : 0).setZero();
  };
  rows(0, T.at_p, T.e_p, T.l_p, 1.0, T.by_start, turn_p);
  rows(2, T.at_q, T.e_q, T.l_q, -1.0, T.by_end, turn_q);
  return T;
}

/// The tangency residual, infinite where a line comes from behind.
double merit(const Tangency& T) {
  if (T.e_p.dot(T.at_p.t) <= 0.0 || T.e_q.dot(T.at_q.t) <= 0.0)
    return std::numeric_limits<double>::infinity();
  return T.residual.norm();
}

Course varied(const Roller& roller, const Course& c, const Frame& f, const Vec4& by) {
  Course n;
  n.x = c.x + by[0] * f.t + by[1] * f.across;
  n.x /= roller.depth(n.x);
  n.t = frame(roller, n.x, std::cos(by[2]) * f.t + std::sin(by[2]) * f.across).t;
  n.arc = std::max(0.0, c.arc + by[3]);
  return n;
}

/// Newton's method with a line search. @returns false if it does not converge.
bool make_tangent(const Roller& roller, const Vec3& p, const Vec3& q, Course& c, Tangency& T) {
  T = tangency(roller, c, p, q);
  double size = T.residual.norm();
  for (int k = 0; k < kMaxIterations && size > kTangent; ++k) {
    Vec4 by = -T.J.fullPivLu().solve(T.residual);
    const double most = std::max(by.head<2>().norm() / roller.size(), std::abs(by[2]));
    if (!(most <= kLargestStep)) by *= kLargestStep / most;
    if (!by.allFinite()) return false;
    bool better = false;
    for (int half = 0; half < kMaxHalvings && !better; ++half, by *= 0.5) {
      const Course next = varied(roller, c, T.at_p, by);
      const Tangency there = tangency(roller, next, p, q);
      if (!(merit(there) < size)) continue;
      better = true;
      c = next;
      T = there;
      size = T.residual.norm();
    }
    if (!better) break;
  }
  return size < kFound;
}

/// From the round roller of the same scaled points to this one, where Newton's method fails at
/// once.
bool deform(const Roller& roller, const Around& a, const Vec3& p, const Vec3& q, Course& c,
            Tangency& T) {
  const Vec3 P = scaled(roller, p), Q = scaled(roller, q);
  const double mean = std::cbrt(roller.semi_axes.prod());
  Roller between{Vec3::Constant(mean)};
  c = start(between, a, mean * P, mean * Q);
  for (int k = 1; k <= kDeformations; ++k) {
    const Vec3 before = between.semi_axes;
    const double part = static_cast<double>(k) / kDeformations;
    between.semi_axes = mean * (roller.semi_axes / mean).array().pow(part);
    const Vec3 stretch = between.semi_axes.cwiseQuotient(before);
    c.x = stretch.cwiseProduct(c.x);
    c.t = stretch.cwiseProduct(c.t);
    c.arc *= c.t.norm();
    c.t.normalize();
    if (!make_tangent(between, between.semi_axes.cwiseProduct(P), between.semi_axes.cwiseProduct(Q),
                      c, T))
      return false;
  }
  return true;
}

Wrapping straight(const Vec3& p, const Vec3& q, bool second) {
  Wrapping w;
  w.length = (q - p).norm();
  w.by_q = (q - p) / w.length;
  w.by_p = -w.by_q;
  if (!second) return w;
  const Mat3 across = (Mat3::Identity() - w.by_q * w.by_q.transpose()) / w.length;
  w.second << across, -across, -across, across;
  return w;
}

}  // namespace

bool Roller::is_cylinder() const { return std::isinf(semi_axes.z()); }

bool Roller::is_sphere() const {
  return semi_axes.x() == semi_axes.y() && semi_axes.y() == semi_axes.z();
}

double Roller::size() const { return semi_axes.minCoeff(); }

double Roller::depth(const Vec3& x) const { return scaled(*this, x).norm(); }

std::optional<Wrapping> wrap(const Roller& roller, const Vec3& p, const Vec3& q, bool second) {
  if (!(roller.depth(p) >= kOutside) || !(roller.depth(q) >= kOutside)) return std::nullopt;
  const Around a = around(roller, p, q);
  Wrapping w;
  if (!(a.arc() > 0.0)) {
    w = straight(p, q, second);
    w.angle = a.longer ? -a.angle : a.angle;
    return w;
  }
  Course c = start(roller, a, p, q);
  Tangency T;
  if (!make_tangent(roller, p, q, c, T) && (roller.is_cylinder() || !deform(roller, a, p, q, c, T)))
    return std::nullopt;
  w.touches = true;
  w.angle = a.longer ? -a.angle : a.angle;
  w.across = a.second;
  w.length = T.l_p + c.arc + T.l_q;
  w.by_p = -T.e_p;
  w.by_q = T.e_q;
  w.from = c.x;
  w.to = T.end;
  w.direction = T.at_p.t;
  w.arc = c.arc;
  if (!second) return w;
  const Mat3 across_p = (Mat3::Identity() - T.e_p * T.e_p.transpose()) / T.l_p;
  const Mat3 across_q = (Mat3::Identity() - T.e_q * T.e_q.transpose()) / T.l_q;
  const Mat4x6 varies = -T.J.completeOrthogonalDecomposition().solve(T.by_points);
  Mat3x6 moved_p = T.by_start * varies, moved_q = T.by_end * varies;
  moved_p.leftCols<3>() -= Mat3::Identity();
  moved_q.rightCols<3>() -= Mat3::Identity();
  w.second << -across_p * moved_p, -across_q * moved_q;
  return w;
}

std::vector<Vec3> Wrapping::points(const Roller& roller, const Vec3& p, const Vec3& q,
                                   int arcs) const {
  std::vector<Vec3> list{p};
  for (int k = 0; k <= arcs; ++k) {
    if (touches)
      list.push_back(follow_geodesic(roller, from, direction, arc * k / arcs).x);
    else
      list.push_back(p + (k + 1.0) / (arcs + 2.0) * (q - p));
  }
  list.push_back(q);
  return list;
}

}  // namespace polhode::geometry
