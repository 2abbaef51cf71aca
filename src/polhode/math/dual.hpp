// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <polhode/core/types.hpp>

namespace polhode::contact {

/// Dual number with derivatives by the twelve increments (Δr_a, Δθ_a, Δr_b, Δθ_b) of a pair of
/// bodies (forward mode). Contact formulas are written once, for double, Dual and Fine.
struct Dual {
  static constexpr int kDirections = 12;
  double v = 0.0;
  double d[kDirections] = {};

  Dual() = default;
  Dual(double value) : v(value) {}  // NOLINT: numbers are constants

  Dual& operator+=(const Dual& o) { return *this = *this + o; }

  /// Value f and, by the chain rule, the derivatives with df/dx = slope.
  [[nodiscard]] Dual chained(double f, double slope) const {
    Dual r(f);
    for (int i = 0; i < kDirections; ++i) r.d[i] = slope * d[i];
    return r;
  }
  friend Dual operator+(const Dual& a, const Dual& b) {
    Dual r(a.v + b.v);
    for (int i = 0; i < kDirections; ++i) r.d[i] = a.d[i] + b.d[i];
    return r;
  }
  friend Dual operator-(const Dual& a, const Dual& b) {
    Dual r(a.v - b.v);
    for (int i = 0; i < kDirections; ++i) r.d[i] = a.d[i] - b.d[i];
    return r;
  }
  friend Dual operator-(const Dual& a) { return a.chained(-a.v, -1.0); }
  friend Dual operator*(const Dual& a, const Dual& b) {
    Dual r(a.v * b.v);
    for (int i = 0; i < kDirections; ++i) r.d[i] = a.v * b.d[i] + b.v * a.d[i];
    return r;
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const double inverse = 1.0 / b.v, q = a.v * inverse;
    Dual r(q);
    for (int i = 0; i < kDirections; ++i) r.d[i] = inverse * (a.d[i] - q * b.d[i]);
    return r;
  }
  friend Dual operator+(const Dual& a, double b) { return a.chained(a.v + b, 1.0); }
  friend Dual operator+(double a, const Dual& b) { return b.chained(a + b.v, 1.0); }
  friend Dual operator-(const Dual& a, double b) { return a.chained(a.v - b, 1.0); }
  friend Dual operator-(double a, const Dual& b) { return b.chained(a - b.v, -1.0); }
  friend Dual operator*(const Dual& a, double b) { return a.chained(a.v * b, b); }
  friend Dual operator*(double a, const Dual& b) { return b.chained(a * b.v, a); }
  friend Dual operator/(const Dual& a, double b) { return a * (1.0 / b); }
};

/// Extended-precision number for gaps deep in the barrier: there the last digit of a double is
/// worth energy.
using Fine = long double;

[[nodiscard]] inline Dual sqrt(const Dual& a) {
  const double root = std::sqrt(a.v);
  return a.chained(root, 0.5 / root);
}
[[nodiscard]] inline double sqrt(double a) { return std::sqrt(a); }
[[nodiscard]] inline Fine sqrt(Fine a) { return std::sqrt(a); }
[[nodiscard]] inline double value(double a) { return a; }
[[nodiscard]] inline double value(Fine a) { return static_cast<double>(a); }
[[nodiscard]] inline double value(const Dual& a) { return a.v; }

/// Vector of three numbers of one type.
template <class T>
struct V3 {
  T x{}, y{}, z{};
};

template <class A, class B>
using Mixed = decltype(A() * B());

[[nodiscard]] inline V3<double> v3(const Vec3& a) { return {a.x(), a.y(), a.z()}; }
template <class T>
[[nodiscard]] Vec3 value(const V3<T>& a) {
  return {value(a.x), value(a.y), value(a.z)};
}
/// The same vector in scalar type T.
template <class T>
[[nodiscard]] V3<T> constant(const Vec3& a) {
  return {T(a.x()), T(a.y()), T(a.z())};
}

template <class A, class B>
[[nodiscard]] V3<Mixed<A, B>> operator+(const V3<A>& a, const V3<B>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class A, class B>
[[nodiscard]] V3<Mixed<A, B>> operator-(const V3<A>& a, const V3<B>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class A>
[[nodiscard]] V3<A> operator-(const V3<A>& a) {
  return {-a.x, -a.y, -a.z};
}
template <class S, class B>
[[nodiscard]] V3<Mixed<S, B>> operator*(const S& s, const V3<B>& b) {
  return {s * b.x, s * b.y, s * b.z};
}
template <class A, class B>
[[nodiscard]] Mixed<A, B> dot(const V3<A>& a, const V3<B>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class A, class B>
[[nodiscard]] V3<Mixed<A, B>> cross(const V3<A>& a, const V3<B>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class A>
[[nodiscard]] A norm(const V3<A>& a) {
  return sqrt(dot(a, a));
}
template <class A>
[[nodiscard]] V3<A> unit(const V3<A>& a) {
  return (A(1.0) / norm(a)) * a;
}

}  // namespace polhode::contact
