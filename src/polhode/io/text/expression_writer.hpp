// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <polhode/io/text/expression_ops.hpp>

namespace polhode::io {

/// The program of an expression while it is read, with the dimensions of its parts.
class ExpressionWriter {
 protected:
  using Op = ExpressionOp;

  ExpressionWriter(std::string_view text, const UnitSystem& units) : text_(text), units_(units) {}

  /// Type of a part of the expression, and the start of its program.
  struct Part {
    Quantity type;           ///< The value is not used.
    std::size_t start = 0;   ///< First instruction.
    std::size_t offset = 0;  ///< First byte.
  };

  /// @throws ExpressionFault
  [[noreturn]] static void stop(std::size_t offset, std::size_t length, std::string what,
                                std::string hint) {
    throw ExpressionFault{offset, length, std::move(what), std::move(hint)};
  }

  /// Quantity of a dimension in SI; a plain number without one.
  static Quantity known(const Dimension& d);
  static bool is_known(const Part& p) { return p.type.certainty == Certainty::kKnown; }
  /// Converts two parts that are added or compared to one dimension.
  Quantity unify(Part& a, Part& b, const std::string& where);
  /// Converts a number in the user's base units to SI.
  void adopt(const Part& part, const Dimension& d, std::optional<std::size_t> end = {});
  /// Type of the product, or of the quotient for sign = -1.
  Quantity multiply(Part& a, Part& b, double sign);
  /// Writes a power.
  Part raise(const Part& base, const Part& exponent);
  /// Value of a part of the program, if it does not depend on t. @param end  The instruction
  /// after it; none: the end of the program.
  [[nodiscard]] std::optional<double> constant_value(std::size_t start,
                                                     std::optional<std::size_t> end = {}) const;
  /// Converts a value and the ends of a span to one dimension. @throws ExpressionFault also if
  /// constant ends are not in order
  void place_in_span(const NamedFunction& f, Part& x, Part& from, Part& to);
  /// Type of a function's value, with its arguments converted to one dimension where they must be.
  Quantity result_type(const NamedFunction& f, Part& a, Part& b);
  /// Writes an instruction that adds a value to the stack. @throws ExpressionFault if it is full
  void push(Expression::Instruction instruction);
  /// Writes an operation on that many values.
  void emit(Op op, int arguments);
  /// Inserts a factor at a position of the program.
  void scale(std::size_t position, double factor);

  std::string_view text_;  ///< Of the expression.
  const UnitSystem& units_;
  std::size_t at_ = 0;  ///< Position of reading [bytes].
  int height_ = 0;      ///< Of the stack of values.
  Expression result_;
};

}  // namespace polhode::io
