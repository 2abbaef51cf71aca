// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/text/units.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <utility>

#include <polhode/core/format.hpp>
#include <polhode/io/text/diagnostics.hpp>

namespace polhode::io {
namespace {

using namespace dimensions;

constexpr double kTiny = 1e-9;  // Exponents are small multiples of 1/2 or 1/3.

bool close(double a, double b) { return std::abs(a - b) < kTiny; }

struct NamedUnit {
  const char* name;
  double factor;
  Dimension dimension;
  bool takes_prefix;
};

constexpr double kTurn = 2.0 * std::numbers::pi;

// International yard and pound (1959), standard gravity (CGPM 1901).
constexpr std::array kUnits = {
    NamedUnit{"m", 1.0, kLength, true},
    NamedUnit{"g", 1e-3, kMass, true},
    NamedUnit{"s", 1.0, kTime, true},
    NamedUnit{"rad", 1.0, kAngle, true},
    NamedUnit{"N", 1.0, kForce, true},
    NamedUnit{"Pa", 1.0, {-1, 1, -2, 0}, true},
    NamedUnit{"J", 1.0, kMoment, true},
    NamedUnit{"W", 1.0, {2, 1, -3, 0}, true},
    NamedUnit{"Hz", 1.0, {0, 0, -1, 0}, true},
    NamedUnit{"deg", kTurn / 360.0, kAngle, false},
    NamedUnit{"\xC2\xB0", kTurn / 360.0, kAngle, false},
    NamedUnit{"rev", kTurn, kAngle, false},
    NamedUnit{"rpm", kTurn / 60.0, kAngularVelocity, false},
    NamedUnit{"min", 60.0, kTime, false},
    NamedUnit{"h", 3600.0, kTime, false},
    NamedUnit{"t", 1e3, kMass, false},
    NamedUnit{"bar", 1e5, {-1, 1, -2, 0}, false},
    NamedUnit{"Nm", 1.0, kMoment, false},
    NamedUnit{"Nmm", 1e-3, kMoment, false},
    NamedUnit{"in", 0.0254, kLength, false},
    NamedUnit{"ft", 0.3048, kLength, false},
    NamedUnit{"lb", 0.45359237, kMass, false},
    NamedUnit{"lbf", 0.45359237 * 9.80665, kForce, false},
    NamedUnit{"g0", 9.80665, kAcceleration, false},
    NamedUnit{"%", 0.01, kNone, false},
};

constexpr std::array<std::pair<const char*, double>, 8> kPrefixes = {{{"n", 1e-9},
                                                                      {"u", 1e-6},
                                                                      {"\xC2\xB5", 1e-6},
                                                                      {"m", 1e-3},
                                                                      {"c", 1e-2},
                                                                      {"k", 1e3},
                                                                      {"M", 1e6},
                                                                      {"G", 1e9}}};

std::optional<Unit> named_unit(std::string_view word) {
  for (const NamedUnit& u : kUnits)
    if (word == u.name) return Unit{u.factor, u.dimension, word == "Hz"};
  for (const auto& [prefix, factor] : kPrefixes) {
    if (!word.starts_with(prefix)) continue;
    const std::string_view rest = word.substr(std::string_view(prefix).size());
    for (const NamedUnit& u : kUnits)
      if (u.takes_prefix && rest == u.name)
        return Unit{factor * u.factor, u.dimension, rest == "Hz"};
  }
  return std::nullopt;
}

/// unit = factor { (blank | '*' | '/') factor };  factor = (name | '(' unit ')' | '1') [ '^' n ].
class UnitParser {
 public:
  explicit UnitParser(std::string_view text) : text_(text) {}

  UnitReading read() {
    UnitReading reading;
    Unit unit;
    if (product(unit, 0) && at_ != text_.size()) fail("unexpected " + quote(text_.substr(at_)));
    if (!what_.empty()) {
      reading.what = what_;
      reading.hint = hint_;
    } else {
      reading.unit = unit;
    }
    return reading;
  }

 private:
  static constexpr int kDeepest = 8;

  bool fail(std::string what, std::string hint = "Write a unit such as N/mm or kg m^2.") {
    if (what_.empty()) {
      what_ = format("the unit {} cannot be read: ", quote(text_)) + std::move(what);
      hint_ = std::move(hint);
    }
    return false;
  }

  void skip_blanks() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }

  bool product(Unit& result, int depth) {
    if (depth > kDeepest) return fail("too many brackets");
    bool divided = false;
    if (!factor(result, depth)) return false;
    while (true) {
      const std::size_t before = at_;
      skip_blanks();
      if (at_ == text_.size() || text_[at_] == ')') return true;
      const char c = text_[at_];
      const bool dot = text_.substr(at_).starts_with("\xC2\xB7");
      double sign = 1.0;
      if (c == '*' || dot) {
        at_ += dot ? 2 : 1;
      } else if (c == '/') {
        ++at_;
        sign = -1.0;
      } else if (at_ == before) {
        return fail("unexpected " + quote(text_.substr(at_)));
      }
      if (sign > 0.0 && divided)
        return fail("the '/' is ambiguous", "Write brackets, e.g. N/(m s).");
      divided = sign < 0.0;
      Unit next;
      skip_blanks();
      if (!factor(next, depth)) return false;
      result.factor *= std::pow(next.factor, sign);
      result.dimension = result.dimension + sign * next.dimension;
      result.has_hertz = result.has_hertz || next.has_hertz;
    }
  }

  bool factor(Unit& result, int depth) {
    skip_blanks();
    if (at_ == text_.size()) return fail("it ends too early");
    if (text_[at_] == '(') {
      ++at_;
      if (!product(result, depth + 1)) return false;
      if (at_ == text_.size() || text_[at_] != ')') return fail("a ')' is missing");
      ++at_;
    } else if (text_[at_] == '1') {
      ++at_;
      result = Unit{};
    } else if (!name(result)) {
      return false;
    }
    return power(result);
  }

  bool name(Unit& result) {
    const std::size_t start = at_;
    while (at_ < text_.size() &&
           std::string_view(" */^()").find(text_[at_]) == std::string_view::npos &&
           !text_.substr(at_).starts_with("\xC2\xB7") && !is_superscript())
      ++at_;
    const std::string_view word = text_.substr(start, at_ - start);
    if (what_.empty() && (word.starts_with('+') || word.starts_with('-'))) {
      what_ = "a unit ends an expression, but " + quote(word.substr(0, 1)) + " follows";
      hint_ = "Give the number with its unit a name in 'variables', and use that.";
      return false;
    }
    const std::optional<Unit> unit = named_unit(word);
    if (!unit && what_.empty() && at_ < text_.size() && text_[at_] == '(') {
      what_ = "a unit ends an expression, but " + quote(word) + " follows";
      hint_ = "Write the unit once, behind the whole expression: 80*sign(v) N.";
      return false;
    }
    if (!unit) {
      if (what_.empty()) {
        what_ = "the unit " + quote(word) + " is not known";
        std::vector<std::string> names = unit_names();
        for (const char* usual : {"mm", "cm", "km", "kg", "ms", "kN", "MPa", "GPa", "kHz"})
          names.emplace_back(usual);
        hint_ = did_you_mean(word, names) + "Units: " + name_list(unit_names(), 100) +
                ", with the usual prefixes.";
      }
      return false;
    }
    result = *unit;
    return true;
  }

  /// A small 2 or 3.
  [[nodiscard]] bool is_superscript() const {
    const std::string_view rest = text_.substr(std::min(at_, text_.size()));
    return rest.starts_with("\xC2\xB2") || rest.starts_with("\xC2\xB3");
  }

  bool power(Unit& unit) {
    int n = 0;
    if (at_ < text_.size() && text_[at_] == '^') {
      const char* first = text_.data() + at_ + 1;
      const auto [end, error] = std::from_chars(first, text_.data() + text_.size(), n);
      if (error != std::errc() || std::abs(n) > 9) return fail("'^' needs a whole number");
      at_ = static_cast<std::size_t>(end - text_.data());
    } else if (is_superscript()) {
      n = text_[at_ + 1] == '\xB2' ? 2 : 3;
      at_ += 2;
    } else {
      return true;
    }
    unit.factor = std::pow(unit.factor, n);
    unit.dimension = n * unit.dimension;
    return true;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::string what_, hint_;
};

struct NamedDimension {
  Dimension dimension;
  const char *name, *unit;
};

constexpr std::array kNames = {
    NamedDimension{kNone, "a plain number", ""},
    NamedDimension{kLength, "a length", "m"},
    NamedDimension{kMass, "a mass", "kg"},
    NamedDimension{kTime, "a time", "s"},
    NamedDimension{kAngle, "an angle", "rad"},
    NamedDimension{kVelocity, "a velocity", "m/s"},
    NamedDimension{kAcceleration, "an acceleration", "m/s^2"},
    NamedDimension{kAngularVelocity, "an angular velocity", "rad/s"},
    NamedDimension{{0, 0, -1, 0}, "a frequency", "1/s"},
    NamedDimension{kForce, "a force", "N"},
    NamedDimension{kMoment, "a moment", "N m"},
    NamedDimension{kInertia, "a moment of inertia", "kg m^2"},
    NamedDimension{kDensity, "a density", "kg/m^3"},
    NamedDimension{kStiffness, "a stiffness", "N/m"},
    NamedDimension{kDamping, "a damping", "N s/m"},
    NamedDimension{kAngularStiffness, "a torsional stiffness", "N m/rad"},
    NamedDimension{kAngularDamping, "a torsional damping", "N m s/rad"},
    NamedDimension{kPressure, "a pressure", "Pa"},
    NamedDimension{kViscosity, "a viscosity", "Pa s"},
    NamedDimension{{2, 1, -3, 0}, "a power", "W"},
    NamedDimension{{2, 0, 0, 0}, "an area", "m^2"},
    NamedDimension{{3, 0, 0, 0}, "a volume", "m^3"},
};

const NamedDimension* find_name(const Dimension& d) {
  for (const NamedDimension& n : kNames)
    if (n.dimension.matches(d) && close(n.dimension.angle, d.angle)) return &n;
  return nullptr;
}

}  // namespace

bool Dimension::matches(const Dimension& other) const {
  return close(length, other.length) && close(mass, other.mass) && close(time, other.time);
}

bool Dimension::is_none() const { return matches({}) && close(angle, 0.0); }

std::string Dimension::name() const {
  const NamedDimension* named = find_name(*this);
  return named ? named->name : "a quantity in " + si_unit();
}

std::string Dimension::si_unit() const {
  if (const NamedDimension* named = find_name(*this)) return named->unit;
  std::string text;
  const auto append = [&](const char* unit, double n) {
    if (close(n, 0.0)) return;
    text += (text.empty() ? "" : " ") + std::string(unit);
    if (!close(n, 1.0)) text += format("^{:g}", n);
  };
  append("kg", mass);
  append("m", length);
  append("s", time);
  append("rad", angle);
  return text;
}

UnitReading read_unit(std::string_view text) { return UnitParser(text).read(); }

std::vector<std::string> unit_names() {
  std::vector<std::string> names;
  names.reserve(std::size(kUnits));
  for (const NamedUnit& u : kUnits) names.emplace_back(u.name);
  return names;
}

double UnitSystem::factor_without_angle(const Dimension& d) const {
  double result = 1.0;
  // Factors of 1 are by far the most common, and stay exact.
  if (length != 1.0) result *= std::pow(length, d.length);
  if (mass != 1.0) result *= std::pow(mass, d.mass);
  if (time != 1.0) result *= std::pow(time, d.time);
  return result;
}

double UnitSystem::factor(const Dimension& d) const {
  const double result = factor_without_angle(d);
  return angle == 1.0 ? result : result * std::pow(angle, d.angle);
}

}  // namespace polhode::io
