// SPDX-License-Identifier: Apache-2.0
// Vector types of one instruction set. Included only by the kernels_*.cpp files, each of which
// defines POLHODE_ISA (a namespace) and POLHODE_WIDTH (doubles per register). Everything here is
// forced inline or lives in that namespace, so that no code of one set leaks into another.
#pragma once

#if POLHODE_WIDTH == 8
#define POLHODE_SWAP_PAIRS 2, 3, 0, 1, 6, 7, 4, 5
#else
#define POLHODE_SWAP_PAIRS 2, 3, 0, 1
#endif
#define POLHODE_INLINE inline __attribute__((always_inline))

namespace polhode::POLHODE_ISA {

inline constexpr int kWidth = POLHODE_WIDTH;  ///< Bodies served by one instruction.
inline constexpr int kParts = 8 / kWidth;     ///< Registers in a block lane or in a row.

/// One quantity of kWidth bodies.
using Pack = double __attribute__((vector_size(8 * kWidth)));
using Mask = long long __attribute__((vector_size(8 * kWidth)));

POLHODE_INLINE Pack broadcast(double x) { return x - Pack{}; }
POLHODE_INLINE Pack load(const double* p) { return *reinterpret_cast<const Pack*>(p); }
POLHODE_INLINE void store(double* p, Pack x) { *reinterpret_cast<Pack*>(p) = x; }
POLHODE_INLINE Pack abs(Pack a) { return (Pack)((Mask)a & 0x7fffffffffffffffLL); }
POLHODE_INLINE Pack max(Pack a, Pack b) { return a > b ? a : b; }
/// The larger one; NaN if one of them is.
POLHODE_INLINE Pack max_keeping_nan(Pack a, Pack b) {
  const Mask first = (Mask)(b <= a) | (Mask)(a != a);
  return first ? a : b;
}
POLHODE_INLINE Pack sqrt(Pack a) {
  Pack r;
  for (int i = 0; i < kWidth; ++i) r[i] = __builtin_sqrt(a[i]);
  return r;
}
/// The largest one; NaN if one of them is.
POLHODE_INLINE double largest(Pack a) {
  double m = a[0];
  for (int i = 1; i < kWidth; ++i) m = a[i] <= m || m != m ? m : a[i];
  return m;
}
POLHODE_INLINE double sum(Pack a) {
  double s = a[0];
  for (int i = 1; i < kWidth; ++i) s += a[i];
  return s;
}
/// base[offset[i]] for each body.
POLHODE_INLINE Pack gather(const double* base, const int* offset) {
  Pack r;
  for (int i = 0; i < kWidth; ++i) r[i] = base[offset[i]];
  return r;
}

/// Eight numbers of one body: a row [six columns | one more | right-hand side] of the elimination.
struct alignas(8 * kWidth) Row {
  Pack part[kParts];

  POLHODE_INLINE double operator[](int i) const { return part[i / kWidth][i % kWidth]; }
};

POLHODE_INLINE Row row_load(const double* p) {
  Row r;
  for (int i = 0; i < kParts; ++i) r.part[i] = load(p + kWidth * i);
  return r;
}
POLHODE_INLINE void row_store(double* p, const Row& r) {
  for (int i = 0; i < kParts; ++i) store(p + kWidth * i, r.part[i]);
}
POLHODE_INLINE Row operator+(const Row& a, const Row& b) {
  Row r;
  for (int i = 0; i < kParts; ++i) r.part[i] = a.part[i] + b.part[i];
  return r;
}
POLHODE_INLINE Row operator-(const Row& a, const Row& b) {
  Row r;
  for (int i = 0; i < kParts; ++i) r.part[i] = a.part[i] - b.part[i];
  return r;
}
POLHODE_INLINE Row operator*(double s, const Row& a) {
  Row r;
  for (int i = 0; i < kParts; ++i) r.part[i] = s * a.part[i];
  return r;
}
POLHODE_INLINE Row multiply(const Row& a, const Row& b) {
  Row r;
  for (int i = 0; i < kParts; ++i) r.part[i] = a.part[i] * b.part[i];
  return r;
}
POLHODE_INLINE double row_sum(const Row& a) {
  Pack s = a.part[0];
  for (int i = 1; i < kParts; ++i) s += a.part[i];
#if POLHODE_WIDTH == 8
  s += __builtin_shufflevector(s, s, 4, 5, 6, 7, 0, 1, 2, 3);
#endif
#if POLHODE_WIDTH >= 4
  s += __builtin_shufflevector(s, s, POLHODE_SWAP_PAIRS);
#endif
  return s[0] + s[1];
}
POLHODE_INLINE Row abs(const Row& a) {
  Row r;
  for (int i = 0; i < kParts; ++i) r.part[i] = abs(a.part[i]);
  return r;
}
/// Number i of the row, broadcast.
template <int i>
POLHODE_INLINE Row spread(const Row& a) {
  constexpr int k = i % kWidth;
  const Pack from = a.part[i / kWidth];
#if POLHODE_WIDTH == 8
  const Pack x = __builtin_shufflevector(from, from, k, k, k, k, k, k, k, k);
#elif POLHODE_WIDTH == 4
  const Pack x = __builtin_shufflevector(from, from, k, k, k, k);
#else
  const Pack x = __builtin_shufflevector(from, from, k, k);
#endif
  Row r;
  for (Pack& part : r.part) part = x;
  return r;
}
POLHODE_INLINE Row& operator+=(Row& a, const Row& b) { return a = a + b; }
POLHODE_INLINE Row& operator-=(Row& a, const Row& b) { return a = a - b; }
POLHODE_INLINE Row row_zero() { return Row{}; }
/// The unit rows; constants in memory are cheaper than building them.
alignas(64) inline constexpr double kUnit[8][8] = {
    {1, 0, 0, 0, 0, 0, 0, 0}, {0, 1, 0, 0, 0, 0, 0, 0}, {0, 0, 1, 0, 0, 0, 0, 0},
    {0, 0, 0, 1, 0, 0, 0, 0}, {0, 0, 0, 0, 1, 0, 0, 0}, {0, 0, 0, 0, 0, 1, 0, 0},
    {0, 0, 0, 0, 0, 0, 1, 0}, {0, 0, 0, 0, 0, 0, 0, 1}};
POLHODE_INLINE Row unit(int i) { return row_load(kUnit[i]); }

// ------------------------------------------------------------------ transposition
// kWidth bodies, eight columns of packs <-> one row per body.

#if POLHODE_WIDTH == 8
POLHODE_INLINE void transpose(const Pack* a, Pack* o) {
  const auto lo = [](Pack x, Pack y) {
    return __builtin_shufflevector(x, y, 0, 8, 2, 10, 4, 12, 6, 14);
  };
  const auto hi = [](Pack x, Pack y) {
    return __builtin_shufflevector(x, y, 1, 9, 3, 11, 5, 13, 7, 15);
  };
  const auto lo2 = [](Pack x, Pack y) {
    return __builtin_shufflevector(x, y, 0, 1, 8, 9, 4, 5, 12, 13);
  };
  const auto hi2 = [](Pack x, Pack y) {
    return __builtin_shufflevector(x, y, 2, 3, 10, 11, 6, 7, 14, 15);
  };
  const auto lo4 = [](Pack x, Pack y) {
    return __builtin_shufflevector(x, y, 0, 1, 2, 3, 8, 9, 10, 11);
  };
  const auto hi4 = [](Pack x, Pack y) {
    return __builtin_shufflevector(x, y, 4, 5, 6, 7, 12, 13, 14, 15);
  };
  const Pack t0 = lo(a[0], a[1]), t1 = hi(a[0], a[1]), t2 = lo(a[2], a[3]), t3 = hi(a[2], a[3]);
  const Pack t4 = lo(a[4], a[5]), t5 = hi(a[4], a[5]), t6 = lo(a[6], a[7]), t7 = hi(a[6], a[7]);
  const Pack s0 = lo2(t0, t2), s1 = lo2(t1, t3), s2 = hi2(t0, t2), s3 = hi2(t1, t3);
  const Pack s4 = lo2(t4, t6), s5 = lo2(t5, t7), s6 = hi2(t4, t6), s7 = hi2(t5, t7);
  o[0] = lo4(s0, s4);
  o[1] = lo4(s1, s5);
  o[2] = lo4(s2, s6);
  o[3] = lo4(s3, s7);
  o[4] = hi4(s0, s4);
  o[5] = hi4(s1, s5);
  o[6] = hi4(s2, s6);
  o[7] = hi4(s3, s7);
}
#elif POLHODE_WIDTH == 4
POLHODE_INLINE void transpose(const Pack* a, Pack* o) {
  const Pack t0 = __builtin_shufflevector(a[0], a[1], 0, 4, 2, 6);
  const Pack t1 = __builtin_shufflevector(a[0], a[1], 1, 5, 3, 7);
  const Pack t2 = __builtin_shufflevector(a[2], a[3], 0, 4, 2, 6);
  const Pack t3 = __builtin_shufflevector(a[2], a[3], 1, 5, 3, 7);
  o[0] = __builtin_shufflevector(t0, t2, 0, 1, 4, 5);
  o[1] = __builtin_shufflevector(t1, t3, 0, 1, 4, 5);
  o[2] = __builtin_shufflevector(t0, t2, 2, 3, 6, 7);
  o[3] = __builtin_shufflevector(t1, t3, 2, 3, 6, 7);
}
#else
POLHODE_INLINE void transpose(const Pack* a, Pack* o) {
  o[0] = __builtin_shufflevector(a[0], a[1], 0, 2);
  o[1] = __builtin_shufflevector(a[0], a[1], 1, 3);
}
#endif

/// Sums of six rows in one, and two zeros.
POLHODE_INLINE Row row_sums(const Row* rows) {
  Row r;
#if POLHODE_WIDTH == 8
  const auto neighbours = [](Pack x, Pack y) {
    return __builtin_shufflevector(x, y, 0, 8, 2, 10, 4, 12, 6, 14) +
           __builtin_shufflevector(x, y, 1, 9, 3, 11, 5, 13, 7, 15);
  };
  const auto pairs = [](Pack x, Pack y) {
    return __builtin_shufflevector(x, y, 0, 1, 8, 9, 4, 5, 12, 13) +
           __builtin_shufflevector(x, y, 2, 3, 10, 11, 6, 7, 14, 15);
  };
  const Pack first = pairs(neighbours(rows[0].part[0], rows[1].part[0]),
                           neighbours(rows[2].part[0], rows[3].part[0]));
  const Pack last = pairs(neighbours(rows[4].part[0], rows[5].part[0]), Pack{});
  r.part[0] = __builtin_shufflevector(first, last, 0, 1, 2, 3, 8, 9, 10, 11) +
              __builtin_shufflevector(first, last, 4, 5, 6, 7, 12, 13, 14, 15);
#elif POLHODE_WIDTH == 4
  Pack pair[4] = {};
  for (int i = 0; i < 3; ++i) {
    const Pack x = rows[2 * i].part[0] + rows[2 * i].part[1];
    const Pack y = rows[2 * i + 1].part[0] + rows[2 * i + 1].part[1];
    pair[i] = __builtin_shufflevector(x, y, 0, 4, 2, 6) + __builtin_shufflevector(x, y, 1, 5, 3, 7);
  }
  for (int i = 0; i < 2; ++i)
    r.part[i] = __builtin_shufflevector(pair[2 * i], pair[2 * i + 1], 0, 1, 4, 5) +
                __builtin_shufflevector(pair[2 * i], pair[2 * i + 1], 2, 3, 6, 7);
#else
  const auto halves = [](const Row& a) {
    return (a.part[0] + a.part[1]) + (a.part[2] + a.part[3]);
  };
  for (int i = 0; i < 3; ++i) {
    const Pack x = halves(rows[2 * i]), y = halves(rows[2 * i + 1]);
    r.part[i] = __builtin_shufflevector(x, y, 0, 2) + __builtin_shufflevector(x, y, 1, 3);
  }
  r.part[3] = Pack{};
#endif
  return r;
}

/// columns[8] of kWidth bodies -> rows of 8, body i's at to + 8 i.
POLHODE_INLINE void to_rows(const Pack* columns, double* to) {
  for (int part = 0; part < kParts; ++part) {
    Pack o[kWidth];
    transpose(columns + kWidth * part, o);
    for (int i = 0; i < kWidth; ++i) store(to + 8 * i + kWidth * part, o[i]);
  }
}
/// Rows of 8 at from + 8 i -> columns[8] of kWidth bodies.
POLHODE_INLINE void to_columns(const double* from, Pack* columns) {
  for (int part = 0; part < kParts; ++part) {
    Pack in[kWidth];
    for (int i = 0; i < kWidth; ++i) in[i] = load(from + 8 * i + kWidth * part);
    transpose(in, columns + kWidth * part);
  }
}

// ------------------------------------------------------------------ vectors of packs or doubles

template <class T>
struct V3 {
  T a[3];
  POLHODE_INLINE T& operator[](int i) { return a[i]; }
  POLHODE_INLINE const T& operator[](int i) const { return a[i]; }
};
template <class T>
POLHODE_INLINE V3<T> operator+(const V3<T>& x, const V3<T>& y) {
  return {x[0] + y[0], x[1] + y[1], x[2] + y[2]};
}
template <class T>
POLHODE_INLINE V3<T> operator-(const V3<T>& x, const V3<T>& y) {
  return {x[0] - y[0], x[1] - y[1], x[2] - y[2]};
}
template <class S, class T>
POLHODE_INLINE V3<T> operator*(S s, const V3<T>& x) {
  return {s * x[0], s * x[1], s * x[2]};
}
template <class T>
POLHODE_INLINE T dot(const V3<T>& x, const V3<T>& y) {
  return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}
template <class T>
POLHODE_INLINE V3<T> cross(const V3<T>& x, const V3<T>& y) {
  return {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
}
/// 3×3 matrix, row by row.
template <class T>
struct M3 {
  T a[9];
  POLHODE_INLINE T& operator[](int i) { return a[i]; }
  POLHODE_INLINE const T& operator[](int i) const { return a[i]; }
};
template <class T>
POLHODE_INLINE V3<T> operator*(const M3<T>& A, const V3<T>& x) {
  return {A[0] * x[0] + A[1] * x[1] + A[2] * x[2], A[3] * x[0] + A[4] * x[1] + A[5] * x[2],
          A[6] * x[0] + A[7] * x[1] + A[8] * x[2]};
}
template <class T>
POLHODE_INLINE V3<T> transposed_times(const M3<T>& A, const V3<T>& x) {
  return {A[0] * x[0] + A[3] * x[1] + A[6] * x[2], A[1] * x[0] + A[4] * x[1] + A[7] * x[2],
          A[2] * x[0] + A[5] * x[1] + A[8] * x[2]};
}

using P3 = V3<Pack>;
using PM = M3<Pack>;

POLHODE_INLINE P3 load3(const double (*x)[8], int at) {
  return {load(x[0] + at), load(x[1] + at), load(x[2] + at)};
}
POLHODE_INLINE void store3(double (*x)[8], int at, const P3& v) {
  for (int i = 0; i < 3; ++i) store(x[i] + at, v[i]);
}
POLHODE_INLINE PM load9(const double (*x)[8], int at) {
  PM m;
  for (int i = 0; i < 9; ++i) m[i] = load(x[i] + at);
  return m;
}
POLHODE_INLINE void store9(double (*x)[8], int at, const PM& m) {
  for (int i = 0; i < 9; ++i) store(x[i] + at, m[i]);
}

}  // namespace polhode::POLHODE_ISA
