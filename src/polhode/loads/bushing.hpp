// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <polhode/loads/coordinate_motion.hpp>
#include <polhode/loads/force_law.hpp>

namespace polhode {

/// An elastic bushing between a frame on a and one on b: y = (d, c), the displacement of b's point
/// along a's axes and the Cayley vector of the relative rotation, 2 tan(θ/2) about its axis.
///
/// The generalised force is K ȳ + C ẏ, plus laws of single components, by the discrete gradient of
/// y: c is a quotient N/D of quadratic functions, so that D̄ Δc = ΔN − c̄ ΔD without error, and the
/// potential ½ yᵀK y is exactly conserved at ρ∞ = 1. @eq{bushing-cayley}
class Bushing : public InteractionItem {
 public:
  static constexpr const char* kKind = "bushing";
  /// @param load  Frames; matrices stiffness_matrix and damping_matrix, or the values of their
  /// diagonals; laws of the components.
  explicit Bushing(const LoadDescription& load);

  [[nodiscard]] bool conservative() const { return C_.isZero(0.0); }
  [[nodiscard]] bool dissipates() const { return !C_.isZero(0.0); }
  [[nodiscard]] bool piecewise() const;
  void pieces(const PairStep& step, ForcePieces& pieces) const;
  void evaluate(const PairStep& step, PairTerms& terms) const;
  [[nodiscard]] Work work(const PairStep& step) const;
  /// Report at an instant: force [N] and moment [N m] on b, at its point; displacement [m] and
  /// rotation [-] along a's axes; energy stored [J].
  [[nodiscard]] std::vector<double> report(const PairStep& step) const;

 private:
  using Coordinates = std::array<CoordinateMotion, 6>;
  [[nodiscard]] Coordinates coordinates(const PairStep& step) const;
  [[nodiscard]] double energy(const Vec6& y) const;

  Vec3 Z_a_, Z_b_;
  Mat3 R_a_, R_b_;
  Mat6 K_, C_;
  std::array<ForceLaw, 6> law_;
};

/// Adds a Bushing to the system.
void add_bushing(System& system, const LoadDescription& load);

}  // namespace polhode
