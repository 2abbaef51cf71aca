// SPDX-License-Identifier: Apache-2.0
#include <Eigen/OrderingMethods>
#include <Eigen/QR>
#include <Eigen/SparseCore>
#include <Eigen/SparseQR>
#include <algorithm>
#include <cmath>

#include <polhode/base/format.hpp>
#include <polhode/solve/newton_system.hpp>
#include <polhode/solve/rank_report.hpp>

namespace polhode {

namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// Up to this many rows the dense factorisation is quicker than its sparse relative is short.
constexpr int kDenseRows = 400;
/// A row takes part in a redundancy if its multiplier in it is at least this part of the largest.
constexpr double kPart = 1e-6;

/// Gᵀ of the exact rows, each scaled to length one, and the interaction of each column.
struct Columns {
  Sparse G_transposed;
  std::vector<int> interaction;
};

Columns constraint_columns(const System& system, const State& state) {
  std::vector<BodyStep> steps;
  steps.reserve(system.body_count() + 1);
  for (int b = 0; b < system.body_count(); ++b) steps.push_back(system.instant(state, b));
  steps.push_back(BodyStep::ground(1.0));
  StepContext context;
  context.ga = GeneralizedAlpha::from_spectral_radius(0.0);
  context.t_n = state.t;
  context.conserving = false;

  Columns columns;
  std::vector<Eigen::Triplet<double>> entries;
  const std::vector<double> no_lambda(system.rows(), 0.0);
  const double per_length = 1.0 / system.length_scale();
  InteractionSweep sweep(system);
  sweep.run(
      steps, context, no_lambda.data(), state.history.data(),
      [&](int i, const PairStep&, const PairTerms& terms) {
        const InteractionRef& ref = system.interactions()[i];
        for (int k = 0; k < ref.rows; ++k) {
          if (terms.compliance[k] != 0.0) continue;
          Eigen::Matrix<double, 12, 1> row = Eigen::Matrix<double, 12, 1>::Zero();
          if (ref.a != kGround) row.head<6>() = terms.G_a.row(k);
          if (ref.b != kGround) row.tail<6>() = terms.G_b.row(k);
          row.segment<3>(3) *= per_length;
          row.tail<3>() *= per_length;
          if (const double size = row.norm(); size > 0.0) row /= size;
          const int column = static_cast<int>(columns.interaction.size());
          columns.interaction.push_back(i);
          for (int c = 0; c < 12; ++c)
            if (row[c] != 0.0)
              entries.emplace_back(6 * (c < 6 ? ref.a : ref.b) + c % 6, column, row[c]);
        }
      },
      true);
  columns.G_transposed.resize(6 * system.body_count(),
                              static_cast<Eigen::Index>(columns.interaction.size()));
  columns.G_transposed.setFromTriplets(entries.begin(), entries.end());
  return columns;
}

/// Marks the rows that take part in the redundancies: y with yᵀG = 0 are, with Gᵀ P = Q [R S; 0 0],
/// P (−R⁻¹S; I), and a row takes part if any of them has it.
template <class Solve, class Column, class Permuted>
void mark(int rank, int columns, Solve&& solve, Column&& column, Permuted&& permuted,
          std::vector<char>& part) {
  for (int j = rank; j < columns; ++j) {
    Vec y = column(j);
    solve(y);
    const double largest = std::max(1.0, y.lpNorm<Eigen::Infinity>());
    for (int i = 0; i < rank; ++i)
      if (std::abs(y[i]) > kPart * largest) part[permuted(i)] = 1;
    part[permuted(j)] = 1;
  }
}

int dense_rank(const Columns& c, double tolerance, std::vector<char>& part) {
  const Mat A(c.G_transposed);
  Eigen::ColPivHouseholderQR<Mat> qr(A.rows(), A.cols());
  qr.setThreshold(tolerance);
  qr.compute(A);
  const int rank = static_cast<int>(qr.rank());
  const Mat R = qr.matrixQR().topRows(rank);
  mark(
      rank, static_cast<int>(A.cols()),
      [&](Vec& y) { R.leftCols(rank).triangularView<Eigen::Upper>().solveInPlace(y); },
      [&](int j) -> Vec { return R.col(j); },
      [&](int i) { return qr.colsPermutation().indices()[i]; }, part);
  return rank;
}

int sparse_rank(const Columns& c, double tolerance, std::vector<char>& part) {
  Eigen::SparseQR<Sparse, Eigen::COLAMDOrdering<int>> qr;
  qr.setPivotThreshold(tolerance);
  qr.compute(c.G_transposed);
  const int rank = static_cast<int>(qr.rank());
  const Sparse R = Eigen::SparseMatrix<double, Eigen::RowMajor>(qr.matrixR());  // sorts the rows
  const Sparse R11 = R.topLeftCorner(rank, rank);
  mark(
      rank, static_cast<int>(c.G_transposed.cols()),
      [&](Vec& y) { R11.triangularView<Eigen::Upper>().solveInPlace(y); },
      [&](int j) { return Vec(Vec(R.col(j)).head(rank)); },
      [&](int i) { return qr.colsPermutation().indices()[i]; }, part);
  return rank;
}

}  // namespace

std::string RankReport::text() const {
  std::string s = format("mobility {}, {} constraint rows, rank {}", mobility, rows, rank);
  if (redundant == 0) return s + ", none redundant";
  s += format(", {} redundant among", redundant);
  for (std::size_t i = 0; i < names.size(); ++i) s += (i == 0 ? " " : ", ") + names[i];
  return s;
}

RankReport rank_report(const System& system, const State& state, double tolerance) {
  const Columns columns = constraint_columns(system, state);
  RankReport report;
  report.rows = static_cast<int>(columns.interaction.size());
  std::vector<char> part(columns.interaction.size(), 0);
  if (report.rows > 0 && system.body_count() > 0)
    report.rank = report.rows <= kDenseRows ? dense_rank(columns, tolerance, part)
                                            : sparse_rank(columns, tolerance, part);
  report.redundant = report.rows - report.rank;
  report.mobility = 6 * system.body_count() - report.rank;
  for (std::size_t j = 0; j < part.size(); ++j) {
    const int i = columns.interaction[j];
    if (!part[j] || (!report.involved.empty() && report.involved.back() == i)) continue;
    report.involved.push_back(i);
    const InteractionRef& ref = system.interactions()[i];
    report.names.push_back(format("{} '{}'", system.group(ref.group).kind(), system.name(ref)));
  }
  return report;
}

}  // namespace polhode
