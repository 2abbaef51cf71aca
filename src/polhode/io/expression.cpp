// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <polhode/io/expression_ops.hpp>

namespace polhode {

double Expression::operator()(double t) const {
  using Op = ExpressionOp;
  std::array<double, kStackSize + 1> stack;
  std::size_t n = 0;  // Values on the stack.
  const auto unary = [&](double value) { stack[n - 1] = value; };
  const auto binary = [&](double value) { stack[--n - 1] = value; };
  for (const Instruction& i : program_) {
    const double x = n > 0 ? stack[n - 1] : 0.0;
    const double y = n > 1 ? stack[n - 2] : 0.0;  // y op x
    switch (i.op) {
      case Op::kPush:
        stack[n++] = i.value;
        break;
      case Op::kTime:
        stack[n++] = t * i.value;
        break;
      case Op::kScale:
        unary(x * i.value);
        break;
      case Op::kAdd:
        binary(y + x);
        break;
      case Op::kSubtract:
        binary(y - x);
        break;
      case Op::kMultiply:
        binary(y * x);
        break;
      case Op::kDivide:
        binary(y / x);
        break;
      case Op::kPower:
        binary(std::pow(y, x));
        break;
      case Op::kNegate:
        unary(-x);
        break;
      case Op::kLess:
        binary(y < x ? 1.0 : 0.0);
        break;
      case Op::kLessEqual:
        binary(y <= x ? 1.0 : 0.0);
        break;
      case Op::kGreater:
        binary(y > x ? 1.0 : 0.0);
        break;
      case Op::kGreaterEqual:
        binary(y >= x ? 1.0 : 0.0);
        break;
      case Op::kEqual:
        binary(y == x ? 1.0 : 0.0);
        break;
      case Op::kNotEqual:
        binary(y != x ? 1.0 : 0.0);
        break;
      case Op::kAnd:
        binary(y != 0.0 && x != 0.0 ? 1.0 : 0.0);
        break;
      case Op::kOr:
        binary(y != 0.0 || x != 0.0 ? 1.0 : 0.0);
        break;
      case Op::kNot:
        unary(x == 0.0 ? 1.0 : 0.0);
        break;
      case Op::kChoose:
        n -= 2;
        stack[n - 1] = stack[n - 1] != 0.0 ? stack[n] : stack[n + 1];
        break;
      case Op::kSin:
        unary(std::sin(x));
        break;
      case Op::kCos:
        unary(std::cos(x));
        break;
      case Op::kTan:
        unary(std::tan(x));
        break;
      case Op::kAsin:
        unary(std::asin(x));
        break;
      case Op::kAcos:
        unary(std::acos(x));
        break;
      case Op::kAtan:
        unary(std::atan(x));
        break;
      case Op::kAtan2:
        binary(std::atan2(y, x));
        break;
      case Op::kSinh:
        unary(std::sinh(x));
        break;
      case Op::kCosh:
        unary(std::cosh(x));
        break;
      case Op::kTanh:
        unary(std::tanh(x));
        break;
      case Op::kExp:
        unary(std::exp(x));
        break;
      case Op::kLog:
        unary(std::log(x));
        break;
      case Op::kLog10:
        unary(std::log10(x));
        break;
      case Op::kSqrt:
        unary(std::sqrt(x));
        break;
      case Op::kAbs:
        unary(std::abs(x));
        break;
      case Op::kSign:
        unary(x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : 0.0);
        break;
      case Op::kFloor:
        unary(std::floor(x));
        break;
      case Op::kMin:
        binary(std::min(y, x));
        break;
      case Op::kMax:
        binary(std::max(y, x));
        break;
    }
  }
  return stack[0];
}

void Expression::fold_constants() {
  struct Value {
    std::size_t start;
    bool constant;
  };
  std::vector<Value> values;
  Expression folded;
  std::vector<Instruction>& program = folded.program_;
  for (const Instruction& i : program_) {
    const auto taken = static_cast<std::ptrdiff_t>(operands(i.op));
    Value result{program.size(), i.op != ExpressionOp::kTime};
    for (auto v = values.end() - taken; v != values.end(); ++v) {
      result.start = std::min(result.start, v->start);
      result.constant = result.constant && v->constant;
    }
    values.erase(values.end() - taken, values.end());
    program.push_back(i);
    if (result.constant && taken > 0) {
      Expression part;
      const auto from = program.begin() + static_cast<std::ptrdiff_t>(result.start);
      part.program_.assign(from, program.end());
      program.erase(from, program.end());
      program.push_back({ExpressionOp::kPush, part(0.0)});
    }
    values.push_back(result);
  }
  program_ = std::move(program);
}

std::optional<double> Expression::factor_to_si(const Dimension& wanted,
                                               const UnitSystem& units) const {
  if (type_.certainty == Certainty::kKnown) {
    // An angle is not a plain number, but 1/s is as good as rad/s.
    const bool stray_angle = wanted.is_none() && std::abs(type_.dimension.angle) > 1e-9;
    if (!type_.dimension.matches(wanted) || stray_angle) return std::nullopt;
    return 1.0;
  }
  const bool with_angle = std::abs(type_.dimension.angle) < 1e-9;
  return with_angle ? units.factor(wanted) : units.factor_without_angle(wanted);
}

}  // namespace polhode
