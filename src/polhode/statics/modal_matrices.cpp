// SPDX-License-Identifier: Apache-2.0
#include <Eigen/QR>

#include <algorithm>
#include <cmath>

#include <polhode/core/format.hpp>
#include <polhode/math/exp_map.hpp>
#include <polhode/math/hat.hpp>

#include <polhode/statics/modal_matrices.hpp>
#include <polhode/statics/turning_model.hpp>

namespace polhode {

namespace {

/// Relative size of the part of a row of G normal to the others below which it is redundant.
constexpr double kRedundant = 1e-9;
/// Largest number of factorisations in the search for a range of ω².
constexpr int kSearches = 40;
/// Damping, as a part of the stiffness at frequencies of the model, below which it is rounding.
constexpr double kNoDamping = 1e-14;
/// Increment of central differences of order four, for rotations and relative lengths [-]:
/// truncation is its fourth power over 30, rounding 1e-16 over it.
constexpr double kDifference = 1e-3;

double largest(const SaddleMatrix& A, int n) {
  double most = 0.0;
  for (std::size_t e = 0; e < A.values().size(); ++e)
    if (A.row()[e] < n && A.column()[e] < n) most = std::max(most, std::abs(A.values()[e]));
  return most;
}

/// Diagonal stiffness over mass, in ascending order [rad²/s²].
std::vector<double> diagonal_ratios(const SaddleMatrix& K, double s, const SaddleMatrix& M) {
  const auto n = static_cast<std::size_t>(M.movable());
  std::vector<double> ratios, k(n, 0.0), mass(n, 0.0);
  for (std::size_t e = 0; e < K.values().size(); ++e) {
    const int i = K.row()[e];
    if (i != K.column()[e] || i >= M.movable()) continue;
    k[static_cast<std::size_t>(i)] += K.values()[e] / s;
    mass[static_cast<std::size_t>(i)] += M.values()[e];
  }
  for (std::size_t i = 0; i < n; ++i)
    if (k[i] > 0.0 && mass[i] > 0.0) ratios.push_back(k[i] / mass[i]);
  std::sort(ratios.begin(), ratios.end());
  return ratios;
}

}  // namespace

ModalMatrices::ModalMatrices(const System& system, const State& state, const ModeOptions& options)
    : system_(system),
      stop_(options.stop),
      newton_(system, {.mixed_point = false}),
      mass_(system, newton_.bodies().topology()),
      damping_(system, newton_.bodies().topology()),
      shifted_(system, newton_.bodies().topology()) {
  newton_.assemble_at(state, options.load_factor);
  if (newton_.rows())  // those that act are rows of the matrices
    mass_ = damping_ = shifted_ = SaddleMatrix(system, newton_.topology());
  put_masses(state);
  put_damping(state, options);
  put_springs_for_compliant_rows();
  asymmetry_ = K().asymmetry();
}

std::vector<int> ModalMatrices::counted() const {
  std::vector<int> list;
  for (int i = 0; i < n(); ++i)
    if (i >= 6 * system_.body_count() || i % 6 < 3 || !system_.bodies()[i / 6].point_mass)
      list.push_back(i);
  for (int i = n(); i < unknowns(); ++i) list.push_back(i);
  return list;
}

linear::KktValues ModalMatrices::nothing() const {
  linear::KktValues values;
  linear::KktValues::Pair none;
  none.K_ab.setZero();
  none.K_ba.setZero();
  none.B_a.setZero();
  none.B_b.setZero();
  none.G_a.setZero();
  none.G_b.setZero();
  none.C.setZero();
  values.pairs.assign(newton_.topology().pairs.size(), none);
  values.diagonal.assign(static_cast<std::size_t>(system_.body_count()), Mat6::Zero());
  return values;
}

void ModalMatrices::put_masses(const State& state) {
  const Nodes& nodes = system_.nodes();
  linear::KktValues values = nothing();
  for (int b = 0; b < system_.body_count(); ++b) {
    const BodyData& body = system_.bodies()[b];
    const Mat3 Lambda = system_.motion(state, b).Lambda();
    Mat6& M = values.diagonal[b];
    M.topLeftCorner<3, 3>().diagonal().setConstant(body.mass);
    if (!body.point_mass) M.bottomRightCorner<3, 3>() = Lambda * body.inertia * Lambda.transpose();
  }
  const KktMap map = kkt_map(system_);
  for (std::size_t i = 0; i < system_.interactions().size(); ++i) {
    const InteractionRef& ref = system_.interactions()[i];
    const double m = system_.traits(ref).coupled_mass;
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
  damping_.place_like(K());
  shifted_.place_like(K());
  mass_.set(values, blocks, nullptr, 1.0);
}

/// Converts compliant rows to springs: G Δq + C Δλ̂ = 0 adds B C⁻¹ G to the stiffness; the row
/// becomes Δλ̂ = 0. @eq{compliance-row}
void ModalMatrices::put_springs_for_compliant_rows() {
  const linear::KktValues& given = newton_.bodies().values();
  const linear::KktTopology& topology = newton_.bodies().topology();
  linear::KktValues values = nothing();
  bool any = false;
  for (std::size_t i = 0; i < topology.pairs.size(); ++i) {
    const linear::KktPair& pair = topology.pairs[i];
    const linear::KktValues::Pair& from = given.pairs[i];
    linear::KktValues::Pair& to = values.pairs[i];
    for (int k = 0; k < pair.rows; ++k) {
      if (!is_spring(pair.first_row + k)) continue;
      any = true;
      const bool on_a = pair.a != kGround, on_b = pair.b != kGround;
      if (on_a) values.diagonal[pair.a] += from.B_a.col(k) * from.G_a.row(k) / from.C[k];
      if (on_b) values.diagonal[pair.b] += from.B_b.col(k) * from.G_b.row(k) / from.C[k];
      if (on_a && on_b) {
        to.K_ab += from.B_a.col(k) * from.G_b.row(k) / from.C[k];
        to.K_ba += from.B_b.col(k) * from.G_a.row(k) / from.C[k];
      }
      to.B_a.col(k) = -from.B_a.col(k);
      to.B_b.col(k) = -from.B_b.col(k);
      to.G_a.row(k) = -from.G_a.row(k);
      to.G_b.row(k) = -from.G_b.row(k);
    }
  }
  if (!any) return;
  SaddleMatrix more(mass_);
  more.set(values, std::vector<double>(9 * system_.nodes().mass().size(), 0.0), nullptr, 1.0);
  K().combine(K(), 1.0, more);
}

/// Computes C: the change of the tangent with a rate, at zero velocities, plus the gyroscopic
/// terms. @eq{modes-damped} @eq{modes-gyroscopic}
void ModalMatrices::put_damping(const State& state, const ModeOptions& options) {
  const std::vector<double> ratios = diagonal_ratios(K(), s(), mass_);
  rate_ = ratios.empty() ? 1.0 : std::sqrt(ratios[ratios.size() / 2]);
  SaddleMatrix still(K());
  newton_.assemble_with_rates(rate_);
  damping_.combine(K(), -1.0, still);
  K() = still;
  find_integrals();
  if (!options.spin.empty()) {
    SaddleMatrix gyroscopic(mass_);
    if (put_gyroscopic(state, options.spin, gyroscopic)) {
      damping_.combine(damping_, s() * rate_, gyroscopic);
      put_circulatory(state, options.spin);
    }
  }
  const auto above_rounding = [&] {
    return !integrals_.empty() ||
           largest(damping_, n()) > kNoDamping * std::max(largest(K(), n()), 1e-300);
  };
  dissipates_ = above_rounding();
  if (options.frame) {
    turns_ = options.frame->speed != 0.0;
    SaddleMatrix coriolis(mass_);
    put_coriolis(state, *options.frame, coriolis);
    damping_.combine(damping_, s() * rate_, coriolis);
    if (!options.frame->ground_turns) put_ground_damping(state, *options.frame);
  }
  damped_ = above_rounding();
}

/// Finds the rows whose compliance grows with the rate, after assembly with rates.
/// @eq{servo-at-rest}
void ModalMatrices::find_integrals() {
  for (std::size_t e = 0; e < damping_.values().size(); ++e)
    if (damping_.row()[e] >= n() && damping_.row()[e] == damping_.column()[e] &&
        damping_.values()[e] != 0.0)
      integrals_.push_back(damping_.row()[e] - n());
  if (integrals_.empty()) return;
  std::sort(integrals_.begin(), integrals_.end());
  linear::KktValues values = nothing();
  const linear::KktTopology& topology = newton_.bodies().topology();
  for (std::size_t i = 0; i < topology.pairs.size(); ++i)
    for (int k = 0; k < topology.pairs[i].rows; ++k)
      if (std::binary_search(integrals_.begin(), integrals_.end(), topology.pairs[i].first_row + k))
        values.pairs[i].C[k] = newton_.bodies().values().pairs[i].C[k] / rate_;
  of_integrals_.push_back(mass_);
  of_integrals_.back().set(values, std::vector<double>(9 * system_.nodes().mass().size(), 0.0),
                           nullptr, 1.0);
}

/// Adds the gyroscopic terms. The momentum about the centre of mass is L = J ω with ω = ω_0 + θ̇ +
/// θ × ω_0 and J = J_0 rotated by θ: its rate is J θ̈ − L̂ θ̇ + (ω̂ J − J ω̂) θ̇ about a steady
/// spin. @eq{modes-gyroscopic}
bool ModalMatrices::put_gyroscopic(const State& state, const std::vector<Vec3>& spin,
                                   SaddleMatrix& gyroscopic) const {
  linear::KktValues values = nothing();
  bool any = false;
  for (int b = 0; b < system_.body_count(); ++b) {
    const BodyData& body = system_.bodies()[b];
    const Vec3& W = spin[static_cast<std::size_t>(b)];
    if (body.point_mass || W.isZero(0.0)) continue;
    any = true;
    const Mat3 Lambda = system_.motion(state, b).Lambda();
    const Mat3 D = -hat(body.inertia * W) + hat(W) * body.inertia - body.inertia * hat(W);
    values.diagonal[b].bottomRightCorner<3, 3>() = Lambda * D * Lambda.transpose();
  }
  gyroscopic.set(values, std::vector<double>(9 * system_.nodes().mass().size(), 0.0), nullptr, 1.0);
  return any;
}

/// Sets the Coriolis terms 2Ω M S, with those of the bodies' rotations. @eq{spin-matrices}
/// @eq{spin-body}
void ModalMatrices::put_coriolis(const State& state, const TurningFrame& frame,
                                 SaddleMatrix& coriolis) const {
  linear::KktValues values = nothing();
  const Mat3 S = hat(frame.omega());
  for (int b = 0; b < system_.body_count(); ++b) {
    const BodyData& body = system_.bodies()[b];
    const Mat3 Lambda = system_.motion(state, b).Lambda();
    const Mat3 J = Lambda * body.inertia * Lambda.transpose();
    values.diagonal[b].topLeftCorner<3, 3>() = 2.0 * body.mass * S;
    if (!body.point_mass)
      values.diagonal[b].bottomRightCorner<3, 3>() = 2.0 * (S * J + J * S) - J.trace() * S;
  }
  const KktMap map = kkt_map(system_);
  for (std::size_t i = 0; i < system_.interactions().size(); ++i) {
    const InteractionRef& ref = system_.interactions()[i];
    const Mat3 C = 2.0 * system_.traits(ref).coupled_mass * S;
    if (C.isZero(0.0)) continue;
    for (int body : {ref.a, ref.b})
      if (body != kGround) values.diagonal[body].topLeftCorner<3, 3>() -= C;
    if (map.pair[i] < 0) continue;
    values.pairs[map.pair[i]].K_ab.topLeftCorner<3, 3>() += C;
    values.pairs[map.pair[i]].K_ba.topLeftCorner<3, 3>() += C;
  }
  const std::vector<double>& mass = system_.nodes().mass();
  std::vector<double> blocks(9 * mass.size(), 0.0);
  for (std::size_t k = 0; k < mass.size(); ++k)
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(blocks.data() + 9 * k) =
        2.0 * mass[k] * S;
  coriolis.set(values, blocks, nullptr, 1.0);
}

/// Adds the stiffness Ω C S of dampers on a ground that stands. @eq{spin-ground-damping}
void ModalMatrices::put_ground_damping(const State& state, const TurningFrame& frame) {
  linear::KktValues values = nothing();
  bool any = false;
  Mat6 S = Mat6::Zero();
  S.topLeftCorner<3, 3>() = S.bottomRightCorner<3, 3>() = hat(frame.omega());
  for (const InteractionRef& ref : system_.interactions()) {
    if (ref.rows > 0 || !system_.traits(ref).dissipates) continue;
    if ((ref.a == kGround) == (ref.b == kGround)) continue;
    any = true;
    values.diagonal[ref.a == kGround ? ref.b : ref.a] += damping_on_ground(system_, state, ref) * S;
  }
  if (!any) return;
  SaddleMatrix more(mass_);
  more.set(values, std::vector<double>(9 * system_.nodes().mass().size(), 0.0), nullptr, 1.0);
  K().combine(K(), s(), more);
}

/// Adds the circulatory stiffness. Forces of dampers that rotate with their bodies also depend on
/// the configuration; this stiffness does work around a closed path. By central differences of the
/// velocity-dependent part of each wrench. @eq{modes-circulatory}
void ModalMatrices::put_circulatory(const State& state, const std::vector<Vec3>& spin) {
  linear::KktValues values = nothing();
  const KktMap map = kkt_map(system_);
  StepContext context;
  context.load_factor = 1.0;
  context.t_n = state.t;
  context.conserving = context.tangents = false;
  const double length = system_.length_scale();
  const std::vector<double> none(kMaxRows, 0.0);
  bool any = false;
  for (std::size_t i = 0; i < system_.interactions().size(); ++i) {
    const InteractionRef& ref = system_.interactions()[i];
    const InteractionGroup& group = system_.group(ref.group);
    const auto turns = [&](int body) {
      return body != kGround && !spin[static_cast<std::size_t>(body)].isZero(0.0);
    };
    if (ref.rows > 0 || !group.traits(ref.item).dissipates || (!turns(ref.a) && !turns(ref.b)))
      continue;
    any = true;
    const auto wrenches = [&](int moved, int component, double by, bool turning) {
      const auto at = [&](int body) {
        if (body == kGround) return BodyStep::ground(1.0);
        const BodyMotion m = system_.motion(state, body);
        Vec3 r = m.r;
        Mat3 Lambda = m.Lambda();
        if (body == moved && component < 3) r[component] += by;
        if (body == moved && component >= 3)
          Lambda = exp_map(by * Vec3::Unit(component - 3)) * Lambda;
        const Vec3 W = turning ? spin[static_cast<std::size_t>(body)] : Vec3(Vec3::Zero());
        return BodyStep::at_instant(r, Lambda, Vec3::Zero(), W);
      };
      const BodyStep a = at(ref.a), b = at(ref.b);
      const PairStep step{a, b, context, none.data(), state.history.data() + ref.first_history};
      PairTerms terms;
      terms.set_zero();
      const int item = ref.item;
      group.evaluate({&item, 1}, {&step, 1}, {&terms, 1});
      return std::pair<Vec6, Vec6>(terms.wrench_a, terms.wrench_b);
    };
    for (const int moved : {ref.a, ref.b}) {
      if (moved == kGround) continue;
      for (int c = 0; c < 6; ++c) {
        const double h = c < 3 ? kDifference * length : kDifference;
        Vec6 D_a = Vec6::Zero(), D_b = Vec6::Zero();
        for (const auto& [place, weight] :
             {std::pair(1.0, 2.0 / 3.0), std::pair(-1.0, -2.0 / 3.0), std::pair(2.0, -1.0 / 12.0),
              std::pair(-2.0, 1.0 / 12.0)})
          for (const bool turning : {true, false}) {
            const auto [on_a, on_b] = wrenches(moved, c, place * h, turning);
            const double factor = (turning ? weight : -weight) / h;
            D_a -= factor * on_a;
            D_b -= factor * on_b;
          }
        const bool first = moved == ref.a;
        if (ref.a != kGround)
          (first ? values.diagonal[ref.a] : values.pairs[map.pair[i]].K_ab).col(c) += D_a;
        if (ref.b != kGround)
          (first ? values.pairs[map.pair[i]].K_ba : values.diagonal[ref.b]).col(c) += D_b;
      }
    }
  }
  if (!any) return;
  SaddleMatrix more(mass_);
  more.set(values, std::vector<double>(9 * system_.nodes().mass().size(), 0.0), nullptr, 1.0);
  K().combine(K(), s(), more);
}

bool ModalMatrices::factor(double sigma) {
  P_K_turned_.resize(0, 0);
  shifted_.combine(K(), -sigma * s(), mass_);
  // Integrals act as the springs that they are at this frequency, otherwise they would hold.
  for (const SaddleMatrix& integrals : of_integrals_)
    shifted_.combine(shifted_, std::sqrt(std::abs(sigma)), integrals);
  return solver_.factor(shifted_, true);
}

bool ModalMatrices::factor_quadratic(double sigma) {
  shifted_.combine(K(), sigma / rate_, damping_);
  shifted_.combine(shifted_, sigma * sigma * s(), mass_);
  P_K_turned_.resize(0, 0);
  if (!solver_.factor(shifted_, false)) return false;
  if (turned_.cols() == 0) return true;
  Mat P_K(unknowns(), turned_.cols());
  for (Eigen::Index i = 0; i < turned_.cols(); ++i) P_K.col(i) = inverse(K_turned_.col(i));
  left_.compute(Mat::Identity(turned_.cols(), turned_.cols()) - M_turned_.transpose() * P_K);
  P_K_turned_ = P_K;
  return true;
}

bool ModalMatrices::is_spring(int row) const {
  return newton_.is_spring(row) && !std::binary_search(integrals_.begin(), integrals_.end(), row);
}

/// All unknowns and multipliers from n() or unknowns() entries.
Vec ModalMatrices::widened(const Vec& x) const {
  Vec all = Vec::Zero(mass_.size());
  all.head(n()) = x.head(n());
  for (Eigen::Index i = n(); i < x.size(); ++i)
    all[n() + integrals_[static_cast<std::size_t>(i - n())]] = x[i];
  return all;
}

Vec ModalMatrices::narrowed(const Vec& y, Eigen::Index size) const {
  Vec x(size);
  x.head(n()) = y.head(n());
  for (Eigen::Index i = n(); i < size; ++i)
    x[i] = y[n() + integrals_[static_cast<std::size_t>(i - n())]];
  return x;
}

Vec ModalMatrices::inverse(const Vec& f) const {
  if (stop_ != nullptr && stop_->load()) throw ModesStopped();
  Vec x = s() * widened(f);
  solver_.solve(x);
  Vec y = narrowed(x, f.size());
  if (P_K_turned_.cols() > 0) {  // Woodbury's formula
    const Eigen::Index n = f.size();
    y += P_K_turned_.topRows(n) * left_.solve(M_turned_.topRows(n).transpose() * y);
  }
  return y;
}

Vec ModalMatrices::times(const SaddleMatrix& A, double factor, const Vec& x) const {
  Vec y;
  A.times(widened(x), y);
  return factor * narrowed(y, x.size());
}

Vec ModalMatrices::integral_rows(const Vec& x) const {
  Vec y;
  newton_.tangent().times(widened(x), y);
  return narrowed(y, unknowns()).tail(unknowns() - n()) / s();
}

Vec ModalMatrices::mass_times(const Vec& x) const { return times(mass_, 1.0, x); }
Vec ModalMatrices::damping_times(const Vec& x) const {
  return times(damping_, 1.0 / (s() * rate_), x);
}
Vec ModalMatrices::stiffness_times(const Vec& x) const {
  Vec y = times(newton_.tangent(), 1.0 / s(), x);
  if (turned_.cols() > 0)
    y -= K_turned_.topRows(x.size()) * (M_turned_.topRows(x.size()).transpose() * x);
  return y;
}

double ModalMatrices::energy_scale(const Vec& x) const {
  Vec y;
  newton_.tangent().magnitudes(widened(x), y);
  return narrowed(y, x.size()).dot(x.cwiseAbs()) / s();
}

ModalMatrices::Dense ModalMatrices::dense() {
  Dense d;
  d.K = d.C = d.M = Mat::Zero(unknowns(), unknowns());
  Mat Gt = Mat::Zero(unknowns(), rows());
  std::vector<int> place(static_cast<std::size_t>(mass_.size()), -1);
  for (int i = 0; i < n(); ++i) place[static_cast<std::size_t>(i)] = i;
  for (std::size_t i = 0; i < integrals_.size(); ++i)
    place[static_cast<std::size_t>(n() + integrals_[i])] = n() + static_cast<int>(i);
  const SaddleMatrix& k = K();
  for (std::size_t e = 0; e < k.values().size(); ++e) {
    const int i = place[static_cast<std::size_t>(k.row()[e])];
    const int j = place[static_cast<std::size_t>(k.column()[e])];
    if (i >= 0 && j >= 0) {
      d.K(i, j) += k.values()[e] / s();
      d.C(i, j) += damping_.values()[e] / (s() * rate_);
      d.M(i, j) += mass_.values()[e];
    } else if (i < 0 && j >= 0) {
      Gt(j, k.row()[e] - n()) -= k.values()[e];
    }
  }
  if (turned_.cols() > 0) d.K -= K_turned_ * M_turned_.transpose();
  d.Gt.resize(unknowns(), 0);
  for (int r = 0; r < rows(); ++r) {
    // springs are in K, integrals are unknowns
    if (newton_.is_spring(r)) continue;
    d.Gt.conservativeResize(unknowns(), d.Gt.cols() + 1);
    d.Gt.rightCols<1>() = Gt.col(r).normalized();
  }
  return d;
}

Mat allowed_motions(const ModalMatrices& m, const Mat& Gt) {
  const std::vector<int> counted = m.counted();
  Mat N = Mat::Zero(m.unknowns(), static_cast<Eigen::Index>(counted.size()));
  for (std::size_t i = 0; i < counted.size(); ++i)
    N(counted[i], static_cast<Eigen::Index>(i)) = 1.0;
  if (Gt.cols() == 0) return N;
  Eigen::ColPivHouseholderQR<Mat> qr(N.cols(), Gt.cols());
  qr.setThreshold(kRedundant);
  qr.compute(Gt(counted, Eigen::all));
  const Mat Q = qr.householderQ();
  return N * Q.rightCols(N.cols() - qr.rank());
}

double range_of(ModalMatrices& m, int count) {
  const std::vector<double> ratios = diagonal_ratios(m.K(), m.s(), m.M());
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

}  // namespace polhode
