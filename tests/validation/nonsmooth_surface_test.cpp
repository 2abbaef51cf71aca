// SPDX-License-Identifier: Apache-2.0
// Bodies that slide and roll over triangles with the non-smooth law, compared with those on the
// plane of these triangles, and in a bowl.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "support/obj_file.hpp"
#include "support/scratch.hpp"
#include "validation/contact_law_scenes.hpp"

namespace polhode::nonsmooth_surface_tests {
namespace {

using namespace contact_law_scenes;
using test::Scratch;
using test::write_obj;

/// A height field of 1.2 m by 0.4 m, flat or a bowl of this radius [m].
std::string field(double cell, double radius = 0.0) {
  const int nx = static_cast<int>(std::lround(1.2 / cell)) + 1,
            ny = static_cast<int>(std::lround(0.4 / cell)) + 1;
  std::string rows;
  for (int j = 0; j < ny; ++j) {
    rows += j == 0 ? "[" : ", [";
    for (int i = 0; i < nx; ++i) {
      const double x = cell * (i - 0.5 * (nx - 1)), y = cell * (j - 0.5 * (ny - 1));
      const double z = radius > 0.0 ? 0.5 * (x * x + y * y) / radius : 0.0;
      rows += format("{}{:.17g}", i == 0 ? "" : ", ", z);
    }
    rows += "]";
  }
  return format(
      "  floor: {{fixed: true, shape: {{height_field: {{spacing: {}, heights: [{}]}}}}}}\n", cell,
      rows);
}

struct Moving {
  const char* name;
  std::string shape, place;
  double close;  ///< Largest difference [m, m/s, rad].
};

const std::string kLies = ", orientation: {axis: x, angle: 90 deg}";

/// Over triangles the discs at the ends of cylinders bulge by 2e-3 of their radius, and the rims of
/// tubes lie as far behind their ends; not so over planes.
const std::vector<Moving> kMoving = {
    {"ball", "sphere: 0.1", "[-0.3969, 0.0123, 0.05]", 1e-9},
    {"capsule", "capsule: [0.1, 0.15]", "[-0.3969, 0.0123, 0.05]" + kLies, 1e-9},
    {"ellipsoid", "ellipsoid: [0.1, 0.12, 0.08]", "[-0.3969, 0.0123, 0.04]", 1e-9},
    {"box", "box: [0.1, 0.1, 0.1]", "[-0.3969, 0.0123, 0.05]", 1e-9},
    {"standing cylinder", "cylinder: [0.1, 0.12]", "[-0.3969, 0.0123, 0.06]", 1e-9},
    {"lying cylinder", "cylinder: [0.1, 0.12]", "[-0.3969, 0.0123, 0.05]" + kLies, 1e-5},
    {"lying tube", "tube: [0.1, 0.06, 0.12]", "[-0.3969, 0.0123, 0.05]" + kLies, 1e-5}};

BodyMotion end_of(const Moving& moving, const std::string& floor, double step) {
  Scene scene{format("  a: {{shape: {{{}}}, mass: 1, position: {}, velocity: [1, 0.1, 0]}}",
                     moving.shape, moving.place),
              "friction: 0.3", std::min(0.5, 300.0 * step)};
  if (!floor.empty()) scene.floor = floor;
  Simulation run = scene.with("nonsmooth", step);
  const RunSummary done = run.run();
  EXPECT_EQ(done.end, RunEnd::finished) << moving.name << ' ' << step << ": " << done.message;
  EXPECT_TRUE(done.warnings.empty()) << moving.name << ' ' << step;
  return run.body("a");
}

/// @tests{nonsmooth-exit} @tests{contact-direction}
TEST(NonsmoothSurface, TrianglesOfAPlaneActAsThePlane) {
  for (const Moving& moving : kMoving)
    for (const double step : {1e-2, 5e-3, 1e-3, 1e-4}) {
      const BodyMotion plane = end_of(moving, "", step);
      for (const double cell : {0.01, 0.1}) {
        const BodyMotion flat = end_of(moving, field(cell), step);
        const std::string where = format("{}, cell {}, step {}", moving.name, cell, step);
        EXPECT_LT((flat.r - plane.r).norm(), moving.close) << where;
        EXPECT_LT((flat.v - plane.v).norm(), moving.close) << where;
        EXPECT_LT((flat.q.coeffs() - plane.q.coeffs()).norm(), moving.close) << where;
      }
    }
}

/// Closed surface of quadrilaterals, four corners each, counterclockwise from outside.
geometry::TriangleSurface of_quads(std::vector<Vec3> points,
                                   const std::vector<std::array<int, 4>>& quads) {
  geometry::TriangleSurface s;
  s.points = std::move(points);
  for (const auto& q : quads) {
    s.triangles.push_back({q[0], q[1], q[2]});
    s.triangles.push_back({q[0], q[2], q[3]});
  }
  return s;
}

/// Corners of a square about the axis, counterclockwise from above.
void add_square(std::vector<Vec3>& points, double half, double z) {
  for (const auto& [x, y] :
       {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)})
    points.push_back({half * x, half * y, z});
}

/// A block, 0.4 m high, with a square pocket in it, 0.3 m deep, whose bottom lies in z = 0.
geometry::TriangleSurface pocket(double half) {
  std::vector<Vec3> points;
  add_square(points, half + 0.1, -0.1);
  add_square(points, half + 0.1, 0.3);
  add_square(points, half, 0.3);
  add_square(points, half, 0.0);
  std::vector<std::array<int, 4>> quads{{0, 3, 2, 1}, {12, 13, 14, 15}};
  for (int k = 0; k < 4; ++k) {
    const int n = (k + 1) % 4;
    quads.push_back({k, n, 4 + n, 4 + k});
    quads.push_back({4 + k, 4 + n, 8 + n, 8 + k});
    quads.push_back({8 + k, 8 + n, 12 + n, 12 + k});
  }
  return of_quads(std::move(points), quads);
}

/// A ball that falls fast into a pocket stays in it, whatever walls are nearer than the bottom.
TEST(NonsmoothSurface, ABallStaysInAPocket) {
  const Scratch folder;
  for (const double half : {0.0501, 0.051, 0.06}) {
    write_obj(folder / "pocket.obj", pocket(half));
    for (const double speed : {1.5, 10.0})
      for (const double step : {1e-2, 5e-3, 1e-3, 1e-4}) {
        Scene scene{format("  a: {{shape: {{sphere: 0.1}}, mass: 1, position: [0, 0, 0.09], "
                           "velocity: [0, 0, {}]}}",
                           -speed),
                    "friction: 0.3", 0.1};
        scene.floor =
            format("  floor: {{fixed: true, shape: {{mesh: {}}}}}\n", folder / "pocket.obj");
        Simulation run = scene.with("nonsmooth", step);
        const RunSummary done = run.run();
        ASSERT_EQ(done.end, RunEnd::finished) << half << ' ' << speed << ' ' << step;
        EXPECT_NEAR(run.body("a").r.z(), 0.05, 1e-4) << half << ' ' << speed << ' ' << step;
        EXPECT_LT(run.body("a").r.head<2>().norm(), half - 0.05 + 1e-4);
      }
  }
}

/// On a closed sheet, thinner than the way of a step, bodies move as on the plane of its upper
/// side.
TEST(NonsmoothSurface, ASheetActsAsThePlaneOfItsUpperSide) {
  const Scratch folder;
  for (const double thickness : {1e-2, 8e-4}) {
    std::vector<Vec3> points;
    add_square(points, 0.5, -thickness);
    add_square(points, 0.5, 0.0);
    std::vector<std::array<int, 4>> quads{{0, 3, 2, 1}, {4, 5, 6, 7}};
    for (int k = 0; k < 4; ++k) quads.push_back({k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k});
    write_obj(folder / "sheet.obj", of_quads(std::move(points), quads));
    const std::string sheet =
        format("  floor: {{fixed: true, shape: {{mesh: {}}}}}\n", folder / "sheet.obj");
    for (const Moving& moving : kMoving)
      for (const double step : {1e-2, 1e-3, 1e-4}) {
        const BodyMotion plane = end_of(moving, "", step), flat = end_of(moving, sheet, step);
        EXPECT_LT((flat.r - plane.r).norm(), moving.close) << moving.name << ' ' << step;
        EXPECT_LT((flat.v - plane.v).norm(), moving.close) << moving.name << ' ' << step;
      }
  }
}

/// A ball that rolls down a groove touches both sides: with the slope φ of these it rolls on the
/// radius R cos φ.
TEST(NonsmoothSurface, ABallRollsDownAGrooveOnBothSides) {
  for (const double side : {0.2, 0.6, 1.2})
    for (const double step : {1e-2, 5e-3, 1e-3, 1e-4}) {
      const double cell = 0.1, rise = cell * std::tan(side), slope = 0.1;
      std::string rows;
      for (const double z : {2.0 * rise, rise, 0.0, rise, 2.0 * rise}) {
        rows += rows.empty() ? "[" : ", [";
        for (int i = 0; i <= 30; ++i) rows += format("{}{:.17g}", i == 0 ? "" : ", ", z);
        rows += "]";
      }
      Scene scene{
          format("  a: {{shape: {{sphere: 0.1}}, mass: 1, position: [-1.2013, 0, {:.17g}]}}",
                 0.05 / std::cos(side)),
          "friction: 1", 1.0, std::tan(slope)};
      scene.floor = format(
          "  floor: {{fixed: true, shape: {{height_field: {{spacing: {}, heights: [{}]}}}}}}\n",
          cell, rows);
      Simulation run = scene.with("nonsmooth", step);
      const RunSummary done = run.run();
      ASSERT_EQ(done.end, RunEnd::finished) << side << ' ' << step << done.message;
      const double along = kG * std::sin(slope) / (1.0 + 0.4 / std::pow(std::cos(side), 2.0));
      EXPECT_NEAR(run.body("a").v.x() / along, 1.0, 1e-3) << side << ' ' << step;
      EXPECT_NEAR(run.body("a").r.z(), 0.05 / std::cos(side), 1e-5) << side << ' ' << step;
      EXPECT_NEAR(run.body("a").r.y(), 0.0, 1e-5) << side << ' ' << step;
    }
}

/// Rounds of a ball and an ellipsoid in a bowl of triangles: at no step do they sink by more than
/// a free fall of one step.
TEST(NonsmoothSurface, NothingSinksIntoABowl) {
  const std::vector<Moving> bodies = {
      {"ball", "sphere: 0.1", "[0.0031, 0.0123, 0.051]", 0.0},
      {"ellipsoid", "ellipsoid: [0.1, 0.12, 0.08]", "[0.0031, 0.0123, 0.0415]", 0.0}};
  for (const Moving& body : bodies)
    for (const double step : {1e-2, 5e-3, 1e-3}) {
      Scene scene{format("  a: {{shape: {{{}}}, mass: 1, position: {}, velocity: [0.5, 0.1, 0]}}",
                         body.shape, body.place),
                  "friction: 0.3", 2.0};
      scene.floor = field(0.02, 0.5);
      Simulation run = scene.with("nonsmooth", step);
      const RunSummary done = run.run();
      ASSERT_EQ(done.end, RunEnd::finished) << body.name << ' ' << step << ": " << done.message;
      EXPECT_GT(done.contacts->least_gap, -0.5 * kG * step * step) << body.name << ' ' << step;
      // Each step is solved to a thousandth of the speed that gravity adds in it.
      EXPECT_LT(std::abs(done.contacts->numerical), 0.01 * std::pow(kG * step, 2.0))
          << body.name << ' ' << step;
    }
}

}  // namespace
}  // namespace polhode::nonsmooth_surface_tests
