// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gtest/gtest.h>

#include <support/run_text.hpp>

namespace polhode::model_faults_tests {
namespace {

const std::string kSlider =
    "format: 1\n"
    "bodies:\n"
    "  pinion: {mass: 1, inertia: [1, 1, 1]}\n"
    "  rack: {mass: 1, inertia: [1, 1, 1]}\n"
    "joints:\n"
    "  hinge: {type: revolute, bodies: [ground, pinion], at: [0, 0, 0], axis: z}\n"
    "  rail: {type: prismatic, bodies: [ground, rack], at: [0, 0, 0], axis: x}\n";
const std::string kShort = "analysis: {duration: 1, step: 0.1}\n";

TEST(ModelFaults, OfAnAnalysisNameTheTypeThatAKeyGoesWith) {
  test::expect_fault(kSlider + "analysis: {duration: 1, step: 0.1, load_steps: 3}\n",
                     "analysis.load_steps: cannot be combined with type dynamics. It requires type "
                     "statics or modes.");
}

TEST(ModelFaults, OfARackAndPinionNameTheOrderOfItsJoints) {
  const auto with = [](const char* joints) {
    return kSlider + kShort + "loads:\n  teeth: {type: gear, joints: [" + joints +
           "], radius: 0.1}\n";
  };
  EXPECT_EQ(test::fault_of(with("rail, hinge")), "");
  test::expect_fault(with("hinge, rail"),
                     "loads.teeth.joints: the turning joint is named before the sliding one. "
                     "Exchange the two joints.");
}

TEST(ModelFaults, OfAMotorNameTheFreeCoordinates) {
  const auto with = [](const char* motor) {
    return kSlider + kShort + "loads:\n  drive: {" + motor + "}\n";
  };
  test::expect_fault(with("type: rotary_motor, joint: hinge, coordinate: rx, speed: 1"),
                     "loads.drive.coordinate: 'rx' is not free as an angle in 'hinge' (revolute). "
                     "Free are: rz.");
  test::expect_fault(with("type: linear_motor, joint: rail, coordinate: y, speed: 1"),
                     "loads.drive.coordinate: 'y' is not free as a displacement in 'rail' "
                     "(prismatic). Free are: z.");
}

TEST(ModelFaults, OfABeamAlongAnArcNameItsPointsOrElements) {
  const auto with = [](const char* arc, const char* elements) {
    return std::string(
               "format: 1\nmaterials: {steel: {type: elastic, youngs_modulus: 2e11, poisson_ratio: "
               "0.3, density: 8000}}\nsections: {rod: {type: circle, diameter: 0.01, material: "
               "steel}}\nbeams:\n  hoop: {arc: ") +
           arc + ", elements: " + elements + ", section: rod, up: z, bonded: {ground: start}}\n" +
           kShort;
  };
  test::expect_fault(with("[[0, 0, 0], [1, 1, 0], [2, 2, 0]]", "4"),
                     "beams.hoop.arc: has its three points on one line. Use points: [start, end] "
                     "for a straight beam.");
  test::expect_fault(with("[[1, 0, 0], [0, 1, 0], [-1, 0, 0]]", "1"),
                     "beams.hoop.elements: is 1: one element turns by 3.14 rad, more than ");
}

}  // namespace
}  // namespace polhode::model_faults_tests
