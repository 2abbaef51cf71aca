// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/read/model_places.hpp>

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/scratch.hpp>

namespace polhode::model_places_tests {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* kModel = R"(format: 1
bodies:
  crank: {mass: 1, inertia: [1, 1, 1]}
joints:
  A:
    type: revolute
    bodies: [ground, crank]
    at: [0, 0, 0]
    axis: z
parts:
  left: {file: part.yaml}
analysis:
  duration: 1
  step: 0.1
)";

constexpr const char* kPart = R"(format: 1
bodies:
  wheel:
    mass: 2
    inertia: [1, 1, 1]
)";

struct Files {
  test::Scratch scratch;
  std::string main = scratch / "model.yaml";
  Files() {
    std::ofstream(main) << kModel;
    std::ofstream(scratch / "part.yaml") << kPart;
  }
  [[nodiscard]] std::string text(const InputError& error,
                                 const io::Overrides& overrides = {}) const {
    const io::ModelPlaces places(io::read_model(main, overrides), overrides);
    const auto found = places.located(error);
    return found ? found->text() : "";
  }
};

TEST(ModelPlaces, AreThoseOfTheDeepestEntryThatAnErrorNames) {
  const Files f;
  EXPECT_EQ(f.text(InputError("joints.A.type", "is odd", "Change it")),
            f.main +
                ":6:11: error: joints.A.type: is odd. Change it.\n"
                "    6 |     type: revolute\n"
                "      |           ^~~~~~~~");
  EXPECT_THAT(f.text(InputError("joints.A.friction", "is odd", "Change it")),
              StartsWith(f.main + ":5:3: error: joints.A.friction: is odd."));
  EXPECT_THAT(f.text(InputError("analysis.step", "is odd", "Change it")),
              StartsWith(f.main + ":14:9: "));
  EXPECT_THAT(f.text(InputError("analysis.solver", "is odd", "Change it")),
              StartsWith(f.main + ":12:1: "));
}

TEST(ModelPlaces, AreThoseOfAThingNamedInTheText) {
  const Files f;
  EXPECT_THAT(f.text(InputError("the start", "cannot be assembled: 'A' is far", "Move it")),
              StartsWith(f.main + ":5:3: error: the start: cannot be"));
  EXPECT_THAT(f.text(InputError("the start", "cannot be assembled", "Move it")),
              StartsWith(f.main + ":1:1: "));
}

TEST(ModelPlaces, AreInTheFileOfAPart) {
  const Files f;
  const std::string part = f.scratch / "part.yaml";
  EXPECT_THAT(f.text(InputError("bodies.left_wheel.mass", "is odd", "Change it")),
              StartsWith(part + ":4:11: error: bodies.left_wheel.mass: "));
}

TEST(ModelPlaces, AreTheOptionThatSetsAnEntry) {
  const Files f;
  EXPECT_EQ(f.text(InputError("analysis.solver", "is odd", "Change it"), {"analysis.solver=tree"}),
            "--set analysis.solver=tree: error: analysis.solver: is odd. Change it.");
}

TEST(ModelPlaces, AreNotGivenToErrorsOfOtherFilesAndOptions) {
  const Files f;
  const std::vector<std::string> others{f.scratch / "part.yaml", "--set", "polhode view",
                                        "out/results.h5"};
  for (const std::string& where : others)
    EXPECT_EQ(f.text(InputError(where, "is odd", "Change it")), "") << where;
  EXPECT_FALSE(io::ModelPlaces().located(InputError("bodies.a", "is odd", "Change it")));
  Model in_code;
  EXPECT_FALSE(io::ModelPlaces(in_code).located(InputError("bodies.a", "is odd", "Change it")));
}

TEST(ModelPlaces, OfTheSolverAreThoseOfWhatItNamesOrOfTheAnalysis) {
  const Files f;
  const io::ModelPlaces places(io::read_model(f.main));
  EXPECT_THAT(places.located(SolveError("the matrix of 'crank' is singular", "Hold it"))->text(),
              StartsWith(f.main + ":3:3: error: the matrix of 'crank' is singular. Hold it."));
  EXPECT_THAT(places.located(SolveError("the matrix is singular", "Hold it"))->text(),
              StartsWith(f.main + ":12:1: "));
}

}  // namespace
}  // namespace polhode::model_places_tests
