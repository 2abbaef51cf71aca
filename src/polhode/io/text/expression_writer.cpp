// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/text/expression_writer.hpp>

#include <cmath>

#include <polhode/core/format.hpp>

namespace polhode::io {

namespace {

constexpr double kMostExponent = 99.0;

}  // namespace

Quantity ExpressionWriter::known(const Dimension& d) {
  if (d.is_none()) return {};
  return {0.0, Certainty::kKnown, d};
}

Quantity ExpressionWriter::unify(Part& a, Part& b, const std::string& where) {
  if (is_known(a) && is_known(b)) {
    if (!a.type.dimension.matches(b.type.dimension))
      stop(a.offset, at_ - a.offset,
           format("{} joins {} and {}", where, a.type.dimension.name(), b.type.dimension.name()),
           "Both must have the same dimension.");
    return a.type;
  }
  if (is_known(a)) {
    adopt(b, a.type.dimension);
    return a.type;
  }
  if (is_known(b)) {
    const std::size_t before = result_.program_.size();
    adopt(a, b.type.dimension, b.start);
    b.start += result_.program_.size() - before;
    return b.type;
  }
  if (a.type.certainty == Certainty::kPure) return b.type;
  return a.type;
}

void ExpressionWriter::adopt(const Part& part, const Dimension& d, std::optional<std::size_t> end) {
  const bool with_angle = std::abs(part.type.dimension.angle) < 1e-9;
  scale(end.value_or(result_.program_.size()),
        with_angle ? units_.factor(d) : units_.factor_without_angle(d));
}

Quantity ExpressionWriter::multiply(Part& a, Part& b, double sign) {
  const Dimension d = a.type.dimension + sign * b.type.dimension;
  const bool bare = a.type.certainty == Certainty::kBare || b.type.certainty == Certainty::kBare;
  if (!bare) return is_known(a) || is_known(b) ? known(d) : Quantity{};
  // A product with a variable of any dimension has any; all numbers are in the user's base units.
  if (is_known(a)) {
    const std::size_t before = result_.program_.size();
    scale(b.start, 1.0 / units_.factor_without_angle(a.type.dimension));
    b.start += result_.program_.size() - before;
  }
  if (is_known(b))
    scale(result_.program_.size(), 1.0 / units_.factor_without_angle(b.type.dimension));
  return {0.0, Certainty::kBare, {0, 0, 0, d.angle}};
}

ExpressionWriter::Part ExpressionWriter::raise(const Part& base, const Part& exponent) {
  if (is_known(exponent))
    stop(exponent.offset, at_ - exponent.offset,
         "the exponent is " + exponent.type.dimension.name(), "It must be a plain number.");
  Quantity type = base.type;
  if (base.type.certainty != Certainty::kPure) {
    std::optional<double> n = constant_value(exponent.start);
    if (n && !(std::abs(*n) <= kMostExponent)) n.reset();
    if (!n && is_known(base))
      stop(exponent.offset, at_ - exponent.offset,
           "the exponent of " + base.type.dimension.name() + " depends on time",
           "It must be constant.");
    if (n) type.dimension = *n * type.dimension;
    if (is_known(base)) type = known(type.dimension);
  }
  emit(Op::kPower, 2);
  return {type, base.start, base.offset};
}

std::optional<double> ExpressionWriter::constant_value(std::size_t start,
                                                       std::optional<std::size_t> end) const {
  Expression part;
  const auto first = result_.program_.begin();
  part.program_.assign(first + static_cast<std::ptrdiff_t>(start),
                       first + static_cast<std::ptrdiff_t>(end.value_or(result_.program_.size())));
  for (const auto& instruction : part.program_)
    if (instruction.op == Op::kTime) return std::nullopt;
  return part(0.0);
}

void ExpressionWriter::place_in_span(const NamedFunction& f, Part& x, Part& from, Part& to) {
  from.type = to.type = unify(from, to, format("{}()", f.name));
  if (is_known(x) && !is_known(to)) {
    adopt(to, x.type.dimension);
    const std::size_t before = result_.program_.size();
    adopt(from, x.type.dimension, to.start);
    to.start += result_.program_.size() - before;
    from.type = to.type = x.type;
  }
  const auto a = constant_value(from.start, to.start), b = constant_value(to.start);
  if (a && b && !(*a < *b))
    stop(from.offset, at_ - from.offset, format("{}() ends before it begins", f.name),
         "Write the start of the span before its end.");
}

Quantity ExpressionWriter::result_type(const NamedFunction& f, Part& a, Part& b) {
  const auto want_number = [&](const char* wanted) {
    if (is_known(a) && !a.type.dimension.matches({}))
      stop(a.offset, at_ - a.offset, format("{}() is given {}", f.name, a.type.dimension.name()),
           format("It needs {}.", wanted));
  };
  switch (f.rule) {
    case FunctionRule::kAngleToNumber:
      want_number("an angle; bare numbers are radians");
      return {};
    case FunctionRule::kNumberToAngle:
      want_number("a plain number");
      return known(dimensions::kAngle);
    case FunctionRule::kNumber:
      want_number("a plain number");
      return {};
    case FunctionRule::kQuotientToAngle:
      unify(a, b, "atan2()");
      return known(dimensions::kAngle);
    case FunctionRule::kKeepTwo:
      return unify(a, b, format("{}()", f.name));
    case FunctionRule::kPlace:
      unify(a, b, format("{}()", f.name));
      return {};
    case FunctionRule::kToNumber:
      return {};
    case FunctionRule::kRoot: {
      Quantity type = a.type;
      type.dimension = 0.5 * type.dimension;
      return type;
    }
    case FunctionRule::kKeep:
    case FunctionRule::kPower:
      break;
  }
  return a.type;
}

void ExpressionWriter::push(Expression::Instruction instruction) {
  result_.program_.push_back(instruction);
  if (++height_ > kStackSize)
    stop(0, text_.size(), "the expression is too deeply nested", "Use variables for its parts.");
}

void ExpressionWriter::emit(Op op, int arguments) {
  result_.program_.push_back({op});
  height_ -= arguments - 1;
}

void ExpressionWriter::scale(std::size_t position, double factor) {
  if (factor == 1.0) return;
  result_.program_.insert(result_.program_.begin() + static_cast<std::ptrdiff_t>(position),
                          {Op::kScale, factor});
}

}  // namespace polhode::io
