// SPDX-License-Identifier: Apache-2.0
// Motion over triangles of a plane, compared with that over the plane, and oscillations in finely
// triangulated troughs and bowls, compared with smooth ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "contact/starts.hpp"
#include "support/obj_file.hpp"
#include "support/scratch.hpp"
#include "validation/model_scene.hpp"

namespace polhode::flat_surfaces_tests {
namespace {

using namespace test;

constexpr double kWidth = 0.6, kMargin = 0.35;

/// Closed slab with its upper side in z = 0; diagonals alternate from cell to cell.
geometry::TriangleSurface slab(double cell, double length) {
  geometry::TriangleSurface s;
  const int nx = static_cast<int>(std::ceil(length / cell)),
            ny = static_cast<int>(std::ceil(kWidth / cell));
  const auto id = [&](int level, int i, int j) { return (level * (ny + 1) + j) * (nx + 1) + i; };
  for (const double z : {0.0, -0.5})
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i)
        s.points.push_back({cell * (i - 0.5 * nx), cell * (j - 0.5 * ny), z});
  const auto quad = [&](int a, int b, int c, int d, bool turned) {
    if (turned) {
      s.triangles.push_back({a, b, d});
      s.triangles.push_back({b, c, d});
    } else {
      s.triangles.push_back({a, b, c});
      s.triangles.push_back({a, c, d});
    }
  };
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const bool turned = (i + j) % 2 == 0;
      quad(id(0, i, j), id(0, i + 1, j), id(0, i + 1, j + 1), id(0, i, j + 1), turned);
      quad(id(1, i, j), id(1, i, j + 1), id(1, i + 1, j + 1), id(1, i + 1, j), turned);
    }
  for (int i = 0; i < nx; ++i) {
    quad(id(1, i, 0), id(1, i + 1, 0), id(0, i + 1, 0), id(0, i, 0), false);
    quad(id(1, i + 1, ny), id(1, i, ny), id(0, i, ny), id(0, i + 1, ny), false);
  }
  for (int j = 0; j < ny; ++j) {
    quad(id(1, 0, j + 1), id(1, 0, j), id(0, 0, j), id(0, 0, j + 1), false);
    quad(id(1, nx, j), id(1, nx, j + 1), id(0, nx, j + 1), id(0, nx, j), false);
  }
  return s;
}

ShapeSpec field_of(int columns, double spacing, std::vector<double> heights) {
  ShapeSpec spec = ModelScene::shape("height_field", {});
  spec.columns = columns;
  spec.spacing = spacing;
  spec.heights = std::move(heights);
  return spec;
}

/// The plane, then fields, a mesh and a hull whose upper sides lie in it.
/// @param file  Of the mesh, written here.
std::vector<ShapeSpec> surfaces(double cell, double length, const std::string& file) {
  const int nx = static_cast<int>(length / cell) + 2, ny = static_cast<int>(kWidth / cell) + 2;
  write_obj(file, slab(cell, length));
  ShapeSpec mesh = ModelScene::shape("mesh", {}), hull = ModelScene::shape("hull", {});
  mesh.file = file;
  for (const double x : {-0.5, 0.5})
    for (const double y : {-0.5, 0.5})
      for (const double z : {-0.5, 0.0}) hull.points.push_back({length * x, kWidth * y, z});
  return {ModelScene::shape("plane", {0.0, 0.0, 1.0}),
          field_of(nx, cell, std::vector<double>(static_cast<std::size_t>(nx * ny))), mesh, hull};
}

enum class Moving { sliding_ball, sliding_box, sliding_capsule, falling_ball, falling_box };

/// Moves one body over each of the surfaces. @returns the largest difference of position, velocity
/// (over the speed, if above 1 m/s) and orientation at the end from those over the plane.
double difference(double cell, double speed, double dt, double mu, Moving moving) {
  const double time = std::min({0.2, 200.0 * dt, 0.8 / speed}), way = speed * time;
  BodyMotion by_plane;
  double most = 0.0;
  int index = 0;
  const Scratch folder;
  for (const ShapeSpec& surface : surfaces(cell, way + 2.0 * kMargin, folder / "slab.obj")) {
    ModelScene s;
    const bool falls = moving == Moving::falling_ball || moving == Moving::falling_box;
    const Vec3 v = speed * Vec3(std::cos(0.03), std::sin(0.03), 0.0) - Vec3(0.0, 0.0, falls);
    const BodyMotion start = at({0.0131 - 0.5 * way, 0.0072, falls ? 0.13 : 0.1}, v);
    ShapeSpec lies = ModelScene::shape("capsule", {0.2, 0.4});
    lies.orientation = Quat((Mat3() << 0, 0, 1, 0, 1, 0, -1, 0, 0).finished());
    const int body = moving == Moving::sliding_ball || moving == Moving::falling_ball
                         ? s.add_ball("ball", 0.1, 1.0, start)
                     : moving == Moving::sliding_capsule
                         ? s.add("capsule", lies, 1.0, {0.004, 0.01, 0.01}, start)
                         : s.add_box("box", {0.3, 0.2, 0.2}, 1.0, start);
    s.add_fixed("ground", surface);
    // The default tolerance, and so the depth of bodies at rest, depends on the size of triangles.
    s.law(mu, falls ? 0.5 : 0.0, 4e-6);
    s.begin(dt);
    s.run(time);
    const BodyMotion end = s.motion(body);
    if (index++ == 0) by_plane = end;
    most = std::max({most, (end.r - by_plane.r).norm(),
                     (end.v - by_plane.v).norm() / std::max(1.0, speed),
                     (end.q.coeffs() - by_plane.q.coeffs()).norm()});
  }
  return most;
}

/// @tests{contact-one-gap}
TEST(FlatSurfaces, AgreeWithThePlaneAtAnyCellSizeSpeedAndStep) {
  const double cells[] = {0.005, 0.02, 0.2}, speeds[] = {0.1, 2.0, 20.0},
               steps[] = {5e-3, 1e-3, 1e-4};
  for (int c = 0; c < 3; ++c)
    for (int v = 0; v < 3; ++v)
      for (int h = 0; h < 3; ++h)
        for (const int rough : {0, 1})
          for (const Moving moving :
               {Moving::sliding_ball, Moving::sliding_box, Moving::sliding_capsule,
                Moving::falling_ball, Moving::falling_box}) {
            // Latin squares: every pair of cell, speed and step for each body with and without
            // friction, and every triple among the bodies.
            if ((c + v + h + rough + static_cast<int>(moving)) % 3 != 0) continue;
            const double mu = 0.3 * rough;
            EXPECT_LT(difference(cells[c], speeds[v], steps[h], mu, moving), 1e-6)
                << "cell " << cells[c] << " speed " << speeds[v] << " step " << steps[h] << " mu "
                << mu << " moving " << static_cast<int>(moving);
          }
}

struct Swing {
  bool bowl;
  double cell, dt;
  int swings;
};

class SwingOnTriangles : public testing::TestWithParam<Swing> {};

/// Each edge of a valley removes the velocity normal to the next face, δ v for the angle δ: a swing
/// with the amplitude A loses A δ of the amplitude, here 1e-3.
/// @tests{contact-one-gap}
TEST_P(SwingOnTriangles, KeepsItsAmplitude) {
  const bool bowl = GetParam().bowl;
  const double cell = GetParam().cell, dt = GetParam().dt;
  const double R = 1.0, rho = 0.05, A = 0.2, direction = bowl ? 0.4 : 0.0;
  const double period = 2.0 * std::numbers::pi * std::sqrt((R - rho) / 9.81) * (1.0 + A * A / 16.0);
  const auto count = [&](double length) { return 2 * static_cast<int>(0.5 * length / cell) + 1; };
  const int nx = count(2.0 * (A + 0.1)), ny = bowl ? nx : count(0.1);
  std::vector<double> z;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const double x = cell * (i - 0.5 * (nx - 1)), y = bowl ? cell * (j - 0.5 * (ny - 1)) : 0.0;
      z.push_back(R - std::sqrt(R * R - x * x - y * y));
    }
  ModelScene s;
  const Vec3 along(std::cos(direction), std::sin(direction), 0.0);
  const Vec3 side = (R - rho) * std::sin(A) * along + Vec3(0.0, 0.0013, 0.0);
  const double reach = bowl ? side.norm() : side.x();
  const double height = R - std::sqrt((R - rho) * (R - rho) - reach * reach);
  const int ball = s.add_ball("ball", rho, 1.0, at(side + Vec3(0.0, 0.0, height + 1e-5)));
  s.add_fixed("ground", field_of(nx, cell, z));
  s.law(0.0, 0.0);
  s.begin(dt);
  s.run(std::floor((GetParam().swings - 0.25) * period / dt) * dt);
  double late = 0.0;
  for (double t = 0.0; t < period; t += dt) {
    s.step();
    late = std::max(late, s.motion(ball).r.head<2>().norm());
  }
  EXPECT_NEAR(late / reach, 1.0, 1e-3 * GetParam().swings);
}

INSTANTIATE_TEST_SUITE_P(Steps, SwingOnTriangles,
                         testing::Values(Swing{false, 0.005, 5e-3, 10},
                                         Swing{false, 0.005, 1e-3, 10},
                                         Swing{false, 0.005, 1e-4, 3}, Swing{true, 0.005, 5e-3, 10},
                                         Swing{true, 0.005, 1e-3, 10}, Swing{true, 0.005, 1e-4, 3}),
                         [](const auto& given) {
                           return std::string(given.param.bowl ? "bowl" : "trough") + "_at_" +
                                  std::to_string(std::lround(1e6 * given.param.dt)) + "_us";
                         });

}  // namespace
}  // namespace polhode::flat_surfaces_tests
