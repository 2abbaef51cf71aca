// SPDX-License-Identifier: Apache-2.0
#include <Eigen/QR>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>

#include <polhode/core/disjoint_sets.hpp>
#include <polhode/core/format.hpp>
#include <polhode/engines/saddle_solver.hpp>
#include <polhode/math/dense.hpp>
#include <polhode/math/hat.hpp>
#include <polhode/stepping/plain_motions.hpp>

namespace polhode {

namespace {

/// Relative residual up to which a motion of a part lies in the space of given free motions.
constexpr double kEqual = 1e-6;
/// Force of a rigid motion, relative to the terms of its sum, below which the motion is free:
/// rounding gives a hundredth of that, the weight of a steel block on a hinge a hundred thousand
/// times as much.
constexpr double kFreeRigid = 5e-13;

using Mat36 = Eigen::Matrix<double, 3, 6>;

/// A connected component of bodies and free nodes.
struct Part {
  std::vector<int> bodies, nodes;
  std::string name;
};

/// Connected components: their bodies and nodes.
std::vector<Part> parts_of(const System& system) {
  const Nodes& nodes = system.nodes();
  const int bodies = system.body_count();
  DisjointSets sets(static_cast<std::size_t>(bodies + nodes.count()));
  for (const InteractionRef& ref : system.interactions()) {
    if (ref.a != kGround && ref.b != kGround) sets.join(ref.a, ref.b);
    if (ref.further_part)
      sets.join(moving_body(ref), moving_body(system.interactions()[ref.first_part]));
  }
  for (int i = 0; i < nodes.count(); ++i)
    if (nodes[i].body >= 0) sets.join(nodes[i].body, bodies + i);
  std::vector<std::string> solids(static_cast<std::size_t>(nodes.count()));
  for (int g = 0; g < nodes.group_count(); ++g)
    for (int e = 0; e < nodes.group(g).size(); ++e) {
      const std::span<const int> list = nodes.group(g).nodes(e);
      for (const int node : list) {
        if (nodes[node].body == kGround) continue;
        std::string& name = solids[static_cast<std::size_t>(node)];
        if (name.empty()) name = nodes.group(g).name();
        if (nodes[list[0]].body != kGround) sets.join(bodies + list[0], bodies + node);
      }
    }
  std::vector<Part> parts;
  std::vector<int> part_of(static_cast<std::size_t>(bodies + nodes.count()), -1);
  for (int i = 0; i < bodies + nodes.count(); ++i) {
    if (i >= bodies && nodes[i - bodies].body == kGround) continue;
    int& part = part_of[static_cast<std::size_t>(sets.first_of(i))];
    if (part < 0) {
      part = static_cast<int>(parts.size());
      parts.emplace_back();
      parts.back().name = i < bodies ? format("body '{}'", system.bodies()[i].name)
                                     : format("'{}'", solids[static_cast<std::size_t>(i - bodies)]);
    }
    Part& p = parts[static_cast<std::size_t>(part)];
    if (i < bodies)
      p.bodies.push_back(i);
    else if (nodes[i - bodies].body == kFreeNode)
      p.nodes.push_back(i - bodies);
  }
  for (Part& part : parts) {
    const bool several = part.bodies.size() > 1 || (!part.bodies.empty() && !part.nodes.empty());
    if (several && parts.size() == 1)
      part.name = "the whole model";
    else if (several)
      part.name += " and everything connected to it";
  }
  return parts;
}

/// Translations along and rotations about x, y, z of a part as columns, and its moments of inertia.
struct RigidMotions {
  Mat R;
  Mat3 inertia = Mat3::Zero();
};
RigidMotions rigid_motions(const System& system, const State& state, const SaddleMatrix& matrix,
                           const Part& part) {
  const Nodes& nodes = system.nodes();
  RigidMotions rigid;
  const auto place = [&](int node) {
    return Vec3(Eigen::Map<const Vec3>(state.node_x.data() + 3 * node));
  };
  double mass = 0.0;
  Vec3 centre = Vec3::Zero();
  for (const int b : part.bodies) {
    mass += system.bodies()[b].mass;
    centre += system.bodies()[b].mass * system.motion(state, b).r;
  }
  for (const int i : part.nodes) {
    mass += nodes.node_mass(i);
    centre += nodes.node_mass(i) * place(i);
  }
  if (mass > 0.0) centre /= mass;
  rigid.R = Mat::Zero(matrix.movable(), 6);
  for (const int b : part.bodies) {
    const BodyMotion m = system.motion(state, b);
    const Vec3 arm = m.r - centre;
    rigid.R.block<3, 3>(6 * b, 0).setIdentity();
    rigid.R.block<3, 3>(6 * b, 3) = -hat(arm);
    rigid.inertia -= system.bodies()[b].mass * hat(arm) * hat(arm);
    if (system.bodies()[b].point_mass) continue;
    rigid.R.block<3, 3>(6 * b + 3, 3).setIdentity();
    rigid.inertia += m.Lambda() * system.bodies()[b].inertia * m.Lambda().transpose();
  }
  for (const int i : part.nodes) {
    const Vec3 arm = place(i) - centre;
    rigid.inertia -= nodes.node_mass(i) * hat(arm) * hat(arm);
    for (int c = 0; c < 3; ++c) {
      const int u = matrix.unknown(i, c);
      if (u < 0) continue;
      rigid.R(u, c) = 1.0;
      rigid.R.block<1, 3>(u, 3) = -hat(arm).row(c);
    }
  }
  return rigid;
}

/// Vectors of the null space of a matrix with few columns, orthonormal.
Mat null_space(const Mat& A) {
  const Eigen::JacobiSVD<Mat> svd(A, Eigen::ComputeFullV);
  Eigen::Index rank = 0;
  while (rank < svd.singularValues().size() && svd.singularValues()[rank] > kEqual) ++rank;
  return svd.matrixV().rightCols(A.cols() - rank);
}

/// Directions that span the columns of a matrix with three rows: along axes if possible.
std::vector<Vec3> directions_of(const Mat& D, const Mat3& axes) {
  std::vector<Vec3> list;
  if (D.cols() == 0) return list;
  const Eigen::JacobiSVD<Mat> svd(D, Eigen::ComputeFullU);
  Eigen::Index rank = 0;
  while (rank < svd.singularValues().size() && svd.singularValues()[rank] > kEqual) ++rank;
  const Mat U = svd.matrixU().leftCols(rank);
  for (int pass = 0; pass < 2; ++pass)  // axes inside the space first, then the remainder of others
    for (int c = 0; c < 3 && static_cast<Eigen::Index>(list.size()) < rank; ++c) {
      Vec3 d = U * (U.transpose() * axes.col(c));
      if (pass == 0 && (d - axes.col(c)).norm() > kEqual) continue;
      for (const Vec3& other : list) d -= other.dot(d) * other;
      if (d.norm() < (pass == 0 ? 0.5 : 1e-3)) continue;
      list.push_back(d.normalized());
    }
  return list;
}

/// Principal axes of inertia; those of the world if these are principal.
Mat3 axes_of(const Mat3& inertia) {
  const double size = inertia.trace();
  Mat3 off = inertia;
  off.diagonal().setZero();
  if (!(size > 0.0) || off.cwiseAbs().maxCoeff() <= kEqual * size) return Mat3::Identity();
  return eigen_of_symmetric(inertia).vectors;
}

}  // namespace

std::vector<PlainMotion> plain_motions(const System& system, const State& state,
                                       const SaddleMatrix& matrix,
                                       const std::vector<Vec>& motions) {
  std::vector<PlainMotion> list;
  if (motions.empty()) return list;
  const double length = system.length_scale();
  const int n = matrix.movable();
  Vec weight = Vec::Ones(n);  // rotations are scaled by ℓ
  for (int b = 0; b < system.body_count(); ++b) weight.segment<3>(6 * b + 3).setConstant(length);
  Mat left(n, static_cast<Eigen::Index>(motions.size()));
  for (std::size_t i = 0; i < motions.size(); ++i)
    left.col(static_cast<Eigen::Index>(i)) = weight.cwiseProduct(motions[i].head(n));
  left = Mat(Eigen::HouseholderQR<Mat>(left).householderQ() * Mat::Identity(n, left.cols()));
  const auto take = [&](const Vec& x, std::string text) {
    Vec d = weight.cwiseProduct(x);
    d.normalize();
    const Vec along = left.transpose() * d;
    if (left.cols() == 0 || along.norm() < 0.5) return;
    // Reduced space, by a reflection whose first vector is removed.
    const Eigen::HouseholderQR<Mat> qr(along);
    const Mat Q = qr.householderQ() * Mat::Identity(left.cols(), left.cols());
    left = Mat(left * Q.rightCols(left.cols() - 1));
    list.push_back({x / x.lpNorm<Eigen::Infinity>(), std::move(text)});
  };
  for (const Part& part : parts_of(system)) {
    const RigidMotions rigid = rigid_motions(system, state, matrix, part);
    Mat R = weight.asDiagonal() * rigid.R;
    R.rightCols<3>() /= length;
    const double size = R.leftCols<3>().norm();
    if (!(size > 0.0)) continue;
    R /= size;
    const Mat c = null_space(R - left * (left.transpose() * R));
    if (c.cols() == 0) continue;
    const Mat shifts = c.topRows(3) * null_space(c.bottomRows(3));
    const auto text = [&](bool turns, const Vec3& d) {
      return format("{} {} {}", part.name, turns ? "rotates about" : "moves along", axis_text(d));
    };
    Mat along = Mat::Zero(3, 0);
    for (const Vec3& d : directions_of(shifts, Mat3::Identity())) {
      take(rigid.R.leftCols<3>() * d, text(false, d));
      along.conservativeResize(3, along.cols() + 1);
      along.rightCols<1>() = d;
    }
    const Eigen::CompleteOrthogonalDecomposition<Mat> turning(c.bottomRows(3));
    for (const Vec3& d : directions_of(c.bottomRows(3), axes_of(rigid.inertia))) {
      Vec6 y = c * turning.solve(d);
      y.tail<3>() /= length;
      y.head<3>() -= along * (along.transpose() * y.head<3>());
      const Vec x = rigid.R * y;
      if (weight.cwiseProduct(x).norm() > kEqual * size * y.norm() * length) take(x, text(true, d));
    }
  }
  for (Eigen::Index i = 0; i < left.cols(); ++i) {
    Vec x = left.col(i).cwiseQuotient(weight);
    x /= x.lpNorm<Eigen::Infinity>();
    list.push_back({x, describe_motion(system, matrix, x)});
  }
  return list;
}

std::vector<Vec> rigid_free_motions(const System& system, const State& state,
                                    const SaddleMatrix& matrix, const SaddleMatrix* without) {
  std::vector<Vec> free;
  const double length = system.length_scale();
  for (const Part& part : parts_of(system)) {
    Mat R = rigid_motions(system, state, matrix, part).R;
    R.rightCols<3>() /= length;
    Mat forces(matrix.size(), 6);
    Vec x(matrix.size()), force, terms;
    double largest = 0.0;
    for (int k = 0; k < 6; ++k) {
      x << R.col(k), Vec::Zero(matrix.size() - matrix.movable());
      matrix.times(x, force);
      matrix.magnitudes(x, terms);
      forces.col(k) = force;
      if (without) {
        without->times(x, force);
        forces.col(k) -= force;
      }
      largest = std::max(largest, terms.lpNorm<Eigen::Infinity>());
    }
    if (!(largest > 0.0)) continue;
    const Eigen::JacobiSVD<Mat> svd(forces / largest, Eigen::ComputeFullV);
    for (Eigen::Index k = 0; k < 6; ++k) {
      if (svd.singularValues()[k] > kFreeRigid) continue;
      x << R * svd.matrixV().col(k), Vec::Zero(matrix.size() - matrix.movable());
      const double size = x.lpNorm<Eigen::Infinity>();
      if (size > kEqual) free.push_back(x / size);  // otherwise it is one of a point
    }
  }
  return free;
}

}  // namespace polhode
