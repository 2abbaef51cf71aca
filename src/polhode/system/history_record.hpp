// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstring>
#include <type_traits>

#include <polhode/core/types.hpp>

namespace polhode {

/// A plain struct of doubles that lies in a history field after field: its numbers have names.
template <class R>
concept HistoryRecord = std::is_trivially_copyable_v<R> && std::is_standard_layout_v<R> &&
                            alignof(R) == alignof(double) &&
                        sizeof(R) % sizeof(double) == 0;

/// Numbers of a history that a record takes.
template <HistoryRecord R>
inline constexpr std::size_t kNumbersOf = sizeof(R) / sizeof(double);

/// The record that begins at a number of a history.
template <HistoryRecord R>
[[nodiscard]] R read_record(const double* history) {
  R record;
  std::memcpy(static_cast<void*>(&record), history, sizeof(R));
  return record;
}

template <HistoryRecord R>
void write_record(const R& record, double* history) {
  std::memcpy(history, static_cast<const void*>(&record), sizeof(R));
}

/// Sets a vector of a record.
inline void set(double (&to)[3], const Vec3& value) {
  for (int i = 0; i < 3; ++i) to[i] = value[i];
}

}  // namespace polhode
