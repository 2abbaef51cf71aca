// SPDX-License-Identifier: Apache-2.0
#include <Eigen/OrderingMethods>
#include <Eigen/QR>
#include <Eigen/SparseCore>
#include <Eigen/SparseQR>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include <polhode/base/format.hpp>
#include <polhode/solve/newton_system.hpp>
#include <polhode/solve/rank_report.hpp>

namespace polhode {

namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// Up to this many rows the dense factorisation is quicker than its sparse relative is short.
constexpr std::size_t kDenseRows = 400;
/// A row takes part in a redundancy if its multiplier in it is at least this part of the largest.
constexpr double kPart = 1e-6;

/// The exact rows of an interaction, each scaled to length one.
struct Rows {
  int interaction = 0, a = kGround, b = kGround;
  Eigen::Matrix<double, Eigen::Dynamic, 12> G;
};

std::vector<Rows> constraint_rows(const System& system, const State& state) {
  std::vector<BodyStep> steps;
  steps.reserve(system.body_count() + 1);
  for (int b = 0; b < system.body_count(); ++b) steps.push_back(system.instant(state, b));
  steps.push_back(BodyStep::ground(1.0));
  StepContext context;
  context.ga = GeneralizedAlpha::from_spectral_radius(0.0);
  context.t_n = state.t;
  context.conserving = false;

  std::vector<Rows> list;
  const std::vector<double> no_lambda(system.rows(), 0.0);
  const double per_length = 1.0 / system.length_scale();
  InteractionSweep sweep(system);
  sweep.run(
      steps, context, no_lambda.data(), state.history.data(),
      [&](int i, const PairStep&, const PairTerms& terms) {
        const InteractionRef& ref = system.interactions()[i];
        Rows rows{i, ref.a, ref.b, {}};
        for (int k = 0; k < ref.rows; ++k) {
          if (terms.compliance[k] != 0.0) continue;
          Eigen::Matrix<double, 1, 12> row = Eigen::Matrix<double, 1, 12>::Zero();
          if (ref.a != kGround) row.head<6>() = terms.G_a.row(k);
          if (ref.b != kGround) row.tail<6>() = terms.G_b.row(k);
          row.segment<3>(3) *= per_length;
          row.tail<3>() *= per_length;
          if (const double size = row.norm(); size > 0.0) row /= size;
          rows.G.conservativeResize(rows.G.rows() + 1, 12);
          rows.G.bottomRows<1>() = row;
        }
        if (rows.G.rows() > 0) list.push_back(std::move(rows));
      },
      true);
  return list;
}

/// Takes out, one after the other, the joint of each body that hangs on a single one: where its
/// rows are independent on that body alone, they are independent of all others. What is left are
/// loops. @returns the rank of what was taken out.
int take_out_branches(const System& system, double tolerance, std::vector<Rows>& rows) {
  std::vector<std::vector<int>> of_body(static_cast<std::size_t>(system.body_count()));
  for (int k = 0; k < static_cast<int>(rows.size()); ++k)
    for (const int body : {rows[k].a, rows[k].b})
      if (body != kGround) of_body[body].push_back(k);
  std::vector<char> gone(rows.size(), 0);
  std::vector<int> ends;
  for (int b = 0; b < system.body_count(); ++b)
    if (of_body[b].size() == 1) ends.push_back(b);
  int rank = 0;
  while (!ends.empty()) {
    const int body = ends.back();
    ends.pop_back();
    if (of_body[body].size() != 1) continue;
    const int k = of_body[body].front();
    const Rows& joint = rows[k];
    Eigen::ColPivHouseholderQR<Mat> qr(6, joint.G.rows());
    qr.setThreshold(tolerance);
    qr.compute((joint.a == body ? joint.G.leftCols<6>() : joint.G.rightCols<6>()).transpose());
    if (qr.rank() < joint.G.rows()) continue;
    rank += static_cast<int>(joint.G.rows());
    gone[k] = 1;
    of_body[body].clear();
    const int other = joint.a == body ? joint.b : joint.a;
    if (other == kGround) continue;
    std::vector<int>& left = of_body[other];
    left.erase(std::find(left.begin(), left.end(), k));
    if (left.size() == 1) ends.push_back(other);
  }
  std::size_t kept = 0;
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (!gone[k]) std::swap(rows[kept++], rows[k]);
  rows.resize(kept);
  return rank;
}

/// Interactions that share bodies, directly or by way of others: their places in the list.
std::vector<std::vector<int>> clusters(const System& system, const std::vector<Rows>& rows) {
  std::vector<int> tie(static_cast<std::size_t>(system.body_count()));
  std::iota(tie.begin(), tie.end(), 0);
  const auto first = [&](int body) {
    while (tie[body] != body) body = tie[body] = tie[tie[body]];
    return body;
  };
  for (const Rows& r : rows)
    if (r.a != kGround && r.b != kGround) tie[first(r.a)] = first(r.b);
  std::map<int, std::vector<int>> by_first;
  for (int k = 0; k < static_cast<int>(rows.size()); ++k)
    by_first[first(rows[k].a != kGround ? rows[k].a : rows[k].b)].push_back(k);
  std::vector<std::vector<int>> list;
  for (auto& [body, members] : by_first) list.push_back(std::move(members));
  return list;
}

/// Gᵀ of a cluster over its own bodies, and the interaction of each column.
struct Columns {
  Sparse G_transposed;
  std::vector<int> interaction;
};

Columns columns_of(const std::vector<Rows>& rows, const std::vector<int>& cluster) {
  Columns columns;
  std::map<int, int> place;
  std::vector<Eigen::Triplet<double>> entries;
  const auto row_of = [&](int body) {
    return 6 * place.try_emplace(body, static_cast<int>(place.size())).first->second;
  };
  for (const int k : cluster) {
    const Rows& r = rows[static_cast<std::size_t>(k)];
    for (Eigen::Index i = 0; i < r.G.rows(); ++i) {
      const auto column = static_cast<int>(columns.interaction.size());
      columns.interaction.push_back(r.interaction);
      for (int c = 0; c < 12; ++c)
        if (r.G(i, c) != 0.0)
          entries.emplace_back(row_of(c < 6 ? r.a : r.b) + c % 6, column, r.G(i, c));
    }
  }
  columns.G_transposed.resize(6 * static_cast<Eigen::Index>(place.size()),
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
  std::vector<Rows> rows = constraint_rows(system, state);
  RankReport report;
  for (const Rows& r : rows) report.rows += static_cast<int>(r.G.rows());
  report.rank = take_out_branches(system, tolerance, rows);
  std::set<int> involved;
  for (const std::vector<int>& cluster : clusters(system, rows)) {
    const Columns columns = columns_of(rows, cluster);
    std::vector<char> part(columns.interaction.size(), 0);
    report.rank += part.size() <= kDenseRows ? dense_rank(columns, tolerance, part)
                                             : sparse_rank(columns, tolerance, part);
    for (std::size_t j = 0; j < part.size(); ++j)
      if (part[j]) involved.insert(columns.interaction[j]);
  }
  report.redundant = report.rows - report.rank;
  report.mobility = 6 * system.body_count() - report.rank;
  for (const int i : involved) {
    report.involved.push_back(i);
    const InteractionRef& ref = system.interactions()[i];
    report.names.push_back(format("{} '{}'", system.group(ref.group).kind(), system.name(ref)));
  }
  return report;
}

}  // namespace polhode
