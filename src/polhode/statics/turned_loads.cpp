// SPDX-License-Identifier: Apache-2.0
// Rigid motions of free parts with loads that turn with them, such as thrusters.
#include <algorithm>
#include <cmath>

#include <polhode/statics/modal_matrices.hpp>
#include <polhode/stepping/plain_motions.hpp>

namespace polhode {

namespace {

/// Force of dampers on a motion, as a part of the terms of its sum, above which it is not free.
constexpr double kResisted = 1e-12;

}  // namespace

/// @eq{modes-turned-loads}
void ModalMatrices::let_turn(const State& state, const std::vector<FollowerLoad>& loads,
                             double load_factor) {
  const auto of_bodies = [](const FollowerLoad& load) { return load.interaction >= 0; };
  if (std::none_of(loads.begin(), loads.end(), of_bodies)) return;
  linear::KktValues values = nothing();
  const KktMap map = kkt_map(system_);
  const auto add = [&](int interaction, const FollowerLoad::Stiffness& K) {
    const InteractionRef& ref = system_.interactions()[static_cast<std::size_t>(interaction)];
    if (ref.a != kGround) values.diagonal[ref.a] += K.topLeftCorner<6, 6>();
    if (ref.b != kGround) values.diagonal[ref.b] += K.bottomRightCorner<6, 6>();
    if (map.pair[interaction] < 0) return;
    values.pairs[map.pair[interaction]].K_ab += K.topRightCorner<6, 6>();
    values.pairs[map.pair[interaction]].K_ba += K.bottomLeftCorner<6, 6>();
  };
  for (const FollowerLoad& load : loads)
    if (of_bodies(load)) add(load.interaction, load.stiffness);
  // The forces with which joints and springs hold moving bodies together turn with these.
  for (int i = 0; i < static_cast<int>(system_.interactions().size()); ++i) {
    const InteractionRef& ref = system_.interactions()[static_cast<std::size_t>(i)];
    const bool within = ref.a != kGround && ref.b != kGround && !system_.traits(ref).holds_ground;
    const bool added = std::any_of(loads.begin(), loads.end(),
                                   [&](const FollowerLoad& load) { return load.interaction == i; });
    if (within && !added) add(i, pair_stiffness(system_, state, load_factor, i));
  }
  SaddleMatrix turning(mass_);
  turning.set(values, std::vector<double>(9 * system_.nodes().mass().size(), 0.0), nullptr, 1.0);
  turning.combine(turning, s() - 1.0, turning);
  Mat V(unknowns(), 0);
  for (const Vec& motion : rigid_free_motions(system_, state, K(), &turning)) {
    Vec x = Vec::Zero(unknowns()), resistance, terms;
    x.head(n()) = motion.head(n());
    damping_.times(widened(x), resistance);
    damping_.magnitudes(widened(x), terms);
    if (resistance.lpNorm<Eigen::Infinity>() > kResisted * terms.lpNorm<Eigen::Infinity>())
      continue;
    for (Eigen::Index i = 0; i < V.cols(); ++i) x -= mass_times(V.col(i)).dot(x) * V.col(i);
    const double square = x.dot(mass_times(x));
    if (!(square > 0.0)) continue;
    V.conservativeResize(unknowns(), V.cols() + 1);
    V.rightCols<1>() = x / std::sqrt(square);
  }
  Mat K_V(V.rows(), V.cols()), M_V(V.rows(), V.cols());
  for (Eigen::Index i = 0; i < V.cols(); ++i) {
    K_V.col(i) = stiffness_times(V.col(i));
    M_V.col(i) = mass_times(V.col(i));
  }
  turned_ = V, K_turned_ = K_V, M_turned_ = M_V;
}

}  // namespace polhode
