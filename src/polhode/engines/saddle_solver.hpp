// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <polhode/engines/saddle_matrix.hpp>
#include <polhode/linear/mumps.hpp>

namespace polhode {

/// Factors a SaddleMatrix with something added to its diagonal: as LDLᵀ of its lower triangle, or
/// as LU. The symbolic work of either is done when it is first asked for.
class SaddleSolver {
 public:
  /// @param diagonal  To be added, by movable unknown; empty: nothing.
  /// @returns false if the matrix is singular.
  [[nodiscard]] bool factor(SaddleMatrix& matrix, bool symmetric,
                            const std::vector<double>& diagonal = {});
  void solve(Vec& x) const;
  /// The matrix has other entries than before.
  void forget() { lu_.reset(), ldl_.reset(); }
  /// After a symmetric factorisation.
  [[nodiscard]] int negative_pivots() const { return ldl_->negative_pivots(); }
  [[nodiscard]] bool symmetric() const { return symmetric_; }

 private:
  std::optional<Mumps> lu_, ldl_;
  bool symmetric_ = true;
  std::vector<double> values_;
};

/// Motions that meet no stiffness: x with K x = 0 and G x = 0 to round-off, each of largest
/// component one, at most `most` of them. Rotations count times ℓ.
/// @param known  Free motions that come first; others are looked for beside them.
[[nodiscard]] std::vector<Vec> free_motions(SaddleMatrix& matrix, double length, int most,
                                            const std::vector<Vec>& known = {});

/// Unknowns whose supports hold free motions: one for each, where it moves most beside those
/// before. Rotations count times ℓ.
[[nodiscard]] std::vector<int> supports_of(const std::vector<Vec>& motions,
                                           const SaddleMatrix& matrix, double length);

/// "x", or "(0.6, 0, 0.8)": a unit vector in words.
[[nodiscard]] std::string axis_text(Vec3 u);

/// What a free motion is, in words: "body 'crank' turns about z".
[[nodiscard]] std::string describe_motion(const System& system, const SaddleMatrix& matrix,
                                          const Vec& x);

}  // namespace polhode
