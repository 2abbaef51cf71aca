// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/linear/kkt.hpp>

namespace polhode::linear {

/// The linear system as one compressed-column matrix, for general sparse solvers, for the rank
/// report and for tests. The pattern is built once; values may be replaced any number of times.
class KktMatrix {
 public:
  KktMatrix() = default;
  explicit KktMatrix(const KktTopology& topology);

  [[nodiscard]] int size() const { return size_; }
  /// Column starts, size() + 1 of them.
  [[nodiscard]] const std::vector<int>& column_start() const { return column_start_; }
  [[nodiscard]] const std::vector<int>& row_index() const { return row_index_; }
  [[nodiscard]] const std::vector<double>& values() const { return values_; }
  [[nodiscard]] std::vector<double>& values() { return values_; }

  /// Replaces all values. @returns false if one of them is not finite.
  bool set(const KktValues& values);
  [[nodiscard]] Mat dense() const;

 private:
  /// Calls put(row, column, value) for every entry, in an order that depends on the topology alone.
  template <class Put>
  void for_each(const KktValues* values, Put&& put) const;

  KktTopology topology_;
  int size_ = 0;
  std::vector<int> column_start_, row_index_, slot_;
  std::vector<double> values_;
};

}  // namespace polhode::linear
