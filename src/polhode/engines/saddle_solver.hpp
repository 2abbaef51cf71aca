// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <polhode/engines/saddle_matrix.hpp>
#include <polhode/linear/mumps.hpp>

namespace polhode {

/// Factorisation of a SaddleMatrix plus a diagonal: LDLᵀ of its lower triangle, or LU. The symbolic
/// analysis of each is done at its first use.
class SaddleSolver {
 public:
  /// @param diagonal  Added to the matrix, by movable unknown; empty: nothing.
  /// @returns false if the matrix is singular.
  [[nodiscard]] bool factor(SaddleMatrix& matrix, bool symmetric,
                            const std::vector<double>& diagonal = {});
  void solve(Vec& x) const;
  /// Discards the analysis: the entries of the matrix have changed.
  void forget() { lu_.reset(), ldl_.reset(); }
  /// Number of negative pivots; after a symmetric factorisation.
  [[nodiscard]] int negative_pivots() const { return ldl_->negative_pivots(); }
  [[nodiscard]] bool symmetric() const { return symmetric_; }

 private:
  std::optional<linear::Mumps> lu_, ldl_;
  bool symmetric_ = true;
  std::vector<double> values_;
};

/// Motions without stiffness: x with K x = 0 and G x = 0 to round-off, each with largest component
/// one, at most `most` of them. Rotations are scaled by ℓ.
/// @param known  Known free motions, which come first; others are searched in addition.
[[nodiscard]] std::vector<Vec> free_motions(SaddleMatrix& matrix, double length, int most,
                                            const std::vector<Vec>& known = {});

/// Unknowns whose supports prevent free motions: one for each, at its largest component that is not
/// yet taken. Rotations are scaled by ℓ.
[[nodiscard]] std::vector<int> supports_of(const std::vector<Vec>& motions,
                                           const SaddleMatrix& matrix, double length);

/// A unit vector as text: "x", or "(0.6, 0, 0.8)".
[[nodiscard]] std::string axis_text(Vec3 u);

/// Description of a free motion: "body 'crank' turns about z".
[[nodiscard]] std::string describe_motion(const System& system, const SaddleMatrix& matrix,
                                          const Vec& x);

}  // namespace polhode
