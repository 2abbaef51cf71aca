// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/text/expression_writer.hpp>

namespace polhode::io {

namespace {

constexpr std::size_t kLongest = 4096;
constexpr int kDeepest = 48;  // Nested brackets.

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

/// Recursive-descent parser that checks dimensions and writes a program for a stack machine.
class ExpressionParser : private ExpressionWriter {
 public:
  /// @param variable  Allowed variable; "" for none.
  ExpressionParser(std::string_view text, const Variables& variables, const UnitSystem& units,
                   std::string_view variable, double in_units)
      : ExpressionWriter(text, units),
        variables_(variables),
        variable_(variable),
        in_units_(in_units) {}

  std::shared_ptr<const Expression> parse(ExpressionFault& fault) {
    try {
      if (text_.size() > kLongest)
        stop(0, 1, format("the expression is longer than {} characters", kLongest),
             "Use variables for its parts.");
      read_all();
      return std::make_shared<const Expression>(std::move(result_));
    } catch (ExpressionFault& found) {
      fault = std::move(found);
      return nullptr;
    }
  }

 private:
  // --- Reading -------------------------------------------------------------------------------

  void skip_blanks() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }

  bool take(std::string_view token) {
    skip_blanks();
    if (!text_.substr(at_).starts_with(token)) return false;
    at_ += token.size();
    return true;
  }

  void expect(std::string_view token) {
    if (!take(token)) unexpected(format("expected '{}'", token));
  }

  [[noreturn]] void unexpected(const std::string& wanted) {
    skip_blanks();
    if (at_ >= text_.size())
      stop(0, text_.size(), "the expression " + quote(text_) + " ends too early: " + wanted,
           std::ranges::count(text_, '(') > std::ranges::count(text_, ')')
               ? "Complete it; in a list or map, put an expression with commas in quotes."
               : "Complete it.");
    stop(at_, 1,
         format("{} cannot be read as a number or expression: {} at {}", quote(text_), wanted,
                quote(text_.substr(at_, 12))),
         "Write a number, a number with its unit, or an expression of the variables.");
  }

  void read_all() {
    Part whole = choice();
    skip_blanks();
    if (at_ < text_.size() && starts_unit()) {
      read_written_unit(whole);
      at_ = text_.size();
    }
    if (at_ < text_.size()) unexpected("an operator is missing");
    result_.type_ = whole.type;
    if (!result_.depends_on_time_) {
      const double value = result_(0.0);
      result_.program_.assign(1, {Op::kPush, value});
      result_.type_.value = value;
    }
    result_.fold_constants();
  }

  [[nodiscard]] bool starts_unit() const {
    const char c = text_[at_];
    return is_letter(c) || c == '%' || static_cast<unsigned char>(c) >= 0x80 ||
           (c == '1' && text_.substr(at_).starts_with("1/"));
  }

  void read_written_unit(Part& whole) {
    const std::string_view written = text_.substr(at_);
    if (text_[at_ - 1] != ' ' && is_letter(text_[at_])) {
      stop(at_, written.size(), quote(text_) + " lacks a space before the unit",
           format("Write '{} {}'.", text_.substr(0, at_), written));
    }
    const UnitReading reading = read_unit(written);
    if (!reading.unit) stop(at_, written.size(), reading.what, reading.hint);
    if (whole.type.certainty == Certainty::kKnown)
      stop(at_, written.size(),
           format("the unit '{}' follows an expression that is {} already", written,
                  whole.type.dimension.name()),
           instead_of_unit(*reading.unit, written));
    result_.unit_ = reading.unit;
    scale(result_.program_.size(), reading.unit->factor);
    whole.type = known(reading.unit->dimension);
  }

  /// Suggested text where an expression has a dimension before its trailing unit: a unit applies to
  /// the whole, so that of `tilt - 90 deg` does not apply to 90 alone.
  [[nodiscard]] std::string instead_of_unit(const Unit& unit, std::string_view written) const {
    const std::size_t end = text_.find_last_not_of(' ', at_ - 1);
    const std::size_t before =
        number_begin_ > 0 ? text_.find_last_not_of(' ', number_begin_ - 1) : std::string_view::npos;
    const bool added = number_end_ == end + 1 && before != std::string_view::npos &&
                       (text_[before] == '+' || text_[before] == '-');
    if (!added) return "Leave the unit out.";
    const std::string_view number = text_.substr(number_begin_, number_end_ - number_begin_);
    const std::string_view rest = text_.substr(0, number_begin_);
    const double factor = unit.factor / units_.factor(unit.dimension);
    const bool degrees = written == "deg" && units_.angle == 1.0;
    return format(
        "A unit counts for the whole expression. Write '{}{}', or make '{} {}' a variable.", rest,
        degrees ? format("{}*pi/180", number)
                : format("{:.9g}", std::strtod(std::string(number).c_str(), nullptr) * factor),
        number, written);
  }

  Part choice() {
    const Nesting nesting(*this);
    Part condition = disjunction();
    if (!take("?")) return condition;
    Part a = choice();
    expect(":");
    Part b = choice();
    const Quantity type = unify(a, b, "':'");
    emit(Op::kChoose, 3);
    return {type, condition.start, condition.offset};
  }

  Part disjunction() {
    Part a = conjunction();
    while (take("||")) a = logical(a, conjunction(), Op::kOr);
    return a;
  }

  Part conjunction() {
    Part a = comparison();
    while (take("&&")) a = logical(a, comparison(), Op::kAnd);
    return a;
  }

  Part logical(const Part& a, const Part&, Op op) {
    emit(op, 2);
    return {{}, a.start, a.offset};
  }

  Part comparison() {
    static constexpr std::array<std::pair<const char*, Op>, 6> kComparisons = {
        {{"<=", Op::kLessEqual},
         {">=", Op::kGreaterEqual},
         {"==", Op::kEqual},
         {"!=", Op::kNotEqual},
         {"<", Op::kLess},
         {">", Op::kGreater}}};
    Part a = sum();
    for (const auto& [token, op] : kComparisons) {
      if (!take(token)) continue;
      Part b = sum();
      unify(a, b, format("'{}'", token));
      emit(op, 2);
      return {{}, a.start, a.offset};
    }
    return a;
  }

  Part sum() {
    Part a = product();
    while (true) {
      const bool plus = take("+");
      if (!plus && !take("-")) return a;
      Part b = product();
      a.type = unify(a, b, plus ? "'+'" : "'-'");
      emit(plus ? Op::kAdd : Op::kSubtract, 2);
    }
  }

  Part product() {
    Part a = signed_power();
    while (true) {
      skip_blanks();
      const bool times = take("*");
      if (!times && !take("/")) return a;
      Part b = signed_power();
      a.type = multiply(a, b, times ? 1.0 : -1.0);
      emit(times ? Op::kMultiply : Op::kDivide, 2);
    }
  }

  Part signed_power() {
    const Nesting nesting(*this);
    skip_blanks();
    const std::size_t start = result_.program_.size(), offset = at_;
    if (take("+")) return signed_power();
    if (take("-")) {
      Part a = signed_power();
      emit(Op::kNegate, 1);
      return {a.type, start, offset};
    }
    if (text_.substr(at_).starts_with("!") && take("!")) {
      signed_power();
      emit(Op::kNot, 1);
      return {{}, start, offset};
    }
    Part base = primary();
    if (!take("^")) return base;
    Part exponent = signed_power();  // 2^3^2 = 2^(3^2), 2^-1 = 0.5, -2^2 = -4.
    return raise(base, exponent);
  }

  Part primary() {
    const Nesting nesting(*this);
    skip_blanks();
    if (at_ >= text_.size()) unexpected("a value is missing");
    const std::size_t offset = at_;
    const std::size_t start = result_.program_.size();
    if (take("(")) {
      Part inner = choice();
      expect(")");
      return {inner.type, start, offset};
    }
    const char c = text_[at_];
    if (is_digit(c) || c == '.') return number();
    if (is_letter(c)) return name();
    unexpected("a value is missing");
  }

  Part number() {
    const std::size_t offset = at_;
    double value = 0.0;
    const auto [end, error] =
        std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error == std::errc::result_out_of_range)
      stop(offset, 1, "a number in " + quote(text_) + " is too large or too small",
           "Stay within 1e-300 and 1e300.");
    if (error != std::errc()) unexpected("a value is missing");
    at_ = static_cast<std::size_t>(end - text_.data());
    number_begin_ = offset;
    number_end_ = at_;
    const std::size_t start = result_.program_.size();
    push({Op::kPush, value});
    return {{}, start, offset};
  }

  Part name() {
    const std::size_t offset = at_;
    while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]))) ++at_;
    const std::string_view word = text_.substr(offset, at_ - offset);
    const std::size_t start = result_.program_.size();
    skip_blanks();
    const bool bracket = text_.substr(at_).starts_with('(');
    for (const NamedFunction& f : kExpressionFunctions)
      if (word == f.name && (f.reserved || bracket)) return call(f, offset);
    if (word == "pi") {
      push({Op::kPush, std::numbers::pi});
      return {{}, start, offset};
    }
    if (word == variable_) {
      result_.depends_on_time_ = true;
      push({Op::kTime, 1.0 / in_units_});
      return {{0.0, Certainty::kBare, {}}, start, offset};
    }
    if (word == "t")
      stop(offset, 1, "'t' (the time) has no meaning here", "This value cannot depend on time.");
    const auto found = variables_.find(word);
    if (found == variables_.end() && bracket) unknown_function(word, offset);
    if (found == variables_.end()) unknown_name(word, offset);
    push({Op::kPush, found->second.value});
    return {found->second, start, offset};
  }

  [[noreturn]] void unknown_name(std::string_view word, std::size_t offset) const {
    std::vector<std::string> names;
    for (const auto& [name, value] : variables_) names.push_back(name);
    std::string known =
        names.empty() ? "There are no variables." : "Variables: " + name_list(names) + ".";
    std::vector<std::string> all = reserved_names();
    all.insert(all.end(), names.begin(), names.end());
    stop(offset, word.size(), "unknown name " + quote(word), did_you_mean(word, all) + known);
  }

  [[noreturn]] static void unknown_function(std::string_view word, std::size_t offset) {
    std::vector<std::string> names;
    for (const NamedFunction& f : kExpressionFunctions) names.emplace_back(f.name);
    stop(offset, word.size(), "unknown function " + quote(word),
         did_you_mean(word, names) + "Functions: " + name_list(names, names.size()) + ".");
  }

  Part call(const NamedFunction& f, std::size_t offset) {
    const std::size_t start = result_.program_.size();
    expect("(");
    std::array<Part, 3> parts;
    for (std::size_t k = 0; k < static_cast<std::size_t>(f.arguments); ++k) {
      if (k > 0) expect(",");
      parts[k] = choice();
    }
    expect(")");
    auto& [a, b, c] = parts;
    if (f.rule == FunctionRule::kPower) {
      Part raised = raise(a, b);
      return {raised.type, start, offset};
    }
    if (f.rule == FunctionRule::kPlace && f.arguments == 3) place_in_span(f, a, b, c);
    const Quantity type = result_type(f, a, b);
    emit(f.op, f.arguments);
    return {type, start, offset};
  }

  /// Counter of nested brackets, signs and calls.
  struct Nesting {
    explicit Nesting(ExpressionParser& p) : parser(p) {
      if (++parser.depth_ > 3 * kDeepest)
        stop(0, parser.text_.size(), "the expression is too deeply nested",
             "Use variables for its parts.");
    }
    ~Nesting() { --parser.depth_; }
    Nesting(const Nesting&) = delete;
    Nesting& operator=(const Nesting&) = delete;
    ExpressionParser& parser;
  };

  const Variables& variables_;
  std::string_view variable_;
  double in_units_;  ///< Size of the user's base unit of the variable, SI.
  std::size_t number_begin_ = 0, number_end_ = 0;  ///< Of the number read last.
  int depth_ = 0;
};

std::shared_ptr<const Expression> Expression::parse(std::string_view text,
                                                    const Variables& variables,
                                                    const UnitSystem& units,
                                                    std::string_view variable, double in_units,
                                                    ExpressionFault& fault) {
  return ExpressionParser(text, variables, units, variable, in_units).parse(fault);
}

}  // namespace polhode::io
