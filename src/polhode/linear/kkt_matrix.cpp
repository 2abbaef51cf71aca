// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <polhode/linear/kkt_matrix.hpp>

namespace polhode::linear {

template <class Put>
void KktMatrix::for_each(const KktValues* values, Put&& put) const {
  const int first_row = 6 * topology_.bodies;
  for (int b = 0; b < topology_.bodies; ++b)
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 6; ++i)
        put(6 * b + i, 6 * b + j, values ? values->diagonal[b](i, j) : 0.0);
  for (std::size_t p = 0; p < topology_.pairs.size(); ++p) {
    const KktPair& pair = topology_.pairs[p];
    const KktValues::Pair* v = values ? &values->pairs[p] : nullptr;
    const int row = first_row + pair.first_row;
    if (pair.a != kGround && pair.b != kGround)
      for (int j = 0; j < 6; ++j)
        for (int i = 0; i < 6; ++i) {
          put(6 * pair.a + i, 6 * pair.b + j, v ? v->K_ab(i, j) : 0.0);
          put(6 * pair.b + i, 6 * pair.a + j, v ? v->K_ba(i, j) : 0.0);
        }
    for (int k = 0; k < pair.rows; ++k) {
      for (int i = 0; i < 6; ++i) {
        if (pair.a != kGround) {
          put(6 * pair.a + i, row + k, v ? -v->B_a(i, k) : 0.0);
          put(row + k, 6 * pair.a + i, v ? v->G_a(k, i) : 0.0);
        }
        if (pair.b != kGround) {
          put(6 * pair.b + i, row + k, v ? -v->B_b(i, k) : 0.0);
          put(row + k, 6 * pair.b + i, v ? v->G_b(k, i) : 0.0);
        }
      }
      put(row + k, row + k, v ? v->C[k] : 0.0);
    }
  }
}

KktMatrix::KktMatrix(const KktTopology& topology)
    : topology_(topology), size_(6 * topology.bodies + topology.rows) {
  std::vector<std::pair<int, int>> entries;  // (column, row)
  for_each(nullptr, [&](int i, int j, double) { entries.emplace_back(j, i); });
  std::vector<std::pair<int, int>> sorted = entries;
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  column_start_.assign(size_ + 1, 0);
  row_index_.reserve(sorted.size());
  for (const auto& [column, row] : sorted) {
    ++column_start_[column + 1];
    row_index_.push_back(row);
  }
  for (int j = 0; j < size_; ++j) column_start_[j + 1] += column_start_[j];
  slot_.reserve(entries.size());
  for (const auto& [column, row] : entries) {
    const auto first = row_index_.begin() + column_start_[column];
    const auto last = row_index_.begin() + column_start_[column + 1];
    slot_.push_back(static_cast<int>(std::lower_bound(first, last, row) - row_index_.begin()));
  }
  values_.assign(row_index_.size(), 0.0);
}

bool KktMatrix::set(const KktValues& values) {
  std::fill(values_.begin(), values_.end(), 0.0);
  std::size_t next = 0;
  double sum = 0.0;  // becomes NaN if anything is not finite
  for_each(&values, [&](int, int, double x) {
    values_[slot_[next++]] += x;
    sum += 0.0 * x;
  });
  return sum == 0.0;
}

Mat KktMatrix::dense() const {
  Mat A = Mat::Zero(size_, size_);
  for (int j = 0; j < size_; ++j)
    for (int k = column_start_[j]; k < column_start_[j + 1]; ++k) A(row_index_[k], j) = values_[k];
  return A;
}

}  // namespace polhode::linear
