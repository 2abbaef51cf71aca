// SPDX-License-Identifier: Apache-2.0
// A point over a surface of triangles has one gap; over a flat one that of the plane.
#include <gtest/gtest.h>

#include <cmath>

#include <polhode/contact/gap.hpp>

#include "contact/scene.hpp"

namespace polhode::surface_gap_tests {
namespace {

using namespace contact;
using namespace test;

geometry::Shape field(double spacing, int n, const std::function<double(double, double)>& height) {
  std::vector<double> z;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      z.push_back(height(spacing * (i - 0.5 * (n - 1)), spacing * (j - 0.5 * (n - 1))));
  return geometry::height_field("field", n, spacing, z);
}

/// @tests{contact-one-gap}
TEST(SurfaceGap, UsesBothSidesOfAValleyAndIsSmoothAcrossIt) {
  const geometry::Shape valley = field(0.1, 21, [](double x, double) { return 0.5 * std::abs(x); });
  const geometry::Shape ball = geometry::sphere("ball", 0.2);
  const Mat3 upright = Mat3::Identity();
  const auto at = [&](double x, double z) {
    return gap({GapKind::point_surface, 0, 0, Fade::none}, ball, valley,
               Placement<double>({x, 0.013, z}, upright, 0),
               Placement<double>(Vec3::Zero(), upright, 6));
  };
  const double slope = std::atan(0.5), touching = 0.1 / std::cos(slope);
  const Gap<double> g = at(0.0, touching);
  EXPECT_NEAR(value(g.normal).z(), 1.0, 1e-9);
  EXPECT_LT(g.distance, 0.0);
  EXPECT_GT(g.distance, -1e-4);
  EXPECT_NEAR(g.slope, std::cbrt(2.0) * std::cos(slope), 1e-3);
  for (const double x : {-2e-5, -1e-5, 0.0, 1e-5, 2e-5, 3e-5}) {
    const double h = 1e-9;
    const double by_x = (at(x + h, touching).distance - at(x - h, touching).distance) / (2.0 * h);
    const Gap<double> here = at(x, touching);
    EXPECT_NEAR(by_x, here.slope * value(here.normal).x(), 1e-5);
  }
}

struct Slide {
  double cell, speed, dt, mu;
};

/// Bodies that slide over a plane in triangles move as over the plane, to 1e-6 m.
TEST(SurfaceGap, LetsBodiesSlideOverFlatTrianglesAsOverThePlane) {
  for (const Slide& c :
       {Slide{0.02, 5.0, 5e-3, 0.0}, Slide{0.02, 5.0, 1e-3, 0.0}, Slide{0.02, 5.0, 1e-3, 0.3},
        Slide{0.005, 1.0, 5e-3, 0.0}, Slide{0.2, 20.0, 1e-3, 0.0}, Slide{0.05, 0.1, 1e-3, 0.2}})
    for (const int kind : {0, 1, 2}) {
      const double way = std::max(0.2, 0.1 * c.speed);
      const int n = static_cast<int>(2.0 * (way + 0.3) / c.cell) + 2;
      const geometry::Shape flat = field(c.cell, n, [](double, double) { return 0.0; });
      BodyMotion end[2];
      for (const bool plane : {true, false}) {
        Scene s;
        const Vec3 v = c.speed * Vec3(std::cos(0.3), std::sin(0.3), 0.0);
        BodyMotion start = at({0.0131, 0.0072, 0.1}, v);
        const int body =
            kind == 0 ? s.add_ball("ball", 0.1, 1.0, start)
            : kind == 1
                ? s.add_box("box", {0.3, 0.2, 0.2}, 1.0, start)
                : s.add("capsule",
                        geometry::capsule(
                            "capsule", 0.2, 0.2,
                            {Vec3::Zero(), (Mat3() << 0, 0, 1, 0, 1, 0, -1, 0, 0).finished()}),
                        1.0, {0.004, 0.01, 0.01}, start);
        if (plane)
          s.add_floor();
        else
          s.contacts->add_shape({kGround, "floor", flat});
        ContactLaw law;
        law.tolerance = 4e-6;
        law.stiffness = 1e6;
        law.friction.mu = c.mu;
        law.friction.turning_stiffness = law.friction.turning_damping = 1.0;
        s.contacts->set_default(law);
        s.begin(c.dt);
        ASSERT_TRUE(s.run(way / c.speed)) << s.last.text();
        end[plane] = s.motion(body);
      }
      EXPECT_LT((end[0].r - end[1].r).norm(), 1e-6) << kind << " " << c.cell << " " << c.speed;
      EXPECT_LT((end[0].v - end[1].v).norm(), 1e-6 * std::max(1.0, c.speed))
          << kind << " " << c.cell << " " << c.speed;
      EXPECT_LT((end[0].q.coeffs() - end[1].q.coeffs()).norm(), 1e-6) << kind << " " << c.cell;
    }
}

TEST(SurfaceGap, RefusesToTreatASurfaceAsASolid) {
  const geometry::Shape flat = field(0.1, 5, [](double, double) { return 0.0; });
  const Mat3 upright = Mat3::Identity();
  const Placement<double> at(Vec3::Zero(), upright, 6);
  EXPECT_THROW(static_cast<void>(point_over_solid(v3(Vec3(0.0, 0.0, 0.2)), 0.0, flat, at)),
               std::logic_error);
}

}  // namespace
}  // namespace polhode::surface_gap_tests
