// SPDX-License-Identifier: Apache-2.0
// Eigenvalues of λ² M + λ C + K on the motions that constraints allow, K unsymmetric or C not zero.
#include <Spectra/GenEigsRealShiftSolver.h>
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <polhode/solve/modal_matrices.hpp>

namespace polhode {

namespace {

/// Up to so many freedoms all eigenvalues are found at once.
constexpr int kDense = 240;
/// Shift, as part of the frequency below which there are as many modes as wanted.
constexpr double kShift = 0.3;
/// Singular values below this part of the largest may belong to free motions, whose forces are
/// below the second number, as part of what they are the sum of.
constexpr double kSmall = 1e-10, kFree = 1e-13;
/// |λ| below this part of the shift is rounding: twofold zeros are found to half the digits.
constexpr double kZero = 1e-7;
/// Imaginary parts below this part of |λ| are rounding.
constexpr double kReal = 1e-12;
constexpr double kArnoldi = 1e-12;
constexpr int kMostFree = 60;

/// Where eigenvalues are looked for: a real number above zero, so that matrices stay real and free
/// motions do no harm.
double shift_of(ModalMatrices& m, int wanted) {
  const double range = range_of(m, wanted);
  return kShift * std::sqrt(range > 0.0 && std::isfinite(range) ? range : 1.0);
}

Complex from_inverse(Complex nu, double sigma) { return sigma * (1.0 + 1.0 / nu); }

/// Of the vectors without stiffness or damping: what another one moves along them.
/// λ² M + λ C + K, tested with the free motions V: a = −Vᵀ(λ C + K) φ / λ².
CVec along_free(const Mat& V_K, const Mat& V_C, Complex lambda, const CVec& phi) {
  if (lambda == Complex(0.0)) return CVec::Zero(V_K.rows());
  const CVec K = V_K.cast<Complex>() * phi, C = V_C.cast<Complex>() * phi;
  return -(lambda * C + K) / (lambda * lambda);
}

void add_free(std::vector<EigenPair>& list, const Vec& x) {
  list.push_back({Complex(0.0), x.cast<Complex>()});
}

/// @eq{modes-quadratic}
std::vector<EigenPair> dense_pairs(ModalMatrices& m, const Mat& N, const ModalMatrices::Dense& d,
                                   int wanted) {
  const Mat M = N.transpose() * d.M * N;
  const Eigen::LLT<Mat> L(M);
  if (L.info() != Eigen::Success) throw std::runtime_error("modes: a motion has no mass");
  const auto whiten = [&](const Mat& A) {
    const Mat left = L.matrixL().solve(Mat(N.transpose() * A * N));
    return Mat(L.matrixL().solve(left.transpose()).transpose());
  };
  const Mat K = whiten(d.K), C = whiten(d.C);
  const Mat back = N * L.matrixU().solve(Mat::Identity(M.rows(), M.cols()));
  const Eigen::Index n = K.rows();

  // Free motions: neither stiffness nor damping resists them.
  Mat stacked(2 * n, n);
  const double k = K.cwiseAbs().maxCoeff(), c = C.cwiseAbs().maxCoeff();
  stacked << K / (k > 0.0 ? k : 1.0), C / (c > 0.0 ? c : 1.0);
  const Eigen::BDCSVD<Mat> svd(stacked, Eigen::ComputeFullV);
  Eigen::Index free = 0;
  for (; free < n; ++free) {
    const Eigen::Index i = n - 1 - free;
    if (svd.singularValues()[i] > kSmall * std::max(1.0, svd.singularValues()[0])) break;
    const Vec x = back * svd.matrixV().col(i);
    const double force = std::abs(x.dot(m.stiffness_times(x)));
    if (force > kFree * m.energy_scale(x)) break;
  }
  const Mat V = svd.matrixV().rightCols(free), W = svd.matrixV().leftCols(n - free);
  const Eigen::Index p = n - free;
  std::vector<EigenPair> pairs;
  for (Eigen::Index i = 0; i < free; ++i) add_free(pairs, back * V.col(i));
  if (p == 0) return pairs;

  const Mat K_w = W.transpose() * K * W, C_w = W.transpose() * C * W;
  const Mat V_K = V.transpose() * K * W, V_C = V.transpose() * C * W;
  const double sigma = shift_of(m, std::min(wanted, static_cast<int>(n)));
  const Mat I = Mat::Identity(p, p);
  const Eigen::PartialPivLU<Mat> P(K_w + sigma * C_w + sigma * sigma * I);
  Mat T(2 * p, 2 * p);
  T.topLeftCorner(p, p) = -sigma * P.solve(C_w + sigma * I);
  T.topRightCorner(p, p) = -sigma * sigma * P.inverse();
  T.bottomLeftCorner(p, p) = I + T.topLeftCorner(p, p);
  T.bottomRightCorner(p, p) = T.topRightCorner(p, p);
  const Eigen::EigenSolver<Mat> eigen(T);
  for (Eigen::Index i = 0; i < 2 * p; ++i) {
    const Complex lambda = from_inverse(eigen.eigenvalues()[i], sigma);
    if (!std::isfinite(std::abs(lambda))) continue;
    const CVec y = eigen.eigenvectors().col(i).head(p);
    const CVec x = W.cast<Complex>() * y + V.cast<Complex>() * along_free(V_K, V_C, lambda, y);
    pairs.push_back({lambda, back.cast<Complex>() * x});
  }
  return pairs;
}

/// σ (A − σ)⁻¹ of the first-order form with the unknowns (x, v/σ), free motions kept out.
class ShiftedInverse {
 public:
  using Scalar = double;
  ShiftedInverse(ModalMatrices& m, double sigma, const Mat& V) : m_(m), sigma_(sigma), V_(V) {
    M_V_ = Mat(V.rows(), V.cols());
    for (Eigen::Index i = 0; i < V.cols(); ++i) M_V_.col(i) = m.mass_times(V.col(i));
  }
  [[nodiscard]] Eigen::Index rows() const { return 2 * m_.n(); }
  [[nodiscard]] Eigen::Index cols() const { return 2 * m_.n(); }
  void set_shift(double) const {}  // was factored with it
  void perform_op(const double* in, double* out) const {
    const int n = m_.n();
    const Vec z_1 = Eigen::Map<const Vec>(in, n), z_2 = Eigen::Map<const Vec>(in + n, n);
    const Vec f = m_.damping_times(z_1) + sigma_ * m_.mass_times(z_1 + z_2);
    Vec y = -sigma_ * m_.inverse(f).head(n);
    Vec w = z_1 + y;
    y -= V_ * (M_V_.transpose() * y);
    w -= V_ * (M_V_.transpose() * w);
    Eigen::Map<Vec>(out, n) = y;
    Eigen::Map<Vec>(out + n, n) = w;
  }

 private:
  ModalMatrices& m_;
  double sigma_;
  Mat V_, M_V_;
};

/// Free motions, orthonormal in the metric of M.
Mat free_of(ModalMatrices& m, double length) {
  Mat V(m.n(), 0);
  for (const Vec& motion : free_motions(m.K(), length, kMostFree)) {
    Vec x = motion.head(m.n());
    for (int twice = 0; twice < 2; ++twice)
      for (Eigen::Index i = 0; i < V.cols(); ++i) x -= m.mass_times(V.col(i)).dot(x) * V.col(i);
    const double square = x.dot(m.mass_times(x));
    if (!(square > 0.0)) continue;  // turns of point masses
    x /= std::sqrt(square);
    if (m.damping_times(x).norm() > kZero * m.damping_times(x.cwiseAbs()).norm()) continue;
    V.conservativeResize(m.n(), V.cols() + 1);
    V.rightCols<1>() = x;
  }
  return V;
}

std::vector<EigenPair> arnoldi_pairs(ModalMatrices& m, double length, int wanted) {
  const double sigma = shift_of(m, wanted);
  const Mat V = free_of(m, length);
  std::vector<EigenPair> pairs;
  for (Eigen::Index i = 0; i < V.cols(); ++i) add_free(pairs, V.col(i));
  if (!m.factor_quadratic(sigma)) throw std::runtime_error("modes: the shifted matrix is singular");
  ShiftedInverse inverse(m, sigma, V);
  const int n = 2 * m.n();
  const int asked = std::min(2 * wanted, n / 4);
  const int krylov = std::min(n, std::max(2 * asked + 20, 40));
  Spectra::GenEigsRealShiftSolver<ShiftedInverse> solver(inverse, asked, krylov, 0.0);
  Vec start(n), first(n);
  for (int i = 0; i < n; ++i) start[i] = 1.0 + std::sin(1.0 + 2.7 * i);
  inverse.perform_op(start.data(), first.data());  // into what the constraints allow
  solver.init(first.data());
  solver.compute(Spectra::SortRule::LargestMagn, 1000, kArnoldi, Spectra::SortRule::LargestMagn);
  if (solver.info() != Spectra::CompInfo::Successful)
    throw std::runtime_error("modes: the Arnoldi iterations have not converged");
  const Eigen::VectorXcd values = solver.eigenvalues();
  const Eigen::MatrixXcd vectors = solver.eigenvectors();
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const Complex lambda = from_inverse(1.0 / values[i], sigma);  // Spectra gives 1/ν
    CVec x = vectors.col(i).head(m.n());
    if (V.cols() > 0) {
      const Vec re = x.real(), im = x.imag();
      const CVec K = m.stiffness_times(re) + Complex(0, 1) * m.stiffness_times(im).cast<Complex>();
      const CVec C = m.damping_times(re) + Complex(0, 1) * m.damping_times(im).cast<Complex>();
      if (lambda != Complex(0.0))
        x -= V.cast<Complex>() * (V.transpose().cast<Complex>() * (lambda * C + K)) /
             (lambda * lambda);
    }
    pairs.push_back({lambda, x});
  }
  return pairs;
}

}  // namespace

std::vector<EigenPair> damped_modes(ModalMatrices& m, double length, int wanted, int& freedoms) {
  std::vector<EigenPair> all;
  if (m.n() <= kDense || 3 * wanted > m.n()) {
    const ModalMatrices::Dense d = m.dense();
    const Mat N = allowed_motions(m, d.Gt);
    freedoms = static_cast<int>(N.cols());
    if (freedoms == 0) return all;
    all = dense_pairs(m, N, d, wanted);
  } else {
    all = arnoldi_pairs(m, length, wanted);
  }
  std::vector<EigenPair> list;
  for (EigenPair& pair : all) {
    if (std::abs(pair.lambda.imag()) <= kReal * std::abs(pair.lambda)) pair.lambda.imag(0.0);
    if (pair.lambda.imag() >= 0.0) list.push_back(std::move(pair));
  }
  std::stable_sort(list.begin(), list.end(), [](const EigenPair& a, const EigenPair& b) {
    return std::abs(a.lambda) < std::abs(b.lambda);
  });
  return list;
}

}  // namespace polhode
