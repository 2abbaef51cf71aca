// SPDX-License-Identifier: Apache-2.0
#include <polhode/system/time_breaks.hpp>

#include <algorithm>
#include <cmath>

namespace polhode {

namespace {

/// Largest curvature effect of a function between samples, as a part of its change over kWindow
/// times as long.
constexpr double kBend = 1.0 / 3.0;
constexpr double kWindow = 4.0;
constexpr int kSamples = 16;
/// Curvature effect, as a part of the function's size, for which no step is shortened.
constexpr double kNothing = 1e-12;
/// Part of the run below which steps are not shortened for sampling: the shortest automatic step.
constexpr double kMinPart = 1e-9;

}  // namespace

TimeBreaks::TimeBreaks(const System& system, double until, int most_derivative)
    : until_(until), most_derivative_(most_derivative) {
  const auto follow = [&](const TimeFunctionPtr& f, int added) {
    if (!f || f->is_constant()) return;
    for (const Followed& other : followed_)
      if (other.function == f && other.added == added) return;
    followed_.push_back({f, added, f->bounds(0.0, until).size, {}});
  };
  for (const InteractionRef& ref : system.interactions()) {
    const InteractionDescription item = system.group(ref.group).describe(ref.item);
    for (const TimeFunctionPtr& f : item.time_functions) follow(f, item.traits.time_order);
  }
  const Nodes& nodes = system.nodes();
  for (int g = 0; g < nodes.group_count(); ++g)
    for (const TimeFunctionPtr& f : nodes.group(g).time_functions()) follow(f, 2);
  for (const PrescribedComponent& p : nodes.prescribed()) follow(p.displacement, 0);
}

TimeBreak TimeBreaks::next(double t) {
  if (t >= until_) {  // the run is continued beyond its end
    until_ = 2.0 * t;
    for (Followed& f : followed_) f.from = -1.0;
  }
  TimeBreak first;
  const auto passed = [t](const TimeBreak& b) { return b.t <= t * (1.0 + kSameBreak); };
  for (Followed& f : followed_) {
    if (f.from < 0.0 || t < f.from || passed(f.next)) {
      f.next = f.function->next_break(t, until_);
      while (f.next.exists() && f.next.derivative + f.added > most_derivative_)
        f.next = f.function->next_break(f.next.t, until_);
      f.next.derivative += f.added;
      f.from = t;
    }
    if (!f.next.exists()) continue;
    const double same = kSameBreak * f.next.t;
    if (f.next.t < first.t - same)
      first = f.next;
    else if (f.next.t <= first.t + same)
      first = {std::min(first.t, f.next.t), std::min(first.derivative, f.next.derivative)};
  }
  return first;
}

double TimeBreaks::sampled_length(double t, double h, double samples) const {
  const double least = kMinPart * until_;
  for (const Followed& f : followed_)
    while (h > least && !sampled(f, t, h, h / samples)) h = std::max(least, 0.7 * h);
  return h;
}

bool TimeBreaks::sampled(const Followed& f, double t, double h, double apart) const {
  const double bend = 0.5 * apart * apart * f.function->bounds(t, t + h).curvature;
  if (bend <= kNothing * f.size) return true;
  // The window ends at the next break, where the function may change arbitrarily.
  double from = t, to = t + kWindow * apart;
  if (f.next.exists() && to > f.next.t) {
    to = f.next.t - 1e-3 * apart;
    from = std::max(0.0, to - kWindow * apart);
  }
  double low = (*f.function)(from), high = low;
  for (int k = 1; k <= kSamples; ++k) {
    const double value = (*f.function)(from + (to - from) * k / kSamples);
    low = std::min(low, value);
    high = std::max(high, value);
  }
  return bend <= kBend * (high - low);
}

}  // namespace polhode
