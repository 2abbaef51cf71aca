// SPDX-License-Identifier: Apache-2.0
#include <polhode/study/batch_channel.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <polhode/core/error.hpp>
#include <polhode/io/read/read_model.hpp>

namespace polhode::batch_channel_tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Model model() {
  return io::read_model_text(
      "format: 1\nbodies:\n"
      "  bar: {shape: {box: [1, 0.05, 0.05]}, density: 1000, position: [0.5, 0, 0]}\n"
      "  bar2: {shape: {box: [1, 0.05, 0.05]}, density: 1000, position: [1.5, 0, 0]}\n"
      "joints:\n  A: {type: revolute, bodies: [ground, bar], at: [0, 0, 0], axis: y}\n"
      "  B: {type: cylindrical, bodies: [bar, bar2], at: [1, 0, 0], axis: y}\n"
      "loads:\n  spring: {type: spring_damper, bodies: [ground, bar2], at: [[2, 0, 1], [2, 0, 0]], "
      "stiffness: 10}\n"
      "output: {probes: {tip: {body: bar, point: [0.5, 0, 0]}}}\n",
      "bars.yaml");
}

std::string message(const std::string& text) {
  try {
    (void)batch_channel(model(), text);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(BatchChannel, NamesColumnsOfObjects) {
  const Model m = model();
  EXPECT_THAT(batch_channel(m, "bodies.bar.position").columns, ElementsAre(0, 1, 2));
  EXPECT_THAT(batch_channel(m, "bodies.bar.velocity").columns, ElementsAre(3, 4, 5));
  EXPECT_THAT(batch_channel(m, "bodies.bar.orientation").columns, ElementsAre(9, 10, 11, 12));
  EXPECT_THAT(batch_channel(m, "bodies.bar.angular_velocity").columns, ElementsAre(13, 14, 15));
  EXPECT_EQ(batch_channel(m, "bodies.bar.angular_velocity").unit, "rad/s");
  EXPECT_THAT(batch_channel(m, "bodies.bar.orientation.w").columns, ElementsAre(9));
  EXPECT_THAT(batch_channel(m, "bodies.bar.position.z").columns, ElementsAre(2));
  EXPECT_TRUE(batch_channel(m, "bodies.bar.position.z").one);
  EXPECT_FALSE(batch_channel(m, "bodies.bar.position").one);
  EXPECT_EQ(batch_channel(m, "bodies.bar2.position").of.target, "bar2");
  EXPECT_THAT(batch_channel(m, "joints.B.coordinates").columns, ElementsAre(6, 7));
  EXPECT_THAT(batch_channel(m, "joints.B.rates").columns, ElementsAre(8, 9));
  EXPECT_THAT(batch_channel(m, "joints.B.coordinates.1").columns, ElementsAre(7));
  EXPECT_THAT(batch_channel(m, "joints.A.force").columns, ElementsAre(0, 1, 2));
  EXPECT_THAT(batch_channel(m, "joints.A.rate rz").columns, ElementsAre(7));
  EXPECT_EQ(batch_channel(m, "joints.A.rate rz").unit, "rad/s");
  EXPECT_THAT(batch_channel(m, "probes.tip").columns.size(), 9U);
  EXPECT_THAT(batch_channel(m, "probes.tip.vz").columns, ElementsAre(5));
  EXPECT_EQ(batch_channel(m, "loads.spring.length").unit, "m");
}

TEST(BatchChannel, SaysWhatIsNotKnown) {
  EXPECT_THAT(message("bodies.bat.position"), HasSubstr("names no body of the model"));
  EXPECT_THAT(message("bodies.bat.position"), HasSubstr("Did you mean 'bar'?"));
  EXPECT_THAT(message("bodies.bar.positoin"), HasSubstr("Did you mean 'position'?"));
  EXPECT_THAT(message("bodies.bar.position.w"), HasSubstr("has no 'position.w'"));
  EXPECT_THAT(message("joints.A.coordinates.1"), HasSubstr("has no 'coordinates.1'"));
  EXPECT_THAT(message("body.bar"), HasSubstr("Write bodies.NAME.position"));
  EXPECT_THAT(message("time"), HasSubstr("is not known"));
}

TEST(BatchChannel, AModelsUsualOnesAreItsProbesOrItsBodies) {
  Model m = model();
  EXPECT_THAT(usual_channels(m), ElementsAre("probes.tip"));
  m.output.probes.clear();
  m.bodies[1].fixed = true;
  EXPECT_THAT(usual_channels(m), ElementsAre("bodies.bar.position", "bodies.bar.orientation"));
}

}  // namespace
}  // namespace polhode::batch_channel_tests
