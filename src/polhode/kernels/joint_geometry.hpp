// SPDX-License-Identifier: Apache-2.0
// Geometry of a joint's shape for the kernels: its rows, its free directions, its position.
#pragma once

#include <polhode/kernels/pack.hpp>
#include <polhode/kernels/tree_data.hpp>

namespace polhode::POLHODE_ISA {

template <int kTranslation, int kDirections>
struct Shape {
  static constexpr JointLayout layout{kTranslation, kDirections};
  static constexpr int T = kTranslation, ND = kDirections;
  static constexpr int taus = T == 3 ? 0 : 3 - T;  ///< Free slides come first,
  static constexpr int omegas = 3 - ND;            ///< then free rotations.
  static constexpr int free = taus + omegas;
  static constexpr int directors = layout.directors();
  static constexpr int of_a = ND == 3 ? 2 : 1;  ///< Directors 0..of_a−1 belong to a.
  static constexpr int slides = layout.slides();
  static constexpr bool sliding = slides > 0;
  static constexpr bool ball = layout.ball();
  /// Row i of the direction rows: director `left(i)` of a · director `right(i)` of b.
  static constexpr int left(int i) { return i == 2 ? 1 : 0; }
  static constexpr int right(int i) { return of_a + (i == 2 ? 1 : i); }
};

POLHODE_INLINE P3 get3(const double* data, int field, int at) {
  return {load(data + 8 * field + at), load(data + 8 * (field + 1) + at),
          load(data + 8 * (field + 2) + at)};
}
POLHODE_INLINE void put3(double* data, int field, int at, const P3& v) {
  for (int i = 0; i < 3; ++i) store(data + 8 * (field + i) + at, v[i]);
}

/// A joint's geometry at t_{n+1}.
template <class S>
struct JointGeometry {
  P3 z_b, arm, u;  ///< u = x_b − x_a.
  P3 director[S::directors > 0 ? S::directors : 1];
  P3 slide[2];
  Pack g[6];  ///< Translation rows, then direction rows.
};

/// Placement of kWidth bodies at one time.
struct Placement {
  P3 r;
  PM L;
};

/// Placement of the bodies whose SIMD lanes in the trial begin at `from`, at t_{n+1} and at t_n.
POLHODE_INLINE Placement gather_at_n1(const TreeView& v, const int* from) {
  const double* trial = reinterpret_cast<const double*>(v.trial);
  Placement p;
  for (int i = 0; i < 3; ++i) p.r[i] = gather(trial + 8 * i, from);
  for (int i = 0; i < 9; ++i) p.L[i] = gather(trial + 8 * (3 + i), from);
  return p;
}
POLHODE_INLINE Placement gather_at_n(const TreeView& v, const int* from) {
  const double* trial = reinterpret_cast<const double*>(v.trial);
  Placement p;
  for (int i = 0; i < 3; ++i)
    p.r[i] = gather(trial + 8 * i, from) - gather(trial + 8 * (21 + i), from);
  for (int i = 0; i < 9; ++i) p.L[i] = gather(trial + 8 * (12 + i), from);
  return p;
}
/// Placement of a block's bodies and of their parents at t_n.
POLHODE_INLINE Placement parents_at_n(const TreeView& v, int block, int at) {
  return gather_at_n(v, v.gather + block * kLanes + at);
}
POLHODE_INLINE Placement bodies_at_n(const TreeView& v, int block, int at) {
  const TrialBlock& t = v.trial[block];
  return {load3(t.r, at) - load3(t.u, at), load9(t.Lambda_n, at)};
}

/// @param data  Of the joints: constants and stored values, see JointLayout.
template <class S>
POLHODE_INLINE JointGeometry<S> joint_geometry(const double* data, int at, const Placement& a,
                                               const Placement& b) {
  constexpr JointLayout l = S::layout;
  JointGeometry<S> q;
  q.z_b = b.L * get3(data, l.Z_b(), at);
  const P3 z_a = a.L * get3(data, l.Z_a(), at);
  const P3 y = b.r + q.z_b - a.r;
  q.u = y - z_a;
  q.arm = S::T == 3 ? z_a : y;
  for (int i = 0; i < S::directors; ++i)
    q.director[i] = (i < S::of_a ? a.L : b.L) * get3(data, l.director() + 3 * i, at);
  for (int i = 0; i < S::slides; ++i) q.slide[i] = a.L * get3(data, l.slide() + 3 * i, at);
  for (int i = 0; i < S::T; ++i)
    q.g[i] = S::T == 3 ? q.u[i] : dot(q.slide[S::sliding ? i : 0], q.u);
  for (int i = 0; i < S::ND; ++i)
    q.g[S::T + i] = dot(q.director[S::left(i)], q.director[S::right(i)]);
  return q;
}

/// Geometry of the joints of a block's bodies to their parents.
template <class S>
POLHODE_INLINE JointGeometry<S> tree_joint(const TreeView& v, int block, int at) {
  const TrialBlock& t = v.trial[block];
  return joint_geometry<S>(v.joint_data + v.joint[block], at,
                           gather_at_n1(v, v.gather + block * kLanes + at),
                           {load3(t.r, at), load9(t.Lambda, at)});
}

/// Stores lever arms, directors and slides at t_n for the iterations of the step.
template <class S>
POLHODE_INLINE void joint_at_n(double* data, int at, const Placement& a, const Placement& b) {
  constexpr JointLayout l = S::layout;
  const P3 z_b = b.L * get3(data, l.Z_b(), at);
  put3(data, l.arm_b_n(), at, z_b);
  put3(data, l.arm_a_n(), at, S::T == 3 ? a.L * get3(data, l.Z_a(), at) : b.r + z_b - a.r);
  for (int i = 0; i < S::directors; ++i)
    put3(data, l.director_n() + 3 * i, at,
         (i < S::of_a ? a.L : b.L) * get3(data, l.director() + 3 * i, at));
  for (int i = 0; i < S::slides; ++i)
    put3(data, l.slide_n() + 3 * i, at, a.L * get3(data, l.slide() + 3 * i, at));
}

/// Free slides of a joint: any basis of the complement of the slide rows, in world components.
template <class S>
POLHODE_INLINE P3 tau(const P3* slide, int i) {
  if constexpr (S::T == 2) {
    return cross(slide[0], slide[1]);
  } else if constexpr (S::T == 1) {
    const P3 along = cross(slide[0], slide[1]);
    return i == 0 ? along : cross(slide[0], along);
  } else {
    P3 e = {Pack{}, Pack{}, Pack{}};
    e[i] = broadcast(1.0);
    return e;
  }
}

/// Free rotations of a joint.
template <class S>
POLHODE_INLINE P3 axis(const P3* director, int i) {
  if constexpr (S::ND == 0) {
    P3 e = {Pack{}, Pack{}, Pack{}};
    e[i] = broadcast(1.0);
    return e;
  } else {
    return director[i];  // one row: x_a and y_b; two rows: z_a
  }
}

/// Solves Σ x_i (d_i × e_i) = t for the direction rows; t lies in their span.
template <class S>
POLHODE_INLINE void direction_coefficients(const P3* director, const P3& t, Pack* x) {
  if constexpr (S::ND == 1) {
    const P3 y = cross(director[0], director[1]);
    x[0] = dot(t, y) / dot(y, y);
  } else if constexpr (S::ND == 2) {
    const Pack k = 1.0 / dot(director[0], cross(director[1], director[2]));
    x[0] = k * dot(t, director[2]);
    x[1] = -k * dot(t, director[1]);
  } else if constexpr (S::ND == 3) {
    const P3 y1 = cross(director[0], director[2]), y2 = cross(director[0], director[3]);
    const P3 y3 = cross(director[1], director[3]);
    const P3 y23 = cross(y2, y3);
    const Pack k = 1.0 / dot(y1, y23);
    x[0] = k * dot(t, y23);
    x[1] = k * dot(t, cross(y3, y1));
    x[2] = k * dot(t, cross(y1, y2));
  }
}

/// The rotation w with (d_i × e_i)·w = g_i.
template <class S>
POLHODE_INLINE P3 direction_correction(const P3* director, const Pack* g) {
  if constexpr (S::ND == 1) {
    const P3 y = cross(director[0], director[1]);
    return (g[0] / dot(y, y)) * y;
  } else if constexpr (S::ND == 2) {
    const Pack k = 1.0 / dot(director[0], cross(director[1], director[2]));
    return (k * g[0]) * director[2] - (k * g[1]) * director[1];
  } else if constexpr (S::ND == 3) {
    const P3 y1 = cross(director[0], director[2]), y2 = cross(director[0], director[3]);
    const P3 y3 = cross(director[1], director[3]);
    const P3 y23 = cross(y2, y3);
    const Pack k = 1.0 / dot(y1, y23);
    return (k * g[0]) * y23 + (k * g[1]) * cross(y3, y1) + (k * g[2]) * cross(y1, y2);
  } else {
    return {Pack{}, Pack{}, Pack{}};
  }
}

/// Calls f.template operator()<Shape>() for a shape code that is not a root.
template <class F>
POLHODE_INLINE void with_shape(int code, F&& f) {
  switch (code) {
    case 1:
      return f.template operator()<Shape<0, 1>>();
    case 2:
      return f.template operator()<Shape<0, 2>>();
    case 3:
      return f.template operator()<Shape<0, 3>>();
    case 4:
      return f.template operator()<Shape<1, 0>>();
    case 5:
      return f.template operator()<Shape<1, 1>>();
    case 6:
      return f.template operator()<Shape<1, 2>>();
    case 7:
      return f.template operator()<Shape<1, 3>>();
    case 8:
      return f.template operator()<Shape<2, 0>>();
    case 9:
      return f.template operator()<Shape<2, 1>>();
    case 10:
      return f.template operator()<Shape<2, 2>>();
    case 11:
      return f.template operator()<Shape<2, 3>>();
    case 12:
      return f.template operator()<Shape<3, 0>>();
    case 13:
      return f.template operator()<Shape<3, 1>>();
    case 14:
      return f.template operator()<Shape<3, 2>>();
    default:
      return f.template operator()<Shape<3, 3>>();
  }
}

}  // namespace polhode::POLHODE_ISA
