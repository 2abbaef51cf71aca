// SPDX-License-Identifier: Apache-2.0
// Bounds of an expression over a span of time: interval arithmetic on its value and first two
// derivatives, and on operations with branches.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include <polhode/io/text/expression_ops.hpp>
#include <polhode/math/interval.hpp>

namespace polhode::io {

namespace {

/// Value, slope and second derivative by time.
struct Jet {
  Interval v, d, e;
};

/// Branches taken.
struct Branches {
  bool open = false;           ///< Some operation may take either of two.
  std::vector<double> chosen;  ///< By operation, at the middle of its operands.

  void note(double choice, bool sure) {
    chosen.push_back(choice);
    open = open || !sure;
  }
};

/// Distance from a break, in differences of times that are one, beyond which its branch is unique.
constexpr double kEdges = 4.0;

Interval square(const Interval& x) { return power(x, 2.0); }

/// f(x) by the chain rule.
Jet chain(const Jet& x, const Interval& f, const Interval& f_1, const Interval& f_2) {
  return {f, f_1 * x.d, f_2 * square(x.d) + f_1 * x.e};
}
Jet hull(const Jet& x, const Jet& y) {
  return {polhode::hull(x.v, y.v), polhode::hull(x.d, y.d), polhode::hull(x.e, y.e)};
}
Jet operator-(const Jet& x) { return {-x.v, -x.d, -x.e}; }
Jet operator+(const Jet& x, const Jet& y) { return {x.v + y.v, x.d + y.d, x.e + y.e}; }
Jet operator*(const Jet& x, const Jet& y) {
  return {x.v * y.v, x.d * y.v + x.v * y.d, x.e * y.v + Interval(2.0) * x.d * y.d + x.v * y.e};
}
Jet inverse(const Jet& x) {
  const Interval r = reciprocal(x.v);
  return chain(x, r, -square(r), Interval(2.0) * square(r) * r);
}

Jet to_power(const Jet& y, const Jet& x) {
  if (x.v.is_number() && x.d.size() == 0.0) {
    const double n = x.v.lo;
    return chain(y, power(y.v, n), Interval(n) * power(y.v, n - 1.0),
                 n == 1.0 ? Interval(0.0) : Interval(n) * Interval(n - 1.0) * power(y.v, n - 2.0));
  }
  if (y.v.lo <= 0.0) return {Interval::all(), Interval::all(), Interval::all()};
  const Interval r = reciprocal(y.v);
  const Jet log = chain(y, growing([](double z) { return std::log(z); }, y.v), r, -square(r));
  const Jet z = x * log;
  const Interval e = growing([](double a) { return std::exp(a); }, z.v);
  return chain(z, e, e, e);
}

Jet arctangent(const Jet& y, const Jet& x, Branches& branches) {
  const bool sure = x.v.lo >= 0.0 || y.v.lo >= 0.0 || y.v.hi < 0.0;
  branches.note(x.v.middle() >= 0.0 ? 2.0 : y.v.middle() >= 0.0 ? 1.0 : 0.0, sure);
  Interval value(-std::numbers::pi, std::numbers::pi);
  if (sure && !(x.v.contains(0.0) && y.v.contains(0.0))) {
    const double a = std::atan2(y.v.lo, x.v.lo), b = std::atan2(y.v.lo, x.v.hi),
                 c = std::atan2(y.v.hi, x.v.lo), d = std::atan2(y.v.hi, x.v.hi);
    value = widened(std::min({a, b, c, d}), std::max({a, b, c, d}));
  }
  const Interval per_size = reciprocal(square(x.v) + square(y.v));
  const Interval n = x.v * y.d - y.v * x.d;
  const Interval grows = Interval(2.0) * (x.v * x.d + y.v * y.d);
  return {value, n * per_size, (x.v * y.e - y.v * x.e - n * grows * per_size) * per_size};
}

/// y < x, or y ≤ x.
Interval less(const Jet& y, const Jet& x, bool or_equal, Branches& branches) {
  const bool sure = y.v.hi < x.v.lo || y.v.lo > x.v.hi || (y.v.is_number() && x.v.is_number());
  const double y_0 = y.v.middle(), x_0 = x.v.middle();
  const bool is_less = or_equal ? y_0 <= x_0 : y_0 < x_0;
  branches.note(is_less ? 1.0 : 0.0, sure);
  return sure ? Interval(is_less ? 1.0 : 0.0) : Interval(0.0, 1.0);
}

Interval equal(const Jet& y, const Jet& x) {
  if (y.v.hi < x.v.lo || y.v.lo > x.v.hi) return 0.0;
  if (y.v.is_number() && x.v.is_number()) return 1.0;
  return {0.0, 1.0};
}

/// Truth of a value: true unless it is zero.
Interval truth(const Jet& x) {
  if (!x.v.contains(0.0)) return 1.0;
  return x.v.is_number() ? Interval(0.0) : Interval(0.0, 1.0);
}

Jet lesser(const Jet& y, const Jet& x, Branches& branches) {
  const bool sure = y.v.hi <= x.v.lo || y.v.lo >= x.v.hi;
  const bool first = y.v.middle() < x.v.middle();
  branches.note(first ? 1.0 : 0.0, sure);
  if (sure) return first ? y : x;
  Jet both = hull(y, x);
  both.v.hi = std::min(y.v.hi, x.v.hi);
  return both;
}

Jet absolute(const Jet& x, Branches& branches) {
  const bool sure = x.v.lo >= 0.0 || x.v.hi <= 0.0;
  const bool negative = x.v.middle() < 0.0;
  branches.note(negative ? -1.0 : 1.0, sure);
  if (sure) return negative ? -x : x;
  Jet both = hull(-x, x);
  both.v = magnitude(x.v);
  return both;
}

Jet sign(const Jet& x, Branches& branches) {
  const double m = x.v.middle();
  const double value = m > 0.0 ? 1.0 : m < 0.0 ? -1.0 : 0.0;
  const bool sure = x.v.lo > 0.0 || x.v.hi < 0.0 || x.v.is_number();
  branches.note(value, sure);
  return {sure ? Interval(value) : Interval(-1.0, 1.0), 0.0, 0.0};
}

Jet whole(const Jet& x, Branches& branches) {
  const double lo = std::floor(x.v.lo), hi = std::floor(x.v.hi);
  branches.note(std::floor(x.v.middle()), lo == hi);
  return {{lo, hi}, 0.0, 0.0};
}

/// Functions of one number without branches.
Jet smooth(ExpressionOp op, const Jet& x) {
  using Op = ExpressionOp;
  const Interval& v = x.v;
  const Interval s = square(v);
  switch (op) {
    case Op::kSin:
      return chain(x, sine(v), cosine(v), -sine(v));
    case Op::kCos:
      return chain(x, cosine(v), -sine(v), -cosine(v));
    case Op::kTan: {
      const Interval c = cosine(v);
      if (c.contains(0.0)) return {Interval::all(), Interval::all(), Interval::all()};
      const Interval t = growing([](double a) { return std::tan(a); }, v);
      const Interval f_1 = Interval(1.0) + square(t);
      return chain(x, t, f_1, Interval(2.0) * t * f_1);
    }
    case Op::kAsin:
    case Op::kAcos: {
      const Interval root = power(Interval(1.0) - s, 0.5);
      const Interval f_1 = reciprocal(root);
      const Interval f = growing([](double a) { return std::asin(a); }, v);
      const Jet asin = chain(x, f, f_1, v * f_1 * f_1 * f_1);
      if (op == Op::kAsin) return asin;
      return Jet{0.5 * std::numbers::pi, 0.0, 0.0} + (-asin);
    }
    case Op::kAtan: {
      const Interval f_1 = reciprocal(Interval(1.0) + s);
      return chain(x, growing([](double a) { return std::atan(a); }, v), f_1,
                   Interval(-2.0) * v * square(f_1));
    }
    case Op::kSinh:
    case Op::kCosh: {
      const Interval sinh = growing([](double a) { return std::sinh(a); }, v);
      const Interval cosh = growing([](double a) { return std::cosh(a); }, magnitude(v));
      return op == Op::kSinh ? chain(x, sinh, cosh, sinh) : chain(x, cosh, sinh, cosh);
    }
    case Op::kTanh: {
      const Interval f = growing([](double a) { return std::tanh(a); }, v);
      const Interval f_1 = Interval(1.0) - square(f);
      return chain(x, f, f_1, Interval(-2.0) * f * f_1);
    }
    case Op::kExp: {
      const Interval f = growing([](double a) { return std::exp(a); }, v);
      return chain(x, f, f, f);
    }
    case Op::kLog:
    case Op::kLog10: {
      const double unit = op == Op::kLog ? 1.0 : 1.0 / std::numbers::ln10;
      const Interval r = v.lo > 0.0 ? reciprocal(v) : Interval::all();
      const Interval f =
          v.lo > 0.0 ? growing([](double a) { return std::log(a); }, v) : Interval::all();
      const Jet log = chain(x, f, r, -square(r));
      return Jet{unit, 0.0, 0.0} * log;
    }
    case Op::kSqrt: {
      const Interval f = power(v, 0.5);
      const Interval f_1 = Interval(0.5) * reciprocal(f);
      return chain(x, f, f_1, Interval(-2.0) * f_1 * f_1 * f_1);
    }
    default:
      return {Interval::all(), Interval::all(), Interval::all()};
  }
}

/// Part of the way from one value to another, held at 0 before and at 1 after.
Jet part_of_way(const Jet& x, const Jet& from, const Jet& to, Branches& branches) {
  const Jet part = (x + (-from)) * inverse(to + (-from));
  return -lesser(Jet{0.0, 0.0, 0.0}, -lesser(Jet{1.0, 0.0, 0.0}, part, branches), branches);
}

/// The program over a span of time.
template <class Program>
Jet run(const Program& program, const Interval& t, Branches& branches) {
  using Op = ExpressionOp;
  std::vector<Jet> stack;
  const auto pop = [&] {
    const Jet x = stack.back();
    stack.pop_back();
    return x;
  };
  const auto logical = [](const Interval& v) { return Jet{v, 0.0, 0.0}; };
  for (const auto& i : program) {
    if (i.op == Op::kPush) {
      stack.push_back({i.value, 0.0, 0.0});
      continue;
    }
    if (i.op == Op::kTime) {
      stack.push_back({t * Interval(i.value), i.value, 0.0});
      continue;
    }
    const Jet x = pop();
    switch (i.op) {
      case Op::kScale:
        stack.push_back(Jet{i.value, 0.0, 0.0} * x);
        break;
      case Op::kAdd:
        stack.push_back(pop() + x);
        break;
      case Op::kSubtract:
        stack.push_back(pop() + (-x));
        break;
      case Op::kMultiply:
        stack.push_back(pop() * x);
        break;
      case Op::kDivide:
        stack.push_back(pop() * inverse(x));
        break;
      case Op::kPower:
        stack.push_back(to_power(pop(), x));
        break;
      case Op::kNegate:
        stack.push_back(-x);
        break;
      case Op::kLess:
      case Op::kLessEqual:
        stack.push_back(logical(less(pop(), x, i.op == Op::kLessEqual, branches)));
        break;
      case Op::kGreater:
      case Op::kGreaterEqual:
        stack.push_back(logical(less(x, pop(), i.op == Op::kGreaterEqual, branches)));
        break;
      case Op::kEqual:
        stack.push_back(logical(equal(pop(), x)));
        break;
      case Op::kNotEqual:
        stack.push_back(logical(Interval(1.0) - equal(pop(), x)));
        break;
      case Op::kAnd:
        stack.push_back(logical(truth(pop()) * truth(x)));
        break;
      case Op::kOr: {
        const Interval a = truth(pop()), b = truth(x);
        stack.push_back(logical({std::max(a.lo, b.lo), std::max(a.hi, b.hi)}));
        break;
      }
      case Op::kNot: {
        const Interval a = truth(x);
        stack.push_back(logical({1.0 - a.hi, 1.0 - a.lo}));
        break;
      }
      case Op::kChoose: {
        const Jet a = pop(), condition = pop();
        const Interval holds = truth(condition);
        stack.push_back(holds.lo > 0.5 ? a : holds.hi < 0.5 ? x : hull(a, x));
        break;
      }
      case Op::kAtan2:
        stack.push_back(arctangent(pop(), x, branches));
        break;
      case Op::kAbs:
        stack.push_back(absolute(x, branches));
        break;
      case Op::kSign:
        stack.push_back(sign(x, branches));
        break;
      case Op::kFloor:
        stack.push_back(whole(x, branches));
        break;
      case Op::kMin:
        stack.push_back(lesser(pop(), x, branches));
        break;
      case Op::kMax:
        stack.push_back(-lesser(-pop(), -x, branches));
        break;
      case Op::kMod: {
        const Jet y = pop();
        stack.push_back(y + (-(x * whole(y * inverse(x), branches))));
        break;
      }
      case Op::kStep:
        stack.push_back(logical(less(x, pop(), true, branches)));
        break;
      case Op::kPulse: {
        const Jet from = pop(), y = pop();
        const Interval begun = less(from, y, true, branches);
        stack.push_back(logical(begun * less(y, x, false, branches)));
        break;
      }
      case Op::kRamp:
      case Op::kSmoothstep: {
        const Jet from = pop(), s = part_of_way(pop(), from, x, branches);
        const bool smooth_ends = i.op == Op::kSmoothstep;
        stack.push_back(smooth_ends ? s * s * (Jet{3.0, 0.0, 0.0} + Jet{-2.0, 0.0, 0.0} * s) : s);
        break;
      }
      default:
        stack.push_back(smooth(i.op, x));
        break;
    }
  }
  return stack.back();
}

/// Search of a span of time by bisection, the earlier half first. The halves are those of the whole
/// span, also in a search of a part of it.
template <class Program>
class BreakSearch {
 public:
  BreakSearch(const Expression& expression, const Program& program, double after, double until)
      : expression_(expression), program_(program), after_(after), until_(until) {
    root_ = std::exp2(std::ceil(std::log2(std::max(until, -after))));
    least_ = 0x1p-70 * root_;
  }

  TimeBreak first() {
    std::optional<TimeBreak> found;
    if (after_ < 0.0) found = search(-root_, root_);
    if (!found && until_ > 0.0) found = search(0.0, root_);
    if (!found && visits_ >= kMax) found = by_samples();
    return found.value_or(TimeBreak{});
  }

 private:
  /// Number of spans after which samples are used: an expression may be undecided everywhere.
  static constexpr int kMax = 20000;
  static constexpr int kSamples = 4096;
  /// Distance from a position, in smallest spans, at which branches before and after it are
  /// compared.
  static constexpr double kBeside = 8.0;

  [[nodiscard]] std::vector<double> branches_at(double t) const {
    Branches branches;
    (void)run(program_, t, branches);
    return branches.chosen;
  }
  [[nodiscard]] double least_width(double t) const {
    return std::max(least_, 0x1p-50 * std::abs(t));
  }
  [[nodiscard]] bool passed(double t) const {
    return t <= after_ + kSameBreak * std::abs(after_) + least_;
  }

  std::optional<TimeBreak> search(double from, double width) {
    const double to = from + width;
    if (passed(to) || from > until_ || visits_ >= kMax) return std::nullopt;
    ++visits_;
    Branches branches;
    (void)run(program_, Interval(from, to), branches);
    if (!branches.open) return std::nullopt;
    if (width <= least_width(to)) return at(to, width);
    if (const auto found = search(from, 0.5 * width)) return found;
    return search(from + 0.5 * width, 0.5 * width);
  }

  /// Break at a time, if the branches before and after it differ.
  [[nodiscard]] std::optional<TimeBreak> at(double t, double width) const {
    const double beside = kBeside * width, before = t - width - beside, after = t + beside;
    if (passed(t) || branches_at(before) == branches_at(after)) return std::nullopt;
    const double jump = std::abs(expression_(after) - expression_(before));
    const double way = after - before;
    const double slopes = std::abs(expression_(after + way) - expression_(after)) +
                          std::abs(expression_(before) - expression_(before - way));
    return TimeBreak{t, jump > kJump * slopes ? 0 : 1};
  }

  /// First change of branches between samples, located by bisection.
  [[nodiscard]] std::optional<TimeBreak> by_samples() const {
    const double h = root_ / kSamples;
    for (double from = h * std::floor(after_ / h); from < until_; from += h) {
      double a = from, b = from + h;
      const std::vector<double> old = branches_at(a);
      if (branches_at(b) == old) continue;
      while (b - a > least_width(b)) {
        const double middle = 0.5 * (a + b);
        (branches_at(middle) == old ? a : b) = middle;
      }
      if (const auto found = at(b, b - a)) return found;
    }
    return std::nullopt;
  }

  /// Ratio to the changes just before and after above which a change is a jump.
  static constexpr double kJump = 8.0;

  const Expression& expression_;
  const Program& program_;
  double after_, until_, root_ = 1.0, least_ = 0.0;
  int visits_ = 0;
};

}  // namespace

TimeBreak Expression::next_break(double t, double until) const {
  if (!depends_on_time_ || !(until > t)) return {};
  return BreakSearch(*this, program_, t, until).first();
}

TimeBounds Expression::bounds(double from, double to) const {
  // A break may lie at either end, where both branches are possible: it is located to round-off.
  const double most = 1e-3 * (to - from);
  const auto edge = [&](double t, TimeSide side) {
    return t + std::clamp(kEdges * (beside(t, side) - t), -most, most);
  };
  Branches branches;
  const Jet f =
      run(program_, Interval(edge(from, TimeSide::kAfter), edge(to, TimeSide::kBefore)), branches);
  return {f.v.size(), f.e.size()};
}

}  // namespace polhode::io
