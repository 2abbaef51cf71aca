// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <polhode/system/system.hpp>

namespace polhode {

/// Bodies at an instant as interactions see them, each computed when it is first asked for: reports
/// of a frame ask for most of them several times.
class SeenBodies {
 public:
  /// Begins another instant.
  void begin(const System& system, double t) {
    bodies_.resize(static_cast<std::size_t>(system.body_count()) + 1);
    of_.resize(bodies_.size(), 0);
    bodies_.back() = BodyStep::ground(1.0);
    context_.t_n = t;
    ++instant_;
  }
  /// An interaction at the instant. @param state  Of that instant, until the next begin().
  [[nodiscard]] PairStep step(const System& system, const State& state, const InteractionRef& ref,
                              const std::vector<double>& lambda) {
    return {body(system, state, ref.a), body(system, state, ref.b), context_,
            lambda.data() + ref.first_row, state.history.data() + ref.first_history};
  }

 private:
  const BodyStep& body(const System& system, const State& state, int body) {
    if (body == kGround) return bodies_.back();
    const auto b = static_cast<std::size_t>(body);
    if (of_[b] != instant_) bodies_[b] = system.instant(state, body);
    of_[b] = instant_;
    return bodies_[b];
  }

  std::vector<BodyStep> bodies_;  ///< The ground last.
  std::vector<std::int64_t> of_;  ///< By body: the instant of its entry.
  std::int64_t instant_ = 0;
  StepContext context_;
};

}  // namespace polhode
