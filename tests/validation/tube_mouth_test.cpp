// SPDX-License-Identifier: Apache-2.0
// Bodies on and in the mouth of a tube: a ball, an egg, a cone, a lid and pens.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::tube_mouth_tests {
namespace {

/// Radius of the mouth, and rounding of its rim, 1e-3 of the median edge of the polygon [m].
constexpr double kMouth = 0.02, kRounding = 1e-5;

/// A tube whose upper end lies at z = 0 and a body of 1 kg.
/// @param body  Its keys but the mass. @param contact  Keys of contacts.default.
Simulation on_mouth(const std::string& body, const std::string& contact, double duration,
                    double step) {
  return Simulation(io::read_model_text(
      format("format: 1\ngravity: [0, 0, -9.81]\nbodies:\n"
             "  tube: {{fixed: true, shape: {{tube: [0.06, 0.04, 0.06]}}, position: [0, 0, "
             "-0.03]}}\n"
             "  plane: {{fixed: true, shape: {{plane: z}}, position: [0, 0, -0.06]}}\n"
             "  body: {{mass: 1, com: [0, 0, 0], position_of: com, {}}}\n"
             "contacts: {{default: {{{}}}}}\n"
             "analysis: {{type: dynamics, duration: {} s, step: {} s}}\n",
             body, contact, duration, step),
      "m.yaml"));
}

/// Height of the centre of a ball of radius R, whose distance from the circle within the rounding
/// is R plus the rounding.
double height_of_ball(double R) {
  const double across = kMouth + kRounding;
  return std::sqrt((R + kRounding) * (R + kRounding) - across * across) - kRounding;
}

/// Height of the centre of an ellipsoid of revolution, from the minimum distance to its meridian.
double height_of_egg(double a, double c) {
  double low = 0.0, high = c;
  for (int k = 0; k < 60; ++k) {
    const double z = 0.5 * (low + high);
    double least = 1.0;
    for (int i = 0; i <= 200000; ++i) {
      const double u = 0.5 * std::numbers::pi * i / 200000;
      least = std::min(
          least, std::hypot(a * std::cos(u) - kMouth - kRounding, z - c * std::sin(u) + kRounding));
    }
    const bool inside =
        std::pow((kMouth + kRounding) / a, 2) + std::pow((z + kRounding) / c, 2) < 1.0;
    (inside || least < kRounding ? low : high) = z;
    if (high - low < 1e-9) break;
  }
  return 0.5 * (low + high);
}

/// Height of the centroid of a cone with its apex below, from the distance to its flank.
double height_of_cone(double R, double length) {
  const double slant = std::hypot(R, length), s = R / slant, c = length / slant;
  return (kRounding - (kMouth + kRounding) * c) / s - kRounding + 0.75 * length;
}

/// Bodies that touch all of the rim at once, or in two places, at the height of the closed form. A
/// ball used to end 1.8 mm lower by `nonsmooth`, a cone 0.5 mm higher.
TEST(TubeMouth, HoldsBodiesAtTheHeightOfTheClosedForm) {
  struct Resting {
    std::string body;
    double height;
  };
  const double chord = 5e-3;  // height of a pen or lid on the end
  const Resting all[] = {
      {"shape: {sphere: 0.06}, inertia: [3.6e-4, 3.6e-4, 3.6e-4], position: [0, 0, 0.0225]",
       height_of_ball(0.03)},
      {"shape: {ellipsoid: [0.06, 0.06, 0.08]}, inertia: [5e-4, 5e-4, 3.6e-4], position: [0, 0, "
       "0.03]",
       height_of_egg(0.03, 0.04)},
      {"shape: {cone: [0.06, 0.06]}, inertia: [2e-4, 2e-4, 2.7e-4], position: [0, 0, 0.0053], "
       "orientation: {axis: x, angle: 180 deg}",
       height_of_cone(0.03, 0.06)},
      {"shape: {capsule: [0.01, 0.1]}, inertia: [8e-4, 8e-4, 1e-5], position: [0, 0.008, 0.0053], "
       "orientation: {axis: y, angle: 90 deg}",
       chord},
      {"shape: {cylinder: [0.01, 0.1]}, inertia: [8e-4, 8e-4, 1e-5], position: [0, 0.008, 0.0053], "
       "orientation: {axis: y, angle: 90 deg}",
       chord},
      {"shape: {cylinder: [0.1, 0.01]}, inertia: [6e-4, 6e-4, 1.1e-3], position: [0.003, 0, "
       "0.0053]",
       chord},
      {"shape: {box: [0.1, 0.1, 0.01]}, inertia: [8e-4, 8e-4, 1.5e-3], position: [0.003, 0, "
       "0.0053]",
       chord}};
  for (const Resting& resting : all)
    for (const std::string law : {"barrier", "nonsmooth"})
      for (const double step : {1e-2, 5e-3, 1e-3, 1e-4}) {
        SCOPED_TRACE(format("{} by {} at {} s", resting.body, law, step));
        Simulation s = on_mouth(resting.body, format("law: {}, friction: 0.3", law),
                                step < 1e-3 ? 0.05 : 0.3, step);
        const RunSummary end = s.run();
        ASSERT_EQ(end.end, RunEnd::finished) << end.message;
        // The non-smooth law keeps what it has of the landing, an error of order 2 that depends on
        // the height of the start: 1.7e-5 m for the cone at 10 ms, after 10 µm more.
        const double landing = law == "nonsmooth" ? 0.04 * 9.81 * step * step : 0.0;
        EXPECT_NEAR(s.body("body").r.z(), resting.height, 1e-5 + landing);
        EXPECT_LT(s.body("body").v.norm(), 1e-3);
      }
}

/// Bars that lie along a sleeve, and a pin that is half in it, by the closed forms of their section
/// in the bore of 20 mm.
TEST(TubeMouth, HoldsShaftsInASleeve) {
  struct Lying {
    std::string body;
    double height;
  };
  // An edge of the square bar, with its rounding of 1e-2 mm, touches the bore.
  const double edge = 0.01 - 1e-5,
               square = edge - std::sqrt(std::pow(0.02 - 1e-5, 2) - edge * edge);
  const std::string inertia = "inertia: [1e-3, 1e-3, 6e-4], ";
  const Lying all[] = {
      {"shape: {cylinder: [0.036, 0.12]}, " + inertia + "position: [0, 0, -0.0019]", -0.002},
      {"shape: {cylinder: [0.036, 0.06]}, " + inertia + "position: [0.02, 0, -0.0019]", -0.002},
      {"shape: {capsule: [0.036, 0.12]}, " + inertia + "position: [0, 0, -0.0019]", -0.002},
      {"shape: {box: [0.02, 0.02, 0.12]}, " + inertia + "position: [0, 0, -0.0072]", square},
      {"shape: {cylinder: [0.0396, 0.12]}, " + inertia + "position: [0, 0, -0.0001]", -2e-4}};
  for (const Lying& lying : all)
    for (const std::string law : {"barrier", "nonsmooth"})
      for (const double step : {5e-3, 1e-3, 1e-4})
        for (const double tilt : {0.0, 2e-3}) {
          SCOPED_TRACE(format("{} by {} at {} s, tilted by {}", lying.body, law, step, tilt));
          if (tilt > 0.0 && lying.height == -2e-4) continue;  // it does not fit
          Simulation s(io::read_model_text(
              format("format: 1\ngravity: [0, 0, -9.81]\nbodies:\n"
                     "  sleeve: {{fixed: true, shape: {{tube: [0.06, 0.04, 0.06]}}, orientation: "
                     "{{axis: y, angle: 90 deg}}}}\n"
                     "  bar: {{mass: 1, com: [0, 0, 0], position_of: com, {}, orientation: {{axis: "
                     "y, angle: {} rad}}}}\n"
                     "contacts: {{default: {{law: {}, friction: 0.3}}}}\n"
                     "analysis: {{type: dynamics, duration: {} s, step: {} s}}\n",
                     lying.body, 0.5 * std::numbers::pi + tilt, law, step < 1e-3 ? 0.05 : 0.2,
                     step),
              "m.yaml"));
          const RunSummary end = s.run();
          ASSERT_EQ(end.end, RunEnd::finished) << end.message;
          EXPECT_NEAR(s.body("bar").r.z(), lying.height, 5e-6);
          EXPECT_LT(std::abs((s.body("bar").q * Vec3::UnitZ()).z()), 1e-4);
          EXPECT_LT(std::abs(end.contacts->numerical), law == "barrier" ? 1e-10 : 1e-5);
        }
}

/// Angular momentum about the vertical axis of a body of 1 kg [kg m²/s].
double about_axis(const BodyMotion& m, const Vec3& inertia) {
  const Mat3 L = m.Lambda();
  return (m.r.cross(m.v) + L * inertia.cwiseProduct(m.W)).z();
}

/// A pen that stands in the tube, leans on its rim and runs about the axis without friction. The
/// rim is a circle, so that the angular momentum about the axis stays, also when the pen first
/// slides down to the wall, but for the error of the steps. On a polygon of 48 sides pens lost a
/// fifth to all of it in a turn.
TEST(TubeMouth, LetsPensRunAboutTheAxis) {
  const Vec3 inertia(1e-3, 1e-3, 1e-5);
  const double rate = 6.0, lower = -0.012, half = 0.05, thick = 0.004;
  const double across = kMouth - lower, up = 0.06 - thick,
               lean = std::atan2(across, up) - std::asin((thick + 5e-4) / std::hypot(across, up));
  const Vec3 middle(lower + half * std::sin(lean), 0.0,
                    -0.06 + thick + 1e-3 + half * std::cos(lean));
  for (const std::string shape :
       {"{capsule: [0.008, 0.108]}", "{cylinder: [0.008, 0.1]}", "{box: [0.0055, 0.0055, 0.1]}"})
    for (const std::string law : {"barrier", "nonsmooth"})
      for (const double step : {1e-2, 5e-3, 1e-3, 1e-4}) {
        SCOPED_TRACE(format("{} by {} at {} s", shape, law, step));
        Simulation s = on_mouth(
            format("shape: {}, inertia: [1e-3, 1e-3, 1e-5], position: [{}, 0, {}], orientation: "
                   "{{axis: y, angle: {} rad}}, velocity: [0, {}, 0], angular_velocity: [0, 0, {}]",
                   shape, middle.x(), middle.z(), lean, rate * middle.x(), rate),
            format("law: {}, friction: 0", law), step < 1e-3 ? 0.1 : 1.0, step);
        const double start = about_axis(s.body("body"), inertia);
        const RunSummary end = s.run();
        ASSERT_EQ(end.end, RunEnd::finished) << end.message;
        EXPECT_NEAR(about_axis(s.body("body"), inertia) / start, 1.0, 100.0 * step * step);
        EXPECT_LT(s.body("body").r.z(), middle.z());
      }
}

}  // namespace
}  // namespace polhode::tube_mouth_tests
