// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/loads/load_vector.hpp>

namespace polhode {

/// A moment on body b, with components in the world or rotating with the body, taken at t_{n+αf}.
///
/// Even a constant one has no potential (rotations do not commute): its work is external. It may be
/// a function of the motion of the centre of mass.
class Moment : public InteractionItem {
 public:
  static constexpr const char* kKind = "moment";
  explicit Moment(const LoadDescription& load);

  [[nodiscard]] bool conservative() const { return false; }
  [[nodiscard]] bool dissipates() const { return moment_.reads_velocity(); }
  [[nodiscard]] std::vector<TimeFunctionPtr> time_functions() const {
    return moment_.time_functions();
  }
  void evaluate(const PairStep& step, PairTerms& terms) const;
  [[nodiscard]] Work work(const PairStep& step) const;
  [[nodiscard]] std::vector<double> report(const PairStep& step) const;  ///< Moment [N m].

 private:
  LoadVector moment_;
};

/// Adds a Moment to the system.
void add_moment(System& system, const LoadDescription& load);

}  // namespace polhode
