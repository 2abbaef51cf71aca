// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/contact_laws/stop_force.hpp>
#include <polhode/surface_contact/nearest_four.hpp>

namespace polhode::surface_contact {

/// Positions and displacements of four points over a step.
struct FourMoves {
  Vec3 x_n1[4];  ///< [m]
  Vec3 u[4];     ///< x_{n+1} − x_n [m].

  void at(double alpha, Vec3 (&x)[4]) const {
    for (int i = 0; i < 4; ++i) x[i] = x_n1[i] - (1.0 - alpha) * u[i];
  }
};

/// Distance over a step, between the nearest features at t_n and those, possibly others, at
/// t_{n+1}. A force λ conjugate to it acts between pairs of points along their averaged connecting
/// lines, so that its resultant and moment vanish and its work is exactly λ Δd:
///
///   q = λ/(d_n + d_{n+1}) (ḡ + κ |ḡ| Δs),   κ = (Δ(d²) − ḡ·Δs)/Σ|ḡ| Δs²
///
/// with s the squared lengths between the points of both features, ḡ the mean of ∂d²/∂s at both
/// ends, and the force of length (i, j) on i 2 q_ij (x̄_i − x̄_j). Weighted by |ḡ| the correction
/// involves only lengths on which the distance depends: from a face to its edges and corners it is
/// continuous, whichever adjacent face is evaluated. @eq{central-gap}
/// @tparam kMaxSets  Sets of four points, each with six lengths.
template <int kMaxSets>
class CentralGapOf {
 public:
  static constexpr int kMaxPoints = 4 * kMaxSets, kMaxLengths = kMaxSets * NearestFour::kLengths;
  using Force = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3 * kMaxPoints, 1>;
  using Stiffness =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3 * kMaxPoints, 3 * kMaxPoints>;

  using Lengths = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxLengths, 1>;
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxLengths, kMaxLengths>;

  /// Distance of several sets of four points over a step.
  struct Over {
    int sets = 0;
    FourMoves moves[kMaxSets];
    double d_n = 0.0, d_n1 = 0.0;  ///< [m]
    Lengths g_n, g_n1;             ///< ∂(d²)/∂s at both ends.
    Square H_n1;                   ///< ∂g_n1/∂s_n1
    void resize() {
      g_n.setZero(NearestFour::kLengths * sets);
      g_n1.setZero(NearestFour::kLengths * sets);
      H_n1.setZero(NearestFour::kLengths * sets, NearestFour::kLengths * sets);
    }
  };
  CentralGapOf(const Over& over, double alpha_f, bool conserving);
  /// @param to  The features at t_{n+1}; null: equal to those at t_n.
  CentralGapOf(const FourMoves& from, const NearestFour& at_n, const FourMoves* to,
               const NearestFour& at_n1, double alpha_f, bool conserving);

  [[nodiscard]] int points() const { return points_; }
  /// Points at t_{n+αf}, those of t_n's features first.
  [[nodiscard]] const Vec3& at_alpha(int point) const { return x_alpha_[point]; }
  [[nodiscard]] Force force(double lambda) const;
  /// Resultant on the first point of each set, which is the same one.
  [[nodiscard]] Vec3 on_point(const Force& f) const {
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < points_; k += 4) sum += f.template segment<3>(3 * k);
    return sum;
  }
  /// D force / D x_{n+1}.
  [[nodiscard]] Stiffness stiffness(const contact::ForceAndSlope& lambda) const;
  /// D d_{n+1} / D x_{n+1}.
  [[nodiscard]] Force slope() const;

 private:
  using Slopes =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxLengths, 3 * kMaxPoints>;
  [[nodiscard]] Slopes slopes(const Vec3 (&x)[kMaxPoints]) const;

  int points_ = 4, lengths_ = NearestFour::kLengths;
  double alpha_;
  double d_n_, d_n1_, d_alpha_;
  Vec3 x_alpha_[kMaxPoints], x_n1_[kMaxPoints];
  int ends_[kMaxLengths][2];
  Lengths change_;                             ///< Δs
  Lengths sign_;                               ///< Of ḡ: repulsion or attraction.
  Lengths g_n1_, g_;                           ///< ∂d²/∂s at t_{n+1}; ḡ + κ |ḡ| Δs
  Lengths mean_;                               ///< ḡ
  double kappa_ = 0.0, change_squared_ = 0.0;  ///< The latter: Σ|ḡ| Δs².
  Square H_n1_;                                ///< ∂g_n1/∂s_n1
};

/// Distance with one feature at each end of the step.
using CentralGap = CentralGapOf<2>;
/// Largest number of triangles about one point, at both ends of a step together.
inline constexpr int kMaxTriangles = 8;

}  // namespace polhode::surface_contact
