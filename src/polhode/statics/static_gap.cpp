// SPDX-License-Identifier: Apache-2.0
// Smallest gap of rows that cannot all hold at a load factor.
#include <algorithm>
#include <cmath>

#include <polhode/equations/trial.hpp>
#include <polhode/linear/kkt.hpp>
#include <polhode/math/quaternion.hpp>
#include <polhode/newton/rank_report.hpp>
#include <polhode/statics/static_newton.hpp>

namespace polhode {

namespace {

constexpr int kGapIterations = 200;
/// First damping, its changes after a step that has made the gap smaller or not, and its largest
/// value: increments are then at rounding [-].
constexpr double kFirstDamping = 1e-3, kLessDamping = 0.2, kMoreDamping = 5.0, kMostDamping = 1e12;
/// Gradient of a gap, relative to the gap, below which no motion makes it smaller.
constexpr double kLeastGradient = 1e-4;
/// Rounding of a gap, relative to the size and the place of the model.
constexpr double kGapRoundOff = 1e-12;
/// Part of a gap, relative to the largest, from which on a row is named.
constexpr double kOpenPart = 1e-2;

/// Gradient of half the square of a gap, by displacements and by rotations times ℓ.
Vec gradient_of(const linear::KktTopology& topology, const linear::KktValues& values,
                const Vec& rhs, double length) {
  const int bodies = 6 * topology.bodies;
  Vec gradient = Vec::Zero(bodies);
  for (std::size_t p = 0; p < topology.pairs.size(); ++p) {
    const linear::KktPair& pair = topology.pairs[p];
    const auto g = rhs.segment(bodies + pair.first_row, pair.rows);
    const auto add = [&](int body, const auto& B) {
      if (body != kGround) gradient.segment<6>(6 * body) -= B.leftCols(pair.rows) * g;
    };
    add(pair.a, values.pairs[p].B_a);
    add(pair.b, values.pairs[p].B_b);
  }
  for (int b = 0; b < topology.bodies; ++b) gradient.segment<3>(6 * b + 3) /= length;
  return gradient;
}

}  // namespace

/// Rows at work_, and their values in the linear system of a damped least-squares step.
/// @param sizes  Of the rows of G, rotations scaled by ℓ, by which rows are divided. If empty they
/// are set: a sum of squares with a fixed weight has a least value.
double StaticNewton::assemble_gap(Vec& rhs, Vec& sizes) {
  const bool first = sizes.size() == 0;
  if (first) sizes = Vec::Zero(system_->rows());
  lengths_.assign(static_cast<std::size_t>(system_->rows()), false);
  start_trial(*system_, last_, trial_);
  place_bodies();
  trial_.lambda_centre = trial_.lambda = work_.lambda;
  std::swap(last_.history, work_.history);
  newton_.assemble(last_, trial_, true);
  std::swap(last_.history, work_.history);
  const double length = system_->length_scale();
  const int bodies = 6 * system_->body_count();
  rhs = Vec::Zero(bodies + system_->rows());
  linear::KktValues& values = newton_.values();
  for (std::size_t p = 0; p < newton_.topology().pairs.size(); ++p) {
    const linear::KktPair& pair = newton_.topology().pairs[p];
    const linear::KktValues::Pair& v = values.pairs[p];
    for (int k = 0; k < pair.rows; ++k) {
      const int row = pair.first_row + k;
      double size = 0.0;
      const auto add = [&](int body, const auto& G) {
        if (body == kGround) return;
        const double by_r = G.row(k).template head<3>().squaredNorm();
        size += by_r + G.row(k).template tail<3>().squaredNorm() / (length * length);
        lengths_[row] = lengths_[row] || by_r > 0.0;
      };
      add(pair.a, v.G_a);
      add(pair.b, v.G_b);
      // A spring carries what it must. A row with several parts has the sum of their squares.
      if (first)
        sizes[row] = newton_.is_spring(row) ? 0.0 : std::hypot(sizes[row], std::sqrt(size));
    }
  }
  for (std::size_t p = 0; p < newton_.topology().pairs.size(); ++p) {
    const linear::KktPair& pair = newton_.topology().pairs[p];
    linear::KktValues::Pair& v = values.pairs[p];
    v.K_ab.setZero(), v.K_ba.setZero();
    v.B_a.setZero(), v.B_b.setZero();
    for (int k = 0; k < pair.rows; ++k) {
      const int row = pair.first_row + k;
      const double weight = sizes[row] > 0.0 ? 1.0 / sizes[row] : 0.0;
      v.G_a.row(k) *= weight, v.G_b.row(k) *= weight;
      v.C[k] = 1.0;
      rhs[bodies + row] = -weight * newton_.row_residual(row);
    }
    if (pair.a != kGround) v.B_a.leftCols(pair.rows) = v.G_a.topRows(pair.rows).transpose();
    if (pair.b != kGround) v.B_b.leftCols(pair.rows) = v.G_b.topRows(pair.rows).transpose();
  }
  return rhs.tail(system_->rows()).norm();
}

/// @eq{statics-gap}
RowGap StaticNewton::least_gap(const State& state, double load_factor) {
  RowGap found;
  if (system_->rows() == 0) return found;
  enter(load_factor, state.t);
  start_at(state);
  trial_.compliance_scale = 1.0;
  const double length = system_->length_scale();
  const std::unique_ptr<linear::LinearSolver> solver = linear::make_linear_solver("sparse_lu");
  solver->analyse(newton_.topology());
  Vec rhs, x, sizes;
  double gap = assemble_gap(rhs, sizes), damping = kFirstDamping;
  bool least = false;
  for (int k = 0; k < kGapIterations && gap > 0.0 && !stopped(); ++k) {
    linear::KktValues& values = newton_.values();
    least = gradient_of(newton_.topology(), values, rhs, length).norm() <= kLeastGradient * gap;
    if (least || damping > kMostDamping) break;
    for (Mat6& K : values.diagonal) {
      K.setZero();
      K.diagonal() << Vec3::Constant(damping), Vec3::Constant(damping * length * length);
    }
    x = rhs;
    if (!solver->factor(values)) break;
    solver->solve(x);
    if (!x.allFinite()) break;
    const State before = work_;
    for (int b = 0; b < system_->body_count(); ++b) {
      BodyMotion m = system_->motion(work_, b);
      m.r += x.segment<3>(6 * b);
      m.q = (quaternion_from_cayley(x.segment<3>(6 * b + 3)) * m.q).normalized();
      work_.set_motion(system_->slot(b), m);
    }
    count_turns();
    if (const double next = assemble_gap(rhs, sizes); next < gap) {
      gap = next;
      damping *= kLessDamping;
      continue;
    }
    work_ = before;
    (void)assemble_gap(rhs, sizes);
    damping *= kMoreDamping;
  }
  double place = std::max(1.0, length);
  for (int b = 0; b < system_->body_count(); ++b)
    place = std::max(place, system_->motion(work_, b).r.lpNorm<Eigen::Infinity>());
  if (least && gap > kGapRoundOff * place) name_open(rhs, sizes, found);
  return found;
}

/// Names the rows that remain open. With all others closed, one has the whole gap: that of a drive,
/// if there is one.
void StaticNewton::name_open(const Vec& rhs, const Vec& sizes, RowGap& found) const {
  const auto rows_of = [&](const InteractionRef& ref) {
    return rhs.segment(6 * system_->body_count() + ref.first_row, ref.rows);
  };
  double most = 0.0;
  for (const InteractionRef& ref : system_->interactions())
    most = std::max(most, rows_of(ref).norm());
  const double gap = rhs.tail(system_->rows()).norm();
  bool at_drive = false;
  for (int i = 0; i < static_cast<int>(system_->interactions().size()); ++i) {
    const InteractionRef& ref = system_->interactions()[i];
    const auto open = rows_of(ref);
    if (ref.rows == 0 || open.norm() < kOpenPart * most) continue;
    found.names.push_back(interaction_name(*system_, i));
    const bool drive = system_->traits(ref).prescribes;
    if (found.names.size() > 1 && (at_drive || !drive)) continue;
    at_drive = drive;
    Eigen::Index largest = 0;
    open.cwiseAbs().maxCoeff(&largest);
    found.open = {i, 0.0, 0.0, lengths_[ref.first_row + largest] != 0};
    double square = 0.0;  // square of the part in the combination that does not vanish
    for (int row = ref.first_row; row < ref.first_row + ref.rows; ++row)
      if (sizes[row] > 0.0 && (lengths_[row] != 0) == found.open.length)
        square += std::pow(rhs[6 * system_->body_count() + row] / sizes[row], 2);
    found.open.gap = gap * gap / std::sqrt(square);
  }
}

}  // namespace polhode
