// SPDX-License-Identifier: Apache-2.0
#include <polhode/math/hat.hpp>
#include <polhode/surface_contact/slip_rates.hpp>

namespace polhode::surface_contact {

std::array<Mat3, 4> slip_rates(const Vec3 (&x)[4], const Eigen::Vector4d& c, const Vec3& n,
                               const TwoEdges& edges) {
  const auto [a, b, p, q] = edges;
  const Vec3 e = x[b] - x[a], f = x[q] - x[p], across = e.cross(f);
  const double per = 1.0 / across.norm();
  const Vec3 m = per * across;
  Vec3 y = Vec3::Zero();
  for (int k = 1; k < 4; ++k) y += c[k] * (x[k] - x[0]);
  // Derivatives of ω by the rates of both edges.
  const Mat3 turn = hat(y), by_e = turn * (per * (0.5 * m * f.transpose() - f * m.transpose())),
             by_f = turn * (per * (e * m.transpose() - 0.5 * m * e.transpose()));
  std::array<Mat3, 4> rates;
  for (int k = 0; k < 4; ++k) rates[static_cast<std::size_t>(k)] = c[k] * Mat3::Identity();
  rates[static_cast<std::size_t>(a)] -= by_e;
  rates[static_cast<std::size_t>(b)] += by_e;
  rates[static_cast<std::size_t>(p)] -= by_f;
  rates[static_cast<std::size_t>(q)] += by_f;
  const Mat3 in_plane = Mat3::Identity() - n * n.transpose();
  for (Mat3& rate : rates) rate = in_plane * rate;
  return rates;
}

}  // namespace polhode::surface_contact
