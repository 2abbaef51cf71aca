// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <polhode/system/element_group.hpp>

namespace polhode::test {

/// Bars with energy ½ EA L ε², ε = (l² − L²)/(2L²): quadratic in squared lengths, so that the
/// average of the strains at both ends of a step gives the energy's difference exactly. Engines are
/// tested with these bars, independently of the product's elements.
class Bars final : public ElementGroup {
 public:
  struct Bar {
    int nodes[2];
    double length;
  };
  double stiffness = 100.0;  ///< EA [N]
  double density = 1.0;      ///< Per length [kg/m].
  double viscosity = 0.0;    ///< Force per strain rate [N s].
  std::vector<Bar> bars;

  void add(int i, int j, const std::vector<Vec3>& X) {
    bars.push_back({{i, j}, (X[j] - X[i]).norm()});
  }
  std::string kind() const override { return "bar"; }
  const std::string& name() const override { return name_; }
  int size() const override { return static_cast<int>(bars.size()); }
  int nodes_per_element() const override { return 2; }
  std::span<const int> nodes(int e) const override { return bars[e].nodes; }
  bool conservative() const override { return viscosity == 0.0; }
  bool dissipates() const override { return viscosity > 0.0; }
  bool mass(int e, double* M) const override {
    const double m = density * bars[e].length / 6.0;
    M[0] = M[3] = 2.0 * m;
    M[1] = M[2] = m;
    return true;
  }
  ElementReport evaluate(const NodeStep& s, const double*, double*, const Mat3&,
                         const ElementSink& sink) const override {
    for (int e = 0; e < size(); ++e) {
      const auto& [n, L] = bars[e];
      const Vec3 d0 = NodeStep::at(s.x_n, n[1]) - NodeStep::at(s.x_n, n[0]);
      const Vec3 d1 = NodeStep::at(s.x_n1, n[1]) - NodeStep::at(s.x_n1, n[0]);
      const Vec3 d = (1.0 - s.alpha_f) * d0 + s.alpha_f * d1;
      const Vec3 rate = s.velocity_alpha(n[1]) - s.velocity_alpha(n[0]);
      const double N = stiffness * strain(d0, d1, L, s.alpha_f) + viscosity * d.dot(rate) / (L * L);
      const Vec3 f = N / L * d;
      Eigen::Matrix<double, 6, 1> forces;
      forces << f, -f;
      sink.add_force(nodes(e), forces.data());
      if (!sink.tangent) continue;
      const Vec3 D_strain = s.alpha_f / (L * L) * d1;
      const Vec3 D_rate = s.alpha_f / (L * L) * (s.rate * d + rate);
      const Mat3 k = -(d * (stiffness * D_strain + viscosity * D_rate).transpose() / L +
                       s.alpha_f * N / L * Mat3::Identity());
      Eigen::Matrix<double, 6, 6, Eigen::RowMajor> K;
      K << k, -k, -k, k;
      sink.add_tangent(e, 2, K.data());
    }
    return {};
  }
  Work work(const NodeStep& s, const double*, const double*) const override {
    Work w;
    for (const auto& [n, L] : bars) {
      const Vec3 d0 = NodeStep::at(s.x_n, n[1]) - NodeStep::at(s.x_n, n[0]);
      const Vec3 d1 = NodeStep::at(s.x_n1, n[1]) - NodeStep::at(s.x_n1, n[0]);
      const double e = strain(d0, d1, L, 1.0);
      w.stored += 0.5 * stiffness * L * e * e;
      const Vec3 d = (1.0 - s.alpha_f) * d0 + s.alpha_f * d1;
      const double e_dot = d.dot(s.velocity_alpha(n[1]) - s.velocity_alpha(n[0])) / (L * L);
      if (s.x_n != s.x_n1) w.dissipated += s.context.dt * L * viscosity * e_dot * e_dot;
    }
    return w;
  }

 private:
  static double strain(const Vec3& d0, const Vec3& d1, double L, double alpha) {
    const double l2 = (1.0 - alpha) * d0.squaredNorm() + alpha * d1.squaredNorm();
    return (l2 - L * L) / (2.0 * L * L);
  }
  std::string name_ = "lattice";
};

/// A lattice of bars on a grid, all neighbours within a cell joined: nodes' positions and bars.
inline std::pair<std::vector<Vec3>, std::unique_ptr<Bars>> lattice(int nx, int ny, int nz, double h,
                                                                   const Vec3& origin) {
  std::vector<Vec3> X;
  for (int i = 0; i <= nx; ++i)
    for (int j = 0; j <= ny; ++j)
      for (int k = 0; k <= nz; ++k) X.push_back(origin + h * Vec3(i, j, k));
  auto bars = std::make_unique<Bars>();
  for (int a = 0; a < static_cast<int>(X.size()); ++a)
    for (int b = a + 1; b < static_cast<int>(X.size()); ++b)
      if ((X[b] - X[a]).lpNorm<Eigen::Infinity>() < 1.01 * h) bars->add(a, b, X);
  return {std::move(X), std::move(bars)};
}

}  // namespace polhode::test
