// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <polhode/io/text/source_tree.hpp>

namespace polhode::source_tree_tests {
namespace {

std::string fault_of(const std::string& text) {
  try {
    static_cast<void>(io::SourceTree::parse(text, "m.yaml"));
  } catch (const io::ModelErrors& errors) {
    return errors.diagnostics().front().what;
  }
  return "";
}

TEST(SourceTree, KeepsTheLocationOfEveryNode) {
  const io::SourceTree tree = io::SourceTree::parse("a:\n  b: [1, {c: x}]\n", "m.yaml");
  const io::SourceNode* b = tree.root().find("a")->find("b");
  EXPECT_EQ(tree.root().find("a")->keys[0].column, 3);
  EXPECT_EQ(b->line, 2);
  EXPECT_EQ(b->column, 6);
  EXPECT_EQ(b->children[1].find("c")->text, "x");
  EXPECT_EQ(b->children[1].find("c")->column, 14);
  EXPECT_EQ(tree.place_of(*b).file, "m.yaml");
}

TEST(SourceTree, ReadsJsonAndWindowsLineEndings) {
  const io::SourceTree tree =
      io::SourceTree::parse("\xEF\xBB\xBF{\"a\": [1,\r\n\"b\"]}\r\n", "m.json");
  EXPECT_EQ(tree.root().find("a")->children[1].text, "b");
  EXPECT_EQ(tree.root().find("a")->children[1].line, 2);
  EXPECT_TRUE(tree.root().find("a")->children[1].in_quotes);
}

TEST(SourceTree, AllowsOneDocumentWithItsMarkers) {
  EXPECT_EQ(io::SourceTree::parse("---\na: 1\n...\n", "m").root().find("a")->text, "1");
  EXPECT_EQ(fault_of("a: 1\n---\nb: 2\n"), "a second document starts here");
}

TEST(SourceTree, RefusesYamlFeaturesOutsideTheSubset) {
  EXPECT_EQ(fault_of("a: &x 1\n"), "anchors (&name) are not allowed");
  EXPECT_EQ(fault_of("a: *x\n"), "aliases (*name) are not allowed");
  EXPECT_EQ(fault_of("a: !t 1\n"), "tags (!name) are not allowed");
  EXPECT_EQ(fault_of("a: ! 1\n"), "tags (!name) are not allowed");
  EXPECT_EQ(fault_of("a: 1\na: 2\n"), "the key 'a' stands twice");
  EXPECT_EQ(fault_of("<<: {a: 1}\n"), "merge keys (<<) are not allowed");
  EXPECT_EQ(fault_of("a: \"x\n"), "the quote is not closed");
  EXPECT_EQ(fault_of("a: 'it''s\n"), "the quote is not closed");
  EXPECT_EQ(fault_of("a: 'it''s'\n"), "");
  EXPECT_EQ(fault_of("a: \"\\\"\"\n"), "");
}

TEST(SourceTree, RefusesBytesThatAreNotUtf8Text) {
  EXPECT_EQ(fault_of("a: \x80"), "the text is not UTF-8");
  EXPECT_EQ(fault_of("a: \xED\xA0\x80"), "the text is not UTF-8");  // A surrogate.
  EXPECT_EQ(fault_of("a: \xC0\x80"), "the text is not UTF-8");      // Overlong.
  EXPECT_EQ(fault_of(std::string("a: \0b", 5)), "the character with code 0 is not allowed");
  EXPECT_EQ(fault_of("a: \r b"), "the character with code 13 is not allowed");
  EXPECT_EQ(fault_of("a: \xE2\x80\xA8"), "a Unicode line separator is not allowed");
}

TEST(SourceTree, RefusesDepthInEveryStyle) {
  const std::string expected = "values are nested more than 64 deep";
  EXPECT_EQ(fault_of(std::string(100000, '[')), expected);
  EXPECT_EQ(fault_of(std::string(100000, '{')), expected);
  std::string dashes, keys, block;
  for (int k = 0; k < 5000; ++k) dashes += "- ";
  for (int k = 0; k < 5000; ++k) keys += "? ";
  for (int k = 0; k < 100; ++k) block += std::string(static_cast<std::size_t>(k), ' ') + "a:\n";
  EXPECT_EQ(fault_of(dashes), expected);
  EXPECT_EQ(fault_of(keys), expected);
  EXPECT_EQ(fault_of(block), expected);
  EXPECT_EQ(fault_of(std::string(64, '[') + std::string(64, ']')), "");
}

TEST(SourceTree, RefusesTooManyValuesAndBytes) {
  io::SourceLimits limits;
  limits.nodes = 10;
  EXPECT_THROW(static_cast<void>(io::SourceTree::parse("[1,2,3,4,5,6,7,8,9,10]", "m", limits)),
               io::ModelErrors);
  EXPECT_NO_THROW(static_cast<void>(io::SourceTree::parse("[1,2,3,4,5,6,7,8,9]", "m", limits)));
  limits.bytes = 3;
  EXPECT_THROW(static_cast<void>(io::SourceTree::parse("a: 1", "m", limits)), io::ModelErrors);
}

TEST(Diagnostics, UnderlineTheValue) {
  const io::SourceText text("m.yaml", "a: {b: [1, 2], c: \"x y\", d: word}  # note\né: µm\n");
  const auto underlined = [&](int line, int column) {
    const std::string excerpt = text.excerpt(line, column);
    return excerpt.substr(excerpt.find('\n') + 1);
  };
  EXPECT_EQ(underlined(1, 1), "      | ^");
  EXPECT_EQ(underlined(1, 8), "      |        ^~~~~~");
  EXPECT_EQ(underlined(1, 19), "      |                   ^~~~~");
  EXPECT_EQ(underlined(1, 29), "      |                             ^~~~");
  EXPECT_EQ(underlined(2, 5), "      |    ^~");  // Characters count, not bytes.
}

TEST(Diagnostics, CutLongLines) {
  const io::SourceText text("m.yaml", std::string(500, 'a') + " bad " + std::string(500, 'c'));
  const std::string excerpt = text.excerpt(1, 502, 3);
  EXPECT_LT(excerpt.size(), 500U);
  EXPECT_NE(excerpt.find(" bad "), std::string::npos);
  const std::size_t second = excerpt.find('\n') + 1;
  EXPECT_EQ(excerpt.find('^') - second, excerpt.find("bad"));
}

}  // namespace
}  // namespace polhode::source_tree_tests
