// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <polhode/io/text/expression.hpp>

namespace polhode::io {

/// Operations of an expression's program on the stack of values.
enum class ExpressionOp : unsigned char {
  kPush,
  kTime,
  kScale,
  kAdd,
  kSubtract,
  kMultiply,
  kDivide,
  kPower,
  kNegate,
  kLess,
  kLessEqual,
  kGreater,
  kGreaterEqual,
  kEqual,
  kNotEqual,
  kAnd,
  kOr,
  kNot,
  kChoose,
  kSin,
  kCos,
  kTan,
  kAsin,
  kAcos,
  kAtan,
  kAtan2,
  kSinh,
  kCosh,
  kTanh,
  kExp,
  kLog,
  kLog10,
  kSqrt,
  kAbs,
  kSign,
  kFloor,
  kMin,
  kMax,
  kMod,
  kStep,
  kPulse,
  kRamp,
  kSmoothstep,
};

/// Dimension rules of functions.
enum class FunctionRule : unsigned char {
  kAngleToNumber,
  kNumberToAngle,
  kNumber,
  kRoot,
  kKeep,
  kKeepTwo,
  kQuotientToAngle,
  kToNumber,
  kPlace,  ///< Of a value among others of its dimension, a plain number.
  kPower
};

/// A function by name.
struct NamedFunction {
  const char* name;
  ExpressionOp op;
  int arguments;
  FunctionRule rule;
  bool reserved = true;  ///< Otherwise a variable may have the name too, which no bracket follows.
};
inline constexpr std::array kExpressionFunctions = {
    NamedFunction{"sin", ExpressionOp::kSin, 1, FunctionRule::kAngleToNumber},
    NamedFunction{"cos", ExpressionOp::kCos, 1, FunctionRule::kAngleToNumber},
    NamedFunction{"tan", ExpressionOp::kTan, 1, FunctionRule::kAngleToNumber},
    NamedFunction{"asin", ExpressionOp::kAsin, 1, FunctionRule::kNumberToAngle},
    NamedFunction{"acos", ExpressionOp::kAcos, 1, FunctionRule::kNumberToAngle},
    NamedFunction{"atan", ExpressionOp::kAtan, 1, FunctionRule::kNumberToAngle},
    NamedFunction{"atan2", ExpressionOp::kAtan2, 2, FunctionRule::kQuotientToAngle},
    NamedFunction{"sinh", ExpressionOp::kSinh, 1, FunctionRule::kNumber},
    NamedFunction{"cosh", ExpressionOp::kCosh, 1, FunctionRule::kNumber},
    NamedFunction{"tanh", ExpressionOp::kTanh, 1, FunctionRule::kNumber},
    NamedFunction{"exp", ExpressionOp::kExp, 1, FunctionRule::kNumber},
    NamedFunction{"log", ExpressionOp::kLog, 1, FunctionRule::kNumber},
    NamedFunction{"log10", ExpressionOp::kLog10, 1, FunctionRule::kNumber},
    NamedFunction{"sqrt", ExpressionOp::kSqrt, 1, FunctionRule::kRoot},
    NamedFunction{"abs", ExpressionOp::kAbs, 1, FunctionRule::kKeep},
    NamedFunction{"sign", ExpressionOp::kSign, 1, FunctionRule::kToNumber},
    NamedFunction{"floor", ExpressionOp::kFloor, 1, FunctionRule::kNumber},
    NamedFunction{"min", ExpressionOp::kMin, 2, FunctionRule::kKeepTwo},
    NamedFunction{"max", ExpressionOp::kMax, 2, FunctionRule::kKeepTwo},
    NamedFunction{"mod", ExpressionOp::kMod, 2, FunctionRule::kKeepTwo, false},
    NamedFunction{"step", ExpressionOp::kStep, 2, FunctionRule::kPlace, false},
    NamedFunction{"pulse", ExpressionOp::kPulse, 3, FunctionRule::kPlace, false},
    NamedFunction{"ramp", ExpressionOp::kRamp, 3, FunctionRule::kPlace, false},
    NamedFunction{"smoothstep", ExpressionOp::kSmoothstep, 3, FunctionRule::kPlace, false},
    NamedFunction{"pow", ExpressionOp::kPower, 2, FunctionRule::kPower},
};

/// Number of values that an operation takes from the stack.
[[nodiscard]] constexpr int operands(ExpressionOp op) {
  using Op = ExpressionOp;
  switch (op) {
    case Op::kPush:
    case Op::kTime:
      return 0;
    case Op::kChoose:
    case Op::kPulse:
    case Op::kRamp:
    case Op::kSmoothstep:
      return 3;
    case Op::kAdd:
    case Op::kSubtract:
    case Op::kMultiply:
    case Op::kDivide:
    case Op::kPower:
    case Op::kLess:
    case Op::kLessEqual:
    case Op::kGreater:
    case Op::kGreaterEqual:
    case Op::kEqual:
    case Op::kNotEqual:
    case Op::kAnd:
    case Op::kOr:
    case Op::kAtan2:
    case Op::kMin:
    case Op::kMax:
    case Op::kMod:
    case Op::kStep:
      return 2;
    default:
      return 1;
  }
}

/// Largest size of the stack; the parser rejects expressions that need more.
inline constexpr int kStackSize = 128;

}  // namespace polhode::io
