// SPDX-License-Identifier: Apache-2.0
// Friction of two crossing edges.
#include <polhode/surface_contact/edge_pair.hpp>
#include <polhode/surface_contact/nearest_weights.hpp>

namespace polhode::surface_contact {

namespace {

using contact::V3;

/// Squared sines of the angles at which friction across the mean direction of round edges begins
/// and is complete: 10 and 30 degrees.
constexpr double kRolls = 0.03015, kSlidesAcross = 0.25;

template <class T>
struct EdgeOnEdge {
  V3<T> force[4], slid;
  PlaneSliding<T> sliding;
};

/// Frictional part of a vector in the contact plane for round edges. The less they cross, the more
/// they roll on each other except along their mean direction.
template <class T>
struct Rolling {
  V3<T> t;
  T w = T(1.0);

  Rolling(const V3<T>& e, const V3<T>& f, bool round) : t(e) {
    if (!round) return;
    const T ee = dot(e, e), ff = dot(f, f), ef = dot(e, f);
    const T square = 1.0 - ef * ef / (ee * ff);
    const double s = contact::value(square);
    if (s >= kSlidesAcross) return;
    const T part = (1.0 / (kSlidesAcross - kRolls)) * (square - kRolls);
    w = s > kRolls ? part * part * (3.0 - 2.0 * part) : T(0.0);
    const double sign = contact::value(ef) < 0.0 ? -1.0 : 1.0;
    t = unit((1.0 / sqrt(ee)) * e + (sign / sqrt(ff)) * f);
  }
  [[nodiscard]] V3<T> of(const V3<T>& x) const {
    if (contact::value(w) == 1.0) return x;
    const V3<T> along = dot(t, x) * t;
    return along + w * (x - along);
  }
};

/// Sliding of the nearest points at the middle of the step in the plane of both edges. The
/// displacement due to the rotation of the two edges is subtracted, with the rotation of the pair
///
///   ω = ((n·Δf) e − (n·Δe) f + ½ (f·Δe − e·Δf) n)/|e × f|
///
/// so that a rotation of the whole causes no slip, and the conjugate forces have no moment.
/// @eq{edge-friction}
template <class T>
EdgeOnEdge<T> edge_friction(const FourMoves& moves, double alpha, const SurfaceLaw& law,
                            const T& pressure, const Vec3& kept, bool round, bool seeded) {
  const FourPoints<T> at(moves, alpha, seeded);
  Vec3 middle[4];
  moves.at(alpha, middle);
  T c[4];
  nearest_weights(nearest_of_edges(middle), at.x, c);
  const V3<T> e = at.x[1] - at.x[0], f = at.x[3] - at.x[2];
  const V3<T> du_e = at.u[1] - at.u[0], du_f = at.u[3] - at.u[2];
  const V3<T> across = cross(e, f);
  const T per = 1.0 / norm(across);
  const V3<T> n = per * across;
  V3<T> y = c[0] * (at.x[0] - at.x[3]), way = c[0] * at.u[0];
  for (int k = 1; k < 4; ++k) {
    y = y + c[k] * (at.x[k] - at.x[3]);
    way = way + c[k] * at.u[k];
  }
  const V3<T> omega =
      per * (dot(n, du_f) * e - dot(n, du_e) * f + (0.5 * (dot(f, du_e) - dot(e, du_f))) * n);
  way = way - cross(omega, y);
  const Rolling<T> rolling(e, f, round);
  const V3<T> slid = rolling.of(way - dot(n, way) * n);
  const auto direction = [&](int from, int to) { return contact::v3(at.x_n[to] - at.x_n[from]); };
  EdgeOnEdge<T> r{{},
                  slid,
                  {SlidePlane<T>(e, f), SlidePlane<double>(direction(0, 1), direction(2, 3)), law,
                   pressure, kept, slid, alpha}};
  const V3<T> h = rolling.of(r.sliding.friction);
  const V3<T> moment = cross(y, h);
  const T on_n = dot(n, moment);
  const V3<T> on_e = per * (dot(f, moment) * n - (0.5 * on_n) * f);
  const V3<T> on_f = per * ((0.5 * on_n) * e - dot(e, moment) * n);
  r.force[0] = c[0] * h - on_e;
  r.force[1] = c[1] * h + on_e;
  r.force[2] = c[2] * h - on_f;
  r.force[3] = c[3] * h + on_f;
  return r;
}

}  // namespace

/// Slip rates of the nearest points. Along the mean direction t of nearly parallel round edges the
/// rate is that of t·y, as in cable-along, which does not need the rotation of the pair.
/// @eq{cable-impact}
std::array<Mat3, 4> EdgePair::slip_rates(const Vec3& n) const {
  const Vec3(&x)[4] = moves_.x_n1;
  const Vec3 e = x[1] - x[0], f = x[3] - x[2];
  const Rolling<double> rolling(contact::v3(e), contact::v3(f), round());
  std::array<Mat3, 4> across{};
  if (rolling.w > 0.0)
    across = polhode::surface_contact::slip_rates(x, nearest_.c, n, {0, 1, 2, 3});
  if (rolling.w == 1.0) return across;
  const Vec3 t = contact::value(rolling.t), b = n.cross(t).normalized(), a = b.cross(n);
  const double per_e = 1.0 / e.norm(), per_f = (e.dot(f) < 0.0 ? -1.0 : 1.0) / f.norm();
  const Vec3 on_e = per_e * e, on_f = per_f * f;
  Vec3 y = Vec3::Zero();
  for (int k = 1; k < 4; ++k) y += nearest_.c[k] * (x[k] - x[0]);
  const Vec3 turns = (y - t.dot(y) * t) / (on_e + on_f).norm();
  const Vec3 by_e = per_e * (turns - on_e.dot(turns) * on_e),
             by_f = per_f * (turns - on_f.dot(turns) * on_f);
  const Vec3 by_turn[4] = {-by_e, by_e, -by_f, by_f};
  std::array<Mat3, 4> rates;
  for (std::size_t k = 0; k < 4; ++k) {
    rates[k] = a * (nearest_.c[static_cast<int>(k)] * t + by_turn[k]).transpose();
    if (rolling.w > 0.0) rates[k] += rolling.w * b * b.transpose() * across[k];
  }
  return rates;
}

FourSlide EdgePair::slide(const Vec3& kept, bool tangent) const {
  if (round() && !(pressure_ > 0.0)) return {};
  const auto sliding = [&](const auto& p, bool seeded) {
    return edge_friction(moves_, alpha_, law_, p, kept, round(), seeded);
  };
  const auto& x = moves_.x_n1;
  return FourSlide(sliding, SlidePlane<double>(contact::v3(x[1] - x[0]), contact::v3(x[3] - x[2])),
                   std::max(0.0, pressure_), tangent);
}

}  // namespace polhode::surface_contact
