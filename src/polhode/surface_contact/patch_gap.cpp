// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include <polhode/math/dual.hpp>
#include <polhode/surface_contact/patch_gap.hpp>

namespace polhode::surface_contact {

namespace {

using contact::Dual;
using contact::V3;

/// Change of the squared vectors, as a part of distance times size of the face, below which it has
/// no direction.
constexpr double kNoPatchChange = 1e-14;

/// Σ N_a x_a of weights that sum to zero, relative to one of the points, to avoid rounding far from
/// the origin.
Vec3 difference(const MeshPoint& m, const double* field) {
  Vec3 sum = Vec3::Zero();
  if (m.count == 0) return sum;
  const Vec3 origin = NodeStep::at(field, m.node[0]);
  for (int a = 1; a < m.count; ++a) sum += m.N[a] * (NodeStep::at(field, m.node[a]) - origin);
  return sum;
}

void add(MeshPoint& to, const PatchFoot::Weights& w, const SurfacePatch& patch,
         const std::vector<MeshPoint>& vertices) {
  for (std::size_t k = 0; k < w.size(); ++k) {
    if (w[k] == 0.0 || patch.vertex[k] < 0) continue;
    const MeshPoint& v = vertices[static_cast<std::size_t>(patch.vertex[k])];
    for (int a = 0; a < v.count; ++a) to.add(v.node[a], -w[k] * v.N[a]);
  }
}

/// Squared change and mean of a vector over the step.
template <class T>
struct Moved {
  T squared;
  V3<T> mean;
  Moved(const V3<T>& end, const V3<T>& change, double alpha)
      : squared(dot(2.0 * end - change, change)), mean(end - (1.0 - alpha) * change) {}
};

/// Forces conjugate to y_n and y_{n+1}.
template <class T>
struct PatchForces {
  V3<T> of[2];
  /// @param shift, moved_shift  y_n − y_{n+1} at t_{n+1}, and its change over the step.
  PatchForces(const V3<T> (&y)[2], const V3<T> (&change)[2], const V3<T>& shift,
              const V3<T>& moved_shift, const T& lambda, const T& d_n1, double d_n, double alpha,
              double least) {
    const Moved<T> moved[2] = {{y[0], change[0], alpha}, {y[1], change[1], alpha}};
    const double share[2] = {1.0 - alpha, alpha};
    const T squares = share[0] * moved[0].squared * moved[0].squared +
                      share[1] * moved[1].squared * moved[1].squared;
    const T mu = lambda / ((1.0 - alpha) * d_n + alpha * d_n1);
    const bool corrected = contact::value(squares) > least * least;
    T kappa(0.0);
    // Δ(d²) − ½ Σ Δ|y|² from the shift of the foot alone: without it there is no rounding, either.
    if (corrected) {
      const V3<T> sum = y[0] + y[1], sum_n = sum - (change[0] + change[1]);
      kappa = -0.5 * (dot(shift, sum) + dot(shift - moved_shift, sum_n)) / squares;
    }
    for (int e = 0; e < 2; ++e)
      of[e] = (share[e] * mu * (1.0 + kappa * moved[e].squared)) * moved[e].mean;
  }
};

}  // namespace

PatchVector::PatchVector(const MeshPoint& point, const SurfacePatch& patch, const PatchFoot& foot,
                         const std::vector<MeshPoint>& vertices)
    : free_count(foot.free_count) {
  for (int a = 0; a < point.count; ++a) way.add(point.node[a], point.N[a]);
  add(way, foot.M, patch, vertices);
  for (int k = 0; k < free_count; ++k) {
    add(along[k], foot.along[k], patch, vertices);
    for (int l = k; l < free_count; ++l) add(bend[k + l], foot.bend[k + l], patch, vertices);
  }
}

Vec3 PatchVector::between(const double* field) const { return difference(way, field); }

PatchGap::PatchGap(const NodeStep& step, const PatchVector& from, const PatchVector& to, double d_n,
                   double d_n1)
    : from_(from),
      to_(to),
      alpha_(step.alpha_f),
      d_n_(d_n),
      d_n1_(d_n1),
      exact_(step.context.conserving && step.alpha_f == 0.5) {
  const bool still = step.x_n == step.x_n1;
  const auto moved = [&](const MeshPoint& m) {
    return still ? Vec3(Vec3::Zero()) : difference(m, step.u);
  };
  y_[0] = difference(from.way, step.x_n1);
  y_[1] = difference(to.way, step.x_n1);
  change_[0] = moved(from.way);
  change_[1] = moved(to.way);
  MeshPoint shift = from.way;
  for (int a = 0; a < to.way.count; ++a) shift.add(to.way.node[a], -to.way.N[a]);
  shift_ = difference(shift, step.x_n1);
  moved_shift_ = moved(shift);
  curvature_.setIdentity();
  for (int k = 0; k < 2; ++k) {
    along_[k] = difference(to.along[k], step.x_n1);
    moved_[k] = moved(to.along[k]);
  }
  for (int k = 0; k < to.free_count; ++k)
    for (int l = 0; l < to.free_count; ++l)
      curvature_(k, l) =
          along_[k].dot(along_[l]) + y_[1].dot(difference(to.bend[k + l], step.x_n1));
  for (int a = 1; a < to.way.count; ++a)
    size_ = std::max(
        size_,
        (NodeStep::at(step.x_n1, to.way.node[a]) - NodeStep::at(step.x_n1, to.way.node[0])).norm());
}

/// @eq{patch-force}
PatchGap::Force PatchGap::force(double lambda) const {
  const V3<double> y[2] = {contact::v3(y_[0]), contact::v3(y_[1])},
                   change[2] = {contact::v3(change_[0]), contact::v3(change_[1])};
  const double least =
      exact_ ? kNoPatchChange * size_ * d_n1_ : std::numeric_limits<double>::infinity();
  const PatchForces<double> f(y, change, contact::v3(shift_), contact::v3(moved_shift_), lambda,
                              d_n1_, d_n_, alpha_, least);
  Force all = Force::Zero();
  for (int e = 0; e < 2; ++e) all.segment<3>(3 * e) << f.of[e].x, f.of[e].y, f.of[e].z;
  return all;
}

PatchGap::Force PatchGap::slope() const {
  Force s = Force::Zero();
  s.segment<3>(3) = y_[1] / d_n1_;
  return s;
}

/// Derivatives by y_n, by y_{n+1} at a fixed foot and by the motion η of the foot, for which ∂y·y
/// remains zero: C δη = −(∂(δy)·y + ∂y·δy) with C = ∂y·∂y + ∂²y·y.
PatchGap::Stiffness PatchGap::stiffness(const contact::ForceAndSlope& lambda) const {
  constexpr int kFoot = 6;  // direction of the first η
  V3<Dual> y[2], change[2];
  for (int e = 0; e < 2; ++e) {
    const auto seeded = [&](double value, int c) {
      Dual d(value);
      d.d[3 * e + c] = 1.0;
      return d;
    };
    y[e] = {seeded(y_[e][0], 0), seeded(y_[e][1], 1), seeded(y_[e][2], 2)};
    change[e] = {seeded(change_[e][0], 0), seeded(change_[e][1], 1), seeded(change_[e][2], 2)};
  }
  for (int k = 0; k < to_.free_count; ++k) {
    Dual* const ends[3] = {&y[1].x, &y[1].y, &y[1].z};
    Dual* const changes[3] = {&change[1].x, &change[1].y, &change[1].z};
    for (int c = 0; c < 3; ++c) {
      ends[c]->d[kFoot + k] = along_[k][c];
      changes[c]->d[kFoot + k] = moved_[k][c];
    }
  }
  Dual d_n1(d_n1_), pressure(lambda.value);
  for (int c = 0; c < 3; ++c) {
    d_n1.d[3 + c] = y_[1][c] / d_n1_;
    pressure.d[3 + c] = lambda.slope * d_n1.d[3 + c];
  }
  const double least =
      exact_ ? kNoPatchChange * size_ * d_n1_ : std::numeric_limits<double>::infinity();
  const auto with_value = [](V3<Dual> difference, const Vec3& exact) {
    difference.x.v = exact[0];
    difference.y.v = exact[1];
    difference.z.v = exact[2];
    return difference;
  };
  const PatchForces<Dual> f(y, change, with_value(y[0] - y[1], shift_),
                            with_value(change[0] - change[1], moved_shift_), pressure, d_n1, d_n_,
                            alpha_, least);

  // The motion of the foot by the four blocks.
  Eigen::Matrix<double, 2, 3 * kPoints> eta = Eigen::Matrix<double, 2, 3 * kPoints>::Zero();
  for (int k = 0; k < to_.free_count; ++k) {
    eta.block<1, 3>(k, 3) = -along_[k].transpose();
    eta.block<1, 3>(k, 6 + 3 * k) = -y_[1].transpose();
  }
  if (to_.free_count == 1)
    eta.row(0) /= curvature_(0, 0);
  else if (to_.free_count == 2)
    eta = (curvature_.inverse() * eta).eval();
  Stiffness K = Stiffness::Zero();
  for (int e = 0; e < 2; ++e) {
    const Dual* const of[3] = {&f.of[e].x, &f.of[e].y, &f.of[e].z};
    for (int c = 0; c < 3; ++c) {
      for (int i = 0; i < kFoot; ++i) K(3 * e + c, i) = of[c]->d[i];
      for (int k = 0; k < to_.free_count; ++k) K.row(3 * e + c) += of[c]->d[kFoot + k] * eta.row(k);
    }
  }
  const Vec3 at_end(f.of[1].x.v, f.of[1].y.v, f.of[1].z.v);
  for (int k = 0; k < to_.free_count; ++k)
    K.block<3, 3 * kPoints>(6 + 3 * k, 0) += at_end * eta.row(k);
  return K;
}

}  // namespace polhode::surface_contact
