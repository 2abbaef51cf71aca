// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/loads/load_vector.hpp>

namespace polhode {

/// A force at a point of body b, with components in the world or rotating with the body.
///
/// It is taken at t_{n+αf}, and acts at the averaged lever arm, so that its work over a step at ρ∞
/// = 1 is exactly force times displacement of the point. A constant force in the world has the
/// potential −f·x; the work of any other is external. It may be a function of the motion of the
/// point. @eq{ga-moment-arm}
class PointForce : public InteractionItem {
 public:
  static constexpr const char* kKind = "force";
  explicit PointForce(const LoadDescription& load);

  [[nodiscard]] bool conservative() const { return force_.is_dead(); }
  [[nodiscard]] bool dissipates() const { return force_.reads_velocity(); }
  [[nodiscard]] std::vector<TimeFunctionPtr> time_functions() const {
    return force_.time_functions();
  }
  void evaluate(const PairStep& step, PairTerms& terms) const;
  [[nodiscard]] Work work(const PairStep& step) const;
  [[nodiscard]] std::vector<double> report(const PairStep& step) const;  ///< Force [N].

 private:
  Vec3 Z_;
  LoadVector force_;
};

/// Adds a PointForce to the system.
void add_point_force(System& system, const LoadDescription& load);

}  // namespace polhode
