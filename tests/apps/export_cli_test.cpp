// SPDX-License-Identifier: Apache-2.0
// Models as robots' files on the command line.
#include <string>

#include <gmock/gmock.h>

#include "command_line.hpp"

namespace polhode::export_cli_tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class Exporter : public test::CommandLine {};

TEST_F(Exporter, WritesAFileThatIsReadAgain) {
  const auto written = run({"export", "model.yaml", "robot.xml"});
  ASSERT_EQ(written.code, 0) << written.err;
  EXPECT_EQ(written.out + written.err, "");
  const auto report = run({"import", "robot.xml", "--json"});
  ASSERT_EQ(report.code, 0) << report.err;
  EXPECT_EQ(value(report.out, "freedoms"), "4");
  EXPECT_NEAR(std::stod(value(report.out, "mass")), 5.0, 1e-12);
  // And from one format to the other.
  EXPECT_EQ(run({"export", "robot.xml", "again.xml"}).code, 0);
}

TEST_F(Exporter, RefusesByNameWhatTheFormatHasNot) {
  const auto refused = run({"export", "model.yaml", "robot.urdf"});
  EXPECT_EQ(refused.code, 3);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("joints.B: a URDF has no joint of the type spherical"),
                                 HasSubstr("model.yaml:9:")));
  EXPECT_FALSE(exists("robot.urdf"));
  const auto partial = run({"export", "model.yaml", "robot.urdf", "--allow-partial"});
  EXPECT_EQ(partial.code, 0);
  EXPECT_THAT(partial.err, HasSubstr("left out: joints.B: a URDF has no joint of the type"));
  EXPECT_TRUE(exists("robot.urdf"));
  const auto json = run({"export", "model.yaml", "robot.urdf", "--allow-partial", "--json"});
  EXPECT_THAT(json.out,
              AllOf(HasSubstr("\"format\": \"URDF\""), HasSubstr("\"kind\": \"left out\""),
                    HasSubstr("\"path\": \"joints.B\"")));
}

TEST_F(Exporter, SaysWhatIsWrongWithItsArguments) {
  const auto ending = run({"export", "model.yaml", "robot.step"});
  EXPECT_EQ(ending.code, 2);
  EXPECT_THAT(ending.err, HasSubstr("'robot.step' is not the name of a URDF or MJCF. Name a .urdf "
                                    "or .xml file."));
  const auto folder = run({"export", "model.yaml", "missing/robot.xml"});
  EXPECT_EQ(folder.code, 5);
  EXPECT_THAT(folder.err, HasSubstr("missing/robot.xml"));
  EXPECT_EQ(run({"export", "nothing.yaml", "robot.xml"}).code, 5);
  ASSERT_EQ(run({"export", "model.yaml", "robot.xml"}).code, 0);
  const auto itself = run({"export", "robot.xml", "robot.xml"});
  EXPECT_EQ(itself.code, 2);
  EXPECT_THAT(itself.err, HasSubstr("the output is the model itself. Name another file."));
}

}  // namespace
}  // namespace polhode::export_cli_tests
