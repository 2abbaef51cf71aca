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

namespace polhode {

/// A step of an expression's program.
enum class ExpressionOp : unsigned char;

/// What is known of the dimension of a value in an expression.
enum class Certainty : unsigned char {
  kPure,   ///< A number; where a dimension is wanted it counts in the user's base units.
  kBare,   ///< From a variable without a unit: any dimension, counted in the user's base units.
  kKnown,  ///< In SI, of a known dimension.
};

/// A value with what is known of its dimension.
struct Quantity {
  double value = 0.0;
  Certainty certainty = Certainty::kPure;
  Dimension dimension;  ///< kBare: only the angle, as far as quantities with units brought it in.
};

/// Variables by name.
using Variables = std::map<std::string, Quantity, std::less<>>;

/// A fault in an expression.
struct ExpressionFault {
  std::size_t offset = 0, length = 0;  ///< In the text [bytes].
  std::string what, hint;
};

/// A checked expression of time, ready to be evaluated by any number of threads.
///
/// Operators  + - * / ^  ( )  < <= > >= == !=  && ||  c ? a : b;  constant pi;  functions sin cos
/// tan asin acos atan atan2 sinh cosh tanh exp log log10 sqrt abs sign floor min max pow. A unit
/// may follow after a blank: "2*pi rad/s". Dimensions of variables with units are followed through.
class Expression {
 public:
  /// @param allow_time  Whether t [s] may stand in it.
  /// @returns an empty pointer and the fault, or the expression.
  static std::shared_ptr<const Expression> parse(std::string_view text, const Variables& variables,
                                                 const UnitSystem& units, bool allow_time,
                                                 ExpressionFault& fault);

  /// The same of another variable than t, such as an elongation x.
  /// @param variable  Its name; it hides a variable of the user's of this name.
  /// @param in_units  Size of the user's base unit of it, SI.
  static std::shared_ptr<const Expression> parse(std::string_view text, const Variables& variables,
                                                 const UnitSystem& units, std::string_view variable,
                                                 double in_units, ExpressionFault& fault);

  /// The value at time t [s], in SI or the user's base units as certainty() says.
  [[nodiscard]] double operator()(double t) const;
  /// The value and its derivatives by time on one side of t: exact ones, by automatic
  /// differentiation. Conditions are those of that side.
  [[nodiscard]] TimeRates rates(double t, TimeSide side) const;
  [[nodiscard]] bool depends_on_time() const { return depends_on_time_; }
  /// The next time at which a condition, abs, sign, floor, min, max or atan2 goes over from one
  /// branch to another, as TimeFunction::next_break: found by interval arithmetic, so that none is
  /// missed, however short. Points at which two parts touch without one taking over are none.
  [[nodiscard]] TimeBreak next_break(double t, double until) const;
  /// As TimeFunction::bounds, by interval arithmetic on value, slope and second derivative; not
  /// finite where an operation in [from, to] is not.
  [[nodiscard]] TimeBounds bounds(double from, double to) const;
  [[nodiscard]] Certainty certainty() const { return type_.certainty; }
  [[nodiscard]] const Dimension& dimension() const { return type_.dimension; }
  /// The unit that was written with a number or behind an expression, if any.
  [[nodiscard]] const std::optional<Unit>& written_unit() const { return unit_; }

  /// Factor from the expression's value to SI if it is taken as a value of this dimension; nothing
  /// if its dimension is another.
  [[nodiscard]] std::optional<double> factor_to_si(const Dimension& wanted,
                                                   const UnitSystem& units) const;

 private:
  friend class ExpressionParser;
  struct Instruction {
    ExpressionOp op;
    double value = 0.0;
  };
  template <class Number>
  [[nodiscard]] Number evaluate(const Number& t) const;

  /// Replaces parts without t by their values.
  void fold_constants();

  std::vector<Instruction> program_;
  Quantity type_;
  std::optional<Unit> unit_;
  bool depends_on_time_ = false;
};

/// Names that a variable cannot have: t, pi and the functions.
[[nodiscard]] std::vector<std::string> reserved_names();

}  // namespace polhode
