// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/loads/point_on_surface.hpp>

namespace polhode {

PointOnSurface::PointOnSurface(const LoadDescription& load)
    : Z_a_(load.Z_a), Z_b_(load.Z_b), R_a_(load.R_a) {
  name = load.name;
  bodies = load.bodies;
  Vec3 a;
  size_ = 0.0;
  for (int i = 0; i < 3; ++i) {
    a[i] = load.value(std::string("semi_axes.") + "xyz"[i], 0.0);
    if (a[i] > 0.0) size_ = size_ > 0.0 ? std::min(size_, a[i]) : a[i];
  }
  if (!(size_ > 0.0)) size_ = a[0] = 1.0;
  for (int i = 0; i < 3; ++i) weight_[i] = a[i] > 0.0 ? size_ / (a[i] * a[i]) : 0.0;
}

void PointOnSurface::evaluate(const PairStep& step, PairTerms& t) const {
  const double lambda = step.lambda[0];
  double sum = -size_;
  Vec6 mu_a = Vec6::Zero(), mu_b = Vec6::Zero(), end_a = Vec6::Zero(), end_b = Vec6::Zero();
  for (int i = 0; i < 3; ++i) {
    if (weight_[i] == 0.0) continue;
    const CoordinateMotion s = coordinate_motion(along(i), step.a, step.b, 0.0, true);
    sum += weight_[i] * s.at_n1 * s.at_n1;
    const double slope = weight_[i] * s.at_alpha;
    mu_a += slope * s.mu_a;
    mu_b += slope * s.mu_b;
    end_a += weight_[i] * s.at_n1 * s.at_n1_a;
    end_b += weight_[i] * s.at_n1 * s.at_n1_b;
    add_force(s, lambda * slope, step, t);
    if (step.context.tangents)
      add_force_change(s, lambda * weight_[i] * s.alpha_a, lambda * weight_[i] * s.alpha_b, t);
  }
  t.g[0] = 0.5 * sum;
  t.B_a.col(0) = mu_a;
  t.B_b.col(0) = mu_b;
  if (step.context.tangents) {
    t.G_a.row(0) = end_a;
    t.G_b.row(0) = end_b;
  }
  clear_ground_sides(step, t);
}

void PointOnSurface::acceleration_terms(const PairStep& step, Vec6& gamma) const {
  gamma[0] = 0.0;
  for (int i = 0; i < 3; ++i) {
    if (weight_[i] == 0.0) continue;
    const FreeDisplacement s = along(i);
    const double rate = s.rate_at_n1(step.a, step.b);
    gamma[0] +=
        weight_[i] * (rate * rate + s.at_n1(step.a, step.b) * s.acceleration_at_n1(step.a, step.b));
  }
}

std::vector<double> PointOnSurface::report(const PairStep& step) const {
  Vec3 force = Vec3::Zero(), place;
  for (int i = 0; i < 3; ++i) {
    place[i] = along(i).at_n1(step.a, step.b);
    force += step.lambda[0] * weight_[i] * place[i] * (step.a.Lambda_n1 * R_a_.col(i));
  }
  return numbers(force, {place[0], place[1], place[2]});
}

void add_point_on_surface(System& system, const LoadDescription& load) {
  double largest = 0.0;
  for (const char axis : {'x', 'y', 'z'})
    largest = std::max(largest, load.value(std::string("semi_axes.") + axis, 0.0));
  if (load.values.contains("semi_axes.x") && largest == 0.0)
    throw InputError(format("loads.{}.semi_axes", load.name), "are all zero",
                     "Give at least one above 0");
  system.group<PointOnSurface>().add(load);
}

}  // namespace polhode
