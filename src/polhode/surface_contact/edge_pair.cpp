// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <polhode/surface_contact/edge_pair.hpp>

namespace polhode::surface_contact {

namespace {

using contact::Dual;
using contact::V3;

/// Squared sines of the angles at which a crossing begins to count, and counts fully: 3 and 10
/// degrees.
constexpr double kFrom = 0.00274, kTo = 0.03015;
/// Smallest change for a difference quotient; below it the derivative is used.
constexpr double kNoChange = 1e-14;

double blend(double c) {
  const double t = std::clamp((c - kFrom) / (kTo - kFrom), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// (m(c_1) − m(c_0))/(c_1 − c_0), evaluated without 0/0.
template <class T>
T blend_quotient(double c_0, const T& c_1) {
  const auto inside = [](double c) { return c > kFrom && c < kTo; };
  const double range = kTo - kFrom, v = contact::value(c_1);
  const double t_0 = (std::clamp(c_0, kFrom, kTo) - kFrom) / range;
  T t_1((std::clamp(v, kFrom, kTo) - kFrom) / range);
  if (inside(v)) t_1 = (1.0 / range) * (c_1 - kFrom);
  const T sum = 3.0 * (t_0 + t_1) - 2.0 * (t_0 * t_0 + t_0 * t_1 + t_1 * t_1);
  if (inside(v) && inside(c_0)) return (1.0 / range) * sum;
  if (std::abs(v - c_0) < kNoChange) return T(0.0);
  return sum * (t_1 - t_0) / (c_1 - c_0);
}

/// Squared lengths of e and f and their scalar product, from squared lengths between the four ends:
/// 2 e·f = s_03 + s_12 − s_02 − s_13.
template <class T>
struct Products {
  T ee, ff, ef;
  Products(const V3<T>& e, const V3<T>& f) : ee(dot(e, e)), ff(dot(f, f)), ef(dot(e, f)) {}
  [[nodiscard]] T square() const { return ee * ff - ef * ef; }  ///< |e × f|²
};

}  // namespace

double crossing(const Vec3& e, const Vec3& f, double squares) {
  return blend(e.cross(f).squaredNorm() / squares);
}

/// @eq{edge-potential}
EdgePair::EdgePair(const FourMoves& moves, const EdgePairData& data, const SurfaceLaw& law,
                   double alpha_f, bool conserving)
    : moves_(moves), data_(data), law_(law), alpha_(alpha_f), conserving_(conserving) {
  Vec3 x_n[4];
  const Vec3(&x_n1)[4] = moves_.x_n1;
  moves_.at(0.0, x_n);
  nearest_ = nearest_of_edges(x_n1);
  gap_n1_ = nearest_.distance - data_.centre;
  const double gap_n = nearest_of_edges(x_n).distance - data_.centre, reach = law_.normal.reach();
  if (gap_n >= reach && gap_n1_ >= reach) return;
  const auto measure = [&](const Vec3(&x)[4]) {
    return (x[1] - x[0]).cross(x[3] - x[2]).squaredNorm() / data_.squares;
  };
  c_n_ = measure(x_n);
  c_n1_ = measure(x_n1);
  m_n_ = blend(c_n_);
  m_n1_ = blend(c_n1_);
  if (!round()) {
    if (m_n_ == 0.0 && m_n1_ == 0.0) return;
    factor_ = (1.0 - alpha_) * m_n_ + alpha_ * m_n1_;
    factor_n1_ = m_n1_;
  }
  acts_ = true;
  add_edges(x_n);
  if (round()) add_points(x_n);
}

void EdgePair::add_edges(const Vec3 (&x_n)[4]) {
  for (int i = -1; i < 2; ++i)
    for (int j = -1; j < 2; ++j) {
      const double sign = (i < 0 ? 1.0 : -data_.shared[i]) * (j < 0 ? 1.0 : -data_.shared[2 + j]);
      if (sign != 0.0) add(sign, i, j, true, x_n);
    }
}

/// Adds the point terms of round edges. Crossing edges are kept apart beyond the range of these.
void EdgePair::add_points(const Vec3 (&x_n)[4]) {
  if (m_n_ == 1.0 && m_n1_ == 1.0) return;
  for (int side = 0; side < 2; ++side) {
    const auto& [parts, area] = data_.points[side];
    for (int k = 0; parts > 0 && k <= parts; ++k) {
      const double share = k == 0 || k == parts ? 0.5 * area : area;
      const double place = static_cast<double>(k) / parts;
      for (int end = -1; end < 2; ++end) {
        const double sign = end < 0 ? share : -share * data_.shared[2 * (1 - side) + end];
        if (sign == 0.0) continue;
        if (side == 0)
          add(sign, place, end, false, x_n);
        else
          add(sign, end, place, false, x_n);
      }
    }
  }
}

/// @eq{edge-potential} @eq{cable-pair}
void EdgePair::add(double sign, double e_place, double f_place, bool across, const Vec3 (&x_n)[4]) {
  const NearestFour at_n = nearest_of_edges(x_n, e_place, f_place),
                    at_n1 = nearest_of_edges(moves_.x_n1, e_place, f_place);
  const auto gap = [&](const NearestFour& at, double m) {
    return at.distance - data_.centre + (across ? data_.retreat * (1.0 - m) : data_.behind);
  };
  const double g_n = gap(at_n, m_n_), g_n1 = gap(at_n1, m_n1_), reach = law_.normal.reach();
  if (g_n >= reach && g_n1 >= reach) return;
  const auto pressure = contact::stop_force(law_.normal, {.at_n = g_n,
                                                          .at_n1 = g_n1,
                                                          .alpha_f = alpha_,
                                                          .conserving = conserving_,
                                                          .end_share = law_.end_share});
  parts_.push_back({sign, g_n, g_n1, pressure,
                    CentralGap(moves_, at_n, nullptr, at_n1, alpha_, conserving_), across,
                    at_n1.c});
  B_n_ += sign * law_.normal.energy(g_n);
  B_n1_ += sign * law_.normal.energy(g_n1);
  (across ? pressure_ : along_) += factor_ * sign * pressure.value;
}

double EdgePair::dissipated() const {
  double taken = 0.0;
  for (const Part& p : parts_) taken -= p.sign * p.pressure.value * (p.gap_n1 - p.gap_n);
  return factor_ * (taken - (B_n1_ - B_n_));
}

bool EdgePair::within(bool at_end) const {
  return std::any_of(parts_.begin(), parts_.end(), [&](const Part& p) {
    return (at_end ? p.gap_n1 : p.gap_n) < law_.normal.reach();
  });
}

std::vector<GapTerm> EdgePair::terms() const {
  std::vector<GapTerm> list;
  for (const Part& p : parts_) list.push_back({factor_n1_ * p.sign, p.gap_n1});
  return list;
}

EdgePair::Force EdgePair::gap_slope(const Part& part) const {
  if (!part.across || !round()) return part.gap.slope();
  return part.gap.slope() - data_.retreat * m_slope();
}

/// Force due to the change of m with the angle: −B̄ Δm/Δc times the derivative of c, which is
/// quadratic in squared lengths, so that at the midpoint it is exact. For round edges B̄ is
/// replaced by the force of the gap that m retracts.
EdgePair::Force EdgePair::by_angle(Stiffness* K) const {
  Force f = Force::Zero(12);
  const bool moves = std::max(c_n_, c_n1_) > kFrom && std::min(c_n_, c_n1_) < kTo;
  if (!moves) return f;
  const auto act = [&]<class T>(T by_m) {
    const FourPoints<T> at(moves_, alpha_, true);
    V3<T> x_n1[4];
    V3<double> x_n[4];
    for (int k = 0; k < 4; ++k) {
      x_n[k] = contact::v3(at.x_n[k]);
      x_n1[k] = at.u[k] + x_n[k];
    }
    const Products<double> before(x_n[1] - x_n[0], x_n[3] - x_n[2]);
    const Products<T> after(x_n1[1] - x_n1[0], x_n1[3] - x_n1[2]);
    const T scale =
        by_m * (-1.0 / data_.squares) *
        blend_quotient(conserving_ ? c_n_ : c_n1_, after.square() * (1.0 / data_.squares));
    const double w = conserving_ ? 0.5 : 1.0;
    const T ee = w * after.ee + (1.0 - w) * before.ee, ff = w * after.ff + (1.0 - w) * before.ff,
            ef = w * after.ef + (1.0 - w) * before.ef;
    const T by_length[6] = {ff, ef, -ef, -ef, ef, ee};
    std::array<V3<T>, 4> force{};
    for (int l = 0; l < NearestFour::kLengths; ++l) {
      const auto i = static_cast<std::size_t>(NearestFour::kEnds[l][0]),
                 j = static_cast<std::size_t>(NearestFour::kEnds[l][1]);
      const V3<T> along = (2.0 * scale * by_length[l]) * (at.x[i] - at.x[j]);
      force[i] = force[i] + along;
      force[j] = force[j] - along;
    }
    return force;
  };
  double by_m = (1.0 - alpha_) * B_n_ + alpha_ * B_n1_;
  if (round()) by_m = data_.retreat * pressure_;
  if (!K) {
    const auto values = act(by_m);
    for (int k = 0; k < 4; ++k)
      f.segment<3>(3 * k) = contact::value(values[static_cast<std::size_t>(k)]);
    return f;
  }
  Dual B(by_m);
  for (const Part& p : parts_) {
    if (!p.across) continue;
    const double by_gap =
        round() ? data_.retreat * p.pressure.slope : -alpha_ * law_.normal.force(p.gap_n1);
    const Force slope = p.sign * by_gap * gap_slope(p);
    for (int j = 0; j < 12; ++j) B.d[j] += slope[j];
  }
  const auto values = act(B);
  for (int k = 0; k < 4; ++k) {
    const V3<Dual>& v = values[static_cast<std::size_t>(k)];
    f.segment<3>(3 * k) = contact::value(v);
    for (int j = 0; j < 12; ++j) K->block<3, 1>(3 * k, j) += Vec3(v.x.d[j], v.y.d[j], v.z.d[j]);
  }
  return f;
}

EdgePair::Force EdgePair::force() const {
  Force f = by_angle(nullptr);
  for (const Part& p : parts_) f += p.sign * factor_ * p.gap.force(p.pressure.value);
  return f;
}

EdgePair::Force EdgePair::m_slope() const {
  Force slope = Force::Zero(12);
  if (c_n1_ <= kFrom || c_n1_ >= kTo) return slope;
  const double t = (c_n1_ - kFrom) / (kTo - kFrom);
  const double by_c = 6.0 * t * (1.0 - t) / (kTo - kFrom) / data_.squares;
  const Vec3 e = moves_.x_n1[1] - moves_.x_n1[0], f = moves_.x_n1[3] - moves_.x_n1[2];
  const Vec3 by_e = 2.0 * by_c * (f.squaredNorm() * e - e.dot(f) * f);
  const Vec3 by_f = 2.0 * by_c * (e.squaredNorm() * f - e.dot(f) * e);
  slope << -by_e, by_e, -by_f, by_f;
  return slope;
}

EdgePair::Stiffness EdgePair::stiffness() const {
  Stiffness K = Stiffness::Zero(12, 12);
  by_angle(&K);
  const Force by_m = m_slope();
  for (const Part& p : parts_) {
    K += p.sign * factor_ * p.gap.stiffness(p.pressure);
    if (!round())
      K += p.sign * alpha_ * p.gap.force(p.pressure.value) * by_m.transpose();
    else if (p.across)
      K -= p.sign * data_.retreat * p.gap.force(p.pressure.slope) * by_m.transpose();
  }
  return K;
}

EdgePair::Force EdgePair::pressure_slope() const {
  Force slope = Force::Zero(12);
  const Force by_m = m_slope();
  for (const Part& p : parts_) {
    if (!p.across) continue;
    slope += p.sign * factor_ * p.pressure.slope * gap_slope(p);
    if (!round()) slope += p.sign * alpha_ * p.pressure.value * by_m;
  }
  return slope;
}

LineSlide EdgePair::slide_along(double kept, bool tangent) const {
  if (!(along_ > 0.0)) return {};
  Force slope = Force::Zero(12);
  for (const Part& p : parts_)
    if (!p.across) slope += p.sign * p.pressure.slope * p.gap.slope();
  return {moves_, alpha_, law_, along_, slope, kept, tangent};
}

Vec3 EdgePair::point() const {
  const auto middle = [&](const Eigen::Vector4d& c) {
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < 4; ++k) sum += 0.5 * std::abs(c[k]) * moves_.x_n1[k];
    return sum;
  };
  if (!round() || !(pressure() > 0.0)) return middle(nearest_.c);
  Vec3 sum = Vec3::Zero();
  for (const Part& p : parts_) sum += p.sign * p.pressure.value * middle(p.c);
  return sum / pressure();
}

Vec3 EdgePair::normal() const {
  Vec3 y = Vec3::Zero();
  for (int k = 0; k < 4; ++k) y += nearest_.c[k] * (moves_.x_n1[k] - moves_.x_n1[0]);
  return y.normalized();
}

}  // namespace polhode::surface_contact
