// SPDX-License-Identifier: Apache-2.0
#include <Spectra/SymGEigsShiftSolver.h>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include <polhode/base/error.hpp>
#include <polhode/base/format.hpp>
#include <polhode/solve/modes.hpp>
#include <polhode/solve/static_newton.hpp>

namespace polhode {

namespace {

/// Up to so many unknowns matrices are dense.
constexpr int kDense = 400;
/// Shift of the Lanczos iterations, below zero by this part of the range of ω² that is wanted, so
/// that motions without stiffness do no harm.
constexpr double kShift = 1e-2;
constexpr int kSearches = 40;  ///< Factorisations that may be spent on finding that range.
constexpr int kRuns = 12;      ///< Of Lanczos iterations, while modes are missing.
constexpr int kSpare = 4;      ///< Modes computed beside those wanted, to have a gap to count in.
/// Relative accuracy of eigenvalues asked of the Lanczos iterations, and accepted residuals.
constexpr double kLanczos = 1e-12, kResidual = 1e-6;
/// ω² below this part of the largest one of the matrices is rounding.
constexpr double kRigid = 1e-12;
/// Rows of G whose part normal to the others is smaller count as redundant.
constexpr double kRedundant = 1e-9;

/// The saddle matrices of stiffness and mass of a state.
class Matrices {
 public:
  Matrices(const System& system, const State& state, const ModeOptions& options)
      : system_(system),
        newton_(system, {.mixed_point = false}),
        mass_(system, newton_.bodies().topology()),
        shifted_(system, newton_.bodies().topology()) {
    newton_.assemble_at(state, options.load_factor);
    put_masses(state);
  }

  [[nodiscard]] SaddleMatrix& K() { return newton_.matrix(); }  ///< Times s.
  [[nodiscard]] const SaddleMatrix& M() const { return mass_; }
  [[nodiscard]] double s() const { return newton_.scale(); }
  [[nodiscard]] int n() const { return mass_.movable(); }
  [[nodiscard]] int rows() const { return mass_.size() - mass_.movable(); }
  [[nodiscard]] StaticNewton& statics() { return newton_; }
  /// Unknowns that count: all but the turns of point masses.
  [[nodiscard]] std::vector<int> counted() const {
    std::vector<int> list;
    for (int i = 0; i < n(); ++i)
      if (i >= 6 * system_.body_count() || i % 6 < 3 || !system_.bodies()[i / 6].point_mass)
        list.push_back(i);
    return list;
  }

  /// Factors s (K − σ M) with its constraints. @returns false if it is singular.
  [[nodiscard]] bool factor(double sigma) {
    shifted_.combine(K(), -sigma * s(), mass_);
    return solver_.factor(shifted_, true);
  }
  /// Eigenvalues below the shift of the last factorisation. (Sylvester; each constraint adds one
  /// negative pivot.)
  [[nodiscard]] int below() const { return solver_.negative_pivots() - rows(); }
  /// (K − σM)⁻¹ f on motions that the constraints allow, and the scaled multipliers behind.
  [[nodiscard]] Vec inverse(const Vec& f) const {
    Vec x = Vec::Zero(mass_.size());
    x.head(n()) = s() * f.head(n());
    solver_.solve(x);
    return x;
  }
  [[nodiscard]] Vec mass_times(const Vec& x) const {
    Vec all = Vec::Zero(mass_.size()), y;
    all.head(n()) = x.head(n());
    mass_.times(all, y);
    return y.head(n());
  }

 private:
  void put_masses(const State& state) {
    const Nodes& nodes = system_.nodes();
    KktValues values;
    KktValues::Pair none;
    none.K_ab.setZero();
    none.K_ba.setZero();
    none.B_a.setZero();
    none.B_b.setZero();
    none.G_a.setZero();
    none.G_b.setZero();
    none.C.setZero();
    values.pairs.assign(newton_.bodies().topology().pairs.size(), none);
    for (int b = 0; b < system_.body_count(); ++b) {
      const BodyData& body = system_.bodies()[b];
      const Mat3 Lambda = system_.motion(state, b).Lambda();
      Mat6 M = Mat6::Zero();
      M.topLeftCorner<3, 3>().diagonal().setConstant(body.mass);
      if (!body.point_mass)
        M.bottomRightCorner<3, 3>() = Lambda * body.inertia * Lambda.transpose();
      values.diagonal.push_back(M);
    }
    const KktMap map = kkt_map(system_);
    for (std::size_t i = 0; i < system_.interactions().size(); ++i) {
      const InteractionRef& ref = system_.interactions()[i];
      const double m = system_.group(ref.group).coupled_mass(ref.item);
      if (m == 0.0) continue;
      for (int body : {ref.a, ref.b})
        if (body != kGround) values.diagonal[body].topLeftCorner<3, 3>().diagonal().array() -= m;
      if (map.pair[i] < 0) continue;
      values.pairs[map.pair[i]].K_ab.topLeftCorner<3, 3>().diagonal().array() += m;
      values.pairs[map.pair[i]].K_ba.topLeftCorner<3, 3>().diagonal().array() += m;
    }
    std::vector<double> blocks(9 * nodes.mass().size(), 0.0);
    for (std::size_t k = 0; k < nodes.mass().size(); ++k)
      for (int c = 0; c < 3; ++c) blocks[9 * k + 4 * c] = nodes.mass()[k];
    mass_.place_like(K());
    shifted_.place_like(K());
    mass_.set(values, blocks, nullptr, 1.0);
  }

  const System& system_;
  StaticNewton newton_;
  SaddleMatrix mass_, shifted_;
  SaddleSolver solver_;
};

/// What Spectra wants of (K − σM)⁻¹ and of M. Modes that are known are kept out.
struct InverseOperator {
  using Scalar = double;
  Matrices* matrices;
  const std::vector<Vec>* known;
  const std::vector<Vec>* M_known;
  [[nodiscard]] Eigen::Index rows() const { return matrices->n(); }
  [[nodiscard]] Eigen::Index cols() const { return matrices->n(); }
  void set_shift(double) const {}  // was factored with it
  void perform_op(const double* in, double* out) const {
    Vec x = matrices->inverse(Eigen::Map<const Vec>(in, matrices->n())).head(matrices->n());
    for (std::size_t i = 0; i < known->size(); ++i) x -= (*M_known)[i].dot(x) * (*known)[i];
    Eigen::Map<Vec>(out, matrices->n()) = x;
  }
};
struct MassOperator {
  using Scalar = double;
  const Matrices* matrices;
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
  double largest = 0.0;  ///< Size of ω² that rounding is measured by.
};

/// All modes, by a basis of the motions that the constraints allow.
Pairs dense_modes(Matrices& m) {
  const int n = m.n(), rows = m.rows();
  Mat K = Mat::Zero(n, n), M = Mat::Zero(n, n), Gt = Mat::Zero(n, rows);
  Vec C = Vec::Zero(rows);
  const SaddleMatrix& k = m.K();
  for (std::size_t e = 0; e < k.values().size(); ++e) {
    const int i = k.row()[e], j = k.column()[e];
    if (i < n && j < n) {
      K(i, j) += k.values()[e] / m.s();
      M(i, j) += m.M().values()[e];
    } else if (i >= n && j < n) {
      Gt(j, i - n) -= k.values()[e];
    } else if (i >= n) {
      C[i - n] -= k.values()[e];
    }
  }
  Mat exact(n, 0);
  for (int r = 0; r < rows; ++r) {
    if (C[r] > kProximal) {  // a compliant row is a spring
      K += Gt.col(r) * Gt.col(r).transpose() / (C[r] * m.s());
      continue;
    }
    exact.conservativeResize(n, exact.cols() + 1);
    exact.rightCols<1>() = Gt.col(r).normalized();
  }
  const std::vector<int> counted = m.counted();
  Mat N = Mat::Zero(n, static_cast<Eigen::Index>(counted.size()));
  for (std::size_t i = 0; i < counted.size(); ++i)
    N(counted[i], static_cast<Eigen::Index>(i)) = 1.0;
  if (exact.cols() > 0) {
    Eigen::ColPivHouseholderQR<Mat> qr(N.cols(), exact.cols());
    qr.setThreshold(kRedundant);
    qr.compute(exact(counted, Eigen::all));
    const Mat Q = qr.householderQ();
    N = N * Q.rightCols(N.cols() - qr.rank());
  }
  Pairs pairs;
  pairs.freedoms = static_cast<int>(N.cols());
  if (N.cols() == 0) return pairs;
  const Mat K_r = N.transpose() * (0.5 * (K + K.transpose())) * N;
  const Mat M_r = N.transpose() * M * N;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Mat> eigen(K_r, M_r);
  for (Eigen::Index i = 0; i < N.cols(); ++i) {
    pairs.values.push_back(eigen.eigenvalues()[i]);
    pairs.shapes.emplace_back(N * eigen.eigenvectors().col(i));
  }
  pairs.largest = std::max(std::abs(pairs.values.front()), std::abs(pairs.values.back()));
  return pairs;
}

/// A value of ω² below which there are at least `count` modes, and not many more.
double range_of(Matrices& m, int count) {
  std::vector<double> ratios;
  std::vector<double> k(m.n(), 0.0), mass(m.n(), 0.0);
  for (std::size_t e = 0; e < m.K().values().size(); ++e) {
    const int i = m.K().row()[e];
    if (i != m.K().column()[e] || i >= m.n()) continue;
    k[i] += m.K().values()[e] / m.s();
    mass[i] += m.M().values()[e];
  }
  for (int i = 0; i < m.n(); ++i)
    if (k[i] > 0.0 && mass[i] > 0.0) ratios.push_back(k[i] / mass[i]);
  std::sort(ratios.begin(), ratios.end());
  double range = ratios.empty() ? 1.0 : 1e-4 * ratios[ratios.size() / 2];
  double too_low = 0.0, too_high = 0.0;
  for (int i = 0; i < kSearches; ++i) {
    if (!m.factor(range)) {
      range *= 1.01;
      continue;
    }
    const int below = m.below();
    if (below >= count && below <= 3 * count + 12) return range;
    (below < count ? too_low : too_high) = range;
    if (too_low > 0.0 && too_high > 0.0) {
      if (too_high < 1.001 * too_low) return too_high;
      range = std::sqrt(too_low * too_high);
    } else {
      range *= below < count ? 30.0 : 1.0 / 30.0;
    }
  }
  return too_high > 0.0 ? too_high : range;
}

/// The `count` eigenvalues nearest σ, without those known. The shift must have been factored.
void lanczos(Matrices& m, double sigma, int count, Pairs& pairs) {
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
  inverse.perform_op(start.data(), first.data());  // into what the constraints allow
  solver.init(first.data());
  solver.compute(Spectra::SortRule::LargestMagn, 1000, kLanczos);
  if (solver.info() != Spectra::CompInfo::Successful)
    throw std::runtime_error("modes: the Lanczos iterations have not converged");
  const Vec values = solver.eigenvalues();
  const Mat shapes = solver.eigenvectors();
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    pairs.values.push_back(values[i]);
    pairs.shapes.emplace_back(shapes.col(i));
  }
  std::vector<std::size_t> order(pairs.values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return pairs.values[i] < pairs.values[j]; });
  const Pairs unsorted = pairs;
  for (std::size_t i = 0; i < order.size(); ++i) {
    pairs.values[i] = unsorted.values[order[i]];
    pairs.shapes[i] = unsorted.shapes[order[i]];
  }
}

/// Where to count: the middle of the widest gap between eigenvalues from `count` on.
struct Gap {
  int below = 0;  ///< Eigenvalues found below.
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

/// Lanczos iterations find one vector of each eigenvalue, and others of the same by rounding only:
/// they are repeated without what was found until the count by inertia says that nothing is
/// missing.
Pairs lanczos_modes(Matrices& m, int count, int wanted) {
  Pairs pairs;
  pairs.largest = range_of(m, wanted);
  const double sigma = -kShift * pairs.largest;
  int missing = wanted;
  for (int run = 0; run < kRuns && missing > 0; ++run) {
    if (!m.factor(sigma)) throw std::runtime_error("modes: the shifted matrix is singular");
    lanczos(m, sigma, std::min(missing + (run > 0 ? kSpare : 0), wanted), pairs);
    const Gap gap = widest_gap(pairs.values, count);
    if (!m.factor(gap.shift)) break;
    missing = m.below() - gap.below;
  }
  return pairs;
}

/// |Kφ − ω²Mφ − Gᵀμ| / (ω² |Mφ|), the multipliers from one inverse iteration.
double residual_of(Matrices& m, double sigma, const Mode& mode, double smallest) {
  const int n = m.n();
  const Vec M_phi = m.mass_times(mode.shape);
  Vec x = m.inverse((mode.omega_squared - sigma) * M_phi), K_phi;
  x.head(n) = mode.shape;
  m.K().times(x, K_phi);
  const double size = m.s() * std::max(std::abs(mode.omega_squared), smallest) * M_phi.norm();
  return (K_phi.head(n) - m.s() * mode.omega_squared * M_phi).norm() / size;
}

}  // namespace

/// @eq{modes-saddle}
ModesReport find_modes(const System& system, const State& equilibrium, const ModeOptions& options) {
  Matrices m(system, equilibrium, options);
  const int n = m.n();
  if (n == 0)
    throw InputError("modes", "nothing in the model moves", "Add a body that is not fixed");
  ModesReport report;
  StaticStep balance;
  m.statics().measure(balance);
  report.unbalanced = balance.force > 0.0 ? balance.residual / balance.force : 0.0;
  report.asymmetry = m.K().asymmetry();

  const int wanted = options.count + kSpare;
  const bool dense = n <= kDense || 3 * wanted > n;
  Pairs pairs = dense ? dense_modes(m) : lanczos_modes(m, options.count, wanted);
  report.freedoms = pairs.freedoms;
  const auto found = static_cast<int>(pairs.values.size());
  const int count = std::min(options.count, found);

  Mat e = Mat::Zero(n, 3);
  for (int b = 0; b < system.body_count(); ++b) e.block<3, 3>(6 * b, 0).setIdentity();
  for (int i = 0; i < system.nodes().count(); ++i)
    for (int c = 0; c < 3; ++c)
      if (const int u = m.K().unknown(i, c); u >= 0) e(u, c) = 1.0;
  Mat M_e(n, 3);
  for (int c = 0; c < 3; ++c) M_e.col(c) = m.mass_times(e.col(c));
  report.total_mass = e.col(0).dot(M_e.col(0));

  for (int i = 0; i < count; ++i) {
    Mode mode;
    mode.omega_squared = pairs.values[i];
    mode.frequency = std::sqrt(std::abs(mode.omega_squared)) / (2.0 * std::numbers::pi);
    mode.rigid = std::abs(mode.omega_squared) <= (dense ? kRigid : 1e-6) * pairs.largest;
    mode.shape = pairs.shapes[i] / std::sqrt(pairs.shapes[i].dot(m.mass_times(pairs.shapes[i])));
    Eigen::Index top = 0;
    mode.shape.cwiseAbs().maxCoeff(&top);
    if (mode.shape[top] < 0.0) mode.shape = -mode.shape;
    mode.participation = M_e.transpose() * mode.shape;
    for (int c = 0; c < 3; ++c) {
      const double all = e.col(c).dot(M_e.col(c));
      if (all > 0.0) mode.effective_mass[c] = mode.participation[c] * mode.participation[c] / all;
    }
    report.modes.push_back(std::move(mode));
  }

  // Every mode below a shift between two of them must have been found.
  Gap gap;
  if (count > 0) gap = widest_gap(pairs.values, count);
  report.shift = gap.shift;
  if (count > 0 && m.factor(report.shift)) {
    report.below_shift = m.below();
    report.complete = report.below_shift == gap.below;
    if (!report.complete)
      report.warnings.push_back(
          format("{} modes lie below {:.6g} Hz, but {} were found: ask for more of them",
                 report.below_shift,
                 std::sqrt(std::max(0.0, report.shift)) / (2.0 * std::numbers::pi), gap.below));
  }
  const double sigma = -kShift * std::max(std::abs(report.shift), kRigid * pairs.largest);
  if (count > 0 && m.factor(sigma))
    for (Mode& mode : report.modes) {
      mode.residual = residual_of(m, sigma, mode, std::abs(sigma));
      if (mode.residual > kResidual)
        report.warnings.push_back(format("the mode of {:.6g} Hz is accurate to {:.1g} only",
                                         mode.frequency, mode.residual));
    }
  return report;
}

std::vector<double> node_shape(const System& system, const State& equilibrium, const Mode& mode) {
  const Nodes& nodes = system.nodes();
  std::vector<double> d(3 * static_cast<std::size_t>(nodes.count()), 0.0);
  const int first = 6 * system.body_count();
  for (int i = 0; i < nodes.count(); ++i) {
    Eigen::Map<Vec3> at(d.data() + 3 * i);
    if (nodes[i].body >= 0) {
      const Vec6 x = mode.shape.segment<6>(6 * nodes[i].body);
      const Vec3 z = system.motion(equilibrium, nodes[i].body).q * nodes[i].Z;
      at = x.head<3>() + x.tail<3>().cross(z);
    }
    for (int c = 0; c < 3; ++c)
      if (nodes.unknown(i, c) >= 0) at[c] = mode.shape[first + nodes.unknown(i, c)];
  }
  return d;
}

}  // namespace polhode
