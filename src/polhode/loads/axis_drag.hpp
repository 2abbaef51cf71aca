// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/loads/load_description.hpp>
#include <polhode/loads/registry.hpp>

namespace polhode {

/// Resistance to the motion of b's point relative to a, and to the relative rotation, by b's axes
/// e_i: the force −(c_i + d_i |v_i|) v_i along each and the moment −(γ_i + δ_i |ω_i|) ω_i about it,
/// v the velocity of b's point relative to a's at the same place. It dissipates
/// −(F·v + M·ω) Δt ≥ 0 in each step. @eq{axis-drag-law}
class AxisDrag : public InteractionItem {
 public:
  static constexpr const char* kKind = "axis_drag";
  /// @param load  Frames; values linear [N s/m], quadratic [N s²/m²], turning [N m s/rad] and
  ///              quadratic_turning [N m s²/rad²] with .x, .y and .z.
  explicit AxisDrag(const LoadDescription& load);

  [[nodiscard]] bool conservative() const { return false; }
  [[nodiscard]] bool dissipates() const { return true; }
  [[nodiscard]] bool piecewise() const {
    return !quadratic_.isZero(0.0) || !quadratic_turning_.isZero(0.0);
  }
  void pieces(const PairStep& step, ForcePieces& pieces) const;
  void evaluate(const PairStep& step, PairTerms& terms) const;
  [[nodiscard]] Work work(const PairStep& step) const;
  /// Report at an instant: force [N] and moment [N m] on b at its point.
  [[nodiscard]] std::vector<double> report(const PairStep& step) const;

 private:
  Vec3 Z_b_;
  Mat3 R_b_;
  Vec3 linear_, quadratic_, turning_, quadratic_turning_;
};

/// Its entry in the list of loads.
[[nodiscard]] LoadKind axis_drag_kind();

}  // namespace polhode
