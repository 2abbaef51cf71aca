// SPDX-License-Identifier: Apache-2.0
// Contact with the round faces of tubes: rolling within them, tubes rolling and standing on planes,
// boxes and triangles.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>

#include "contact/shapes_for_tests.hpp"
#include "contact/starts.hpp"
#include "support/scratch.hpp"
#include "validation/model_scene.hpp"

namespace polhode::tube_contact_tests {
namespace {

using namespace contact;
using namespace test;

/// A shape that lies along y instead of z.
ShapeSpec along_y(const std::string& type, std::vector<double> sizes) {
  ShapeSpec spec = ModelScene::shape(type, std::move(sizes));
  spec.orientation = Quat((Mat3() << 1, 0, 0, 0, 0, 1, 0, -1, 0).finished());
  return spec;
}

enum class Rolling { ball, capsule, cylinder };

struct Inside {
  Rolling body;
  double dt;
};

std::string name_of(const Inside& c) {
  const char* const body = c.body == Rolling::ball      ? "ball"
                           : c.body == Rolling::capsule ? "capsule"
                                                        : "cylinder";
  return std::string(body) + "_at_" + std::to_string(std::lround(1e6 * c.dt)) + "_us";
}

class RollingInATube : public testing::TestWithParam<Inside> {};

/// Oscillation about the bottom with ω² = g/((1 + k)(R − ρ)), k = I/(m ρ²): the displacement of the
/// centre is ρ times the rotation. With a polygon of 48 sides the error would be 2e-3 of R.
TEST_P(RollingInATube, SwingsOnItsOwnRadius) {
  const auto [kind, dt] = GetParam();
  const double R = 0.5, rho = 0.1, A = 0.1, k = kind == Rolling::ball ? 0.4 : 0.5;
  ModelScene s;
  const BodyMotion start = at({(R - rho) * std::sin(A), 0.003, -(R - rho) * std::cos(A)});
  const int body =
      kind == Rolling::ball
          ? s.add_ball("ball", rho, 1.0, start)
          : s.add("rod",
                  kind == Rolling::capsule ? along_y("capsule", {2.0 * rho, 0.4 + 2.0 * rho})
                                           : along_y("cylinder", {2.0 * rho, 0.4}),
                  1.0, {0.02, 0.5 * rho * rho, 0.02}, start);
  s.add_fixed("tube", along_y("tube", {1.2, 2.0 * R, 1.0}));
  s.law(0.5, 0.0);
  s.begin(dt);
  const double period =
      2.0 * std::numbers::pi * std::sqrt((1.0 + k) * (R - rho) / 9.81) * (1.0 + A * A / 16.0);
  std::vector<double> crossings;
  double turn = 0.0, angle = A;
  std::array<double, 2> turns{}, angles{A, A};
  for (double t = dt; t < 2.6 * period; t += dt) {
    const BodyMotion before = s.motion(body);
    s.step();
    const BodyMotion m = s.motion(body);
    if (before.r.x() * m.r.x() < 0.0)
      crossings.push_back(t - dt * m.r.x() / (m.r.x() - before.r.x()));
    turn += 2.0 * std::asin((m.q * before.q.conjugate()).y());
    angle = std::atan2(m.r.x(), -m.r.z());
    turns = {std::min(turns[0], turn), std::max(turns[1], turn)};
    angles = {std::min(angles[0], angle), std::max(angles[1], angle)};
    EXPECT_NEAR(std::hypot(m.r.x(), m.r.z()), R - rho, 1e-4 * rho);
  }
  ASSERT_GE(crossings.size(), 5u);
  EXPECT_NEAR((crossings[4] - crossings[0]) / (2.0 * period), 1.0, 1e-4);
  EXPECT_NEAR((turns[1] - turns[0]) * rho / ((angles[1] - angles[0]) * (R - rho)), 1.0, 1e-4);
  EXPECT_NEAR(s.motion(body).r.y(), 0.003, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(
    Steps, RollingInATube,
    testing::Values(Inside{Rolling::ball, 5e-3}, Inside{Rolling::ball, 1e-3},
                    Inside{Rolling::ball, 1e-4}, Inside{Rolling::capsule, 5e-3},
                    Inside{Rolling::capsule, 1e-3}, Inside{Rolling::capsule, 1e-4},
                    Inside{Rolling::cylinder, 5e-3}, Inside{Rolling::cylinder, 1e-3},
                    Inside{Rolling::cylinder, 1e-4}),
    [](const auto& given) { return name_of(given.param); });

enum class Floor { plane, box, triangles };

struct OnAFloor {
  Floor floor;
  double dt;

  void add(ModelScene& s) const {
    if (floor == Floor::plane) return s.add_floor();
    if (floor == Floor::box)
      return s.add_fixed("box", ModelScene::shape("box", {8.0, 4.0, 0.4}), {0.0, 0.0, -0.2});
    ShapeSpec field = ModelScene::shape("height_field", {});
    field.columns = 9;
    field.spacing = 0.5;
    field.heights.assign(81, 0.0);
    s.add_fixed("field", field);
  }
};

class TubeOnAFloor : public testing::TestWithParam<OnAFloor> {};

TEST_P(TubeOnAFloor, RollsOnItsOwnRadius) {
  const double R = 0.3, v = 2.0, dt = GetParam().dt;
  ModelScene s;
  BodyMotion start = at({0.0, 0.0, R}, {v, 0.0, 0.0});
  start.W = {0.0, v / R, 0.0};
  const int wheel =
      s.add("wheel", along_y("tube", {2.0 * R, 0.4, 0.1}), 1.0, {0.03, 0.05, 0.03}, start);
  GetParam().add(s);
  s.law(0.5, 0.0);
  s.begin(dt);
  double turn = 0.0;
  for (double t = 0.0; t < 0.5; t += dt) {
    const Quat before = s.motion(wheel).q;
    s.step();
    turn += 2.0 * std::asin((s.motion(wheel).q * before.conjugate()).y());
    EXPECT_NEAR(s.motion(wheel).r.z(), R, 1e-4 * R);
  }
  // The Cayley rotation of a step has the angle 2 atan(θ/2).
  const double cayley = v / R * dt * v / R * dt / 12.0;
  EXPECT_NEAR(s.motion(wheel).r.x() / (R * turn), 1.0, 1e-4 + cayley);
  EXPECT_NEAR(s.motion(wheel).v.x(), v, 1e-4 * v);
}

TEST_P(TubeOnAFloor, SlidesOnItsEndFaceToAHalt) {
  const double v = 1.0, mu = 0.3;
  ModelScene s;
  const int tube = s.add("tube", ModelScene::shape("tube", {0.3, 0.2, 0.2}), 1.0,
                         {0.01, 0.01, 0.015}, at({0.0, 0.0, 0.1}, {v, 0.0, 0.0}));
  GetParam().add(s);
  s.law(mu, 0.0);
  s.begin(GetParam().dt);
  s.run(0.6);
  const BodyMotion m = s.motion(tube);
  EXPECT_NEAR(m.r.x(), v * v / (2.0 * mu * 9.81), 1e-4);
  EXPECT_NEAR(m.r.z(), 0.1, 5e-6);
  EXPECT_LT((m.q * Vec3::UnitZ()).head<2>().norm(), 1e-6);
  EXPECT_LT(m.v.norm(), 1e-3);
}

std::vector<OnAFloor> floors_and_steps() {
  std::vector<OnAFloor> all;
  for (const Floor floor : {Floor::plane, Floor::box, Floor::triangles})
    for (const double dt : {5e-3, 1e-3, floor == Floor::triangles ? 5e-4 : 1e-4})
      all.push_back({floor, dt});
  return all;
}

INSTANTIATE_TEST_SUITE_P(Steps, TubeOnAFloor, testing::ValuesIn(floors_and_steps()),
                         [](const auto& given) {
                           const Floor floor = given.param.floor;
                           const char* const name = floor == Floor::plane ? "plane"
                                                    : floor == Floor::box ? "box"
                                                                          : "triangles";
                           return std::string(name) + "_at_" +
                                  std::to_string(std::lround(1e6 * given.param.dt)) + "_us";
                         });

/// A pipe of 1 kg with a wall of 10 mm and a fixed body of this shape.
/// @param motion  Keys of the pipe but shape and mass. @param contact  Keys of contacts.default.
Simulation pipe_and(const std::string& shape, double length, const std::string& motion,
                    const std::string& contact, double duration, double step) {
  return Simulation(io::read_model_text(
      format("format: 1\ngravity: [0, 0, -9.81]\nbodies:\n"
             "  other: {{fixed: true, shape: {}}}\n"
             "  pipe: {{shape: {{tube: [0.2, 0.18, {}]}}, mass: 1, inertia: [0.01, 0.01, "
             "0.00905], {}}}\n"
             "contacts: {{default: {{{}}}}}\n"
             "analysis: {{type: dynamics, duration: {} s, step: {} s}}\n",
             shape, length, motion, contact, duration, step),
      "m.yaml"));
}

/// Speed of a pipe that rolls on its rims. As a polygon it would lose a quarter of it in a second.
TEST(TubeContact, RollsFreelyByEitherLaw) {
  const std::string row = "[0, 0, 0, 0, 0, 0, 0]";
  const std::string floors[] = {
      "{plane: z}", "{box: [10, 2, 0.2], position: [0, 0, -0.1]}",
      "{height_field: {spacing: 1, heights: [" + row + ", " + row + ", " + row + "]}}"};
  for (const std::string& floor : floors)
    for (const std::string law : {"barrier", "nonsmooth"})
      for (const double step : {1e-2, 5e-3, 1e-3}) {
        SCOPED_TRACE(format("{} by {} at {} s", floor, law, step));
        Simulation s = pipe_and(floor, 0.3,
                                "orientation: {axis: x, angle: 90 deg}, position: [0, 0, 0.1], "
                                "velocity: [1, 0, 0], angular_velocity: [0, 10, 0]",
                                format("law: {}, friction: 0.3", law), 1.0, step);
        const RunSummary end = s.run();
        ASSERT_EQ(end.end, RunEnd::finished) << end.message;
        EXPECT_NEAR(s.body("pipe").v.x(), 1.0, 1e-6);
        EXPECT_NEAR(s.body("pipe").v.y(), 0.0, 1e-9);
        EXPECT_NEAR(s.body("pipe").r.z(), 0.1, 1e-6);
        EXPECT_LT(std::abs(end.contacts->numerical), 1e-9);
      }
}

/// A tube that falls, aligned, over a post that fits into it: a box, a hull and a mesh.
TEST(TubeContact, FallsOverAPost) {
  const Scratch folder;
  std::ofstream(folder / "post.obj") << "v -0.05 -0.05 -0.2\nv 0.05 -0.05 -0.2\nv 0.05 0.05 -0.2\n"
                                        "v -0.05 0.05 -0.2\nv -0.05 -0.05 0\nv 0.05 -0.05 0\n"
                                        "v 0.05 0.05 0\nv -0.05 0.05 0\nf 1 3 2\nf 1 4 3\nf 5 6 7\n"
                                        "f 5 7 8\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\n"
                                        "f 3 8 7\nf 4 1 5\nf 4 5 8\n";
  const std::string posts[] = {
      "{box: [0.1, 0.1, 0.2], position: [0, 0, -0.1]}",
      "{hull: {points: [[-0.05, -0.05, -0.2], [0.05, -0.05, -0.2], [0, 0.05, -0.2], [0, 0, 0]]}}",
      format("{{mesh: {}}}", folder / "post.obj")};
  for (const std::string& post : posts)
    for (const std::string law : {"barrier", "nonsmooth"})
      for (const double step : {5e-3, 1e-3}) {
        SCOPED_TRACE(format("{} by {} at {} s", post, law, step));
        Simulation s = pipe_and(post, 0.1, "position: [0, 0, 0.1]",
                                format("law: {}, friction: 0.3", law), 0.15, step);
        const RunSummary end = s.run();
        ASSERT_EQ(end.end, RunEnd::finished) << end.message;
        EXPECT_NEAR(s.body("pipe").r.z(), 0.1 - 0.5 * 9.81 * 0.0225, 1e-9);
      }
}

/// A thin bar through a tube, and a tube that falls with its mouth on a corner of a box: the rim
/// touches neither.
TEST(TubeContact, LeavesItsMouthOpen) {
  for (const double step : {5e-3, 1e-3, 2e-4}) {
    const std::string falls = "position: [0, 0, 0.5]";
    Simulation s = pipe_and("{box: [0.02, 0.02, 2], position: [0.07, 0, 0]}", 0.3, falls,
                            "friction: 0", 0.3, step);
    const RunSummary end = s.run();
    ASSERT_EQ(end.end, RunEnd::finished) << step;
    EXPECT_NEAR(s.body("pipe").r.z(), 0.5 - 0.5 * 9.81 * 0.09, 1e-9) << step;
    EXPECT_EQ(end.contacts->touching, 0) << step;
    Simulation t =
        pipe_and("{box: [0.4, 0.4, 0.4], orientation: {axis: [1, -1, 0], angle: 0.955316618 rad}}",
                 0.3, falls, "friction: 0", 0.3, step);
    const RunSummary rests = t.run();
    ASSERT_EQ(rests.end, RunEnd::finished) << step << ": " << rests.message;
    // Three edges of the corner, each at √2 of its height from the vertical, meet the inner rim.
    const double of_rim = round_tube(0.2, 0.18, 0.3).rounding, of_box = 2e-4;
    const double corner = (0.2 - of_box) * std::sqrt(3.0),
                 lower = (0.09 + of_rim - std::sqrt(3.0) * (of_rim + of_box)) / std::sqrt(2.0);
    EXPECT_NEAR(t.body("pipe").r.z(), corner - lower - of_rim + 0.15, 1e-6) << step;
    EXPECT_LT(rests.energy_drift, 1e-9) << step;
  }
}

}  // namespace
}  // namespace polhode::tube_contact_tests
