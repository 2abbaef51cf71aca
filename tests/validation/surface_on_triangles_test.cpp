// SPDX-License-Identifier: Apache-2.0
// Contact of solids' surfaces with rigid meshes, height fields and tubes, from model files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include <contact/shapes_for_tests.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/io/results/checkpoint.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <support/obj_file.hpp>
#include <support/scratch.hpp>

namespace polhode::test::surface_on_triangles_tests {
namespace {

using testing::HasSubstr;

std::string flat_field(int n, double spacing) {
  std::string row;
  for (int i = 0; i < n; ++i) row += i > 0 ? ", 0" : "0";
  std::string rows;
  for (int i = 0; i < n; ++i) rows += (i > 0 ? ", [" : "[") + row + "]";
  return format("{{height_field: {{spacing: {}, heights: [{}]}}}}", spacing, rows);
}

/// A cube of rubber and a body that spins freely, in space.
Model collision(const std::string& shape, const std::string& law, const std::string& duration) {
  return io::read_model_text(R"(
format: 1
bodies:
  ring: {density: 500, position: [0.19, 0.01, 0.02], velocity: [-1, 0, 0], angular_velocity: [2, 3, 1], shape: )" +
                                 shape + R"(}
materials: {rubber: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}}
solids:
  cube:
    mesh: {block: {size: [0.1, 0.1, 0.1], cells: [3, 3, 3]}}
    material: rubber
    velocity: [0.5, 0, 0]
contacts: {default: {)" + law +
                                 R"(}}
analysis: {duration: )" + duration +
                                 R"(, step: 0.5 ms}
)",
                             "collision.yaml");
}

TEST(SurfaceOnTriangles, KeepsEnergyAndMomentaOnBodiesThatSpin) {
  const Scratch folder;
  const std::string file = folder / "ring.obj";
  write_obj(file, torus(0.07, 0.03));
  for (const std::string& shape :
       {format("{{mesh: {}}}", file), std::string("{tube: [0.16, 0.08, 0.1]}")}) {
    Simulation simulation(collision(shape, "restitution: 1", "0.15 s"));
    const RunSummary summary = simulation.run();
    ASSERT_EQ(summary.end, RunEnd::finished) << shape << summary.message;
    EXPECT_GT(simulation.contact(0).impulse, 0.1) << shape;
    EXPECT_LT(summary.energy_drift, 1e-11) << shape;
    EXPECT_LT(summary.linear_momentum_drift, 1e-12) << shape;
    EXPECT_LT(summary.angular_momentum_drift, 1e-12) << shape;
  }
}

/// With a spring law points are within the surface: the balance with the reported stored energy is
/// closed after each step.
TEST(SurfaceOnTriangles, ReportsTheEnergyStoredBySpringLaws) {
  Simulation simulation(
      collision("{tube: [0.16, 0.08, 0.1]}", "law: linear, restitution: 1", "0.1 s"));
  const auto total = [&] {
    const Balance b = simulation.balance();
    return b.kinetic + b.potential + b.dissipated - b.put_in;
  };
  const double before = total();
  double most = 0.0;
  const RunSummary summary =
      simulation.run({}, [&](Simulation&) { most = std::max(most, std::abs(total() - before)); });
  ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
  EXPECT_GT(simulation.contact(0).impulse, 0.1);
  EXPECT_LT(most, 1e-10 * before);
}

TEST(SurfaceOnTriangles, ContinuesFromACheckpointInTheSameBits) {
  const Scratch folder;
  write_obj(folder / "ring.obj", torus(0.07, 0.03));
  const Model model = collision(format("{{mesh: {}}}", folder / "ring.obj"),
                                "restitution: 0.5, friction: 0.5", "80 ms");
  const std::string file = folder / "checkpoint.pst";
  Simulation straight(model);
  int touched = 0;
  const RunSummary summary = straight.run({}, [&](Simulation& s) {
    if (s.contact(0).points == 0 || ++touched != 3) return;
    io::write_checkpoint(file, model, s.system(), s.state());
  });
  ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
  ASSERT_GT(touched, 3);
  EXPECT_LT(summary.linear_momentum_drift, 1e-12);
  Simulation continued(model, io::read_checkpoint(file, model, straight.system()));
  EXPECT_LT(continued.time(), straight.time());
  ASSERT_EQ(continued.run().end, RunEnd::finished);
  EXPECT_EQ(continued.state_hash(), straight.state_hash());
}

/// Positions of the nodes of a block after a run on a body.
std::vector<Vec3> after_run(const std::string& body, const std::string& block,
                            const std::string& duration) {
  Simulation simulation(io::read_model_text(R"(
format: 1
gravity: [0, 0, -9.81]
bodies: {base: {fixed: true, )" + body + R"(}}
materials: {rubber: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000, viscosity: {relaxation_time: 2 ms}}}
solids:
  block: {material: rubber, )" + block +
                                                R"(}
contacts: {default: {friction: 0.2, gap_tolerance: 0.5 mm, reference_pressure: 20 kPa}}
analysis: {duration: )" + duration +
                                                R"(, step: 2 ms}
)",
                                            "slide.yaml"));
  const RunSummary summary = simulation.run();
  EXPECT_EQ(summary.end, RunEnd::finished) << summary.message;
  EXPECT_GT(simulation.contact(0).impulse, 0.1);
  return simulation.solid(0).position;
}

double farthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double most = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, (a[k] - b[k]).norm());
  return most;
}

/// A block on triangles in a plane: it slides across their edges and corners as on the plane.
TEST(SurfaceOnTriangles, SlidesDownAFieldAsDownAPlane) {
  const double slope = 20.0 / 180.0 * std::acos(-1.0);
  const std::string turned = "orientation: {axis: y, angle: 20 deg}";
  const Vec3 up(std::sin(slope), 0.0, std::cos(slope)),
      down(std::cos(slope), 0.0, -std::sin(slope));
  const Vec3 start = 0.0503 * up + 0.013 * Vec3::UnitY();
  const std::string block = format(
      "mesh: {{block: {{size: [0.2, 0.2, 0.1], cells: [3, 3, 2]}}, position: [{:.17g}, "
      "{:.17g}, {:.17g}], {}}}",
      start[0], start[1], start[2], turned);
  const std::vector<Vec3> on_field =
      after_run(turned + ", shape: " + flat_field(41, 0.0625), block, "0.6 s");
  const std::vector<Vec3> on_plane = after_run(turned + ", shape: {plane: z}", block, "0.6 s");
  EXPECT_LT(farthest(on_field, on_plane), 1e-9);
  const auto way = [&](const std::vector<Vec3>& places) {
    Vec3 middle = Vec3::Zero();
    for (const Vec3& x : places) middle += x / static_cast<double>(places.size());
    return down.dot(middle - start);
  };
  const double acceleration = 9.81 * (std::sin(slope) - 0.2 * std::cos(slope));
  const double second = way(on_plane) -
                        2.0 * way(after_run(turned + ", shape: {plane: z}", block, "0.45 s")) +
                        way(after_run(turned + ", shape: {plane: z}", block, "0.3 s"));
  EXPECT_NEAR(second / (0.15 * 0.15) / acceleration, 1.0, 1e-6);
  // It lands with four times its weight, against which bristles need 3 ms to hold: the effect is
  // 2.1 % of its displacement with steps of 2 ms, 0.8 % by 0.4 ms, 0.7 % by 0.1 ms.
  EXPECT_NEAR(way(on_field) / (0.5 * acceleration * 0.36), 1.0, 0.025);
}

/// A block that falls on a box: the motion on a box of triangles is the same, including edges and
/// corners with the same rounding.
TEST(SurfaceOnTriangles, FallsOnABoxOfTrianglesAsOnABox) {
  const Scratch folder;
  write_obj(folder / "box.obj", plate({0.3, 0.3, 0.2}, 3));
  const std::string block =
      "mesh: {block: {size: [0.1, 0.1, 0.1], cells: [2, 2, 2]}, position: [0.143, 0.137, 0.18], "
      "orientation: {axis: [1, 2, 0], angle: 35 deg}}, velocity: [0, 0, -1]";
  const std::vector<Vec3> on_box = after_run("shape: {box: [0.3, 0.3, 0.2]}", block, "0.3 s");
  const std::vector<Vec3> on_mesh =
      after_run(format("shape: {{mesh: {}}}", folder / "box.obj"), block, "0.3 s");
  EXPECT_LT(farthest(on_box, on_mesh), 1e-7);
  EXPECT_GT(farthest(on_box, {on_box.size(), Vec3(0.143, 0.137, 0.1)}), 0.1) << "it fell off";
}

/// A cube of rubber that hits thin walls at a speed at which it would pass them in a twentieth of a
/// step.
TEST(SurfaceOnTriangles, NothingPassesThroughThinWalls) {
  const Scratch folder;
  write_obj(folder / "plate.obj", plate({1.0, 1.0, 0.005}, 6));
  const std::string mesh = format("{{mesh: {}}}", folder / "plate.obj");
  for (const std::string& shape : {mesh, flat_field(9, 0.125),
                                   std::string("{tube: [1.5, 1.49, 0.5], position: [0, 0, -0.75], "
                                               "orientation: {axis: x, angle: 90 deg}}")}) {
    Simulation simulation(io::read_model_text(R"(
format: 1
bodies: {wall: {fixed: true, shape: )" + shape +
                                                  R"(}}
materials: {rubber: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000, viscosity: {relaxation_time: 1 ms}}}
solids:
  cube:
    mesh: {block: {size: [0.1, 0.1, 0.1], cells: [2, 2, 2]}, position: [0.02, 0.01, 0.33], orientation: {axis: [1, 2, 0], angle: 20 deg}}
    material: rubber
    velocity: [0.3, 0, -20]
contacts: {default: {friction: 0.3}}
analysis: {duration: 40 ms, step: 5 ms}
)",
                                              "shot.yaml"));
    double energy = simulation.balance().kinetic, rise = 0.0;
    const RunSummary summary = simulation.run({}, [&](Simulation& s) {
      const Balance b = s.balance();
      rise = std::max(rise, b.kinetic + b.potential - energy);
      energy = b.kinetic + b.potential;
      for (const Vec3& x : s.solid(0).position) EXPECT_GT(x[2], -0.02) << "at " << s.time();
    });
    ASSERT_EQ(summary.end, RunEnd::finished) << shape << summary.message;
    EXPECT_GT(simulation.contact(0).impulse, 20.0) << shape << ": it was stopped";
    EXPECT_LT(rise, 1e-9 * 200.0) << shape;
  }
}

/// Uniform contact pressure at every node, also over corners and edges of the field.
TEST(SurfaceOnTriangles, PassesThePatchTestOnAField) {
  Simulation simulation(io::read_model_text(R"(
format: 1
bodies: {floor: {fixed: true, shape: )" + flat_field(9, 0.25) +
                                                R"(}}
materials: {m: {type: st_venant_kirchhoff, youngs_modulus: 2000, poisson_ratio: 0.3, density: 1}}
solids:
  block:
    mesh: {block: {size: [1, 1, 0.8], cells: [3, 2, 2]}, position: [0, 0, 0.4]}
    element: hex8_standard
    material: m
    contact: {surface: zmin}
    prescribed: {x: {nodes: xmin, x: 0}, y: {nodes: ymin, y: 0}}
loads: {p: {type: pressure, solid: block, surface: zmax, pressure: 30, follower: false}}
contacts: {default: {gap_tolerance: 1 mm}}
analysis: {type: statics}
)",
                                            "patch.yaml"));
  const RunSummary summary = simulation.run();
  ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
  const std::vector<surface_contact::SurfacePointReport> points = simulation.surface_points(0);
  ASSERT_EQ(points.size(), 12U);
  for (const surface_contact::SurfacePointReport& point : points)
    EXPECT_NEAR(point.pressure / 30.0, 1.0, 1e-10);
  EXPECT_NEAR(simulation.contact(0).force[2], 30.0, 1e-8);
}

TEST(SurfaceOnTriangles, RefusesSolidsThatStartWithinABody) {
  const Scratch folder;
  write_obj(folder / "box.obj", plate({0.5, 0.5, 0.5}, 2));
  const auto error_of = [](const std::string& body, const std::string& law = "") -> std::string {
    try {
      Simulation(io::read_model_text(R"(
format: 1
bodies: {rock: {fixed: true, )" + body +
                                         R"(}}
materials: {rubber: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}}
solids:
  pad: {mesh: {block: {size: [0.1, 0.1, 0.1], cells: [1, 1, 1]}}, material: rubber}
contacts: {)" + law + R"(}
analysis: {duration: 1 ms, step: 1 ms}
)",
                                     "start.yaml"))
          .run();
    } catch (const std::exception& e) {
      return e.what();
    }
    return {};
  };
  const std::string box = format("shape: {{mesh: {}}}", folder / "box.obj");
  EXPECT_THAT(error_of(box), HasSubstr("pad in rock by 0.2 m")) << "the whole solid is within";
  EXPECT_THAT(error_of(box + ", position: [0.28, 0, 0]"), HasSubstr("pad in rock by 0.02 m"));
  EXPECT_EQ(error_of(box + ", position: [0.3001, 0, 0]"), "");
  const std::string field = "shape: " + flat_field(5, 0.1);
  EXPECT_THAT(error_of(field + ", position: [0, 0, 1]"), HasSubstr("pad in rock by 1.05 m"));
  EXPECT_EQ(error_of(field + ", position: [0, 0, -0.0501]"), "");
  EXPECT_EQ(error_of(field + ", position: [1, 0, 1]"), "") << "beside it";
  EXPECT_THAT(error_of(box + ", position: [1, 0, 0]", "default: {gap_tolerance: 0.1}"),
              HasSubstr("a gap_tolerance of 0.1 m, above a quarter of the median edge of its "
                        "triangles, 0.0884 m"));
}

}  // namespace
}  // namespace polhode::test::surface_on_triangles_tests
