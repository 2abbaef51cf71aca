// SPDX-License-Identifier: Apache-2.0
// Eigenvalues of λ² M + λ C + K on the admissible motions, for unsymmetric K or nonzero C.
#include <Spectra/GenEigsRealShiftSolver.h>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/core/error.hpp>
#include <polhode/statics/modal_matrices.hpp>

namespace polhode {

namespace {

/// Number of degrees of freedom up to which all eigenvalues are computed by a dense solver.
constexpr int kDampedDense = 240;
/// Shift, as a part of the frequency below which the requested number of modes lies.
constexpr double kDampedShift = 0.3;
/// Shift in the search for free motions, as a part of the main shift, for a few inverse iterations;
/// and their largest energy, as a part of the terms of its sum.
constexpr double kNearZero = 1e-4, kFree = 1e-13;
constexpr int kIterations = 4;
constexpr double kSlows = 1e-3;  ///< Part of a free motion that damping may dissipate in that time.
/// Part of a free motion that Coriolis forces may deflect in a time 1/σ where they are rounding: in
/// a turning frame a motion is only apart from the others without them.
constexpr double kDeflected = 1e-9;
/// Size of rounding for eigenvalues of the inverse that belong to massless degrees of freedom.
constexpr double kNoMass = 1e-15;
/// |λ|, as a part of the shift, below which it is rounding.
constexpr double kZero = 1e-7;
/// Imaginary part, as a part of |λ|, below which it is rounding.
constexpr double kReal = 1e-12;
constexpr double kArnoldi = 1e-12;
constexpr int kMaxFree = 60;

/// Positive real shift of the eigenvalue search: matrices stay real and free motions do not make
/// them singular.
double shift_of(ModalMatrices& m, int wanted) {
  const double range = range_of(m, wanted);
  return kDampedShift * std::sqrt(range > 0.0 && std::isfinite(range) ? range : 1.0);
}

Complex from_inverse(Complex nu, double sigma) {
  const Complex lambda = sigma * (1.0 + 1.0 / nu);
  return std::abs(lambda) <= kZero * sigma ? Complex(0.0) : lambda;
}

/// Eigenvalues without damping, of σ² (K + σ²M)⁻¹M: λ² is exactly real if ν is. Both roots; one
/// grows if they are not imaginary.
std::pair<Complex, Complex> undamped_from_inverse(Complex nu, double sigma) {
  const Complex square = sigma * sigma * (1.0 - 1.0 / nu);
  if (std::abs(square) <= kZero * kZero * sigma * sigma) return {0.0, 0.0};
  if (square.imag() == 0.0) {
    const double root = std::sqrt(std::abs(square.real()));
    return square.real() < 0.0 ? std::pair(Complex(0.0, root), Complex(0.0, -root))
                               : std::pair(Complex(root, 0.0), Complex(-root, 0.0));
  }
  const Complex root = std::sqrt(square);
  return {root, -root};
}

CVec times(const Mat& A, const CVec& x) {
  CVec y(A.rows());
  y.real() = A * x.real();
  y.imag() = A * x.imag();
  return y;
}

/// Motions with neither stiffness nor damping, orthonormal in the metric of M.
Mat free_of(ModalMatrices& m, double sigma) {
  Mat V(m.unknowns(), 0);
  if (m.turned().cols() > 0) V = m.turned();
  if (!m.factor_quadratic(kNearZero * sigma)) return V;
  const auto clean = [&](Vec& x) {
    for (Eigen::Index i = 0; i < V.cols(); ++i) x -= m.mass_times(V.col(i)).dot(x) * V.col(i);
    const double square = x.dot(m.mass_times(x));
    if (square > 0.0) x /= std::sqrt(square);
    return square > 0.0;
  };
  while (V.cols() < kMaxFree) {
    Vec x(m.unknowns());
    const double step = 2.7 + 0.3 * static_cast<double>(V.cols());
    for (int i = 0; i < m.unknowns(); ++i) x[i] = 1.0 + std::sin(1.0 + step * i);
    bool moves = clean(x);
    for (int k = 0; k < kIterations && moves; ++k) {
      x = m.inverse(m.mass_times(x));
      moves = clean(x) && clean(x) && x.allFinite();
    }
    if (!moves || std::abs(x.dot(m.stiffness_times(x))) > kFree * m.energy_scale(x)) break;
    // Effect of damping, or of a gyroscopic moment, on it in a time 1/(kNearZero σ).
    const Vec y = m.inverse(m.damping_times(x));
    const double change = std::sqrt(y.dot(m.mass_times(y))) * sigma;
    if (m.turns() ? change > kDeflected : change * kNearZero > kSlows) break;
    V.conservativeResize(m.unknowns(), V.cols() + 1);
    V.rightCols<1>() = x;
  }
  return V;
}

/// @eq{modes-quadratic}
std::vector<EigenPair> dense_pairs(ModalMatrices& m, const Mat& N, const ModalMatrices::Dense& d,
                                   int wanted) {
  const auto n = static_cast<int>(N.cols());
  const int modes = std::max(1, n - (m.unknowns() - m.n()));  // integrals are no oscillators
  const double sigma = shift_of(m, std::min(wanted, modes));
  const Mat V = free_of(m, sigma);
  std::vector<EigenPair> pairs;
  for (Eigen::Index i = 0; i < V.cols(); ++i)
    pairs.push_back({Complex(0.0), V.col(i).cast<Complex>()});
  const Eigen::Index p = n - V.cols();
  if (p <= 0) return pairs;
  // The others in the orthogonal complement in the metric of M.
  Mat W = N;
  if (V.cols() > 0) {
    const Mat M_V = N.transpose() * (d.M * V);
    const Mat Q = Eigen::HouseholderQR<Mat>(M_V).householderQ() * Mat::Identity(n, n);
    W = N * Q.rightCols(p);
  }
  const Mat K_W = d.K * W, C_W = d.C * W, M_W = d.M * W;
  const Mat K = W.transpose() * K_W, C = W.transpose() * C_W, M = W.transpose() * M_W;
  const Mat V_K = V.transpose() * K_W, V_C = V.transpose() * C_W;
  const Eigen::PartialPivLU<Mat> P(Mat(K + sigma * C + (sigma * sigma) * M));
  const Mat P_M = (sigma * sigma) * P.solve(M);
  const auto add = [&](Complex lambda, const CVec& y) {
    CVec x = times(W, y);
    if (V.cols() > 0 && lambda != Complex(0.0))
      x -= times(V, (lambda * times(V_C, y) + times(V_K, y)) / (lambda * lambda));
    pairs.push_back({lambda, x});
  };
  if (!m.damped()) {
    const Eigen::EigenSolver<Mat> eigen(P_M);
    for (Eigen::Index i = 0; i < p; ++i) {
      const Complex nu = eigen.eigenvalues()[i];
      if (std::abs(nu) <= kNoMass) continue;
      const auto [root, other] = undamped_from_inverse(nu, sigma);
      add(root, eigen.eigenvectors().col(i));
      if (other != root) add(other, eigen.eigenvectors().col(i));
    }
    return pairs;
  }
  const Mat P_C = sigma * P.solve(C) + P_M;
  Mat T(2 * p, 2 * p);
  T.topLeftCorner(p, p) = -P_C;
  T.topRightCorner(p, p) = -P_M;
  T.bottomLeftCorner(p, p) = Mat::Identity(p, p) - P_C;
  T.bottomRightCorner(p, p) = -P_M;
  const Eigen::EigenSolver<Mat> eigen(T);
  for (Eigen::Index i = 0; i < 2 * p; ++i)
    if (std::abs(eigen.eigenvalues()[i]) > kNoMass)
      add(from_inverse(eigen.eigenvalues()[i], sigma), eigen.eigenvectors().col(i).head(p));
  return pairs;
}

/// Operator σ (A − σ)⁻¹ of the first-order form with the unknowns (x, v/σ), free motions projected
/// out; without damping σ² (K + σ²M)⁻¹M.
class ShiftedInverse {
 public:
  using Scalar = double;
  ShiftedInverse(ModalMatrices& m, double sigma, const Mat& V) : m_(m), sigma_(sigma), V_(V) {
    M_V_ = Mat(V.rows(), V.cols());
    for (Eigen::Index i = 0; i < V.cols(); ++i) M_V_.col(i) = m.mass_times(V.col(i));
  }
  [[nodiscard]] Eigen::Index rows() const {
    return m_.damped() ? 2 * m_.unknowns() : m_.unknowns();
  }
  [[nodiscard]] Eigen::Index cols() const { return rows(); }
  void set_shift(double) const {}  // it is already factored with it
  void perform_op(const double* in, double* out) const {
    const int n = m_.unknowns();
    if (!m_.damped()) {
      const Vec x = Eigen::Map<const Vec>(in, n);
      Vec y = sigma_ * sigma_ * m_.inverse(m_.mass_times(x));
      y -= V_ * (M_V_.transpose() * y);
      Eigen::Map<Vec>(out, n) = y;
      return;
    }
    const Vec z_1 = Eigen::Map<const Vec>(in, n), z_2 = Eigen::Map<const Vec>(in + n, n);
    const Vec f = m_.damping_times(z_1) + sigma_ * m_.mass_times(z_1 + z_2);
    Vec y = -sigma_ * m_.inverse(f);
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

std::vector<EigenPair> arnoldi_pairs(ModalMatrices& m, int wanted) {
  const double sigma = shift_of(m, wanted);
  const Mat V = free_of(m, sigma);
  std::vector<EigenPair> pairs;
  for (Eigen::Index i = 0; i < V.cols(); ++i)
    pairs.push_back({Complex(0.0), V.col(i).cast<Complex>()});
  if (!m.factor_quadratic(sigma))
    throw SolveError("modes: the shifted matrix is singular", kHoldModel);
  ShiftedInverse inverse(m, sigma, V);
  const auto n = static_cast<int>(inverse.rows());
  const int asked = std::min(m.damped() ? 2 * wanted : wanted, n / 4);
  const int krylov = std::min(n, std::max(2 * asked + 20, 40));
  Spectra::GenEigsRealShiftSolver<ShiftedInverse> solver(inverse, asked, krylov, 0.0);
  Vec start(n), first(n);
  for (int i = 0; i < n; ++i) start[i] = 1.0 + std::sin(1.0 + 2.7 * i);
  inverse.perform_op(start.data(), first.data());  // projected onto the constraints
  solver.init(first.data());
  solver.compute(Spectra::SortRule::LargestMagn, 1000, kArnoldi, Spectra::SortRule::LargestMagn);
  if (solver.info() != Spectra::CompInfo::Successful)
    throw SolveError("modes: the Arnoldi iterations have not converged", kFewerModes);
  const Eigen::VectorXcd values = solver.eigenvalues();
  const Eigen::MatrixXcd vectors = solver.eigenvectors();
  const auto add = [&](Complex lambda, CVec x) {
    if (V.cols() > 0 && lambda != Complex(0.0)) {
      const Vec re = x.real(), im = x.imag();
      CVec K(m.unknowns()), C(m.unknowns());
      K.real() = m.stiffness_times(re);
      K.imag() = m.stiffness_times(im);
      C.real() = m.damping_times(re);
      C.imag() = m.damping_times(im);
      x -= times(V, times(V.transpose(), lambda * C + K) / (lambda * lambda));
    }
    pairs.push_back({lambda, std::move(x)});
  };
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const Complex nu = 1.0 / values[i];  // Spectra returns the inverse
    const CVec x = vectors.col(i).head(m.unknowns());
    if (m.damped()) {
      add(from_inverse(nu, sigma), x);
      continue;
    }
    const auto [root, other] = undamped_from_inverse(nu, sigma);
    add(root, x);
    if (other != root) add(other, x);
  }
  return pairs;
}

}  // namespace

std::vector<EigenPair> damped_modes(ModalMatrices& m, int wanted, int& freedoms) {
  std::vector<EigenPair> all;
  if (m.n() <= kDampedDense || 3 * wanted > m.n()) {
    const ModalMatrices::Dense d = m.dense();
    const Mat N = allowed_motions(m, d.Gt);
    freedoms = static_cast<int>(N.cols()) - (m.unknowns() - m.n());
    if (freedoms == 0) return all;
    all = dense_pairs(m, N, d, wanted);
  } else {
    all = arnoldi_pairs(m, wanted);
  }
  std::vector<EigenPair> list;
  for (EigenPair& pair : all) {
    if (std::abs(pair.lambda.imag()) <= kReal * std::abs(pair.lambda)) pair.lambda.imag(0.0);
    pair.shape.conservativeResize(m.n());  // without integrals
    if (pair.lambda.imag() >= 0.0) list.push_back(std::move(pair));
  }
  std::stable_sort(list.begin(), list.end(), [](const EigenPair& a, const EigenPair& b) {
    return std::abs(a.lambda) < std::abs(b.lambda);
  });
  return list;
}

}  // namespace polhode
