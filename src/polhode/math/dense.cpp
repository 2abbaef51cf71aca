// SPDX-License-Identifier: Apache-2.0
#include <polhode/math/dense.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace polhode {

Quat rotation_between(const Vec3& from, const Vec3& to) { return Quat::FromTwoVectors(from, to); }

Mat6 inverse(const Mat6& A) { return A.inverse(); }

bool is_positive_definite(const Mat6& A) { return Eigen::LLT<Mat6>(A).info() == Eigen::Success; }

SymmetricEigen eigen_of_symmetric(const Mat3& A) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace polhode
