// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/loads/load_description.hpp>

namespace polhode {

/// A force over a step with its derivative by the coordinate at t_{n+1}.
struct LawValue {
  double value = 0.0;
  double slope = 0.0;
};

/// A force f(x) with a potential: k x + k₂ |x| x, K/x², plus a table or an expression, or the
/// derivative of a given potential; on both sides of x = 0 or on one only.
///
/// Over a step it is the mean of f from x_{n+1} − 2(1 − αf) Δx to x_{n+1}: at ρ∞ = 1 the force
/// times Δx is the change of the potential, and at αf = 1 it is f(x_{n+1}). @eq{law-mean}
class ForceLaw {
 public:
  enum class Acts { both, tension, compression };

  ForceLaw() = default;
  /// @param load  Values stiffness, quadratic and inverse_square, a law of this name or the law
  /// `energy` for the potential, the word `acts`.
  ForceLaw(const LoadDescription& load, const std::string& law);

  /// Force over a step from x_n to x_n1.
  [[nodiscard]] LawValue over_step(double x_n, double x_n1, double alpha_f) const;
  [[nodiscard]] LawValue at(double x) const;    ///< f(x) and f'(x).
  [[nodiscard]] double energy(double x) const;  ///< ∫ f from 0 to x.
  [[nodiscard]] bool is_zero() const { return k_ == 0.0 && k_2_ == 0.0 && K_ == 0.0 && !f_; }

 private:
  [[nodiscard]] bool acts_on(double x) const {
    return acts_ == Acts::both || (acts_ == Acts::tension) == (x > 0.0);
  }
  [[nodiscard]] double mean(double p, double q) const;
  [[nodiscard]] double mean_on_one_side(double p, double q) const;

  double k_ = 0.0, k_2_ = 0.0, K_ = 0.0;
  TimeFunctionPtr f_;
  TimeFunctionPtr V_;  ///< Potential of f_ if that is given, else null.
  Acts acts_ = Acts::both;
};

/// A resistance c v plus a table or an expression of v, which must oppose v.
class ResistanceLaw {
 public:
  ResistanceLaw() = default;
  /// @param load  Value damping, and a law of this name.
  ResistanceLaw(const LoadDescription& load, const std::string& law)
      : c_(load.value("damping", 0.0)), f_(load.law(law)) {}

  [[nodiscard]] LawValue at(double v) const;
  [[nodiscard]] bool is_zero() const { return c_ == 0.0 && !f_; }

 private:
  double c_ = 0.0;
  TimeFunctionPtr f_;
};

/// Mean of a function over [p, q] to round-off: Gauss's rule between the kinks reported by the
/// function, on intervals that are halved.
[[nodiscard]] double mean_value(const TimeFunction& f, double p, double q);

}  // namespace polhode
