// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <vector>

#include <polhode/math/dense.hpp>
#include <polhode/solids/cell_stability.hpp>
#include <polhode/solids/mesh/shapes.hpp>
#include <polhode/solids/solid_elements.hpp>

namespace polhode::solids {

namespace {

constexpr double kSmallestTried = 0.3;
/// Stretches tried from one downwards, since a brick may resist again below a range in which it
/// does not; and halvings of that step, to 2e-4.
constexpr int kTried = 35, kHalvings = 7;
constexpr int kCorners = 8;
constexpr int kLateralIterations = 20;  ///< Of Newton's method: quadratic, from strains below 0.5.

/// One brick, evaluated at homogeneous stretches.
class Brick {
 public:
  Brick(const std::string& element, const std::shared_ptr<const Material>& material,
        const Vec3& size)
      : material_(material) {
    for (const Vec3& corner : cell_shape("hex8").nodes) {
      corners_.push_back(corner);
      X_.push_back(0.5 * corner.cwiseProduct(size));
    }
    SolidElementsDescription d;
    d.name = "brick";
    d.element = element;
    d.material = material;
    d.density = 1.0;
    for (int i = 0; i < kCorners; ++i) d.connectivity.push_back(i);
    d.X = X_;
    group_ = make_solid_elements(std::move(d));
    for (int i = 0; i < kCorners; ++i)
      for (int j = 0; j < kCorners; ++j) slots_.push_back(kCorners * i + j);
  }

  /// Whether it resists hourglass motions, those orthogonal to all homogeneous deformations: u_c =
  /// ξη, ηζ, ζξ, ξηζ in each direction c.
  [[nodiscard]] bool resists(int axis, double stretch) const {
    Vec3 F = Vec3::Constant(lateral_stretch(axis, stretch));
    F[axis] = stretch;
    std::vector<double> x, none(3 * kCorners, 0.0), force(3 * kCorners, 0.0);
    for (const Vec3& X : X_)
      for (int c = 0; c < 3; ++c) x.push_back(F[c] * X[c]);
    std::vector<double> tangent(9 * slots_.size(), 0.0), history(group_->history_size(), 0.0),
        scratch(group_->scratch_size(), 0.0);
    group_->initialize(history.data());
    group_->begin_step(history.data(), scratch.data());
    StepContext context;
    context.conserving = false;
    const NodeStep step{.x_n = x.data(),
                        .x_n1 = x.data(),
                        .u = none.data(),
                        .v_n = none.data(),
                        .v_n1 = none.data(),
                        .context = context,
                        .alpha_f = 1.0,
                        .rate = 0.0};
    (void)group_->evaluate(step, history.data(), scratch.data(), Mat3::Identity(),
                           ElementSink{force.data(), tangent.data(), slots_.data()});
    Mat H = Mat::Zero(3 * kCorners, 12), K(3 * kCorners, 3 * kCorners);
    for (int i = 0; i < kCorners; ++i) {
      const Vec3& s = corners_[static_cast<std::size_t>(i)];
      const double pattern[] = {s[0] * s[1], s[1] * s[2], s[2] * s[0], s[0] * s[1] * s[2]};
      for (int h = 0; h < 4; ++h)
        for (int c = 0; c < 3; ++c) H(3 * i + c, 3 * h + c) = pattern[h];
      for (int j = 0; j < kCorners; ++j)
        for (int e = 0; e < 9; ++e)
          K(3 * i + e / 3, 3 * j + e % 3) =
              -tangent[static_cast<std::size_t>(9 * (kCorners * i + j) + e)];
    }
    const Mat k = H.transpose() * (K + K.transpose()) * H;
    if (!k.allFinite()) return false;
    return Eigen::SelfAdjointEigenSolver<Mat>(k, Eigen::EigenvaluesOnly).eigenvalues()[0] > 0.0;
  }

 private:
  /// Stretch in the other two directions at which these are free of stress.
  [[nodiscard]] double lateral_stretch(int axis, double stretch) const {
    const int i = (axis + 1) % 3, j = (axis + 2) % 3;
    Vec6 E = Vec6::Zero();
    E[axis] = 0.5 * (stretch * stretch - 1.0);
    for (int k = 0; k < kLateralIterations; ++k) {
      const MaterialPoint point = discrete_stress(*material_, E, E);
      // With both strains the same at the end of a step, the tangent is half of dS/dE.
      E[i] = E[j] = E[i] - 0.5 * point.S[i] / (point.D(i, i) + point.D(i, j));
    }
    return std::sqrt(1.0 + 2.0 * E[i]);
  }

  std::shared_ptr<const Material> material_;
  std::vector<Vec3> X_, corners_;
  std::unique_ptr<SolidElements> group_;
  std::vector<int> slots_;
};

}  // namespace

/// @eq{hourglass-stability}
double stable_stretch(const std::string& element, const std::shared_ptr<const Material>& material,
                      const Vec3& size, int axis) {
  const Brick brick(element, material, size);
  constexpr double step = (1.0 - kSmallestTried) / kTried;
  int tried = 1;
  while (tried <= kTried && brick.resists(axis, 1.0 - tried * step)) ++tried;
  if (tried > kTried) return 0.0;
  double lost = 1.0 - tried * step, kept = lost + step;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (lost + kept);
    (brick.resists(axis, middle) ? kept : lost) = middle;
  }
  return kept;
}

}  // namespace polhode::solids
