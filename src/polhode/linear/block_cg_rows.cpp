// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/linear/block_cg_blocks.hpp>

namespace polhode {

namespace {

/// Addition to the unit diagonal of D, of the size of its single-precision rounding.
constexpr double kRedundant = 1e-6;

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
    alone_[t.a] = alone_[t.b] = 1;
    ties_.push_back(t);
  }
}

bool BlockCg::set_rows(std::span<const Row> rows) {
  const auto count = static_cast<int>(moving_.size()), n = static_cast<int>(rows.size());
  inverse_.resize(moving_.size());
  rows_.clear();
  row_bodies_.clear();
  row_values_.setZero(n);
  carried_.setZero(n);
  std::vector<char> taken(moving_.size(), 0);
  for (int i = 0; i < n; ++i) {
    const Row& row = rows[static_cast<std::size_t>(i)];
    ScaledRow r{};
    r.a = row.a == kGround ? count : place_[row.a];
    r.b = row.b == kGround ? count : place_[row.b];
    for (const int place : {r.a, r.b}) {
      if (place == count || taken[place]) continue;
      taken[place] = alone_[place] = 1;
      invert_pivot(place, diagonal_[place]);
      row_bodies_.push_back(place);
    }
    const auto pair = [&](int place, const Vec6& G) {
      Pair p{};
      for (int k = 0; place != count && k < 3; ++k) {
        p.moved[k] = static_cast<float>(per_length_ * G[k]);
        p.turned[k] = static_cast<float>(per_turn_ * G[3 + k]);
      }
      return p;
    };
    r.on_a = pair(r.a, row.G_a);
    r.on_b = pair(r.b, row.G_b);
    if (r.a != count) r.along_a = times(inverse_[r.a], r.on_a);
    if (r.b != count) r.along_b = times(inverse_[r.b], r.on_b);
    const double size = dot(r.on_a, r.along_a) + dot(r.on_b, r.along_b);
    if (!std::isfinite(size)) return false;
    r.scale = size > 0.0 ? 1.0 / std::sqrt(size) : 0.0;  // no body moves along it
    const auto factor = static_cast<float>(r.scale);
    for (Pair* p : {&r.on_a, &r.on_b, &r.along_a, &r.along_b}) {
      p->moved *= factor;
      p->turned *= factor;
    }
    row_values_[i] = -r.scale * row.g;
    rows_.push_back(r);
  }
  std::sort(row_bodies_.begin(), row_bodies_.end());
  return factor_rows();
}

/// Factors D. Rows are coupled in D if they share a body. The diagonal of redundant rows nearly
/// vanishes.
bool BlockCg::factor_rows() {
  const auto count = static_cast<int>(moving_.size()), n = static_cast<int>(rows_.size());
  std::vector<std::vector<int>> rows_of(static_cast<std::size_t>(count));
  for (int i = 0; i < n; ++i)
    for (const int place : {rows_[i].a, rows_[i].b})
      if (place != count) rows_of[static_cast<std::size_t>(place)].push_back(i);
  std::vector<Eigen::Triplet<double>> entries;
  for (const int place : row_bodies_) {
    const auto on = [&](int i) { return rows_[i].a == place ? rows_[i].on_a : rows_[i].on_b; };
    const auto along = [&](int i) {
      return rows_[i].a == place ? rows_[i].along_a : rows_[i].along_b;
    };
    for (const int i : rows_of[static_cast<std::size_t>(place)])
      for (const int j : rows_of[static_cast<std::size_t>(place)])
        if (i >= j) entries.emplace_back(i, j, 0.5 * (dot(on(i), along(j)) + dot(on(j), along(i))));
  }
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, kRedundant);
  Eigen::SparseMatrix<double> D(n, n);
  D.setFromTriplets(entries.begin(), entries.end());
  D_.compute(D);
  return D_.info() == Eigen::Success && (D_.vectorD().array() > 0.0).all();
}

void BlockCg::project(Vectors& r) {
  Vec t(static_cast<Eigen::Index>(rows_.size()));
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const ScaledRow& row = rows_[i];
    double sum = 0.0;
    if (static_cast<std::size_t>(row.a) < r.size()) sum += dot(row.along_a, r[row.a]);
    if (static_cast<std::size_t>(row.b) < r.size()) sum += dot(row.along_b, r[row.b]);
    t[static_cast<Eigen::Index>(i)] = sum;
  }
  const Vec w = D_.solve(t);
  carried_ += w;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const ScaledRow& row = rows_[i];
    const auto by = static_cast<float>(w[static_cast<Eigen::Index>(i)]);
    const auto take = [&](int place, const Pair& on) {
      if (static_cast<std::size_t>(place) >= r.size()) return;
      r[place].moved -= by * on.moved;
      r[place].turned -= by * on.turned;
    };
    take(row.a, row.on_a);
    take(row.b, row.on_b);
  }
}

double BlockCg::force_of_rows() const {
  if (rows_.empty()) return 0.0;
  const Vec w = D_.solve(row_values_);
  double size = 0.0;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const double by = std::abs(w[static_cast<Eigen::Index>(i)]);
    for (const Pair* p : {&rows_[i].on_a, &rows_[i].on_b})
      size = std::max(size, by * std::sqrt(dot(*p, *p)));
  }
  return size;
}

BlockCg::Vectors BlockCg::fulfil_rows(double size, Vectors& b) {
  const std::size_t n = moving_.size();
  const Vec w = D_.solve(row_values_) / size;
  p_.assign(n + 1, Pair{});
  y_.assign(n + 1, Pair{});
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const ScaledRow& row = rows_[i];
    const auto by = static_cast<float>(w[static_cast<Eigen::Index>(i)]);
    const auto go = [&](int place, const Pair& along) {
      if (static_cast<std::size_t>(place) == n) return;
      p_[place].moved += by * along.moved;
      p_[place].turned += by * along.turned;
    };
    go(row.a, row.along_a);
    go(row.b, row.along_b);
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

}  // namespace polhode
