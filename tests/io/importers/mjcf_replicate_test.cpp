// SPDX-License-Identifier: Apache-2.0
// Copies of bodies, sites and geoms of an MJCF. Places and names are those of MuJoCo 4.0.
#include <cmath>

#include "mjcf_fixture.hpp"

namespace polhode::mjcf_tests {
namespace {

const BodySpec& body_named(const Model& model, const std::string& name) {
  for (const BodySpec& body : model.bodies)
    if (body.name == name) return body;
  throw std::runtime_error("no body " + name);
}

/// Three pendulums on a spiral stair, each with a ring of sites.
const std::string kStair =
    "<worldbody><site name='o' pos='5 0 0'/>"
    "<replicate count='3' offset='0 0 1' euler='0 0 30' sep='-'>"
    "<body name='a' pos='1 0 0'><joint name='h' axis='0 1 0'/>"
    "<geom name='g' size='0.1' pos='0.3 0 0' mass='2'/>"
    "<site name='s' pos='0.1 0 0'/>"
    "<replicate count='2' offset='0.2 0 0'><site name='t'/></replicate></body>"
    "</replicate></worldbody>";

TEST_F(Mjcf, ReplicatesAreTurnedAndMovedFromCopyToCopy) {
  const Model model = read(kStair);
  const double root = std::sqrt(0.75);
  const Vec3 places[] = {{1, 0, 0}, {root, 0.5, 1}, {0.5, root, 2}};
  for (int k = 0; k < 3; ++k) {
    const BodySpec& body = body_named(model, format("a-{}", k));
    // The centre of mass is 0.3 m farther from the axis.
    const Vec3 centre = places[k] + 0.3 * Vec3(places[k].x(), places[k].y(), 0.0);
    EXPECT_NEAR((body.position - centre).norm(), 0.0, 2.0 * kRounding) << k;
    EXPECT_NEAR(body.mass, 2.0, kRounding);
  }
  // The coordinate of each joint is that of one pendulum, as the weight turns with none of them.
  const Model single = read_bodies(
      "<body name='a' pos='1 0 0'><joint name='h' axis='0 1 0'/>"
      "<geom name='g' size='0.1' pos='0.3 0 0' mass='2'/></body>");
  for (const double step : {0.02, 0.002, 0.0002}) {
    const auto moved = [&](Model of) {
      of.analysis.step = step;
      Simulation s(std::move(of));
      while (s.time() < 0.1999) s.step(0.2);
      return s;
    };
    const Simulation all = moved(model), one = moved(single);
    const double angle = one.joint("h").coordinates[0];
    EXPECT_GT(std::abs(angle), 0.1);
    for (const char* joint : {"h-0", "h-1", "h-2"})
      EXPECT_NEAR(all.joint(joint).coordinates[0], angle, 1e-11) << joint << " at " << step;
  }
}

// Sites at (0.95262794, 0.55, 1) and, of the inner copies, (1.03923048, 0.6, 1).
TEST_F(Mjcf, ReplicatesGiveTheirNamesTheNumbersOfTheCopies) {
  const auto length = [&](const std::string& site) {
    const Model model = read(kStair + "<tendon><spatial name='line' stiffness='1'><site site='" +
                             site + "'/><site site='o'/></spatial></tendon>");
    return load_of(model, "line")->parameters.at("free_length");
  };
  EXPECT_NEAR(length("s-1"), (Vec3(0.95262794, 0.55, 1) - Vec3(5, 0, 0)).norm(), 1e-8);
  EXPECT_NEAR(length("t1-1"), (Vec3(1.03923048, 0.6, 1) - Vec3(5, 0, 0)).norm(), 1e-8);
  EXPECT_NEAR(length("t0-2"), (Vec3(0.5, 0.8660254, 2) - Vec3(5, 0, 0)).norm(), 1e-8);
  EXPECT_THAT(fault(kStair + "<actuator><motor joint='h'/></actuator>"),
              HasSubstr("there is no joint 'h'. Joints: h-0, h-1, h-2"));
  EXPECT_NE(load_of(read(kStair + "<actuator><motor name='m' joint='h-2'/></actuator>"), "m"),
            nullptr);
  // As many digits as those of the count.
  const Model ten = read_bodies("<replicate count='10' offset='0 0 1'><body name='b'><freejoint/>" +
                                kBall + "</body></replicate>");
  EXPECT_EQ(body_named(ten, "b09").position, Vec3(0, 0, 9));
  EXPECT_EQ(ten.bodies.size(), 11U);
}

TEST_F(Mjcf, ReplicatesAreRefusedWithoutACount) {
  const std::string inside = "<body name='b'><freejoint/>" + kBall + "</body></replicate>";
  EXPECT_THAT(body_fault("<replicate offset='0 0 1'>" + inside),
              HasSubstr("<replicate> has the count 0. Give a whole number from 1"));
  EXPECT_THAT(body_fault("<replicate count='1.5'>" + inside), HasSubstr("has the count 1.5"));
  EXPECT_THAT(body_fault("<replicate count='1e9'>" + inside), HasSubstr("up to 100000"));
  EXPECT_THAT(body_fault("<body name='c'>" + kBall +
                         "<replicate count='2'><joint name='j'/></replicate></body>"),
              HasSubstr("<replicate> has a joint that is not in a body"));
}

}  // namespace
}  // namespace polhode::mjcf_tests
