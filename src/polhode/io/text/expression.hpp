// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <polhode/core/time_function.hpp>
#include <polhode/io/text/units.hpp>
#include <polhode/model/model.hpp>

namespace polhode::io {

/// A step of an expression's program.
enum class ExpressionOp : unsigned char;

/// Knowledge of the dimension of a value in an expression.
enum class Certainty : unsigned char {
  kPure,   ///< A number; if a dimension is needed it is in the user's base units.
  kBare,   ///< From a variable without a unit: any dimension, in the user's base units.
  kKnown,  ///< In SI, of a known dimension.
};

/// A value with the knowledge of its dimension.
struct Quantity {
  double value = 0.0;
  Certainty certainty = Certainty::kPure;
  Dimension dimension;  ///< kBare: only the angle, as far as known from quantities with units.
};

/// Variables by name.
using Variables = std::map<std::string, Quantity, std::less<>>;

/// An error in an expression.
struct ExpressionFault {
  std::size_t offset = 0, length = 0;  ///< In the text [bytes].
  std::string what, hint;
};

/// A checked expression of time, ready to be evaluated by any number of threads.
///
/// Operators  + - * / ^  ( )  < <= > >= == !=  && ||  c ? a : b;  constant pi;  functions sin cos
/// tan asin acos atan atan2 sinh cosh tanh exp log log10 sqrt abs sign floor min max pow mod step
/// pulse ramp smoothstep. A unit may follow after a blank: "2*pi rad/s". Dimensions of variables
/// with units are checked.
class Expression {
 public:
  /// @param allow_time  Whether t [s] is allowed.
  /// @returns an empty pointer and the error, or the expression.
  static std::shared_ptr<const Expression> parse(std::string_view text, const Variables& variables,
                                                 const UnitSystem& units, bool allow_time,
                                                 ExpressionFault& fault);

  /// Parses an expression of a variable other than t, such as an elongation x.
  /// @param variable  Its name; it hides a user's variable of this name.
  /// @param in_units  Size of the user's base unit of it, SI.
  static std::shared_ptr<const Expression> parse(std::string_view text, const Variables& variables,
                                                 const UnitSystem& units, std::string_view variable,
                                                 double in_units, ExpressionFault& fault);

  /// The value at time t [s], in SI or the user's base units as certainty() says.
  [[nodiscard]] double operator()(double t) const;
  /// Value and its time derivatives on one side of t: exact, by automatic differentiation.
  /// Conditions are evaluated on that side.
  [[nodiscard]] TimeRates rates(double t, TimeSide side) const;
  [[nodiscard]] bool depends_on_time() const { return depends_on_time_; }
  /// Next time at which a condition or a function with branches (abs, floor) changes its branch, as
  /// TimeFunction::next_break: by interval arithmetic, so that none is missed, however short.
  /// Points at which two branches touch without a change do not count.
  [[nodiscard]] TimeBreak next_break(double t, double until) const;
  /// Bounds as TimeFunction::bounds, by interval arithmetic on value, slope and second derivative;
  /// not finite where an operation in [from, to] is not.
  [[nodiscard]] TimeBounds bounds(double from, double to) const;
  [[nodiscard]] Certainty certainty() const { return type_.certainty; }
  [[nodiscard]] const Dimension& dimension() const { return type_.dimension; }
  /// Unit written with a number or after an expression, if any.
  [[nodiscard]] const std::optional<Unit>& written_unit() const { return unit_; }

  /// Factor from the expression's value to SI if it is interpreted with this dimension; nothing if
  /// its dimension is different.
  [[nodiscard]] std::optional<double> factor_to_si(const Dimension& wanted,
                                                   const UnitSystem& units) const;

 private:
  friend class ExpressionParser;
  friend class ExpressionWriter;
  struct Instruction {
    ExpressionOp op;
    double value = 0.0;
  };
  template <class Number>
  [[nodiscard]] Number evaluate(const Number& t) const;

  /// Replaces subexpressions without t by their values.
  void fold_constants();

  std::vector<Instruction> program_;
  Quantity type_;
  std::optional<Unit> unit_;
  bool depends_on_time_ = false;
};

/// Reserved names: t, pi and those functions whose names no variable may have.
[[nodiscard]] std::vector<std::string> reserved_names();

}  // namespace polhode::io
