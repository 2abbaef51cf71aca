// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <polhode/io/text/source_tree.hpp>
#include <polhode/io/text/surrogate_pairs.hpp>

namespace polhode::surrogate_pairs_tests {
namespace {

TEST(SurrogatePairs, AreReadAsJsonWritesThem) {
  // U+1F600 is f0 9f 98 80 in UTF-8 (Unicode, table 3-6); U+10FFFF is the last character.
  const io::SourceTree tree =
      io::SourceTree::parse(R"({"title": "a\ud83d\ude00b\uDBFF\uDFFF", "n": 1})", "m.json");
  EXPECT_EQ(tree.root().find("title")->text,
            "a\xF0\x9F\x98\x80"
            "b\xF4\x8F\xBF\xBF");
  const io::SourceNode* after = tree.root().find("n");
  EXPECT_EQ(after->column, 46) << "the column in the user's text";
}

TEST(SurrogatePairs, LocateErrorsBehindThemInTheUsersText) {
  try {
    static_cast<void>(io::SourceTree::parse("a: [\"\\ud83d\\ude00\", &b 1]\n", "m.yaml"));
    FAIL();
  } catch (const io::ModelErrors& errors) {
    EXPECT_EQ(errors.diagnostics().front().place.column, 21);
  }
}

TEST(SurrogatePairs, StayAsTheyAreOutsideOfDoubleQuotes) {
  for (const char* text :
       {R"(a: \ud83d\ude00)", R"(a: '\ud83d\ude00')", R"(a: "\\ud83d\\ude00")"}) {
    EXPECT_TRUE(io::SurrogatePairs(text).none()) << text;
    EXPECT_EQ(io::SurrogatePairs(text).text(), text);
  }
}

TEST(SurrogatePairs, HalvesAreErrors) {
  for (const char* text : {R"(a: "\ud83d")", R"(a: "\ude00\ud83d")", R"(a: "\ud83d\u0041")",
                           R"(a: "\ud83d\ude0)", R"(a: "\ud83d\)"})
    EXPECT_THROW(static_cast<void>(io::SourceTree::parse(text, "m")), io::ModelErrors) << text;
}

}  // namespace
}  // namespace polhode::surrogate_pairs_tests
