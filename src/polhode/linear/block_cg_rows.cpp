// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include <polhode/linear/block_cg_blocks.hpp>

namespace polhode::linear {

namespace {

/// Addition to the unit diagonal of D, for redundant rows.
constexpr double kRedundant = 1e-12;

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

double BlockCg::dot(const Vec6& x, const Pair& y) {
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) sum += x[i] * y.moved[i] + x[3 + i] * y.turned[i];
  return sum;
}

/// Inverse of a body's diagonal block in double precision, also stored rounded.
Mat6 BlockCg::invert_precisely(int body) {
  const auto k = static_cast<std::size_t>(body);
  const auto wide = [](const Block& block) {
    Mat6 M;
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 3; ++i) {
        M(i, j) = block.column[j].moved[i];
        M(3 + i, j) = block.column[j].turned[i];
      }
    return Mat6(0.5 * (M + M.transpose()));
  };
  Eigen::LLT<Mat6> factors(wide(diagonal_[k]));
  if (factors.info() != Eigen::Success) factors.compute(wide(own_[moving_[k]]));
  const Mat6 inverse = factors.solve(Mat6::Identity());
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < 3; ++i) {
      inverse_[k].column[j].moved[i] = static_cast<float>(inverse(i, j));
      inverse_[k].column[j].turned[i] = static_cast<float>(inverse(3 + i, j));
    }
  return inverse;
}

bool BlockCg::set_rows(std::span<const Row> rows) {
  const auto count = static_cast<int>(moving_.size()), n = static_cast<int>(rows.size());
  inverse_.resize(moving_.size(), Block{});
  rows_.clear();
  row_bodies_.clear();
  row_values_.setZero(n);
  carried_.setZero(n);
  std::vector<Mat6> inverses;
  std::vector<int> inverse_of(moving_.size(), -1);
  for (int i = 0; i < n; ++i) {
    const Row& row = rows[static_cast<std::size_t>(i)];
    ScaledRow r{};
    r.a = row.a == kGround ? count : place_[row.a];
    r.b = row.b == kGround ? count : place_[row.b];
    const auto put = [&](int place, const Vec6& G, Vec6& on, Vec6& along) {
      on.setZero();
      along.setZero();
      if (place == count) return;
      if (inverse_of[place] < 0) {
        inverse_of[place] = static_cast<int>(inverses.size());
        inverses.push_back(invert_precisely(place));
        alone_[place] = 2;
        row_bodies_.push_back(place);
      }
      on << per_length_ * G.head<3>(), per_turn_ * G.tail<3>();
      along = inverses[static_cast<std::size_t>(inverse_of[place])] * on;
    };
    put(r.a, row.G_a, r.on_a, r.along_a);
    put(r.b, row.G_b, r.on_b, r.along_b);
    const double size = r.on_a.dot(r.along_a) + r.on_b.dot(r.along_b);
    if (!std::isfinite(size)) return false;
    r.scale = size > 0.0 ? 1.0 / std::sqrt(size) : 0.0;  // no body moves along it
    for (Vec6* p : {&r.on_a, &r.on_b, &r.along_a, &r.along_b}) *p *= r.scale;
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
        if (i >= j) entries.emplace_back(i, j, 0.5 * (on(i).dot(along(j)) + on(j).dot(along(i))));
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
    const double by = w[static_cast<Eigen::Index>(i)];
    const auto take = [&](int place, const Vec6& on) {
      if (static_cast<std::size_t>(place) >= r.size()) return;
      for (int k = 0; k < 3; ++k) {
        r[place].moved[k] -= static_cast<float>(by * on[k]);
        r[place].turned[k] -= static_cast<float>(by * on[3 + k]);
      }
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
    for (const Vec6* p : {&rows_[i].on_a, &rows_[i].on_b}) size = std::max(size, by * p->norm());
  }
  return size;
}

BlockCg::Vectors BlockCg::fulfil_rows(double size, Vectors& b) {
  const std::size_t n = moving_.size();
  const Vec w = D_.solve(row_values_) / size;
  p_.assign(n + 1, Pair{});
  y_.assign(n + 1, Pair{});
  std::vector<Vec6> sums(n + 1, Vec6::Zero());  // their terms may cancel
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const ScaledRow& row = rows_[i];
    sums[row.a] += w[static_cast<Eigen::Index>(i)] * row.along_a;
    sums[row.b] += w[static_cast<Eigen::Index>(i)] * row.along_b;
  }
  for (const int place : row_bodies_)
    for (int k = 0; k < 3; ++k) {
      p_[place].moved[k] = static_cast<float>(sums[place][k]);
      p_[place].turned[k] = static_cast<float>(sums[place][3 + k]);
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
