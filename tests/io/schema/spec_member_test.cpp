// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/schema/spec_member.hpp>

#include <algorithm>

#include <gtest/gtest.h>

#include <polhode/io/schema/field_table.hpp>
#include <support/bound_specs.hpp>

namespace polhode::spec_member_tests {
namespace {

enum class Way { here, there };
struct Trip {
  double length = 1.0;
  std::optional<int> stops;
  Way way = Way::here;
};

TEST(SpecMember, PointsIntoTheSpec) {
  Trip trip;
  *std::get<double*>(io::SpecMember(&Trip::length).in(trip)) = 3.0;
  *std::get<std::optional<int>*>(io::SpecMember(&Trip::stops).in(trip)) = 2;
  std::get<io::EnumReference>(io::SpecMember(&Trip::way).in(trip)).set(1);
  EXPECT_EQ(trip.length, 3.0);
  EXPECT_EQ(trip.stops, 2);
  EXPECT_EQ(trip.way, Way::there);
}

TEST(SpecMember, ShowsValuesAndTheNumberOfAnEnumeration) {
  const Trip trip{.length = 2.0, .stops = {}, .way = Way::there};
  double seen = 0.0;
  const auto look = [&](const auto& value) {
    if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(value)>>) seen = value;
  };
  io::SpecMember(&Trip::length).visit(trip, look);
  EXPECT_EQ(seen, 2.0);
  io::SpecMember(&Trip::way).visit(trip, look);
  EXPECT_EQ(seen, 1.0);
}

TEST(SpecMember, RefusesAnotherSpec) {
  const io::SpecMember member = &Trip::length;
  AnalysisSpec analysis;
  EXPECT_TRUE(member.belongs_to<Trip>());
  EXPECT_FALSE(member.belongs_to<AnalysisSpec>());
  EXPECT_FALSE(io::SpecMember().belongs_to<Trip>());
  EXPECT_THROW(static_cast<void>(member.in(analysis)), std::logic_error);
  EXPECT_THROW(member.visit(analysis, [](const auto&) {}), std::logic_error);
  EXPECT_THROW(static_cast<void>(io::SpecMember().in(analysis)), std::logic_error);
  EXPECT_THROW(static_cast<void>(io::fields_of<Trip>(io::analysis_fields())), std::logic_error);
}

/// Other specs would be skipped by the tests of all bound fields.
TEST(SpecMember, BelongsToOneTestedSpec) {
  for (const io::FieldTable* table : io::all_field_tables())
    for (const io::Field& field : table->fields)
      EXPECT_EQ(test::owners(field), field.member ? 1 : 0) << table->title << ' ' << field.name;
}

TEST(SpecMember, IsBoundToAtMostOneFieldOfATable) {
  for (const io::FieldTable* table : io::all_field_tables())
    test::BoundSpecs().each([&]<class Spec>(Spec& spec) {
      std::vector<io::SpecValue> members;
      for (const io::Field& field : table->fields) {
        if (!field.member.belongs_to<Spec>()) continue;
        const io::SpecValue member = field.member.in(spec);
        EXPECT_EQ(std::count(members.begin(), members.end(), member), 0)
            << table->title << ' ' << field.name;
        members.push_back(member);
      }
    });
}

}  // namespace
}  // namespace polhode::spec_member_tests
