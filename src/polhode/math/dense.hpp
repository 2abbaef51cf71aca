// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/core/types.hpp>

namespace polhode {

/// Operations on small dense matrices that are expensive to compile: Eigen's templates of them are
/// instantiated in one source.

/// Smallest rotation that turns one vector into the direction of another.
[[nodiscard]] Quat rotation_between(const Vec3& from, const Vec3& to);
/// Inverse by LU decomposition with partial pivoting.
[[nodiscard]] Mat6 inverse(const Mat6& A);
/// Whether Cholesky's decomposition of a symmetric matrix exists.
[[nodiscard]] bool is_positive_definite(const Mat6& A);

/// Eigenvalues of a symmetric matrix, ascending, and orthonormal eigenvectors as columns.
struct SymmetricEigen {
  Vec3 values;
  Mat3 vectors;
};
[[nodiscard]] SymmetricEigen eigen_of_symmetric(const Mat3& A);

}  // namespace polhode
