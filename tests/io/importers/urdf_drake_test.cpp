// SPDX-License-Identifier: Apache-2.0
// Joints of Drake's name space in a URDF.
#include <cmath>
#include <fstream>
#include <numbers>

#include <gmock/gmock.h>

#include <polhode/io/read/read_model.hpp>
#include <polhode/io/text/diagnostics.hpp>
#include <polhode/newton/rank_report.hpp>
#include <polhode/simulation/simulation.hpp>

#include <support/scratch.hpp>

namespace polhode::urdf_drake_tests {
namespace {

using testing::HasSubstr;

class UrdfOfDrake : public testing::Test {
 protected:
  [[nodiscard]] Model read(const std::string& type, const std::string& inside) const {
    std::ofstream(folder_ / "robot.urdf")
        << "<robot name='r' xmlns:drake='http://drake.mit.edu'><link name='base'/>"
           "<link name='arm'><inertial><origin xyz='0 0 -0.5'/><mass value='2'/>"
           "<inertia ixx='0.3' iyy='0.3' izz='0.2'/></inertial></link>"
           "<drake:joint name='j' type='" +
               type + "'><parent link='base'/><child link='arm'/>" + inside +
               "</drake:joint></robot>";
    return io::read_model(folder_ / "robot.urdf", {});
  }
  [[nodiscard]] std::string fault(const std::string& type, const std::string& inside) const {
    try {
      static_cast<void>(read(type, inside));
    } catch (const io::ModelErrors& errors) {
      return errors.text();
    }
    return "none";
  }
  /// Body of the link after a time, by steps of a length.
  [[nodiscard]] static BodyMotion after(Model model, double time, double step) {
    model.analysis.step = step;
    Simulation s(std::move(model));
    while (s.time() < time - 1e-9) s.step(time);
    return s.body("arm");
  }
  test::Scratch folder_;
};

/// Coordinates that are free.
int freedoms(const Model& model) {
  const Simulation s(model);
  return rank_report(s.system(), s.state()).mobility;
}

TEST_F(UrdfOfDrake, HasTheFreedomsOfItsTypes) {
  EXPECT_EQ(freedoms(read("floating", "")), 6);
  EXPECT_EQ(freedoms(read("ball", "")), 3);
  EXPECT_EQ(freedoms(read("planar", "")), 3);
  EXPECT_EQ(freedoms(read("universal", "")), 2);
  EXPECT_EQ(freedoms(read("screw", "<drake:screw_thread_pitch value='0.1'/><axis xyz='0 0 1'/>")),
            1);
}

// The plane is that of x and y of the joint's frame, here turned by 0.3 about x: the weight along
// it is m g sin 0.3.
TEST_F(UrdfOfDrake, MovesInThePlaneAcrossZ) {
  for (const double step : {0.05, 0.005, 0.0005}) {
    const BodyMotion arm = after(read("planar", "<origin rpy='0.3 0 0'/>"), 0.5, step);
    const double way = -0.5 * 9.81 * std::sin(0.3) * 0.25;
    // The link's coordinates begin at the joint.
    const Vec3 origin = arm.r + arm.Lambda() * Vec3(0, 0, 0.5);
    EXPECT_NEAR((origin - way * Vec3(0, std::cos(0.3), std::sin(0.3))).norm(), 0.0, 1e-12) << step;
  }
}

// z'' = -g / (1 + J (2 pi / pitch)^2 / m); turns are of second order.
TEST_F(UrdfOfDrake, FallsAlongTheThread) {
  const double pitch = 0.4, turn = 2.0 * std::numbers::pi / pitch;
  for (const double step : {0.05, 0.005, 0.0005}) {
    const BodyMotion arm = after(
        read("screw", "<axis xyz='0 0 1'/><drake:screw_thread_pitch value='0.4'/>"), 0.2, step);
    const double way = -0.5 * 9.81 / (1.0 + 0.2 * turn * turn / 2.0) * 0.04;
    EXPECT_NEAR(arm.r.z() + 0.5, way, 1e-3 * step * step) << step;
    // A right-handed thread.
    EXPECT_NEAR(arm.omega().z(), way / 0.2 * 2.0 * turn, 0.1 * step * step) << step;
  }
}

// About x on the parent and y on the child: the arm at rest turns about neither z nor an axis
// between.
TEST_F(UrdfOfDrake, TurnsAboutXAndY) {
  const Model model = read("universal", "");
  ASSERT_EQ(model.joints.size(), 1U);
  EXPECT_EQ(model.joints[0].type, "universal");
  // A pendulum about x, from 0.4: energy is that of the closed form.
  Model swing = model;
  const double J = 0.3 + 2.0 * 0.25;
  swing.bodies.at(static_cast<std::size_t>(swing.body_index("arm"))).angular_velocity =
      Vec3(1.0, 0.0, 0.0);
  swing.bodies.at(static_cast<std::size_t>(swing.body_index("arm"))).velocity = Vec3(0, 0.5, 0);
  for (const double step : {0.01, 0.001}) {
    const BodyMotion arm = after(swing, 0.3, step);
    EXPECT_NEAR(arm.omega().y(), 0.0, 1e-10);
    EXPECT_NEAR(arm.omega().z(), 0.0, 1e-10);
    const double rate = arm.omega().x();
    EXPECT_NEAR(0.5 * J * rate * rate + 2.0 * 9.81 * arm.r.z(), 0.5 * J - 9.81, 20.0 * step * step)
        << step;
    EXPECT_LT(std::abs(rate), 0.9);
  }
}

// J w' = -c w: of a ball that turns about the vertical through its centre of mass.
TEST_F(UrdfOfDrake, DampsABallByItsAngularVelocity) {
  Model model = read("ball", "<dynamics damping='0.4'/>");
  model.bodies.at(static_cast<std::size_t>(model.body_index("arm"))).angular_velocity =
      Vec3(0, 0, 2);
  for (const double step : {0.01, 0.001, 0.0001})
    EXPECT_NEAR(after(model, 0.3, step).omega().z(), 2.0 * std::exp(-0.4 * 0.3 / 0.2),
                10.0 * step * step + 1e-11)
        << step;
}

TEST_F(UrdfOfDrake, IsRefusedWhereTheModelHasNoSuchForce) {
  EXPECT_THAT(fault("revolute", ""),
              HasSubstr("the joint 'j' has the unknown type 'revolute'. Types: floating, ball, "
                        "planar, screw, universal"));
  EXPECT_THAT(fault("screw", ""), HasSubstr("the screw 'j' has no <drake:screw_thread_pitch>"));
  EXPECT_THAT(fault("planar", "<dynamics damping='0 0 1'/>"),
              HasSubstr("the planar joint 'j' has a damping"));
  EXPECT_EQ(fault("planar", "<dynamics damping='0 0 0'/>"), "none");
  EXPECT_THAT(fault("universal", "<dynamics damping='0.1'/>"),
              HasSubstr("the universal joint 'j' has a damping"));
}

}  // namespace
}  // namespace polhode::urdf_drake_tests
