// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <complex>
#include <vector>

#include <polhode/statics/modes.hpp>
#include <polhode/statics/static_newton.hpp>

namespace polhode {

/// What to try where eigenvalues are not found.
inline constexpr const char* kFewerModes = "Ask for fewer modes (analysis.count)";
inline constexpr const char* kHoldModel =
    "Hold the model by joints or springs, or ask for modes about the start";

using Complex = std::complex<double>;
using CVec = Eigen::VectorXcd;

/// An eigenvalue with its vector, in the unknowns of bodies and nodes: the motion
/// Re(shape exp(λt)).
struct EigenPair {
  Complex lambda;  ///< [rad/s]
  CVec shape;
};

/// Stiffness, damping and mass of a state, with the constraints, as sparse matrices of one pattern:
///
///   M ẍ + C ẋ + K x − Gᵀμ = 0,  G x = 0   @eq{modes-damped}
///
/// C holds what forces gain with velocities, and the gyroscopic moments of bodies that turn.
class ModalMatrices {
 public:
  ModalMatrices(const System& system, const State& state, const ModeOptions& options);

  [[nodiscard]] SaddleMatrix& K() { return newton_.matrix(); }  ///< Times s().
  [[nodiscard]] const SaddleMatrix& M() const { return mass_; }
  [[nodiscard]] double s() const { return newton_.scale(); }
  [[nodiscard]] int n() const { return mass_.movable(); }
  [[nodiscard]] int rows() const { return mass_.size() - mass_.movable(); }
  [[nodiscard]] StaticNewton& statics() { return newton_; }
  /// Unknowns that count: all but the turns of point masses.
  [[nodiscard]] std::vector<int> counted() const;
  /// Forces depend on velocities.
  [[nodiscard]] bool damped() const { return damped_; }
  /// Asymmetry of the stiffness, before its symmetric part is taken.
  [[nodiscard]] double asymmetry() const { return asymmetry_; }

  /// Factors the symmetric part of s (K − σ M) with its constraints. @returns false if it is
  /// singular.
  [[nodiscard]] bool factor(double sigma);
  /// Eigenvalues ω² of the symmetric part below the shift of the last factorisation. (Sylvester;
  /// each constraint adds one negative pivot.)
  [[nodiscard]] int below() const { return solver_.negative_pivots() - rows(); }
  /// Factors s (K + σ C + σ² M) with its constraints, whatever their symmetry.
  [[nodiscard]] bool factor_quadratic(double sigma);
  /// The inverse of what was factored last times f, on motions that the constraints allow, and
  /// scaled multipliers behind.
  [[nodiscard]] Vec inverse(const Vec& f) const;
  [[nodiscard]] Vec mass_times(const Vec& x) const;
  [[nodiscard]] Vec damping_times(const Vec& x) const;
  [[nodiscard]] Vec stiffness_times(const Vec& x) const;
  /// Size of xᵀKx that rounding is measured by: |x|ᵀ|K||x|.
  [[nodiscard]] double energy_scale(const Vec& x) const;

  /// Matrices by unknown, constraint rows that are exact in Gt, compliant ones in K as springs.
  struct Dense {
    Mat K, C, M, Gt;
  };
  [[nodiscard]] Dense dense();

 private:
  void put_masses(const State& state);
  void put_damping(const State& state, const ModeOptions& options);
  void put_springs_for_compliant_rows();
  [[nodiscard]] bool put_gyroscopic(const State& state, const std::vector<Vec3>& spin,
                                    SaddleMatrix& gyroscopic) const;
  void put_circulatory(const State& state, const std::vector<Vec3>& spin);
  [[nodiscard]] KktValues nothing() const;
  [[nodiscard]] Vec times(const SaddleMatrix& A, double factor, const Vec& x) const;

  const System& system_;
  StaticNewton newton_;
  SaddleMatrix mass_, damping_, shifted_;  ///< damping_ is times s() and rate_.
  double rate_ = 1.0, asymmetry_ = 0.0;
  bool damped_ = false;
  SaddleSolver solver_;
};

/// A value of ω² below which the symmetric part has at least `count` modes, and not many more.
[[nodiscard]] double range_of(ModalMatrices& m, int count);

/// Eigenvalues next to zero of a model whose matrices are not symmetric or that is damped; of
/// conjugate ones that with Im λ ≥ 0. Free motions first, then by |λ|.
/// @param wanted    How many, at least, if there are so many.
/// @param freedoms  Set to their number where matrices are dense; else left.
[[nodiscard]] std::vector<EigenPair> damped_modes(ModalMatrices& m, int wanted, int& freedoms);

/// Columns: a basis of the motions that the exact constraints allow, orthonormal, without turns of
/// point masses.
[[nodiscard]] Mat allowed_motions(const ModalMatrices& m, const Mat& Gt);

}  // namespace polhode
