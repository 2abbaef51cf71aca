// SPDX-License-Identifier: Apache-2.0
#include <Eigen/LU>
#include <Eigen/SVD>

#include <cmath>
#include <numeric>

#include <polhode/solids/solid_elements.hpp>
#include <polhode/stepping/extrapolated_velocities.hpp>

namespace polhode {

namespace {

/// Sum of the weights' magnitudes above which errors are amplified.
constexpr double kLargestWeights = 12.0;
constexpr std::size_t kFewestSteps = 3;

/// Nodes of viscous materials, whose stress depends on velocities.
std::vector<bool> viscous_nodes(const Nodes& nodes) {
  std::vector<bool> viscous(static_cast<std::size_t>(nodes.count()), false);
  for (int g = 0; g < nodes.group_count(); ++g) {
    const ElementGroup& group = nodes.group(g);
    const solids::SolidElements* solid = solids::as_solid(group);
    if (solid == nullptr || !solid->material().viscous()) continue;
    for (int e = 0; e < group.size(); ++e)
      for (const int node : group.nodes(e)) viscous[static_cast<std::size_t>(node)] = true;
  }
  return viscous;
}

/// Nodes connected by elements with mass, each solid separately; only those of viscous materials.
std::vector<std::vector<int>> nodes_by_solid(const Nodes& nodes) {
  const std::vector<bool> viscous = viscous_nodes(nodes);
  std::vector<int> solid(static_cast<std::size_t>(nodes.count()), -1);
  std::vector<std::vector<int>> solids;
  for (int first = 0; first < nodes.count(); ++first) {
    if (solid[first] >= 0 || !viscous[static_cast<std::size_t>(first)]) continue;
    std::vector<int> list{first};
    solid[first] = static_cast<int>(solids.size());
    for (std::size_t k = 0; k < list.size(); ++k)
      for (int b = nodes.row_start()[list[k]]; b < nodes.row_start()[list[k] + 1]; ++b) {
        const int other = nodes.column()[b];
        if (nodes.mass()[b] == 0.0 || solid[other] >= 0) continue;
        solid[other] = solid[first];
        list.push_back(other);
      }
    solids.push_back(std::move(list));
  }
  return solids;
}

using Points = Eigen::Matrix<double, 3, Eigen::Dynamic>;

Points points_of(const std::vector<double>& field, const std::vector<int>& list) {
  Points P(3, static_cast<Eigen::Index>(list.size()));
  for (std::size_t k = 0; k < list.size(); ++k)
    P.col(static_cast<Eigen::Index>(k)) = at_node(field, list[k]);
  return P;
}

Points about_their_mean(const Points& P) { return P.colwise() - P.rowwise().mean(); }

/// Points rotated rigidly for the best fit to others (W. Kabsch, Acta Cryst. A 32 (1976) 922). Both
/// relative to their means.
Points turned_onto(const Points& others, const Points& P) {
  const Eigen::JacobiSVD<Mat3> svd(others * P.transpose(),
                                   Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vec3 sign = Vec3::Ones();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0) sign.z() = -1.0;
  return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose() * P;
}

/// Rigid-body part of velocities.
Points rigid_part(const Points& arms, const Points& v) {
  Mat3 inertia = Mat3::Zero();
  Vec3 spin = Vec3::Zero();
  for (Eigen::Index k = 0; k < arms.cols(); ++k) {
    const Vec3 z = arms.col(k);
    inertia += z.squaredNorm() * Mat3::Identity() - z * z.transpose();
    spin += z.cross(Vec3(v.col(k)));
  }
  const Vec3 omega = inertia.fullPivLu().solve(spin);
  Points rigid = v.rowwise().mean().replicate(1, v.cols());
  for (Eigen::Index k = 0; k < arms.cols(); ++k) rigid.col(k) += omega.cross(Vec3(arms.col(k)));
  return rigid;
}

}  // namespace

std::vector<double> extrapolation_weights(const std::vector<double>& dt) {
  const auto n = static_cast<Eigen::Index>(dt.size());
  if (n < static_cast<Eigen::Index>(kFewestSteps)) return {};
  Mat A(n, n);
  double end = 0.0;  // in units of the last step, from t_n
  for (Eigen::Index k = 0; k < n; ++k) {
    const double h = dt[static_cast<std::size_t>(k)] / dt[0], start = end - h;
    if (!(h > 0.0)) return {};
    A(0, k) = 1.0;
    A(1, k) = 0.5 * (start + end);
    if (n > 3) A(2, k) = (start * start + start * end + end * end) / 3.0;
    A(n - 1, k) = (k % 2 == 0 ? 1.0 : -1.0) / h;
    end = start;
  }
  Vec one = Vec::Zero(n);
  one[0] = 1.0;
  const Vec w = A.fullPivLu().solve(one);
  if (!(w.lpNorm<1>() < kLargestWeights)) return {};
  return {w.begin(), w.end()};
}

std::vector<double> extrapolated_velocities(const System& system, const State& state) {
  const Nodes& nodes = system.nodes();
  std::vector<double> v = state.node_v;
  if (nodes.empty() || !nodes.dissipates()) return v;
  const auto count = static_cast<std::size_t>(std::min(4, state.past_count));
  if (count < kFewestSteps) return v;
  std::vector<double> dt;
  double end = state.t;
  std::vector<const double*> mean;  // velocities of these steps
  for (std::size_t k = 0; k < count; ++k) {
    const int ring = (state.past_next - 1 - static_cast<int>(k) + 2 * kPast) % kPast;
    dt.push_back(2.0 * (end - state.past_time[static_cast<std::size_t>(ring)]));
    end -= dt.back();
    mean.push_back(state.node_past.data() + static_cast<std::size_t>(ring) * v.size());
  }
  const std::vector<double> weight = extrapolation_weights(dt);
  if (weight.empty()) return v;

  for (const std::vector<int>& list : nodes_by_solid(nodes)) {
    const Points x = points_of(state.node_x, list), arms = about_their_mean(x);
    Points rate = rigid_part(arms, points_of(state.node_v, list));
    Points place = x, after = arms;
    for (std::size_t k = 0; k < count; ++k) {
      for (std::size_t i = 0; i < list.size(); ++i)
        place.col(static_cast<Eigen::Index>(i)) -=
            dt[k] * Eigen::Map<const Vec3>(mean[k] + 3 * static_cast<std::size_t>(list[i]));
      const Points before = turned_onto(arms, about_their_mean(place));
      rate += weight[k] / dt[k] * (after - before);
      after = before;
    }
    for (std::size_t i = 0; i < list.size(); ++i)
      at_node(v, list[i]) = rate.col(static_cast<Eigen::Index>(i));
  }
  return v;
}

}  // namespace polhode
