// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/core/types.hpp>

namespace polhode {

/// Friction of a cable on the points that it runs over, with a bristle at each. The segments have
/// tensions beyond the cable's mean tension N̄, parts p_k with Σ p_k/k_k = 0, until the tensions on
/// both sides of a point are in the ratio e^{μβ} (capstan equation of Euler and Eytelwein). Then
/// the cable slips there by q_j, from segment to segment: N_j += k_j q_j, N_{j+1} −= k_{j+1} q_j.
/// @eq{cable-capstan}
///
/// Over a step N = Π(N̄ + p_n + φ Δ), p_{n+1} = Π'(p_n + Δ) with Δ_k = k_k (Δl_k − w_k ΔL), as for
/// the bristle of contact. Π' uses the differences of tension found by Π, so that the dissipation
/// is never negative.
class CableFriction {
 public:
  /// @param stiffness  k_k of the segments [N/m].
  explicit CableFriction(std::vector<double> stiffness);

  /// Tensions with friction, and their derivatives by the trial.
  struct Held {
    Vec tension;   ///< Of the segments [N].
    Mat by_trial;  ///< By the trial tensions [-].
    Mat by_ratio;  ///< By ln(ratio) of each point [N].
    bool slips = false;
  };
  /// @param trial  Tensions without slip [N].
  /// @param ratio  Smaller over larger tension at which each point slips, e^{−μβ} [-].
  [[nodiscard]] Held hold(const Vec& trial, const Vec& ratio) const;
  /// Tensions if slip occurs at this difference of the tensions of both sides [N].
  [[nodiscard]] Vec hold_differences(const Vec& trial, const Vec& most) const;

  /// Tensions without slip in addition to the mean one: k_k (Δl_k − w_k ΔL), as a matrix on Δl
  /// [N/m].
  [[nodiscard]] const Mat& stretch() const { return stretch_; }
  /// Energy of the bristles [J]. @param parts  p_k [N].
  [[nodiscard]] double energy(const Vec& parts) const;

 private:
  /// Slip where a·N_larger − N_smaller > b: q and the direction of each point, 0: it sticks.
  struct Slip {
    Vec q;
    std::vector<int> sign;
  };
  [[nodiscard]] Slip search(Vec N, const Vec& a, const Vec& b) const;
  /// Change of the tensions by the slip of a point.
  [[nodiscard]] Vec by_slip(Eigen::Index point) const;

  Vec k_;
  Mat stretch_;
};

}  // namespace polhode
