// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>

#include <polhode/core/version.hpp>
#include <polhode/io/schema/field_table.hpp>
#include <polhode/io/schema/schema.hpp>
#include <support/paths.hpp>

namespace polhode::schema_tests {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = test::source_dir();

TEST(Schema, NamesEveryFieldWithItsMeaning) {
  const std::string schema = io::json_schema();
  for (const io::FieldTable* table : io::all_field_tables()) {
    for (const io::Field& field : table->fields) {
      EXPECT_NE(schema.find("\"" + field.name + "\""), std::string::npos) << table->title;
      EXPECT_FALSE(field.meaning.empty()) << table->title << " " << field.name;
    }
  }
}

/// Release by release, so that "0.10" comes after "0.9".
std::pair<int, int> version_of(const std::string& text) {
  const std::size_t dot = text.find('.');
  return {std::stoi(text.substr(0, dot)), std::stoi(text.substr(dot + 1))};
}

TEST(Schema, NamesTheVersionsOfEveryField) {
  const auto [major, minor] = version_of(version());
  const std::pair<int, int> next(major, minor + 1);
  const std::string page = io::reference_markdown();
  for (const io::FieldTable* table : io::all_field_tables()) {
    for (const io::Field& field : table->fields) {
      SCOPED_TRACE(table->title + " " + field.name);
      EXPECT_LE(version_of(field.since), next);
      if (field.changed.empty()) continue;
      EXPECT_LT(version_of(field.since), version_of(field.changed));
      EXPECT_LE(version_of(field.changed), next);
      EXPECT_NE(page.find("| " + field.since + ", changed in " + field.changed + " |"),
                std::string::npos);
    }
  }
}

TEST(Schema, DefinesAllItsReferences) {
  const std::string schema = io::json_schema();
  const std::string mark = "\"#/$defs/";
  for (std::size_t k = schema.find(mark); k != std::string::npos; k = schema.find(mark, k + 1)) {
    const std::size_t start = k + mark.size();
    const std::string name = schema.substr(start, schema.find('"', start) - start);
    EXPECT_NE(schema.find("\n    \"" + name + "\": {"), std::string::npos) << name;
  }
}

/// The published schema accepts the good models and refuses those with wrong keys or kinds.
TEST(Schema, AgreesWithTheReader) {
  const fs::path file = fs::temp_directory_path() / "polhode_schema_test.json";
  std::ofstream(file) << io::json_schema();
  const std::string command = "python3 \"" +
                              (kRoot / "tests/io/schema/validate_schema.py").string() + "\" \"" +
                              file.string() + "\" \"" + (kRoot / "tests/corpus").string() + "\"";
  const int status = std::system(command.c_str());
  fs::remove(file);
  const int code = status < 0 ? 77 : (status >> 8) & 0xFF;
  if (code == 77 || code == 127)
    GTEST_SKIP() << "python3 with jsonschema and yaml is not installed";
  EXPECT_EQ(code, 0);
}

/// docs/reference/model_file.md is made from the field tables. To regenerate it, run this test with
/// POLHODE_WRITE_REFERENCE=1 in the environment.
TEST(Schema, ReferencePageIsUpToDate) {
  const fs::path page = kRoot / "docs/reference/model_file.md";
  if (std::getenv("POLHODE_WRITE_REFERENCE")) {
    fs::create_directories(page.parent_path());
    std::ofstream(page) << io::reference_markdown();
  }
  std::ifstream stream(page);
  std::ostringstream text;
  text << stream.rdbuf();
  EXPECT_TRUE(text.str() == io::reference_markdown())
      << "Run this test with POLHODE_WRITE_REFERENCE=1 to write " << page;
}

}  // namespace
}  // namespace polhode::schema_tests
