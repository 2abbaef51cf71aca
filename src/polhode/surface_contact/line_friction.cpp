// SPDX-License-Identifier: Apache-2.0
#include <polhode/surface_contact/line_friction.hpp>
#include <polhode/surface_contact/plane_friction.hpp>

namespace polhode::surface_contact {

namespace {

using contact::V3;

template <class T>
struct Along {
  V3<T> force[4];
  T friction, slid, bristle;
  bool slips = false;
};

/// Deflection of the bristle, limited to its largest length.
template <class T>
T held(const T& s, const T& most) {
  const double v = contact::value(s), m = contact::value(most);
  if (std::abs(v) <= m) return s;
  return v < 0.0 ? -1.0 * most : most;
}

/// @eq{cable-along}
template <class T>
Along<T> sliding(const FourMoves& moves, double alpha, const SurfaceLaw& law, const T& pressure,
                 double kept, bool seeded) {
  const FourPoints<T> at(moves, alpha, seeded);
  const V3<T> e = at.x[1] - at.x[0], f = at.x[3] - at.x[2];
  const T per_e = 1.0 / norm(e), per_f = (contact::value(dot(e, f)) < 0.0 ? -1.0 : 1.0) / norm(f);
  const V3<T> on_e = per_e * e, on_f = per_f * f, both = on_e + on_f;
  const T per_both = 1.0 / norm(both);
  const V3<T> t = per_both * both;
  const V3<T> y = 0.5 * (at.x[0] + at.x[1] - at.x[2] - at.x[3]);
  const V3<T> across = per_both * (y - dot(t, y) * t);
  // ∂q/∂e and ∂q/∂f, through t.
  const V3<T> by_e = per_e * (across - dot(on_e, across) * on_e);
  const V3<T> by_f = per_f * (across - dot(on_f, across) * on_f);
  const V3<T> slope[4] = {0.5 * t - by_e, 0.5 * t + by_e, -0.5 * t - by_f, -0.5 * t + by_f};
  Along<T> r;
  r.slid = T(0.0);
  for (int k = 0; k < 4; ++k) r.slid = r.slid + dot(slope[k], at.u[k]);
  const T most = (law.mu / law.bristle) * pressure, start = held(T(kept), most);
  r.slips = std::abs(contact::value(start + r.slid)) > contact::value(most);
  r.bristle = held(start + r.slid, most);
  r.friction = -law.bristle * held(start + alpha * r.slid, most);
  for (int k = 0; k < 4; ++k) r.force[k] = r.friction * slope[k];
  return r;
}

}  // namespace

LineSlide::LineSlide(const FourMoves& moves, double alpha, const SurfaceLaw& law, double pressure,
                     const CentralGap::Force& by_pressure, double kept, bool tangent) {
  const Along<double> r = sliding(moves, alpha, law, pressure, kept, false);
  friction = r.friction;
  slid = r.slid;
  bristle_n1 = r.bristle;
  slips = r.slips;
  for (int k = 0; k < 4; ++k) force.segment<3>(3 * k) = contact::value(r.force[k]);
  on_first = force.segment<3>(0) + force.segment<3>(3);
  if (!tangent) return;
  contact::Dual p(pressure);
  for (int j = 0; j < 12; ++j) p.d[j] = by_pressure[j];
  const Along<contact::Dual> D = sliding(moves, alpha, law, p, kept, true);
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 12; ++j)
      K.block<3, 1>(3 * k, j) << D.force[k].x.d[j], D.force[k].y.d[j], D.force[k].z.d[j];
}

}  // namespace polhode::surface_contact
