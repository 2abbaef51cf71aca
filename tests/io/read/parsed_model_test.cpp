// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/read/parsed_model.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <polhode/io/results/model_fingerprint.hpp>

namespace polhode::io::parsed_model_tests {
namespace {

using testing::HasSubstr;

constexpr const char* kText =
    "format: 1\nvariables: {L: 2}\nbodies:\n  bar: {mass: L, inertia: [1, 1, 1], position: [L, 0, "
    "0]}\n";

std::string message(const std::function<void()>& read) {
  try {
    read();
  } catch (const ModelErrors& e) {
    return e.what();
  }
  return "";
}

TEST(ParsedModel, ReadsLikeAModelFileWithAllOverrides) {
  const ParsedModel parsed(kText, "bar.yaml", {"bodies.bar.position.1=3 mm"});
  for (const char* value : {"3", "-0.5e-1", "1+2", "2 m", "[1]", ""}) {
    const Overrides own = {"L=" + std::string(value)};
    Overrides all = {"bodies.bar.position.1=3 mm"};
    all.push_back(own[0]);
    std::string hash, parsed_hash;
    const std::string by_text =
        message([&] { hash = model_fingerprint(read_model_text(kText, "bar.yaml", all)); });
    const std::string by_parsed =
        message([&] { parsed_hash = model_fingerprint(parsed.read(own)); });
    EXPECT_EQ(by_text, by_parsed) << value;
    EXPECT_EQ(hash, parsed_hash) << value;
  }
  EXPECT_EQ(parsed.read().bodies[0].mass, 2.0);
  EXPECT_EQ(parsed.read({"L=5"}).bodies[0].position, Vec3(5.0, 3e-3, 0.0));
  EXPECT_EQ(parsed.read().bodies[0].position, Vec3(2.0, 3e-3, 0.0));
}

TEST(ParsedModel, ReportsFaultsWhereTheyAre) {
  EXPECT_THAT(message([] { const ParsedModel p("bodies: [", "bar.yaml"); }),
              HasSubstr("bar.yaml:1"));
  EXPECT_THAT(message([] { const ParsedModel p(kText, "bar.yaml", {"bodies.baz.mass=1"}); }),
              HasSubstr("--set bodies.baz.mass=1"));
  const ParsedModel parsed(kText, "bar.yaml");
  EXPECT_THAT(message([&] { (void)parsed.read({"bodies.bar.mass=-1"}); }),
              HasSubstr("--set bodies.bar.mass=-1"));
}

}  // namespace
}  // namespace polhode::io::parsed_model_tests
