// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/loads/load_description.hpp>

namespace polhode {

/// A moment on body b, with components in the world or turning with the body, taken at t_{n+αf}.
///
/// Not even a constant one has a potential (turns do not commute): its work is put in.
class Moment : public InteractionItem {
 public:
  static constexpr const char* kKind = "moment";
  explicit Moment(const LoadDescription& load);

  [[nodiscard]] bool conservative() const { return false; }
  [[nodiscard]] std::vector<TimeFunctionPtr> time_functions() const {
    return {moment_.begin(), moment_.end()};
  }
  void evaluate(const PairStep& step, PairTerms& terms) const;
  [[nodiscard]] Work work(const PairStep& step) const;
  [[nodiscard]] std::vector<double> report(const PairStep& step) const;  ///< Moment [N m].

 private:
  TimeVector moment_;
  bool body_fixed_;
};

/// Adds a Moment to the system.
void add_moment(System& system, const LoadDescription& load);

}  // namespace polhode
