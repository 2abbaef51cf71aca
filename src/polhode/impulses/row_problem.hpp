// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

#include <polhode/core/types.hpp>

namespace polhode {

/// Rows of a row problem that belong together.
struct ImpulseRows {
  enum class Kind {
    equality,  ///< y = 0, one row: of a joint.
    normal,    ///< 0 ≤ p ⊥ y ≥ 0, one row: of a contact point or a stop.
    /// One to three rows of a friction cone: |p| at most its bound; y = 0 inside the cone, y
    /// against its outward normal on it: most dissipation. Coulomb friction and rolling have two
    /// rows, torsion has one.
    friction
  };
  Kind kind = Kind::normal;
  Eigen::Index first = 0;    ///< Number of the first row.
  Eigen::Index size = 1;     ///< Number of rows.
  Eigen::Index normal = -1;  ///< Row of a friction cone's normal impulse; −1: none.
  /// Half axes of the friction cone's section per unit normal impulse, μ [-] or a length [m].
  Vec3 half_axes = Vec3::Zero();
  double carried = 0.0;  ///< Normal impulse of the friction cone besides that of the row [N s].
};

/// Result of a row problem.
struct RowReport {
  bool converged = true;
  /// Largest error of a row's velocity [m/s].
  double error = 0.0;
  Eigen::Index worst = -1;  ///< Its row; −1: none.
  int iterations = 0;       ///< Of Newton's method.
  int sweeps = 0;           ///< Gauss-Seidel, where Newton's method did not converge.
};

/// Impulses p of unilateral and frictional rows with the velocities y = A p + b, in addition to
/// impulses that act already: bounds hold for their sums. @eq{row-problem}
///
/// Newton's method solves the natural map F = p − proj(p − y/d) = 0 of the sums, with d_i = A_ii of
/// a row and the largest eigenvalue of the block of friction, of an elliptic cone times (μ/μ_i)²
/// with its larger half axis μ. Impulses of rows that share a load
/// are unique by proximal iterations: the solution is the nearest one to the initial impulses,
/// whatever the order of the rows. (P. Alart and A. Curnier, Comput. Methods Appl. Mech. Engrg. 92,
/// 1991, 353-375; R. T. Rockafellar, SIAM J. Control Optim. 14, 1976, 877-898.)
struct RowProblem {
  /// @param rows  Number of rows.
  explicit RowProblem(Eigen::Index rows);

  Mat A;      ///< Velocities by unit impulses; nearly symmetric, positive semi-definite [1/kg].
  Vec b;      ///< Velocities for p = 0, less their targets [m/s].
  Vec given;  ///< Impulses that act already, contained in b [N s]; zero at first.
  /// Lengths that turn angular velocities into velocities; 1 of other rows.
  Vec lengths;
  /// Error of the initial impulses above which a thousandth of it may be left [m/s]: where the
  /// problem is the linearisation of one that is linearised again.
  double exact_below = std::numeric_limits<double>::infinity();
  std::vector<ImpulseRows> blocks;  ///< Each row in one of them.
  /// The nearest solution is that by the sum of squares of impulses; otherwise these are weighted
  /// by the mobilities d.
  bool even = false;

  /// Improves impulses until the error of every row is below the tolerance and the rounding of its
  /// velocity, 64 ε (Σ|A_ij p_j| + |b_i|). Otherwise the best impulses found are left, and the
  /// report says so.
  /// @param p  Initial impulses; the solution. @param tolerance  Of velocities [m/s].
  /// @param guess  Impulses at which the search begins instead, such as those of the step before;
  /// the solution is still the nearest one to the initial impulses. Null: none.
  [[nodiscard]] RowReport solve(Vec& p, double tolerance, const Vec* guess = nullptr) const;
};

/// Largest number of rows for which the dense factors of RowProblem pay.
inline constexpr Eigen::Index kMostDenseRows = 300;

}  // namespace polhode
