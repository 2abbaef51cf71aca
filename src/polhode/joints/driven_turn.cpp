// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/dynamics/load_step.hpp>
#include <polhode/joints/driven_turn.hpp>
#include <polhode/math/exp_map.hpp>

namespace polhode {

double driven_turn(const FrameMotion& motion, const StepContext& context) {
  using Rotation = FrameMotion::Rotation;
  if (motion.rotation == Rotation::none) return 0.0;
  const double t_n = function_time_n(context), t_n1 = context.t_n1();
  const double part_n = load_factor_n(context), part_n1 = context.load_factor;
  const auto parameters = [&](double t) {
    Eigen::Vector4d x = Eigen::Vector4d::Zero();
    for (int k = 0; k < 4; ++k)
      if (const auto& f = motion.parameters[static_cast<std::size_t>(k)]) x[k] = (*f)(t);
    return x;
  };
  if (motion.rotation == Rotation::quaternion) {
    if (part_n != part_n1)
      return log_map(motion.at(t_n, part_n).D.transpose() * motion.at(t_n1, part_n1).D).norm();
    // Continuous functions stay on one cover: opposite quaternions are a whole turn apart.
    const double cosine = parameters(t_n).normalized().dot(parameters(t_n1).normalized());
    return 2.0 * std::abs(part_n1) * std::acos(std::clamp(cosine, -1.0, 1.0));
  }
  // Rotation vectors whose difference is δ are at most |δ| apart; an Euler sequence is three turns.
  const Eigen::Vector4d way = part_n1 * parameters(t_n1) - part_n * parameters(t_n);
  return motion.rotation == Rotation::vector ? way.norm() : way.cwiseAbs().sum();
}

}  // namespace polhode
