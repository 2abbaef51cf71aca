// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <polhode/core/names.hpp>

namespace polhode::names_tests {
namespace {

TEST(Names, SuggestTheNearestWord) {
  const std::vector<std::string> words = {"mass", "inertia", "position", "velocity"};
  EXPECT_EQ(closest("mas", words), "mass");
  EXPECT_EQ(closest("postion", words), "position");
  EXPECT_EQ(closest("psoition", words), "position");
  EXPECT_EQ(closest("Mass", words), "mass");
  EXPECT_EQ(closest("colour", words), "");
  EXPECT_EQ(closest("", words), "");
  EXPECT_EQ(did_you_mean("inertai", words), "Did you mean 'inertia'? ");
}

TEST(Names, AreListedUpToALimit) {
  EXPECT_EQ(name_list({"a", "b"}), "a, b");
  EXPECT_EQ(name_list({"a", "b", "c"}, 2), "a, b and 1 more");
}

TEST(Names, AreQuotedInOneShortLine) {
  EXPECT_EQ(quote("a\nb"), "'a b'");
  EXPECT_LT(quote(std::string(1000, 'x')).size(), 70U);
}

}  // namespace
}  // namespace polhode::names_tests
