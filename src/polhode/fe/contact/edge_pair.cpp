// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <polhode/fe/contact/edge_pair.hpp>

namespace polhode {

namespace {

using contact::Dual;
using contact::V3;

/// Squared sines of the angles at which edges begin to count, and count fully: 3 and 10 degrees.
constexpr double kFrom = 0.00274, kTo = 0.03015;
/// Changes below this have no quotient: a derivative does.
constexpr double kNoChange = 1e-14;

double blend(double c) {
  const double t = std::clamp((c - kFrom) / (kTo - kFrom), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// (m(c_1) − m(c_0))/(c_1 − c_0), without 0/0.
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

/// Squared lengths of e and f and their product, which squared lengths between the four ends give:
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
  if (m_n_ == 0.0 && m_n1_ == 0.0) return;
  acts_ = true;
  m_ = (1.0 - alpha_) * m_n_ + alpha_ * m_n1_;
  for (int i = -1; i < 2; ++i)
    for (int j = -1; j < 2; ++j) {
      const double sign = (i < 0 ? 1.0 : -data_.shared[i]) * (j < 0 ? 1.0 : -data_.shared[2 + j]);
      if (sign == 0.0) continue;
      const NearestFour at_n = nearest_of_edges(x_n, i, j), at_n1 = nearest_of_edges(x_n1, i, j);
      const double g_n = at_n.distance - data_.centre, g_n1 = at_n1.distance - data_.centre;
      if (g_n >= reach && g_n1 >= reach) continue;
      const auto pressure = contact::stop_force(law_.normal, {.at_n = g_n,
                                                              .at_n1 = g_n1,
                                                              .alpha_f = alpha_,
                                                              .conserving = conserving_,
                                                              .end_share = law_.end_share});
      parts_.push_back({sign, g_n, g_n1, pressure,
                        CentralGap(moves_, at_n, nullptr, at_n1, alpha_, conserving_)});
      B_n_ += sign * law_.normal.energy(g_n);
      B_n1_ += sign * law_.normal.energy(g_n1);
      pressure_ += m_ * sign * pressure.value;
    }
}

double EdgePair::dissipated() const {
  double taken = 0.0;
  for (const Part& p : parts_) taken -= p.sign * p.pressure.value * (p.gap_n1 - p.gap_n);
  return m_ * (taken - (B_n1_ - B_n_));
}

/// What changing m by the angle takes: −B̄ Δm/Δc times the derivative of c, which in squared lengths
/// is quadratic, so that in the middle of the step it is exact.
EdgePair::Force EdgePair::by_angle(Stiffness* K) const {
  Force f = Force::Zero(12);
  const bool moves = std::max(c_n_, c_n1_) > kFrom && std::min(c_n_, c_n1_) < kTo;
  if (!moves) return f;
  const auto act = [&]<class T>(T B_mean) {
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
        B_mean * (-1.0 / data_.squares) *
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
  const double B_mean = (1.0 - alpha_) * B_n_ + alpha_ * B_n1_;
  if (!K) {
    const auto values = act(B_mean);
    for (int k = 0; k < 4; ++k)
      f.segment<3>(3 * k) = contact::value(values[static_cast<std::size_t>(k)]);
    return f;
  }
  Dual B(B_mean);
  for (const Part& p : parts_) {
    const Force slope = -alpha_ * p.sign * law_.normal.force(p.gap_n1) * p.gap.slope();
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
  for (const Part& p : parts_) f += p.sign * m_ * p.gap.force(p.pressure.value);
  return f;
}

EdgePair::Force EdgePair::mean_m_slope() const {
  Force slope = Force::Zero(12);
  if (c_n1_ <= kFrom || c_n1_ >= kTo) return slope;
  const double t = (c_n1_ - kFrom) / (kTo - kFrom);
  const double by_c = alpha_ * 6.0 * t * (1.0 - t) / (kTo - kFrom) / data_.squares;
  const Vec3 e = moves_.x_n1[1] - moves_.x_n1[0], f = moves_.x_n1[3] - moves_.x_n1[2];
  const Vec3 by_e = 2.0 * by_c * (f.squaredNorm() * e - e.dot(f) * f);
  const Vec3 by_f = 2.0 * by_c * (e.squaredNorm() * f - e.dot(f) * e);
  slope << -by_e, by_e, -by_f, by_f;
  return slope;
}

EdgePair::Stiffness EdgePair::stiffness() const {
  Stiffness K = Stiffness::Zero(12, 12);
  by_angle(&K);
  const Force m_slope = mean_m_slope();
  for (const Part& p : parts_) {
    K += p.sign * m_ * p.gap.stiffness(p.pressure);
    K += p.sign * p.gap.force(p.pressure.value) * m_slope.transpose();
  }
  return K;
}

EdgePair::Force EdgePair::pressure_slope() const {
  Force slope = Force::Zero(12);
  const Force m_slope = mean_m_slope();
  for (const Part& p : parts_)
    slope += p.sign * (m_ * p.pressure.slope * p.gap.slope() + p.pressure.value * m_slope);
  return slope;
}

Vec3 EdgePair::point() const {
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < 4; ++k) sum += 0.5 * std::abs(nearest_.c[k]) * moves_.x_n1[k];
  return sum;
}

Vec3 EdgePair::normal() const {
  Vec3 y = Vec3::Zero();
  for (int k = 0; k < 4; ++k) y += nearest_.c[k] * (moves_.x_n1[k] - moves_.x_n1[0]);
  return y.normalized();
}

}  // namespace polhode
