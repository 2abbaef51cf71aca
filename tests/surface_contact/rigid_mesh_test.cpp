// SPDX-License-Identifier: Apache-2.0
// Gaps of points over rigid surfaces of triangles.
#include <gtest/gtest.h>

#include <cmath>

#include <contact/shapes_for_tests.hpp>
#include <polhode/geometry/hull.hpp>
#include <polhode/surface_contact/rigid_surface.hpp>
#include <support/derivative.hpp>
#include <support/obj_file.hpp>

namespace polhode::test::rigid_mesh_tests {
namespace {

contact::NormalLaw band(double tolerance) {
  contact::NormalLaw law;
  law.tolerance = tolerance;
  law.stiffness = 7.0;
  return law;
}

/// Hills and valleys on a grid of 9 × 9 points at distances of 1, no steeper than 1:1.
geometry::Shape hills(double rounding) {
  std::vector<double> heights;
  for (int i = 0; i < 81; ++i) heights.push_back(0.4 * std::sin(2.3 * i) + 0.1 * std::cos(7.0 * i));
  return geometry::height_field("hills", 9, 1.0, heights, {}, rounding);
}

surface_contact::RigidMesh ring(double rounding) {
  return surface_contact::RigidMesh(geometry::mesh("ring", torus(3.5, 1.5), {}, rounding));
}

TEST(NormalLaw, FindsTheGapOfAnEnergy) {
  for (const auto potential : {contact::NormalPotential::barrier, contact::NormalPotential::linear,
                               contact::NormalPotential::hertz}) {
    contact::NormalLaw law = band(0.01);
    law.potential = potential;
    for (const double part : {-0.999999, -0.9, -0.3, -1e-3}) {
      const double gap = 0.01 * part;
      EXPECT_NEAR(law.gap_of(law.energy(gap)), gap, 1e-16);
    }
    EXPECT_EQ(law.gap_of(0.0), law.reach());
  }
  const contact::NormalLaw law = band(0.01);
  EXPECT_NEAR(law.gap_of(law.energy(0.0099)), 0.0099, 1e-9);
}

/// Gap over a flat surface with arbitrary corners and edges: shared features of neighbours count
/// once. @tests{surface-feature-sum}
TEST(RigidMesh, IsAPlaneWhereItIsFlat) {
  const double rho = 0.05;
  // Corners of a flat field, moved in the plane, so that triangles are of all shapes.
  Random random(7);
  geometry::Shape shape =
      geometry::height_field("flat", 9, 1.0, std::vector<double>(81, 0.0), {}, rho);
  for (Vec3& x : shape.corners) x.head<2>() += 0.3 * Vec3(random.vector()).head<2>();
  const surface_contact::RigidMesh field(shape);
  const contact::NormalLaw law = band(0.3);
  const double radii[] = {0.0, 0.4, 2.5};  // of a ball about the point, to larger than triangles
  for (int k = 0; k < 3000; ++k) {
    Vec3 y = random.vector(3.0);
    const double radius = radii[k % 3];
    if (k % 4 == 1) y = shape.corners[static_cast<std::size_t>(40 + k % 3)];  // over a corner
    if (k % 4 == 2)                                                           // over an edge
      y = 0.3 * shape.corners[40] + 0.7 * shape.corners[41];
    y[2] = 0.25 * random.number();
    if (y[2] < -rho) y[2] += 0.3;
    y[2] += radius;
    const surface_contact::SurfaceGap g = field.gap(y, {law, 100.0, false, radius});
    EXPECT_NEAR(g.value, y[2] - radius, 1e-13);
    EXPECT_LT((g.normal - Vec3::UnitZ()).norm(), 1e-10) << y.transpose();
    EXPECT_LT(g.curvature.norm(), 1e-8);
    EXPECT_NEAR(field.distance(y, 10.0, false), y[2], 1e-14);
  }
}

/// Gap of a box of triangles: that of the box, at its faces, edges and corners.
TEST(RigidMesh, AgreesWithTheBoxOfItsTriangles) {
  using enum surface_contact::RigidSurface::Kind;
  const double rho = 0.2;
  const surface_contact::RigidSurface plain{.kind = box, .half = {2.0, 3.0, 2.5}, .rounding = rho};
  std::vector<Vec3> corners;
  for (int k = 0; k < 8; ++k)
    corners.emplace_back(k & 1 ? 2.0 : -2.0, k & 2 ? 3.0 : -3.0, k & 4 ? 2.5 : -2.5);
  const surface_contact::RigidSurface meshed{
      .kind = mesh,
      .triangles = std::make_shared<surface_contact::RigidMesh>(
          geometry::mesh("box", geometry::convex_hull("box", corners), {}, rho))};
  const contact::NormalLaw law = band(rho);
  Random random(41);
  for (int k = 0; k < 4000; ++k) {
    const double radius = k < 2000 ? 0.0 : 1.7;
    const Vec3 half = Vec3(2.0, 3.0, 2.5) + Vec3::Constant(0.8 * radius);
    Vec3 y = random.vector(1.1).cwiseProduct(half);
    if (k % 2 == 0) y = 1.02 * y.cwiseQuotient(y.cwiseAbs()).cwiseProduct(half);
    if (k % 4 == 0) y[k % 3] *= 0.7;
    const bool within = plain.distance(y) < -rho;
    const surface_contact::SurfaceGap g = plain.gap(y, {law, 100.0, false, radius}),
                                      h = meshed.gap(y, {law, 100.0, within, radius});
    ASSERT_NEAR(g.value, h.value, 1e-13) << y.transpose();
    if (within) continue;
    EXPECT_LT((g.normal - h.normal).norm(), 1e-10) << y.transpose();
    EXPECT_LT((g.curvature - h.curvature).norm(), 1e-8) << y.transpose();
    EXPECT_NEAR(meshed.distance(y) - radius, h.value, 1e-13);
    EXPECT_NEAR(meshed.distance(y, 0.05), std::min(h.value + radius, 0.05), 1e-13);
  }
}

/// A drum of triangles converges to a cylinder with the square of the angle between its sides, for
/// any radius of the ball.
TEST(RigidMesh, ConvergesToACylinderWithSecondOrder) {
  const contact::NormalLaw law = band(0.05);
  for (const double radius : {0.0, 0.3, 2.0}) {
    double coarse = 0.0;
    for (const int sides : {16, 32, 64, 128}) {
      const surface_contact::RigidMesh drum(
          geometry::mesh("drum", prism(1.0, 3.0, sides), {}, 1e-3));
      double worst = 0.0;
      for (int k = 0; k < 500; ++k) {
        const double u = 0.1 + 0.006 * k, d = 1.0 + radius;
        const Vec3 y(d * std::cos(u), d * std::sin(u), 0.001 * k);
        worst = std::max(worst, std::abs(drum.gap(y, {law, 100.0, false, radius}).value));
      }
      const double half = std::numbers::pi / sides;
      EXPECT_LT(worst, 1.2 * (0.5 * half * half)) << "the height of the arc over a side";
      if (coarse > 0.0) {
        EXPECT_LT(worst, 0.3 * coarse) << sides;
      }
      coarse = worst;
    }
  }
}

/// Points within the band over a rough surface, many of them near several features.
template <class What>
void for_points(const surface_contact::RigidMesh& mesh, const surface_contact::GapQuery& query,
                What&& what) {
  const contact::NormalLaw& law = query.law;
  Random random(23);
  int found = 0;
  for (int k = 0; k < 40000 && found < 300; ++k) {
    const Vec3 y = random.vector(4.0).cwiseProduct(Vec3(1.0, 1.0, 0.4 + 0.2 * query.radius));
    const double d = mesh.distance(y, 4.0, true) - query.radius;
    if (d < -0.9 * law.tolerance || d > law.tolerance) continue;
    ++found;
    what(y);
  }
  EXPECT_EQ(found, 300);
}

/// @tests{surface-feature-sum}
TEST(RigidMesh, HasTheDerivativesOfItsGap) {
  const contact::NormalLaw law = band(0.2);
  for (const double radius : {0.0, 0.9}) {
    const surface_contact::GapQuery query{law, 100.0, false, radius};
    for (const surface_contact::RigidMesh& mesh :
         {surface_contact::RigidMesh(hills(0.2)), ring(0.2)}) {
      double several = 0.0;
      for_points(mesh, query, [&](const Vec3& y) {
        const surface_contact::SurfaceGap g = mesh.gap(y, query);
        several = std::max(several, mesh.distance(y, 4.0, false) - radius - g.value);
        const auto value = [&](const Vec& d) -> Vec {
          return Vec::Constant(1, mesh.gap(Vec3(y + Vec3(d)), query).value);
        };
        const auto normal = [&](const Vec& d) -> Vec {
          return mesh.gap(Vec3(y + Vec3(d)), query).normal;
        };
        if (g.value > 0.95 * law.tolerance) return;  // its normal turns fast where the band ends
        expect_derivative(g.normal.transpose(), value, "gap", 1e-6, 1e-6);
        expect_derivative(g.curvature, normal, "normal", 1e-4, 1e-7);
      });
      EXPECT_GT(several, 1e-3) << "some points are near two features at least";
    }
  }
}

/// Along a path at a distance, the change of energy is the work of the force. @returns the largest
/// energy.
double expect_work(const surface_contact::RigidMesh& mesh, const surface_contact::GapQuery& query,
                   const Vec3& from, const Vec3& to, double height, int n = 4000) {
  const contact::NormalLaw& law = query.law;
  const auto over = [&](double part) {
    Vec3 y = from + part * (to - from);
    for (int i = 0; i < 20; ++i)  // out to that distance
      y[2] += height + query.radius - mesh.distance(y, 10.0, true);
    return y;
  };
  Vec3 y = over(0.0);
  surface_contact::SurfaceGap g = mesh.gap(y, query);
  double energy = law.energy(g.value), work = 0.0, most = 0.0;
  const double start = energy;
  for (int i = 1; i <= n; ++i) {
    const Vec3 next = over(i / static_cast<double>(n));
    const surface_contact::SurfaceGap h = mesh.gap(next, query);
    const Vec3 f = 0.5 * (law.force_and_slope(g.value).value * g.normal +
                          law.force_and_slope(h.value).value * h.normal);
    work -= f.dot(next - y);
    energy = law.energy(h.value);
    EXPECT_NEAR(energy - start, work, 1e-3 * law.energy(0.0));
    most = std::max(most, energy);
    y = next;
    g = h;
  }
  return most;
}

/// Energy without jumps along a path. @tests{surface-feature-sum}
TEST(RigidMesh, DoesWorkEqualToItsChangeOfEnergy) {
  const contact::NormalLaw law = band(0.2);
  const surface_contact::RigidMesh mesh(hills(0.2));
  for (const double radius : {0.0, 0.6}) {
    Random random(3);
    double most = 0.0;
    for (int k = 0; k < 20; ++k) {
      Vec3 from = random.vector(3.0), to = random.vector(3.0);
      from[2] = to[2] = 0.0;
      most = std::max(most, expect_work(mesh, {law, 100.0, false, radius}, from, to, 0.05));
    }
    EXPECT_GT(most, 1.2 * law.energy(0.05)) << "the path crosses valleys";
  }
}

/// A ball that does not fit through a ring: at every position on the hole the force is at least
/// that of the nearest feature, and the energy has no jumps. @tests{surface-feature-holes}
TEST(RigidMesh, StopsABallWiderThanAHole) {
  const contact::NormalLaw law = band(0.2);
  const surface_contact::RigidMesh mesh(geometry::mesh("ring", torus(3.5, 1.5, 400), {}, 0.2));
  const surface_contact::GapQuery query{law, 100.0, false, 2.3};
  Random random(9);
  int acted = 0;
  for (int k = 0; k < 500; ++k) {
    const Vec3 y = Vec3(0.3 * random.number(), 0.3 * random.number(), 1.0 + random.number());
    const double nearest = mesh.distance(y, 10.0, false) - query.radius;
    if (nearest > law.tolerance || nearest < -0.9 * law.tolerance) continue;
    ++acted;
    EXPECT_LT(mesh.gap(y, query).value, nearest + 1e-13) << y.transpose();
  }
  EXPECT_GT(acted, 100);
  const Vec3 from(0.3, 0.25, 2.0), to(-0.24, -0.225, 2.0);
  EXPECT_GT(expect_work(mesh, query, from, to, 0.05, 400), 0.99 * law.energy(0.05));
}

TEST(RigidMesh, DistinguishesInsideFromOutside) {
  const surface_contact::RigidMesh mesh = ring(0.1);
  const contact::NormalLaw law = band(0.1);
  Random random(2);
  int within = 0;
  for (int k = 0; k < 3000; ++k) {
    const Vec3 y = random.vector(5.0).cwiseProduct(Vec3(1.0, 1.0, 0.4));
    const double tube = std::hypot(std::hypot(y[0], y[1]) - 3.5, y[2]);
    if (tube > 1.2 && tube < 1.6) continue;  // the ring has corners
    const double d = mesh.distance(y, 100.0, true);
    EXPECT_EQ(d < 0.0, tube < 1.2) << y.transpose();
    EXPECT_NEAR(mesh.gap(y, {law, 100.0, true}).value, d, 1e-14);
    within += tube < 1.2 ? 1 : 0;
  }
  EXPECT_GT(within, 200);

  const surface_contact::RigidMesh field(hills(0.1));
  EXPECT_LT(field.distance({0.3, 0.4, -2.0}, 100.0, true), -1.0) << "a point below";
  EXPECT_GT(field.distance({0.3, 0.4, 2.0}, 100.0, true), 1.0);
  EXPECT_GT(field.distance({4.5, 0.4, -2.0}, 100.0, true), 1.0) << "a point beside";
  EXPECT_GT(field.distance({0.3, 0.4, -2.0}, 100.0, false), 1.0) << "it has two sides in motion";
}

}  // namespace
}  // namespace polhode::test::rigid_mesh_tests
