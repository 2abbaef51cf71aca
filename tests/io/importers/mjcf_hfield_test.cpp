// SPDX-License-Identifier: Apache-2.0
// Height fields of an MJCF. Heights are those where rays of MuJoCo 4.0 meet the field.
#include <cmath>

#include "mjcf_fixture.hpp"

namespace polhode::mjcf_tests {
namespace {

/// A field of 2 x 3 numbers on a grid of squares of 1 m, and a ball above a corner.
std::string field(const std::string& attributes, double x, double y) {
  return "<asset><hfield name='h' nrow='2' ncol='3' size='1 0.5 0.4 0.1'" + attributes +
         "/></asset><worldbody><geom type='hfield' hfield='h' pos='0 0 0.2'/>" +
         format(
             "<body name='b' pos='{} {} 3'><freejoint/>"
             "<geom size='0.1' mass='1' condim='1'/></body></worldbody>",
             x, y);
}

TEST_F(Mjcf, HeightFieldsHaveTheirNumbersInTheRangeOfTheirSize) {
  const Model model = read(field(" elevation='1 2 3 5 6 9'", 0, 0));
  ASSERT_EQ(model.bodies[0].shapes.size(), 1U);
  const ShapeSpec& shape = model.bodies[0].shapes[0];
  EXPECT_EQ(shape.type, "height_field");
  EXPECT_EQ(shape.position, Vec3(0, 0, 0.2));
  ASSERT_EQ(shape.heights.size(), 6U);
  // From -y to +y, -x to +x; of MuJoCo above the geom's 0.2 m: 0.4, 0.45, 0.6, 0.2, 0.25, 0.3.
  const double known[] = {0.2, 0.25, 0.4, 0.0, 0.05, 0.1};
  for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(shape.heights[k], known[k], 1e-15) << k;
  const Model flat = read(field("", 0, 0));
  EXPECT_EQ(flat.bodies[0].shapes[0].heights, std::vector<double>(6, 0.0));
}

// The ball of 0.1 m falls without friction and comes to rest on the field: a flat one at 0.2 m, and
// at the bottom of a valley along y whose sides rise by 0.4 m on 1 m.
TEST_F(Mjcf, HeightFieldsStopWhatFalls) {
  const auto rest = [&](const std::string& attributes, double x, double step) {
    write("robot.xml", "<mujoco>" + field(attributes, x, 0.1) + "</mujoco>");
    Model model = io::read_model(write("model.yaml",
                                       "format: 1\nimport: {file: robot.xml, shapes: collision}\n"
                                       "contacts: {default: {law: rigid, restitution: 0}}\n"));
    model.analysis.step = step;
    Simulation s(model);
    while (s.time() < 1.4999) s.step(1.5);
    return s.body("b").r.z();
  };
  const double up = 0.1 * std::sqrt(1.0 + 0.4 * 0.4);
  for (const double step : {2e-2, 5e-3, 5e-4}) {
    EXPECT_NEAR(rest("", 0.3, step), 0.3, 2e-4) << step;
    EXPECT_NEAR(rest(" elevation='1 0 1 1 0 1'", 0.0, step), 0.2 + up, 2e-4) << step;
  }
}

TEST_F(Mjcf, HeightFieldsThatAreNotReadAreReported) {
  EXPECT_THAT(notes(field(" file='hills.png'", 0, 0)), HasSubstr("<geom type=\"hfield\">"));
  EXPECT_THAT(fault(field(" elevation='1 2 3'", 0, 0)), HasSubstr("'elevation' of <hfield>"));
}

}  // namespace
}  // namespace polhode::mjcf_tests
