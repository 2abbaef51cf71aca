// SPDX-License-Identifier: Apache-2.0
// Files whose tags are nested deeper than the parser of XML allows.
#include "mjcf_fixture.hpp"

namespace polhode::xml_depth_tests {
namespace {

using namespace mjcf_tests;

class XmlDepth : public Mjcf {
 protected:
  /// A rope: bodies one in the other on balls, each 0.1 m below, one a line.
  static std::string rope(int count, const std::string& last = "") {
    std::string text = "<worldbody>";
    for (int k = 0; k < count; ++k)
      text += format(
          "<body name='b{}' pos='0 0 -0.1'><!-- > <body> --><joint name='j{}' type='ball'/>{}\n", k,
          k, kBall);
    text += last;
    for (int k = 0; k < count; ++k) text += "</body>";
    return text + "</worldbody>\n";
  }
};

TEST_F(XmlDepth, ARopeHasAllItsBodies) {
  for (const int count : {70, 90, 150, 300, 480}) {
    const Model model = read(rope(count));
    ASSERT_EQ(model.bodies.size(), static_cast<std::size_t>(count + 1)) << count;
    for (int k : {0, count / 2, count - 1})
      EXPECT_NEAR(
          model.bodies[static_cast<std::size_t>(model.body_index(format("b{}", k)))].position.z(),
          -0.1 * (k + 1), 1e-12)
          << count;
  }
}

TEST_F(XmlDepth, ErrorsHaveTheirLines) {
  // The first line is <mujoco>; the last body's line has a bad number.
  EXPECT_THAT(fault(rope(200, "<joint name='x' pos='0 0'/>\n")), HasSubstr("robot.xml:202:"));
  EXPECT_THAT(notes(rope(200, "<strange/>\n")), HasSubstr("202: ignored: <strange>"));
  std::string open = rope(200);
  open.replace(open.find("</body></body></worldbody>"), 7, "</bode>");
  EXPECT_THAT(fault(open), HasSubstr("the text is not XML"));
  EXPECT_THAT(fault(rope(600)), HasSubstr("tags are nested more than 500 deep"));
  EXPECT_THAT(fault(rope(200, "<polhode-part number='1'/>")), HasSubstr("is not allowed"));
}

}  // namespace
}  // namespace polhode::xml_depth_tests
