// SPDX-License-Identifier: Apache-2.0
#include <Spectra/SymGEigsShiftSolver.h>
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/statics/undamped_modes.hpp>

namespace polhode {

namespace {

/// Number of unknowns up to which matrices are dense.
constexpr int kDense = 400;
/// Negative shift of the inverse, as a part of the requested range of ω², so that free motions do
/// not make it singular.
constexpr double kShift = 1e-2;
constexpr int kRuns = 12;  ///< Largest number of Lanczos runs, while modes are missing.
constexpr int kSpare = 4;  ///< Additional modes, to find a gap for the count.
/// Relative accuracy of eigenvalues in the Lanczos iterations.
constexpr double kLanczos = 1e-12;
/// ω², as a part of the range, below which it may be rounding; it is if the energy of the motion is
/// below the second part of the terms of its sum.
constexpr double kMayBeFree = 1e-7, kFreeEnergy = 1e-13;
/// ω², as a part of the range, below which it is always rounding: of motions without any stiffness.
constexpr double kNothing = 1e-20;

/// The operations (K − σM)⁻¹ and M in Spectra's interface, with known modes projected out.
struct InverseOperator {
  using Scalar = double;
  ModalMatrices* matrices;
  const std::vector<Vec>* known;
  const std::vector<Vec>* M_known;
  [[nodiscard]] Eigen::Index rows() const { return matrices->n(); }
  [[nodiscard]] Eigen::Index cols() const { return matrices->n(); }
  void set_shift(double) const {}  // it is already factored with it
  void perform_op(const double* in, double* out) const {
    Vec x = matrices->inverse(Eigen::Map<const Vec>(in, matrices->n()));
    for (std::size_t i = 0; i < known->size(); ++i) x -= (*M_known)[i].dot(x) * (*known)[i];
    Eigen::Map<Vec>(out, matrices->n()) = x;
  }
};
struct MassOperator {
  using Scalar = double;
  const ModalMatrices* matrices;
  [[nodiscard]] Eigen::Index rows() const { return matrices->n(); }
  [[nodiscard]] Eigen::Index cols() const { return matrices->n(); }
  void perform_op(const double* in, double* out) const {
    Eigen::Map<Vec>(out, matrices->n()) =
        matrices->mass_times(Eigen::Map<const Vec>(in, matrices->n()));
  }
};

struct Pairs {
  std::vector<double> values;  ///< ω², ascending.
  std::vector<Vec> shapes;
  int freedoms = -1;
  double range = 0.0;  ///< Size of ω² that is the reference of rounding.

  void sort() {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t i, std::size_t j) { return values[i] < values[j]; });
    const Pairs unsorted = *this;
    for (std::size_t i = 0; i < order.size(); ++i) {
      values[i] = unsorted.values[order[i]];
      shapes[i] = unsorted.shapes[order[i]];
    }
  }
};

/// All modes, by a basis of the admissible motions. Of Lᵀ (K − σM)⁻¹ L, M = L Lᵀ, the lowest modes
/// are the largest eigenvalues: slender beams lose no digits.
Pairs dense_modes(ModalMatrices& m, int wanted) {
  const ModalMatrices::Dense d = m.dense();
  const Mat N = allowed_motions(m, d.Gt);
  Pairs pairs;
  pairs.freedoms = static_cast<int>(N.cols());
  if (N.cols() == 0) return pairs;
  pairs.range = range_of(m, std::min(wanted, pairs.freedoms));
  const double sigma = -kShift * pairs.range;
  const Mat K = N.transpose() * (0.5 * (d.K + d.K.transpose())) * N;
  const Mat M = N.transpose() * d.M * N;
  const Eigen::LLT<Mat> factor(M);
  if (factor.info() != Eigen::Success)
    throw SolveError("modes: a motion has no mass", "Give every body and node that moves a mass");
  const Mat L = factor.matrixL();
  Mat T = L.transpose() * Eigen::PartialPivLU<Mat>(K - sigma * M).solve(L);
  T = Mat(0.5 * (T + T.transpose()));
  const Eigen::SelfAdjointEigenSolver<Mat> eigen(T);
  for (Eigen::Index i = 0; i < N.cols(); ++i) {
    pairs.values.push_back(sigma + 1.0 / eigen.eigenvalues()[i]);
    pairs.shapes.emplace_back(N * factor.matrixU().solve(eigen.eigenvectors().col(i)));
  }
  pairs.sort();
  return pairs;
}

/// Computes the `count` eigenvalues nearest σ, without known ones. The shift must have been
/// factored.
void lanczos(ModalMatrices& m, double sigma, int count, Pairs& pairs) {
  const int n = m.n();
  std::vector<Vec> M_known;
  for (const Vec& shape : pairs.shapes) M_known.push_back(m.mass_times(shape));
  const std::vector<Vec> known = pairs.shapes;
  InverseOperator inverse{&m, &known, &M_known};
  MassOperator mass{&m};
  const int krylov = std::min(n, std::max(2 * count + 10, 30));
  Spectra::SymGEigsShiftSolver<InverseOperator, MassOperator, Spectra::GEigsMode::ShiftInvert>
      solver(inverse, mass, count, krylov, sigma);
  Vec start(n), first(n);
  for (int i = 0; i < n; ++i)
    start[i] = 1.0 + std::sin(1.0 + (2.7 + 0.1 * static_cast<double>(known.size())) * i);
  start = m.mass_times(start);
  inverse.perform_op(start.data(), first.data());  // projected onto the constraints
  solver.init(first.data());
  solver.compute(Spectra::SortRule::LargestMagn, 1000, kLanczos);
  if (solver.info() != Spectra::CompInfo::Successful)
    throw SolveError("modes: the Lanczos iterations have not converged", kFewerModes);
  const Vec values = solver.eigenvalues();
  const Mat shapes = solver.eigenvectors();
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    pairs.values.push_back(values[i]);
    pairs.shapes.emplace_back(shapes.col(i));
  }
  pairs.sort();
}

/// Shift for the count: the middle of the widest gap between eigenvalues from `count` on.
struct Gap {
  int below = 0;  ///< Number of eigenvalues found below.
  double shift = 0.0;
};
Gap widest_gap(const std::vector<double>& values, int count) {
  const auto found = static_cast<int>(values.size());
  if (count >= found) return {found, values.back() + std::max(1.0, std::abs(values.back()))};
  int last = count;
  for (int i = count; i < found; ++i)
    if (values[i] - values[i - 1] > values[last] - values[last - 1]) last = i;
  return {last, 0.5 * (values[last - 1] + values[last])};
}

/// Modes by Lanczos iterations. These find one vector of each eigenvalue, further ones of a
/// multiple eigenvalue only by rounding: they are repeated with known modes projected out until the
/// count by inertia shows that none is missing.
Pairs lanczos_modes(ModalMatrices& m, int count, int wanted) {
  Pairs pairs;
  pairs.range = range_of(m, wanted);
  const double sigma = -kShift * pairs.range;
  int missing = wanted;
  for (int run = 0; run < kRuns && missing > 0; ++run) {
    if (!m.factor(sigma)) throw SolveError("modes: the shifted matrix is singular", kHoldModel);
    lanczos(m, sigma, std::min(missing + (run > 0 ? kSpare : 0), wanted), pairs);
    const Gap gap = widest_gap(pairs.values, count);
    if (!m.factor(gap.shift)) break;
    missing = m.below() - gap.below;
  }
  return pairs;
}

}  // namespace

UndampedModes undamped_modes(ModalMatrices& m, int count) {
  const int n = m.n(), wanted = count + kSpare;
  Pairs pairs =
      n <= kDense || 3 * wanted > n ? dense_modes(m, wanted) : lanczos_modes(m, count, wanted);
  UndampedModes result;
  result.freedoms = pairs.freedoms;
  const auto found = static_cast<int>(pairs.values.size());
  for (int i = 0; i < found; ++i) {
    double& square = pairs.values[i];
    const Vec& x = pairs.shapes[i];
    bool free = false;
    if (std::abs(square) <= kMayBeFree * pairs.range) {  // by energy: more accurate than 1/ν − σ
      const double energy = x.dot(m.stiffness_times(x));
      square = energy / x.dot(m.mass_times(x));
      free = std::abs(energy) <= kFreeEnergy * m.energy_scale(x) ||
             std::abs(square) <= kNothing * pairs.range;
    }
    result.free.push_back(free);
  }
  if (found > 0) {
    const Gap gap = widest_gap(pairs.values, std::min(count, found));
    result.shift = gap.shift;
    result.counted = m.factor(gap.shift);
    if (result.counted) {
      result.below_shift = m.below();
      result.complete = result.below_shift == gap.below;
    }
    if (!result.complete)
      result.warning =
          format("{} modes lie below {:.6g} Hz, but {} were found: ask for more of them",
                 result.below_shift,
                 std::sqrt(std::max(0.0, result.shift)) / (2.0 * std::numbers::pi), gap.below);
  }
  result.omega_squared = std::move(pairs.values);
  result.shapes = std::move(pairs.shapes);
  return result;
}

}  // namespace polhode
