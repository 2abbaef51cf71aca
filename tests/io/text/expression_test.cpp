// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <polhode/io/text/expression.hpp>

namespace polhode::expression_tests {
namespace {

constexpr double kPi = std::numbers::pi;

/// SI value at t of a text, read as a value of this dimension; NaN if it is refused.
double value(const std::string& text, const io::Dimension& wanted = {},
             const io::UnitSystem& units = {}, const io::Variables& variables = {},
             double t = 0.0) {
  io::ExpressionFault fault;
  const auto expression = io::Expression::parse(text, variables, units, true, fault);
  if (!expression) return NAN;
  const auto factor = expression->factor_to_si(wanted, units);
  return factor ? *factor * (*expression)(t) : NAN;
}

std::string fault_of(const std::string& text, const io::Variables& variables = {}) {
  io::ExpressionFault fault;
  EXPECT_FALSE(io::Expression::parse(text, variables, {}, false, fault)) << text;
  return fault.what;
}

io::Quantity known(double si, const io::Dimension& d) { return {si, io::Certainty::kKnown, d}; }
io::Quantity bare(double number) { return {number, io::Certainty::kBare, {}}; }

TEST(Expression, FollowsTheUsualPrecedence) {
  EXPECT_EQ(value("1 + 2*3"), 7.0);
  EXPECT_EQ(value("-2^2"), -4.0);
  EXPECT_EQ(value("2^3^2"), 512.0);
  EXPECT_EQ(value("2^-1"), 0.5);
  EXPECT_EQ(value("8/4/2"), 1.0);
  EXPECT_EQ(value("1 - -1"), 2.0);
  EXPECT_EQ(value("(1+2)*3"), 9.0);
  EXPECT_EQ(value("1 < 2 && 3 >= 4 || 1 == 1"), 1.0);
  EXPECT_EQ(value("0 ? 1 : 2 > 1 ? 3 : 4"), 3.0);
  EXPECT_EQ(value("!0 + 1"), 2.0);
  EXPECT_EQ(value("1e-3"), 1e-3);
  EXPECT_EQ(value(".5"), 0.5);
}

TEST(Expression, EvaluatesAllListedFunctions) {
  EXPECT_DOUBLE_EQ(value("sin(pi/6)"), std::sin(kPi / 6));
  EXPECT_DOUBLE_EQ(value("atan2(1, -1)", io::dimensions::kAngle), std::atan2(1.0, -1.0));
  EXPECT_DOUBLE_EQ(value("sqrt(2)*exp(1) + log(3) - log10(5)"),
                   std::sqrt(2.0) * std::exp(1.0) + std::log(3.0) - std::log10(5.0));
  EXPECT_EQ(value("min(1, 2) + max(3, 4) + abs(-5) + sign(-2) + floor(2.5)"), 11.0);
  EXPECT_EQ(value("pow(2, 10)"), 1024.0);
}

TEST(Expression, HasRemaindersStepsPulsesAndRamps) {
  EXPECT_EQ(value("mod(7, 3)"), 1.0);
  EXPECT_EQ(value("mod(-1, 3)"), 2.0);
  EXPECT_EQ(value("mod(1, -3)"), -2.0);
  const auto at = [](const std::string& text, double t) { return value(text, {}, {}, {}, t); };
  EXPECT_EQ(at("step(t, 2)", 1.999), 0.0);
  EXPECT_EQ(at("step(t, 2)", 2.0), 1.0);
  for (const auto& [t, on] : {std::pair(0.9, 0.0), {1.0, 1.0}, {2.9, 1.0}, {3.0, 0.0}})
    EXPECT_EQ(at("pulse(t, 1, 3)", t), on) << t;
  for (const auto& [t, part] :
       {std::pair(0.0, 0.0), {1.0, 0.0}, {1.5, 0.25}, {3.0, 1.0}, {9.0, 1.0}}) {
    EXPECT_EQ(at("ramp(t, 1, 3)", t), part) << t;
    EXPECT_EQ(at("smoothstep(t, 1, 3)", t), part * part * (3.0 - 2.0 * part)) << t;
  }
  EXPECT_EQ(at("pulse(mod(t, 2), 0, 1)", 4.5), 1.0);
  EXPECT_EQ(at("pulse(mod(t, 2), 0, 1)", 5.5), 0.0);
  EXPECT_EQ(fault_of("ramp(1, 3, 2)"), "ramp() ends before it begins");
  EXPECT_EQ(fault_of("pulse(1, 3, 3)"), "pulse() ends before it begins");
}

TEST(Expression, PlacesOfQuantitiesAreNumbersOfOneDimension) {
  const io::Variables v = {{"L", known(0.5, io::dimensions::kLength)},
                           {"m", known(2.0, io::dimensions::kMass)}};
  io::UnitSystem mm;
  mm.length = 1e-3;
  EXPECT_DOUBLE_EQ(value("ramp(L, 250, 750)", {}, mm, v), 0.5);
  EXPECT_DOUBLE_EQ(value("ramp(250, 0, L)", {}, mm, v), 0.5);
  EXPECT_DOUBLE_EQ(value("ramp(250, -L, L)", {}, mm, v), 0.75);
  EXPECT_DOUBLE_EQ(value("step(L, 499)", {}, mm, v), 1.0);
  EXPECT_DOUBLE_EQ(value("mod(L, 200)", io::dimensions::kLength, mm, v), 0.1);
  EXPECT_EQ(fault_of("ramp(L, m, 3)", v), "ramp() joins a length and a mass");
  EXPECT_EQ(fault_of("mod(L, m)", v), "mod() joins a length and a mass");
}

TEST(Expression, VariablesMayHaveTheNamesOfFunctionsThatAreNotTaken) {
  const io::Variables v = {{"ramp", bare(3.0)}, {"step", bare(0.5)}};
  EXPECT_EQ(value("ramp*step + ramp (step, 0, 1)", {}, {}, v), 2.0);
}

TEST(Expression, AnUnknownFunctionListsThoseThatExist) {
  io::ExpressionFault fault;
  EXPECT_FALSE(io::Expression::parse("1 + smothstep(2, 1, 3)", {}, {}, false, fault));
  EXPECT_EQ(fault.what, "unknown function 'smothstep'");
  EXPECT_TRUE(fault.hint.starts_with("Did you mean 'smoothstep'? Functions: ")) << fault.hint;
  EXPECT_EQ(fault.offset, 4U);
}

TEST(Expression, TakesAUnitAfterAnExpression) {
  EXPECT_DOUBLE_EQ(value("30 deg", io::dimensions::kAngle), kPi / 6);
  EXPECT_DOUBLE_EQ(value("2*pi rad/s", io::dimensions::kAngularVelocity), 2 * kPi);
  EXPECT_DOUBLE_EQ(value("5 N/mm", io::dimensions::kStiffness), 5e3);
  EXPECT_DOUBLE_EQ(value("-1 rad/s", io::dimensions::kAngularVelocity), -1.0);
}

TEST(Expression, ChecksDimensions) {
  EXPECT_TRUE(std::isnan(value("3 mm", io::dimensions::kMass)));
  EXPECT_TRUE(std::isnan(value("30 deg", io::dimensions::kNone)));
  const io::Variables v = {{"L", known(0.5, io::dimensions::kLength)},
                           {"m", known(2.0, io::dimensions::kMass)},
                           {"w", known(3.0, io::dimensions::kAngularVelocity)}};
  EXPECT_DOUBLE_EQ(value("w*L", io::dimensions::kVelocity, {}, v), 1.5);
  EXPECT_DOUBLE_EQ(value("m*L^2/12", io::dimensions::kInertia, {}, v), 2.0 * 0.25 / 12);
  EXPECT_DOUBLE_EQ(value("sqrt(L*L)", io::dimensions::kLength, {}, v), 0.5);
  EXPECT_DOUBLE_EQ(value("L/(2*L)", io::dimensions::kNone, {}, v), 0.5);
  EXPECT_TRUE(std::isnan(value("m*L", io::dimensions::kInertia, {}, v)));
  EXPECT_EQ(fault_of("L + m", v), "'+' joins a length and a mass");
  EXPECT_EQ(fault_of("exp(L)", v), "exp() is given a length");
  EXPECT_EQ(fault_of("2^L", v), "the exponent is a length");
}

TEST(Expression, InfersUnitsOfVariablesFromTheirUse) {
  const io::UnitSystem mm{.length = 1e-3};
  const io::Variables v = {{"L", bare(100.0)},
                           {"w", known(2.0, io::dimensions::kAngularVelocity)},
                           {"d", known(0.02, io::dimensions::kLength)}};
  EXPECT_DOUBLE_EQ(value("L/2", io::dimensions::kLength, mm, v), 0.05);
  EXPECT_DOUBLE_EQ(value("w*L", io::dimensions::kVelocity, mm, v), 0.2);
  EXPECT_DOUBLE_EQ(value("L + d", io::dimensions::kLength, mm, v), 0.12);
  EXPECT_DOUBLE_EQ(value("d + 5", io::dimensions::kLength, mm, v), 0.025);
  EXPECT_DOUBLE_EQ(value("5 + d", io::dimensions::kLength, mm, v), 0.025);
  EXPECT_DOUBLE_EQ(value("d*L", {2, 0, 0, 0}, mm, v), 0.02 * 0.1);
}

TEST(Expression, UsesRadiansWhereAUnitContainsAnAngle) {
  const io::UnitSystem deg{.angle = kPi / 180.0};
  const io::Variables v = {{"a", bare(30.0)},
                           {"w", known(2.0, io::dimensions::kAngularVelocity)},
                           {"L", bare(3.0)},
                           {"k", bare(2.0)},
                           {"q", known(kPi / 6, io::dimensions::kAngle)}};
  EXPECT_DOUBLE_EQ(value("2*a", io::dimensions::kAngle, deg, v), kPi / 3);
  EXPECT_DOUBLE_EQ(value("w*L", io::dimensions::kVelocity, deg, v), 6.0);
  EXPECT_DOUBLE_EQ(value("k*w", io::dimensions::kAngularVelocity, deg, v), 4.0);
  EXPECT_DOUBLE_EQ(value("q + 30", io::dimensions::kAngle, deg, v), kPi / 3);
  EXPECT_DOUBLE_EQ(value("asin(0.5)", io::dimensions::kAngle, deg, v), kPi / 6);
  EXPECT_DOUBLE_EQ(value("sin(q)", io::dimensions::kNone, deg, v), 0.5);
}

TEST(Expression, HasTimeInTheUnitOfTheFile) {
  const io::UnitSystem ms{.time = 1e-3};
  EXPECT_DOUBLE_EQ(value("t", io::dimensions::kNone, ms, {}, 0.005), 5.0);
  const io::Variables v = {{"T", known(1.0, io::dimensions::kTime)}};
  EXPECT_DOUBLE_EQ(value("sin(2*pi*t/T)", io::dimensions::kNone, ms, v, 0.125), std::sin(kPi / 4));
}

TEST(Expression, LocatesItsErrors) {
  io::ExpressionFault fault;
  EXPECT_FALSE(io::Expression::parse("1 + foo(2)", {}, {}, false, fault));
  EXPECT_EQ(fault.offset, 4U);
  EXPECT_EQ(fault.length, 3U);
  EXPECT_EQ(fault.what, "unknown function 'foo'");
  EXPECT_EQ(fault_of("t"), "'t' (the time) has no meaning here");
  EXPECT_EQ(fault_of("3kg"), "'3kg' lacks a space before the unit");
}

TEST(Expression, RefusesTextThatIsTooDeepOrTooLong) {
  EXPECT_EQ(fault_of(std::string(2000, '(') + "1"), "the expression is too deeply nested");
  EXPECT_EQ(fault_of(std::string(2000, '-') + "1"), "the expression is too deeply nested");
  EXPECT_EQ(fault_of(std::string(5000, '1')), "the expression is longer than 4096 characters");
  std::string tower = "1";
  for (int k = 0; k < 300; ++k) tower += "^1";
  EXPECT_EQ(fault_of(tower), "the expression is too deeply nested");
  std::string sum = "1";
  for (int k = 0; k < 1000; ++k) sum += "+1";
  EXPECT_EQ(value(sum), 1001.0);
}

}  // namespace
}  // namespace polhode::expression_tests
