// SPDX-License-Identifier: Apache-2.0
// Load steps that are refused, and what is kept of those that are not.
#include <polhode/core/format.hpp>
#include <polhode/equations/node_motion.hpp>
#include <polhode/statics/static_newton.hpp>
#include <polhode/system/interaction_group.hpp>

namespace polhode {

/// Whether the bodies of an interaction that follows their rotation over the step have turned
/// relative to each other by half a turn or more: the nearest of the turns is then another one.
/// Quaternions keep their sign from iterate to iterate, so that they tell more than half a turn
/// from less.
bool StaticNewton::turns_too_far(const InteractionRef& ref) const {
  const InteractionTraits& traits = system_->traits(ref);
  if (traits.lazy_history || (traits.history_size == 0 && traits.rows == 0)) return false;
  const auto turned = [&](int body) {
    if (body == kGround) return Quat::Identity();
    return Quat(system_->motion(work_, body).q * system_->motion(last_, body).q.conjugate());
  };
  return turned(ref.a).coeffs().dot(turned(ref.b).coeffs()) <= 0.0;
}

/// Reason why a load step is rejected: mirror images, beams bent too far, more than half a turn,
/// shapes passed through.
std::string StaticNewton::refused(StaticStep& step) {
  step.worst.clear();
  for (const InteractionRef& ref : system_->interactions()) {
    const InteractionGroup& group = system_->group(ref.group);
    const BodyStep a = body_step(*system_, last_, trial_, ref.a),
                   b = body_step(*system_, last_, trial_, ref.b);
    const PairStep pair{a, b, trial_.context, work_.lambda.data() + ref.first_row,
                        work_.history.data() + ref.first_history};
    const bool too_far = turns_too_far(ref);
    if (!too_far && group.acceptable(ref.item, pair)) continue;
    return format("{} '{}': {}", group.kind(), system_->name(ref),
                  too_far ? "turned by half a turn or more in one load step"
                          : group.traits(ref.item).refusal);
  }
  if (const int g = passed_shape(); g >= 0)
    return format("contact of '{}': a point passed through a shape",
                  system_->nodes().group(g).name());
  return {};
}

/// Work of a drive's rows over a load step, less that with the multipliers at its end, which they
/// have over all of a step of dynamics [J]. @eq{statics-work}
double StaticNewton::work_by_lag(const InteractionRef& ref, const PairStep& pair) const {
  if (system_->traits(ref).work_entry < 0) return 0.0;
  const Vec6 increment =
      system_->group(ref.group).prescribed(ref.item, pair, TimeSide::kBefore).increment;
  double more = 0.0;
  for (int k = 0; k < ref.rows; ++k) {
    const std::size_t row = static_cast<std::size_t>(ref.first_row + k);
    more += 0.5 * (last_.lambda[row] - work_.lambda[row]) * increment[k];
  }
  return more;
}

void StaticNewton::commit(State& state, double load_factor) {
  const Nodes& nodes = system_->nodes();
  for (const InteractionRef& ref : system_->interactions()) {
    if (system_->traits(ref).history_size == 0) continue;
    const BodyStep a = body_step(*system_, last_, trial_, ref.a),
                   b = body_step(*system_, last_, trial_, ref.b);
    double* history = work_.history.data() + ref.first_history;
    const PairStep pair{a, b, trial_.context, work_.lambda.data() + ref.first_row, history};
    const double more = work_by_lag(ref, pair);
    system_->group(ref.group).commit(ref.item, pair, history);
    if (more != 0.0) history[system_->traits(ref).work_entry] += more;
  }
  if (!nodes.empty()) {
    work_.node_x = trial_.node_x;
    NodeStep instant = node_step(work_, trial_);
    instant.x_n = instant.x_n1;
    for (int g = 0; g < nodes.group_count(); ++g)
      nodes.group(g).commit(instant, work_.element_history.data() + nodes.first_history(g),
                            trial_.element_scratch.data() + nodes.first_scratch(g));
  }
  work_.t = load_factor;
  held_ = nodes_.residual();
  state = last_ = work_;
}

}  // namespace polhode
