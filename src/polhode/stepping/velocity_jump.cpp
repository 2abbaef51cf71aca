// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <span>

#include <polhode/stepping/velocity_jump.hpp>

namespace polhode {

namespace {

/// Prescribed rates of rows that count for the work of their impulses.
Vec6 working_rates(const InteractionGroup& group, int item, const PairStep& step,
                   VelocityJump::Rate rate) {
  const auto at = [&](TimeSide side) { return group.prescribed(item, step, side).rate; };
  if (rate == VelocityJump::Rate::before) return at(TimeSide::kBefore);
  if (rate == VelocityJump::Rate::after) return at(TimeSide::kAfter);
  return 0.5 * (at(TimeSide::kBefore) + at(TimeSide::kAfter));
}

}  // namespace

double take_jump(const System& system, State& state, const VelocityJump& jump) {
  double work = 0.0;
  auto more = jump.more.begin();
  PairTerms terms;
  for (int i = 0; i < static_cast<int>(system.interactions().size()); ++i) {
    const InteractionRef& ref = system.interactions()[i];
    const auto rows = jump.rows.empty() ? std::span<const double>()
                                        : std::span(jump.rows).subspan(ref.first_row, ref.rows);
    const bool by_rows = std::any_of(rows.begin(), rows.end(), [](double x) { return x != 0.0; });
    if (!by_rows && (more == jump.more.end() || more->interaction != i)) continue;
    const InteractionGroup& group = system.group(ref.group);
    const std::vector<double> none(static_cast<std::size_t>(ref.rows), 0.0);
    PairView view = system.instant(state, ref, nullptr);
    view.context.ga = GeneralizedAlpha::from_spectral_radius(0.0);  // as InstantSolver
    view.context.conserving = false;
    const PairStep step{view.a, view.b, view.context, none.data(), view.history};
    const InteractionTraits& traits = system.traits(ref);
    double* history = state.history.data() + ref.first_history;
    Vec6 on_a = Vec6::Zero(), on_b = Vec6::Zero();
    if (by_rows) {
      terms.set_zero();
      group.evaluate(std::span(&ref.item, 1), std::span(&step, 1), std::span(&terms, 1));
      for (int k = 0; k < ref.rows; ++k) {
        on_a += rows[k] * terms.G_a.row(k).transpose();
        on_b += rows[k] * terms.G_b.row(k).transpose();
      }
      if (traits.work_entry >= 0) {
        const double done = working_rates(group, ref.item, step, jump.rate)
                                .head(ref.rows)
                                .dot(Eigen::Map<const Vec>(rows.data(), ref.rows));
        history[traits.work_entry] += done;
        work += done;
      }
    }
    for (; more != jump.more.end() && more->interaction == i; ++more) {
      on_a += more->on_a;
      on_b += more->on_b;
    }
    if (traits.impulse_sum == ImpulseSum::of_row)
      history[traits.impulse_entry] += by_rows ? rows[0] : 0.0;
    else if (traits.impulse_sum != ImpulseSum::none)
      add_impulse(traits.impulse_sum, step, on_a, on_b, history + traits.impulse_entry);
  }
  return work;
}

}  // namespace polhode
