// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <complex>
#include <vector>

#include <Eigen/LU>

#include <polhode/statics/follower_loads.hpp>
#include <polhode/statics/modes.hpp>
#include <polhode/statics/static_newton.hpp>

namespace polhode {

/// Hint for eigenvalues that are not found.
inline constexpr const char* kFewerModes = "Ask for fewer modes (analysis.count)";
inline constexpr const char* kHoldModel =
    "Hold the model by joints or springs, or ask for modes about the start";

using Complex = std::complex<double>;
using CVec = Eigen::VectorXcd;

/// An eigenvalue with its vector, in the unknowns of bodies and nodes: the motion Re(shape
/// exp(λt)).
struct EigenPair {
  Complex lambda;  ///< [rad/s]
  CVec shape;
};

/// Stiffness, damping and mass of a state with the constraints, as sparse matrices of one pattern:
///
///   M ẍ + C ẋ + K x − Gᵀμ = 0,  G x = 0   @eq{modes-damped}
///
/// C contains the derivatives of forces by velocities and the gyroscopic moments of rotating
/// bodies.
class ModalMatrices {
 public:
  ModalMatrices(const System& system, const State& state, const ModeOptions& options);

  [[nodiscard]] SaddleMatrix& K() { return newton_.matrix(); }  ///< Scaled by s().
  [[nodiscard]] const SaddleMatrix& M() const { return mass_; }
  [[nodiscard]] double s() const { return newton_.scale(); }
  [[nodiscard]] int n() const { return mass_.movable(); }
  /// n() and the multipliers that are states of their own, integrals of servos: rows whose
  /// compliance grows with the rate of a motion. @eq{servo-at-rest}
  [[nodiscard]] int unknowns() const { return n() + static_cast<int>(integrals_.size()); }
  [[nodiscard]] int rows() const { return mass_.size() - mass_.movable(); }
  [[nodiscard]] StaticNewton& statics() { return newton_; }
  /// Active ones of unknowns(): all but the rotations of point masses.
  [[nodiscard]] std::vector<int> counted() const;
  /// Whether forces depend on velocities.
  [[nodiscard]] bool damped() const { return damped_; }
  /// Whether they do so other than by Coriolis forces and gyroscopic moments.
  [[nodiscard]] bool dissipates() const { return dissipates_; }
  /// Whether the model is seen from a turning frame.
  [[nodiscard]] bool turns() const { return turns_; }
  /// Asymmetry of the stiffness, before its symmetric part is taken.
  [[nodiscard]] double asymmetry() const { return asymmetry_; }

  /// Rigid motions of parts that only these loads, which turn with their bodies, give a stiffness:
  /// these motions become free ones. @eq{modes-turned-loads}
  void let_turn(const State& state, const std::vector<FollowerLoad>& loads, double load_factor);
  /// Those motions, orthonormal in the metric of M.
  [[nodiscard]] const Mat& turned() const { return turned_; }

  /// Factors the symmetric part of s (K − σ M) with its constraints. @returns false if it is
  /// singular.
  [[nodiscard]] bool factor(double sigma);
  /// Number of eigenvalues ω² of the symmetric part below the shift of the last factorisation
  /// (Sylvester's law of inertia; each constraint adds one negative pivot).
  [[nodiscard]] int below() const { return solver_.negative_pivots() - rows(); }
  /// Factors s (K + σ C + σ² M) with its constraints, for any symmetry.
  [[nodiscard]] bool factor_quadratic(double sigma);
  // Products with vectors of n() or unknowns() entries, of the same length.
  /// By the last factored inverse, on the admissible motions.
  /// @throws ModesStopped
  [[nodiscard]] Vec inverse(const Vec& f) const;
  [[nodiscard]] Vec mass_times(const Vec& x) const;
  [[nodiscard]] Vec damping_times(const Vec& x) const;
  [[nodiscard]] Vec stiffness_times(const Vec& x) const;
  /// Scale |x|ᵀ|K||x| of the rounding of xᵀKx.
  [[nodiscard]] double energy_scale(const Vec& x) const;

  /// Left side −Gφ of the rows of integrals, by row, for a shape of n() entries, over s().
  [[nodiscard]] Vec integral_rows(const Vec& x) const;

  /// Dense matrices by unknowns(); exact constraint rows in Gt, compliant ones in K as springs.
  struct Dense {
    Mat K, C, M, Gt;
  };
  [[nodiscard]] Dense dense();

 private:
  void put_masses(const State& state);
  void put_damping(const State& state, const ModeOptions& options);
  void find_integrals();
  void put_springs_for_compliant_rows();
  [[nodiscard]] bool put_gyroscopic(const State& state, const std::vector<Vec3>& spin,
                                    SaddleMatrix& gyroscopic) const;
  void put_coriolis(const State& state, const TurningFrame& frame, SaddleMatrix& coriolis) const;
  void put_ground_damping(const State& state, const TurningFrame& frame);
  void put_circulatory(const State& state, const std::vector<Vec3>& spin);
  [[nodiscard]] linear::KktValues nothing() const;
  [[nodiscard]] Vec times(const SaddleMatrix& A, double factor, const Vec& x) const;
  [[nodiscard]] Vec widened(const Vec& x) const;
  [[nodiscard]] Vec narrowed(const Vec& y, Eigen::Index size) const;
  [[nodiscard]] bool is_spring(int row) const;

  const System& system_;
  const std::atomic<bool>* stop_;
  StaticNewton newton_;
  SaddleMatrix mass_, damping_, shifted_;  ///< damping_ is scaled by s() and rate_.
  double rate_ = 1.0, asymmetry_ = 0.0;
  bool damped_ = false, dissipates_ = false, turns_ = false;
  Mat turned_, K_turned_, M_turned_;  ///< V, K V and M V; no columns: none.
  Mat P_K_turned_;                    ///< (K + σC + σ²M)⁻¹ K V after factor_quadratic().
  Eigen::PartialPivLU<Mat> left_;     ///< 1 − (M V)ᵀ of that.
  std::vector<int> integrals_;        ///< Rows, ascending.
  std::vector<SaddleMatrix> of_integrals_;  ///< Their compliance at a rate of 1/s; empty: none.
  SaddleSolver solver_;
};

/// A value of ω² below which the symmetric part has at least `count` modes, and not many more.
[[nodiscard]] double range_of(ModalMatrices& m, int count);

/// Eigenvalues closest to zero of a model with unsymmetric matrices or damping; of conjugate pairs
/// the one with Im λ ≥ 0. Free motions first, then by |λ|.
/// @param wanted  Smallest number of eigenvalues, if there are as many.
/// @param freedoms  Set to their number where matrices are dense; otherwise unchanged.
[[nodiscard]] std::vector<EigenPair> damped_modes(ModalMatrices& m, int wanted, int& freedoms);

/// Basis, as orthonormal columns, of the motions admitted by the exact constraints, without
/// rotations of point masses.
[[nodiscard]] Mat allowed_motions(const ModalMatrices& m, const Mat& Gt);

}  // namespace polhode
