// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <Eigen/OrderingMethods>

#include <polhode/core/assert.hpp>
#include <polhode/core/disjoint_sets.hpp>
#include <polhode/linear/block_cg_blocks.hpp>

namespace polhode::linear {

namespace {

/// Addition to the unit diagonal of Q, for redundant rows.
constexpr double kRedundant = 1e-12;
/// Number of rows of a group up to which fill-in in its part of Q is no concern.
constexpr int kFewRows = 12;
/// Number of bodies of a group up to which its part of the preconditioner is one dense matrix.
constexpr std::size_t kFewBodies = 3;

}  // namespace

void BlockCg::set_ties(std::span<const Tie> ties) {
  for (const Tie& tie : ties) {
    ScaledTie t{{}, {}, place_[tie.a], place_[tie.b]};
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 6; ++i) {
        const double scale = (i < 3 ? per_length_ : per_turn_) * (j < 3 ? per_length_ : per_turn_);
        const auto put = [&](Pair& column, double v) {
          Four& half = i < 3 ? column.moved : column.turned;
          half[i % 3] = static_cast<float>(scale * v);
        };
        put(t.ab.column[j], tie.K_ab(i, j));
        put(t.ba.column[j], tie.K_ab(j, i));
      }
    ties_.push_back(t);
  }
}

double BlockCg::dot(const Vec6& x, const Pair& y) {
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) sum += x[i] * y.moved[i] + x[3 + i] * y.turned[i];
  return sum;
}

bool BlockCg::set_rows(std::span<const Row> rows) {
  const auto count = static_cast<int>(moving_.size()), n = static_cast<int>(rows.size());
  const auto place = [&](int body) { return body == kGround ? count : place_[body]; };
  POLHODE_ASSERT(groups_.empty());
  for (int i = 0; i < n; ++i) {
    const Row& row = rows[static_cast<std::size_t>(i)];
    ScaledRow& r = rows_.emplace_back(ScaledRow{});
    r.a = place(row.a);
    r.b = place(row.b);
    r.number = i;
  }
  find_groups();
  eliminate();
  for (Group& group : groups_)
    for (const int k : group.bodies) {
      group.touches_later_one = group.touches_later_one || later_[k] < first_[k + 1];
      group.inverses.push_back(invert_pivot(static_cast<std::size_t>(k)));
    }
  for (ScaledRow& r : rows_) {
    if (r.a == count && r.b == count) continue;
    const Group& group = groups_[static_cast<std::size_t>(group_of(r))];
    const Row& row = rows[static_cast<std::size_t>(r.number)];
    const auto put = [&](int k, const Vec6& G, Vec6& on, Vec6& along) {
      if (k == count) return;
      on << per_length_ * G.head<3>(), per_turn_ * G.tail<3>();
      const auto at = std::lower_bound(group.bodies.begin(), group.bodies.end(), k);
      along = group.inverses[static_cast<std::size_t>(at - group.bodies.begin())] * on;
    };
    put(r.a, row.G_a, r.on_a, r.along_a);
    put(r.b, row.G_b, r.on_b, r.along_b);
    const double size = r.on_a.dot(r.along_a) + r.on_b.dot(r.along_b);
    if (!std::isfinite(size)) return false;
    r.scale = size > 0.0 ? 1.0 / std::sqrt(size) : 0.0;  // no body moves along it
    for (Vec6* p : {&r.on_a, &r.on_b, &r.along_a, &r.along_b}) *p *= r.scale;
    r.value = -r.scale * row.g;
  }
  return factor_rows();
}

/// Finds the groups of the bodies of rows_, in the order of their smallest bodies.
void BlockCg::find_groups() {
  const auto count = static_cast<int>(moving_.size());
  DisjointSets sets(moving_.size());
  std::vector<char> has_rows(moving_.size(), 0);
  for (const ScaledRow& row : rows_) {
    if (row.a != count && row.b != count) sets.join(row.a, row.b);
    for (const int k : {row.a, row.b})
      if (k != count) has_rows[static_cast<std::size_t>(k)] = 1;
  }
  for (int k = 0; k < count; ++k) {
    if (!has_rows[static_cast<std::size_t>(k)]) continue;
    const int first = sets.first_of(k);
    if (first == k) groups_.emplace_back();
    group_of_[k] = first == k ? static_cast<int>(groups_.size()) - 1 : group_of_[first];
    groups_[static_cast<std::size_t>(group_of_[k])].bodies.push_back(k);
  }
}

/// Number of a row's group; that after the last one for rows between fixed bodies.
int BlockCg::group_of(const ScaledRow& row) const {
  const auto count = static_cast<int>(group_of_.size());
  const int k = std::min(row.a, row.b);
  return k == count ? static_cast<int>(groups_.size()) : group_of_[k];
}

/// Q, its lower part. Rows are coupled if they share a body.
Eigen::SparseMatrix<double> BlockCg::matrix_of_rows() const {
  const auto n = static_cast<int>(rows_.size()), count = static_cast<int>(moving_.size());
  std::vector<std::pair<int, int>> by_body;
  for (int i = 0; i < n; ++i)
    for (const int k : {rows_[i].a, rows_[i].b})
      if (k != count) by_body.emplace_back(k, i);
  std::sort(by_body.begin(), by_body.end());
  const auto on = [&](int i, int k) -> const Vec6& {
    return rows_[i].a == k ? rows_[i].on_a : rows_[i].on_b;
  };
  const auto along = [&](int i, int k) -> const Vec6& {
    return rows_[i].a == k ? rows_[i].along_a : rows_[i].along_b;
  };
  Eigen::SparseMatrix<double> Q(n, n);
  Q.reserve(static_cast<Eigen::Index>(3 * by_body.size()));
  std::vector<std::pair<int, double>> column;
  for (int j = 0; j < n; ++j) {
    column.assign(1, {j, kRedundant});
    for (const int k : {rows_[j].a, rows_[j].b}) {
      if (k == count) continue;
      for (auto at = std::lower_bound(by_body.begin(), by_body.end(), std::pair(k, j));
           at != by_body.end() && at->first == k; ++at)
        column.emplace_back(at->second, 0.5 * (on(at->second, k).dot(along(j, k)) +
                                               on(j, k).dot(along(at->second, k))));
    }
    std::stable_sort(column.begin(), column.end(),
                     [](const auto& x, const auto& y) { return x.first < y.first; });
    Q.startVec(j);
    for (auto at = column.begin(); at != column.end();) {
      double& entry = Q.insertBack(at->first, j) = 0.0;
      for (const int i = at->first; at != column.end() && at->first == i; ++at) entry += at->second;
    }
  }
  Q.finalize();
  return Q;
}

/// Sorts rows by group and, in large groups, for little fill-in, and factors Q. The diagonal of
/// redundant rows nearly vanishes.
bool BlockCg::factor_rows() {
  const auto earlier = [&](const ScaledRow& x, const ScaledRow& y) {
    return group_of(x) < group_of(y);
  };
  if (!std::is_sorted(rows_.begin(), rows_.end(), earlier))
    std::stable_sort(rows_.begin(), rows_.end(), earlier);
  std::vector<int> sizes(groups_.size() + 1, 0);
  for (const ScaledRow& row : rows_) ++sizes[static_cast<std::size_t>(group_of(row))];
  int last = 0;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    groups_[g].first = last;
    groups_[g].last = last += sizes[g];
  }
  Eigen::SparseMatrix<double> Q = matrix_of_rows();
  if (!groups_.empty() && *std::max_element(sizes.begin(), sizes.end()) > kFewRows) {
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
    Eigen::AMDOrdering<int>()(Q.selfadjointView<Eigen::Lower>(), order);
    int* const first = order.indices().data();
    std::stable_sort(first, first + order.size(),
                     [&](int i, int j) { return group_of(rows_[i]) < group_of(rows_[j]); });
    std::vector<ScaledRow> sorted;
    for (Eigen::Index i = 0; i < order.size(); ++i) sorted.push_back(rows_[order.indices()[i]]);
    rows_ = std::move(sorted);
    Eigen::SparseMatrix<double> twisted(Q.rows(), Q.cols());
    twisted.selfadjointView<Eigen::Lower>() =
        Q.selfadjointView<Eigen::Lower>().twistedBy(order.inverse());
    Q = std::move(twisted);
  }
  const auto n = static_cast<Eigen::Index>(rows_.size());
  row_values_.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) row_values_[i] = rows_[static_cast<std::size_t>(i)].value;
  carried_.setZero(n);
  work_.setZero(n);
  Q_.compute(Q);
  if (Q_.info() != Eigen::Success || !(Q_.vectorD().array() > 0.0).all()) return false;
  for (Group& group : groups_) invert_group(group);
  return true;
}

/// Projected inverse of a small group: M⁻¹ − VᵀV with Q = L Δ Lᵀ and V = Δ^(-1/2) L⁻¹ G M⁻¹.
void BlockCg::invert_group(Group& group) {
  const auto bodies = group.bodies.size();
  if (bodies > kFewBodies) return;
  V_.setZero(group.last - group.first, static_cast<Eigen::Index>(6 * bodies));
  const auto columns = [&](std::size_t body) {
    return V_.middleCols<6>(static_cast<Eigen::Index>(6 * body));
  };
  const auto& L = Q_.matrixL().nestedExpression();  // below the diagonal of ones
  for (int i = group.first; i < group.last; ++i) {
    const ScaledRow& row = rows_[static_cast<std::size_t>(i)];
    for (std::size_t b = 0; b < bodies; ++b) {
      if (row.a == group.bodies[b]) columns(b).row(i - group.first) += row.along_a.transpose();
      if (row.b == group.bodies[b]) columns(b).row(i - group.first) += row.along_b.transpose();
    }
  }
  for (int j = group.first; j < group.last; ++j) {
    for (int p = L.outerIndexPtr()[j]; p < L.outerIndexPtr()[j + 1]; ++p)
      V_.row(L.innerIndexPtr()[p] - group.first) -= L.valuePtr()[p] * V_.row(j - group.first);
    V_.row(j - group.first) /= std::sqrt(Q_.vectorD()[j]);
  }
  group.inverse.resize(bodies * bodies);
  for (std::size_t a = 0; a < bodies; ++a)
    for (std::size_t b = 0; b < bodies; ++b) {
      Mat6 P = -(columns(a).transpose().lazyProduct(columns(b)));
      if (a == b) P += group.inverses[a];
      narrow(P, group.inverse[a * bodies + b]);
    }
}

/// w ← Q⁻¹ w for the rows of a group.
void BlockCg::solve_rows(const Group& group, Vec& w) const {
  const auto& L = Q_.matrixL().nestedExpression();  // below the diagonal of ones
  const int *first = L.outerIndexPtr(), *row = L.innerIndexPtr();
  const double* const value = L.valuePtr();
  const auto& Delta = Q_.vectorD();
  for (int j = group.first; j < group.last; ++j)
    for (int p = first[j]; p < first[j + 1]; ++p) w[row[p]] -= value[p] * w[j];
  for (int j = group.last; j-- > group.first;) {
    w[j] /= Delta[j];
    for (int p = first[j]; p < first[j + 1]; ++p) w[j] -= value[p] * w[row[p]];
  }
}

void BlockCg::project(const Group& group, Vectors& r, Vec* carried) {
  const auto count = static_cast<int>(moving_.size());
  for (int i = group.first; i < group.last; ++i) {
    const ScaledRow& row = rows_[static_cast<std::size_t>(i)];
    double sum = 0.0;
    if (row.a != count) sum += dot(row.along_a, r[row.a]);
    if (row.b != count) sum += dot(row.along_b, r[row.b]);
    work_[i] = sum;
  }
  solve_rows(group, work_);
  for (int i = group.first; i < group.last; ++i) {
    const ScaledRow& row = rows_[static_cast<std::size_t>(i)];
    const double by = work_[i];
    if (carried) (*carried)[i] += by;
    const auto take = [&](int k, const Vec6& on) {
      if (k == count) return;
      for (int c = 0; c < 3; ++c) {
        r[k].moved[c] -= static_cast<float>(by * on[c]);
        r[k].turned[c] -= static_cast<float>(by * on[3 + c]);
      }
    };
    take(row.a, row.on_a);
    take(row.b, row.on_b);
  }
}

void BlockCg::project(Vectors& r) {
  for (const Group& group : groups_) project(group, r, &carried_);
}

double BlockCg::force_of_rows() const {
  if (rows_.empty()) return 0.0;
  const Vec w = Q_.solve(row_values_);
  double size = 0.0;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const double by = std::abs(w[static_cast<Eigen::Index>(i)]);
    for (const Vec6* p : {&rows_[i].on_a, &rows_[i].on_b}) size = std::max(size, by * p->norm());
  }
  return size;
}

BlockCg::Vectors BlockCg::fulfil_rows(double size, Vectors& b) {
  const std::size_t n = moving_.size();
  const Vec w = Q_.solve(row_values_) / size;
  p_.assign(n + 1, Pair{});
  y_.assign(n + 1, Pair{});
  std::vector<Vec6> sums(n + 1, Vec6::Zero());  // their terms may cancel
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const ScaledRow& row = rows_[i];
    sums[row.a] += w[static_cast<Eigen::Index>(i)] * row.along_a;
    sums[row.b] += w[static_cast<Eigen::Index>(i)] * row.along_b;
  }
  for (const Group& group : groups_)
    for (const int body : group.bodies)
      for (int k = 0; k < 3; ++k) {
        p_[body].moved[k] = static_cast<float>(sums[body][k]);
        p_[body].turned[k] = static_cast<float>(sums[body][3 + k]);
      }
  multiply();
  subtract_friction(p_, y_);
  for (std::size_t k = 0; k < n; ++k) {
    b[k].moved -= y_[k].moved;
    b[k].turned -= y_[k].turned;
  }
  Vectors asked(p_.begin(), p_.end() - 1);
  p_.back() = Pair{};
  return asked;
}

}  // namespace polhode::linear
