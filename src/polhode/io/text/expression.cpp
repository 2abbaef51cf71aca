// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <polhode/core/time_jet.hpp>
#include <polhode/io/text/expression_ops.hpp>

namespace polhode::io {

namespace {

/// Part of the way from one value to another, held at 0 before and at 1 after.
template <class Number>
Number part_of_way(const Number& x, const Number& from, const Number& to) {
  using std::max, std::min;
  return max(Number(0.0), min(Number(1.0), (x - from) / (to - from)));
}

}  // namespace

template <class Number>
Number Expression::evaluate(const Number& t) const {
  using Op = ExpressionOp;
  using std::abs, std::acos, std::asin, std::atan, std::atan2, std::cos, std::cosh, std::exp,
      std::floor, std::log, std::log10, std::max, std::min, std::pow, std::sin, std::sinh,
      std::sqrt, std::tan, std::tanh;
  const Number zero = 0.0;
  std::array<Number, kStackSize + 1> stack;
  std::size_t n = 0;  // Values on the stack.
  const auto unary = [&](const Number& value) { stack[n - 1] = value; };
  const auto binary = [&](const Number& value) { stack[--n - 1] = value; };
  const auto ternary = [&](const Number& value) { stack[(n -= 2) - 1] = value; };
  for (const Instruction& i : program_) {
    const Number x = n > 0 ? stack[n - 1] : zero;
    const Number y = n > 1 ? stack[n - 2] : zero;  // y op x
    const Number first = n > 2 ? stack[n - 3] : zero;
    switch (i.op) {
      case Op::kPush:
        stack[n++] = i.value;
        break;
      case Op::kTime:
        stack[n++] = t * i.value;
        break;
      case Op::kScale:
        unary(x * Number(i.value));
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
        binary(pow(y, x));
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
        binary(y != zero && x != zero ? 1.0 : 0.0);
        break;
      case Op::kOr:
        binary(y != zero || x != zero ? 1.0 : 0.0);
        break;
      case Op::kNot:
        unary(x == zero ? 1.0 : 0.0);
        break;
      case Op::kChoose:
        n -= 2;
        stack[n - 1] = stack[n - 1] != zero ? stack[n] : stack[n + 1];
        break;
      case Op::kSin:
        unary(sin(x));
        break;
      case Op::kCos:
        unary(cos(x));
        break;
      case Op::kTan:
        unary(tan(x));
        break;
      case Op::kAsin:
        unary(asin(x));
        break;
      case Op::kAcos:
        unary(acos(x));
        break;
      case Op::kAtan:
        unary(atan(x));
        break;
      case Op::kAtan2:
        binary(atan2(y, x));
        break;
      case Op::kSinh:
        unary(sinh(x));
        break;
      case Op::kCosh:
        unary(cosh(x));
        break;
      case Op::kTanh:
        unary(tanh(x));
        break;
      case Op::kExp:
        unary(exp(x));
        break;
      case Op::kLog:
        unary(log(x));
        break;
      case Op::kLog10:
        unary(log10(x));
        break;
      case Op::kSqrt:
        unary(sqrt(x));
        break;
      case Op::kAbs:
        unary(abs(x));
        break;
      case Op::kSign:
        unary(x > zero ? 1.0 : x < zero ? -1.0 : 0.0);
        break;
      case Op::kFloor:
        unary(floor(x));
        break;
      case Op::kMin:
        binary(min(y, x));
        break;
      case Op::kMax:
        binary(max(y, x));
        break;
      case Op::kMod:
        binary(y - x * floor(y / x));
        break;
      case Op::kStep:
        binary(y >= x ? 1.0 : 0.0);
        break;
      case Op::kPulse:
        ternary(first >= y && first < x ? 1.0 : 0.0);
        break;
      case Op::kRamp:
        ternary(part_of_way(first, y, x));
        break;
      case Op::kSmoothstep: {
        const Number s = part_of_way(first, y, x);
        ternary(s * s * (Number(3.0) - Number(2.0) * s));
        break;
      }
    }
  }
  return stack[0];
}

double Expression::operator()(double t) const { return evaluate(t); }

TimeRates Expression::rates(double t, TimeSide side) const {
  const double near = beside(t, side);
  const TimeJet jet = evaluate(TimeJet{near, 1.0, 0.0});
  return TimeRates{jet.value, jet.rate, jet.second}.moved(t - near);
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
    // An angle is not a plain number, but 1/s is accepted for rad/s.
    const bool stray_angle = wanted.is_none() && std::abs(type_.dimension.angle) > 1e-9;
    if (!type_.dimension.matches(wanted) || stray_angle) return std::nullopt;
    return 1.0;
  }
  const bool with_angle = std::abs(type_.dimension.angle) < 1e-9;
  return with_angle ? units.factor(wanted) : units.factor_without_angle(wanted);
}

std::shared_ptr<const Expression> Expression::parse(std::string_view text,
                                                    const Variables& variables,
                                                    const UnitSystem& units, bool allow_time,
                                                    ExpressionFault& fault) {
  return parse(text, variables, units, allow_time ? "t" : "", units.time, fault);
}

std::vector<std::string> reserved_names() {
  std::vector<std::string> names = {"t", "pi"};
  for (const auto& f : kExpressionFunctions)
    if (f.reserved) names.emplace_back(f.name);
  return names;
}

}  // namespace polhode::io
