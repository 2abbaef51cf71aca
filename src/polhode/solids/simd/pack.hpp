// SPDX-License-Identifier: Apache-2.0
// Vectors of doubles, one element per lane, for templates compiled once for each instruction set. A
// template instantiated with a Pack belongs to one set only, because the widths differ; other
// functions must not be called from the files kernels_*.cpp.
#pragma once

namespace polhode::solids {

/// W doubles for SIMD arithmetic.
template <int W>
struct PackOf;
template <>
struct PackOf<2> {
  using type = double __attribute__((vector_size(16)));
};
template <>
struct PackOf<4> {
  using type = double __attribute__((vector_size(32)));
};
template <>
struct PackOf<8> {
  using type = double __attribute__((vector_size(64)));
};
template <int W>
using Pack = typename PackOf<W>::type;

template <class P>
inline constexpr int kWidth = static_cast<int>(sizeof(P) / sizeof(double));

/// All bits set where a comparison holds.
template <class P>
using MaskOf = decltype(P{} < P{});

template <class P>
[[gnu::always_inline]] inline P broadcast(double x) {
  return P{} + x;
}

/// Load from memory of any alignment.
template <class P>
[[gnu::always_inline]] inline P load(const double* p) {
  P r;
  __builtin_memcpy(&r, p, sizeof r);
  return r;
}
template <class P>
[[gnu::always_inline]] inline void store(double* p, const P& x) {
  __builtin_memcpy(p, &x, sizeof x);
}

template <class M>
[[gnu::always_inline]] inline bool any(const M& mask) {
  long long found = 0;
  for (unsigned i = 0; i < sizeof(M) / sizeof(long long); ++i) found |= mask[i];
  return found != 0;
}

/// Packs passed to a function found through a table.
template <class P>
[[gnu::always_inline]] inline const double* numbers(const P* p) {
  return reinterpret_cast<const double*>(p);
}
template <class P>
[[gnu::always_inline]] inline double* numbers(P* p) {
  return reinterpret_cast<double*>(p);
}

}  // namespace polhode::solids
