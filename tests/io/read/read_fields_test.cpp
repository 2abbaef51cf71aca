// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_context.hpp>
#include <support/bound_specs.hpp>

namespace polhode::read_fields_tests {
namespace {

/// A value within the range that differs from all defaults.
double number_for(const io::Field& field) {
  const double least = std::max(field.range.least, -4.0), most = std::min(field.range.most, 10.0);
  return field.kind == io::FieldKind::kInteger ? std::ceil(least) + 3.0
                                               : least + 0.3 * (most - least);
}

/// Text of a value for a field of the model file; "" for kinds that are not bound to a member.
std::string text_for(const io::Field& field) {
  switch (field.kind) {
    case io::FieldKind::kNumber:
    case io::FieldKind::kStep:
    case io::FieldKind::kInteger:
    case io::FieldKind::kTimeNumber:
      return format("{}", number_for(field));
    case io::FieldKind::kText:
      return "steel";
    case io::FieldKind::kVector:
    case io::FieldKind::kDirection:
      return "[0, 0.6, 0.8]";
    case io::FieldKind::kNumberList:
      return "[2.5, 1]";
    case io::FieldKind::kNames:
      return "[red, blue]";
    default:
      return "";
  }
}

/// Texts of which at least one is not the default.
std::vector<std::string> texts_for(const io::Field& field) {
  if (field.kind == io::FieldKind::kBoolean) return {"false", "true"};
  if (field.kind == io::FieldKind::kChoice) return field.choices;
  return {text_for(field)};
}

/// Reads a section of one table into a spec. @returns the messages, one a line.
template <class Spec>
std::string read(const io::FieldTable& table, const std::string& text, Spec& spec) {
  const io::SourceTree tree = io::SourceTree::parse(text, "test.yaml");
  io::Diagnostics diagnostics(tree.source());
  io::ReadContext context{.tree = tree, .diagnostics = diagnostics};
  io::Section section(context, tree.root(), {}, "section", table);
  section.read_into(spec);
  try {
    diagnostics.throw_if_any();
  } catch (const io::ModelErrors& e) {
    return e.what();
  }
  return "";
}

/// Compares values of one type; functions of time by their value.
template <class T>
bool same(const T& a, const T& b) {
  if constexpr (std::is_same_v<T, TimeFunctionPtr>)
    return !a == !b && (!a || (*a)(0.0) == (*b)(0.0));
  else
    return a == b;
}

/// Whether a member has equal values in two specs.
template <class Spec>
bool equal(const io::SpecMember& member, const Spec& one, const Spec& other) {
  bool result = false;
  member.visit(one, [&](const auto& a) {
    member.visit(other, [&](const auto& b) {
      if constexpr (std::is_same_v<decltype(a), decltype(b)>) result = same(a, b);
    });
  });
  return result;
}

/// The table of one field, which is not required.
io::FieldTable table_of(io::Field field) {
  field.required = false;
  return {"table", "One field.", {std::move(field)}};
}

TEST(ReadInto, StoresEveryBoundField) {
  for (const io::FieldTable* table : io::all_field_tables())
    for (const io::Field& field : table->fields)
      test::BoundSpecs().each([&]<class Spec>(Spec& standard) {
        if (!field.member.belongs_to<Spec>()) return;
        bool changes = false;
        for (const std::string& text : texts_for(field)) {
          Spec spec{};
          EXPECT_EQ(read(table_of(field), field.name + ": " + text + "\n", spec), "")
              << table->title;
          changes = changes || !equal(field.member, spec, standard);
        }
        EXPECT_TRUE(changes) << table->title << ' ' << field.name;
      });
}

/// The value that a word gives to the field of an enumeration.
template <class Spec, class Enum>
Enum value_of(const io::FieldTable& table, const char* name, const char* word, Enum Spec::*member) {
  Spec spec{};
  EXPECT_EQ(read(table_of(table.at(name)), std::string(name) + ": " + word + "\n", spec), "");
  return spec.*member;
}

TEST(ReadInto, MapsEachWordToItsEnumerator) {
  const std::pair<const char*, Combination> ways[] = {
      {"geometric_mean", Combination::geometric_mean},
      {"mean", Combination::mean},
      {"minimum", Combination::minimum},
      {"maximum", Combination::maximum},
      {"product", Combination::product},
  };
  const io::FieldTable& combine = io::contact_combination_fields();
  for (const auto& [word, way] : ways) {
    EXPECT_EQ(value_of(combine, "friction", word, &ContactsSpec::friction), way);
    EXPECT_EQ(value_of(combine, "restitution", word, &ContactsSpec::restitution), way);
  }
  using Law = JointEnforcement::Law;
  for (const auto& [word, law] :
       {std::pair("penalty", Law::penalty), {"augmented", Law::augmented}})
    EXPECT_EQ(value_of(io::enforcement_fields(), "type", word, &JointEnforcement::law), law);
  for (const auto& [word, strain] :
       {std::pair("engineering", BarStrain::engineering), {"green", BarStrain::green}})
    EXPECT_EQ(value_of(io::cable_fields(), "strain", word, &CableLineSpec::strain), strain);
}

struct Trip {
  double length = 1.0;
  std::optional<double> pace;
  int legs = 2;
};

const io::FieldTable& trip_fields() {
  static const io::FieldTable table{
      "trip",
      "A table of this test.",
      {{.name = "length", .meaning = "Length.", .range = io::kPositive, .member = &Trip::length},
       {.name = "pace", .meaning = "Pace.", .member = &Trip::pace},
       {.name = "by_hand", .meaning = "A number without a member."},
       {.name = "legs",
        .kind = io::FieldKind::kInteger,
        .meaning = "Number of legs.",
        .member = &Trip::legs}}};
  return table;
}

TEST(ReadInto, DoesNotChangeAbsentOrInvalidFields) {
  Trip trip;
  EXPECT_EQ(read(trip_fields(), "legs: 5\nby_hand: 3\n", trip), "");
  EXPECT_EQ(trip.length, 1.0);
  EXPECT_FALSE(trip.pace);
  EXPECT_EQ(trip.legs, 5);
  const std::string messages = read(trip_fields(), "length: -3\nlegs: 1.5\npace: 7\n", trip);
  EXPECT_NE(messages.find("section.length: must be positive, but is -3"), std::string::npos);
  EXPECT_NE(messages.find("section.legs: must be a whole number"), std::string::npos);
  EXPECT_EQ(trip.length, 1.0);
  EXPECT_EQ(trip.legs, 5);
  EXPECT_EQ(trip.pace, 7.0);
}

TEST(ReadInto, RefusesAnotherSpecAndAMemberThatCannotStoreTheKind) {
  Trip trip;
  EXPECT_THROW(read(io::analysis_fields(), "duration: 2\n", trip), std::logic_error);
  io::Field field = trip_fields().at("length");
  field.kind = io::FieldKind::kText;
  EXPECT_THROW(read(table_of(field), "length: long\n", trip), std::logic_error);
}

TEST(ReadInto, LeavesOutKeysThatAreReadByHand) {
  const io::SourceTree tree = io::SourceTree::parse("length: 3\nlegs: 7\n", "test.yaml");
  io::Diagnostics diagnostics(tree.source());
  io::ReadContext context{.tree = tree, .diagnostics = diagnostics};
  io::Section section(context, tree.root(), {}, "section", trip_fields());
  Trip trip;
  section.read_into(trip, {"legs"});
  EXPECT_EQ(trip.length, 3.0);
  EXPECT_EQ(trip.legs, 2);
  EXPECT_THROW(section.read_into(trip, {"leg"}), std::logic_error);
}

}  // namespace
}  // namespace polhode::read_fields_tests
