// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <polhode/core/format.hpp>
#include <polhode/newton/row_check.hpp>

namespace polhode {

namespace {

/// Round-offs of a row's coordinates, and multiple of them to which an iteration that has stalled
/// comes.
constexpr double kRowRoundOff = 8.0 * std::numeric_limits<double>::epsilon();
constexpr double kAtRoundOff = 4.0;
/// Largest relative rotation of two bodies in a step, |Θ| = 2 of each: a counted angle is below
/// this times the steps so far [rad].
constexpr double kTurnOfStep = 2.0 * std::numbers::pi;
/// Kind of interactions whose rows are products of directions, also if they count turns.
constexpr const char* kJointKind = "joint";

}  // namespace

std::string OpenRow::gap_text() const {
  return format("a gap of {:.2g} {}", gap, length ? "m" : "rad");
}

RowCheck::RowCheck(const System& system)
    : system_(&system),
      size_(static_cast<std::size_t>(system.body_count())),
      gaps_(static_cast<std::size_t>(system.rows())) {
  for (int b = 0; b < system.body_count(); ++b) {
    const BodyData& body = system.bodies()[b];
    size_[b] = std::sqrt(0.5 * body.inertia.trace() / body.mass);
  }
  const auto extend = [&](int body, double length) {
    if (body != kGround) size_[body] = std::max(size_[body], length);
  };
  for (const InteractionRef& ref : system.interactions()) {
    if (ref.rows == 0) continue;
    const InteractionDescription of = system.group(ref.group).describe(ref.item);
    for (const int body : {ref.a, ref.b}) extend(body, of.traits.reach);
    if (!of.motion_basis) continue;
    extend(ref.a, of.motion_basis->Z_a.norm());
    extend(ref.b, of.motion_basis->Z_b.norm());
  }
  // Bodies smaller than that are points at the scale of the mechanism.
  const double point = RowCheck::kTolerance * system.length_scale();
  double smallest = 1.0;
  for (double& size : size_) {
    if (size < point) size = system.length_scale();
    smallest = std::min(smallest, size);
  }
  smallest_ = kTolerance * smallest;
}

bool RowCheck::hold(const State& state, const Trial& trial, bool rounded) {
  open_ = {};
  std::fill(gaps_.begin(), gaps_.end(), 0.0);
  PairTerms terms;
  terms.set_zero();
  double of_parts = 0.0, noise_of_parts = 0.0;  // sums over a row's parts so far
  const double turned = kTurnOfStep * static_cast<double>(state.ledger.steps + 1);
  for (int i = 0; i < static_cast<int>(system_->interactions().size()); ++i) {
    const InteractionRef& ref = system_->interactions()[i];
    if (ref.rows == 0 || system_->is_off(state, i)) continue;
    const PairView view = pair_view(*system_, state, trial, ref);
    const PairStep step = view.step();
    const InteractionGroup& group = system_->group(ref.group);
    group.evaluate({&ref.item, 1}, {&step, 1}, {&terms, 1});
    const double length =
        std::max(ref.a == kGround ? 0.0 : size_[ref.a], ref.b == kGround ? 0.0 : size_[ref.b]);
    const double reach = length + step.a.r_n1.lpNorm<1>() + step.b.r_n1.lpNorm<1>();
    const bool counts = group.kind() != kJointKind && group.traits(ref.item).history_size > 0;
    const double angle = counts ? turned : 1.0;
    for (int k = 0; k < ref.rows; ++k) {
      double by_r = 0.0, by_theta = 0.0;
      const auto add = [&](int body, const auto& G) {
        if (body == kGround) return;
        by_r = std::max(by_r, G.row(k).template head<3>().norm());
        by_theta = std::max(by_theta, G.row(k).template tail<3>().norm());
      };
      add(ref.a, terms.G_a);
      add(ref.b, terms.G_b);
      const double spring = std::abs(terms.compliance[k] * step.lambda[k]);
      const double noise =
          noise_of_parts + kRowRoundOff * (by_r * reach + by_theta * angle + spring);
      of_parts += terms.g[k];
      noise_of_parts = ref.last_part ? 0.0 : noise;
      if (!ref.last_part) continue;
      const double value = std::exchange(of_parts, 0.0);
      const double tolerance =
          rounded ? kAtRoundOff * noise : kTolerance * (by_r * length + by_theta) + noise;
      gaps_[ref.first_row + k] = value + terms.compliance[k] * step.lambda[k];
      const double gap = std::abs(gaps_[ref.first_row + k]);
      if (!(gap <= open_.over * tolerance)) open_ = {i, gap, gap / tolerance, by_r > 0.0};
    }
  }
  return open_.over <= 1.0;
}

}  // namespace polhode
