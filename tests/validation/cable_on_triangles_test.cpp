// SPDX-License-Identifier: Apache-2.0
// Contact of cables with meshes, height fields and tubes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <contact/shapes_for_tests.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <support/obj_file.hpp>
#include <support/scratch.hpp>
#include <validation/rope_over_drum.hpp>

namespace polhode::test::cable_on_triangles_tests {
namespace {

using std::numbers::pi;
using testing::HasSubstr;

/// A body is thrown at a cable between two blocks, all free in space.
/// @param how  Position and velocities of the body.
Model thrown(const std::string& shape, const std::string& how, double duration, double step) {
  return io::read_model_text(format(R"(
format: 1
bodies:
  left: {{shape: {{box: [0.1, 0.2, 0.2]}}, density: 1000, position: [-0.55, 0, 0]}}
  right: {{shape: {{box: [0.1, 0.2, 0.2]}}, density: 1000, position: [0.55, 0, 0]}}
  stone: {{density: 1000, {}, shape: {}}}
cables:
  rope: {{through: [[left, [0.05, 0, 0]], [right, [-0.05, 0, 0]]], stiffness: 20 kN, mass_per_length: 0.05,
         elements: 20, contact: {{radius: 4 mm}}}}
contacts: {{default: {{restitution: 1}}}}
analysis: {{duration: {:g}, step: {:g}}}
)",
                                    how, shape, duration, step),
                             "thrown.yaml");
}

double impulses(const Simulation& s) {
  double sum = 0.0;
  for (std::size_t k = 0; k < s.contact_map().pairs.size(); ++k)
    sum += s.contact(static_cast<int>(k)).impulse;
  return sum;
}

/// A rope two metres above a height field: no overlap is reported, for any last digits of its
/// radius.
TEST(CableOnTriangles, FarAboveAFieldOverlapsNothing) {
  for (const double radius : {5.8e-3, 5.85e-3, 5.9e-3, 6e-3, 7e-3, 8e-3}) {
    const Model model = io::read_model_text(format(R"(
format: 1
bodies:
  field: {{fixed: true, shape: {{height_field: {{spacing: 0.15, heights: [[0, 0, 0], [0, 0, 0], [0, 0, 0]]}}}}}}
  ball: {{shape: {{sphere: 0.1}}, mass: 1, position: [0, 0, 2]}}
cables:
  rope: {{through: [[ground, [0.02, 0, 2.3]], [ball]], stiffness: 10 kN, mass_per_length: 1,
         elements: 3, contact: {{radius: {:g}}}}}
contacts: {{}}
analysis: {{duration: 1 ms, step: 1 ms}}
)",
                                                   radius),
                                            "above.yaml");
    EXPECT_NO_THROW(Simulation{model}) << radius;
  }
}

double node_z(const Simulation& s, int node) {
  return s.body(s.model().body_index("rope." + std::to_string(node))).r.z();
}

/// Corners, edges and hollows of the body pass along the cable.
TEST(CableOnTriangles, KeepsEnergyAndMomentaOnBodiesThatSpin) {
  const Scratch folder;
  write_obj(folder / "ring.obj", torus(0.05, 0.02));
  for (const std::string& shape :
       {format("{{mesh: {}}}", folder / "ring.obj"), std::string("{tube: [0.12, 0.06, 0.06]}")}) {
    Simulation s(thrown(shape,
                        "position: [0.013, 0.002, 0.1], velocity: [0, 0, -3], "
                        "angular_velocity: [3, 20, 4]",
                        0.04, 2e-4));
    const RunSummary r = s.run();
    ASSERT_EQ(r.end, RunEnd::finished) << shape << r.message;
    EXPECT_GT(impulses(s), 0.2) << shape;
    EXPECT_LT(r.energy_drift, 1e-10) << shape;
    EXPECT_LT(r.linear_momentum_drift, 1e-12) << shape;
    EXPECT_LT(r.angular_momentum_drift, 1e-12) << shape;
    EXPECT_NEAR(r.contacts->lost_in_impacts, 0.0, 1e-15);
    EXPECT_GT(r.contacts->least_gap, -4e-6) << "the tolerance: 1e-3 of the cable's radius";
  }
}

/// A bead that fits closely about the cable, with a clearance of a twentieth of its radius, is
/// thrown across it: the cable touches both sides of the bore and of its mouths.
TEST(CableOnTriangles, KeepsEnergyAndMomentaOfABeadAroundIt) {
  for (const double step : {5e-4, 2e-4, 5e-5}) {
    Simulation s(thrown("{tube: [0.02, 0.0084, 0.04], orientation: {axis: y, angle: 90 deg}}",
                        "position: [0.013, 0, 0], velocity: [0.3, 0.5, -1], "
                        "angular_velocity: [5, 3, 2]",
                        0.02, step));
    const RunSummary r = s.run();
    ASSERT_EQ(r.end, RunEnd::finished) << step << r.message;
    EXPECT_GT(impulses(s), 0.02) << step;
    EXPECT_LT(r.energy_drift, 1e-8) << step;
    EXPECT_LT(r.linear_momentum_drift, 1e-11) << step;
    EXPECT_LT(r.angular_momentum_drift, 1e-11) << step;
    EXPECT_GT(r.contacts->least_gap, -4e-6) << "the tolerance: 1e-3 of the cable's radius";
  }
}

/// In a step of 1 ms the plate, and the wall of the tube, would pass the cable many times.
TEST(CableOnTriangles, FastThinBodiesDoNotPassThroughAThinCable) {
  const Scratch folder;
  write_obj(folder / "plate.obj", plate({0.12, 0.12, 0.004}, 4));
  struct Throw {
    std::string shape, how;
    double duration;
  };
  const std::string mesh = format("{{mesh: {}}}", folder / "plate.obj"),
                    tube = "{tube: [0.12, 0.116, 0.1], orientation: {axis: x, angle: 90 deg}}";
  const auto at = [](double z, double speed) {
    return format("position: [0.013, 0.002, {}], velocity: [0, 0, {}]", z, -speed);
  };
  for (const Throw& t : {Throw{mesh, at(0.03, 30.0), 3e-3}, Throw{mesh, at(0.03, 100.0), 1e-3},
                         Throw{tube, at(0.08, 30.0), 2e-3}, Throw{tube, at(0.08, 100.0), 1e-3}}) {
    Simulation s(thrown(t.shape, t.how, t.duration, 1e-3));
    double least = 1.0;
    const RunSummary r = s.run(
        {}, [&](Simulation& now) { least = std::min(least, now.body(2).r.z() - node_z(now, 10)); });
    ASSERT_EQ(r.end, RunEnd::finished) << t.shape << r.message;
    EXPECT_GT(least, 0.0) << t.shape << " stays above the middle of the cable";
    EXPECT_GT(impulses(s), 0.1) << t.shape;
    EXPECT_LT(r.energy_drift, 1e-8) << t.shape;
  }
}

std::string drum_of(const Scratch& folder, int sides) {
  const std::string file = folder / format("drum_{}.obj", sides);
  write_obj(file, prism(Drum::kRadius, 0.1, sides));
  return format("{{mesh: {}}}", file);
}

/// Euler and Eytelwein, over triangles.
TEST(CableOnTriangles, RopeOverADrumOfTrianglesHoldsBelowTheRatioOfEytelwein) {
  const Scratch folder;
  const double mu = 0.2, ratio = std::exp(mu * pi);
  const Drum drum(16, 0.9 * ratio, mu, 0.3, drum_of(folder, 64));
  Simulation s(drum.model);
  EXPECT_LT(std::abs(drum.acceleration(s)), 1e-3);
  EXPECT_LT(std::abs(s.body(drum.heavy).v.z()), 1e-3);
  const double weight = (1.0 + 0.9 * ratio + drum.rope_mass) * Drum::g;
  EXPECT_NEAR(s.contact(0).force.z() / weight, 1.0, 1e-2);
}

/// A rope slips over triangles as over the cylinder if the angle between sides of the drum is less
/// than that between pieces of the rope; otherwise these catch on its corners.
TEST(CableOnTriangles, RopeOverADrumOfTrianglesSlipsAsOverTheCylinder) {
  const Scratch folder;
  const double mu = 0.2, ratio = std::exp(mu * pi), heavy = 1.25 * ratio;
  const Drum drum(16, heavy, mu, 0.3, drum_of(folder, 128));
  Simulation s(drum.model);
  const double a = Drum::g * (heavy - ratio) / (heavy + ratio);
  EXPECT_NEAR(drum.acceleration(s) / a, 1.0, 5.0 / (16 * 16) + 0.01);
  EXPECT_EQ(s.contact(0).status, 2);
}

/// A rope that lies straight in a groove between two slopes of 45 degrees: both carry it.
TEST(CableOnTriangles, RopeLiesInAGroove) {
  std::string rows;
  for (int j = 0; j < 9; ++j) {
    rows += j > 0 ? ", [" : "[";
    for (int i = 0; i < 9; ++i) rows += format("{}{}", i > 0 ? ", " : "", 0.05 * std::abs(j - 4));
    rows += "]";
  }
  const double radius = 0.01, height = radius * std::sqrt(2.0);
  Simulation s(io::read_model_text(format(R"(
format: 1
gravity: [0, 0, -9.81]
bodies: {{ground_shape: {{fixed: true, shape: {{height_field: {{spacing: 0.05, heights: [{}]}}}}}}}}
cables:
  rope: {{through: [[ground, [-0.1, 0, {:.17g}]], [ground, [0.1, 0, {:.17g}]]], stiffness: 10 kN, mass_per_length: 0.5,
         elements: 10, contact: {{radius: 10 mm}}}}
contacts: {{}}
analysis: {{type: statics}}
)",
                                          rows, height + 3e-5, height + 3e-5),
                                   "groove.yaml"));
  const RunSummary r = s.run();
  ASSERT_EQ(r.end, RunEnd::finished) << r.message;
  const ContactReport c = s.contact(0);
  EXPECT_NEAR(c.force.z() / (0.5 * 0.2 * 9.81), 0.9, 1e-4) << "each end carries half a piece";
  EXPECT_LT(std::abs(c.force.y()), 1e-9);
  for (int k = 1; k < 10; ++k) {
    EXPECT_NEAR(node_z(s, k), height, 2e-3 * radius) << k;
    EXPECT_NEAR(s.body(s.model().body_index("rope." + std::to_string(k))).r.y(), 0.0, 1e-9) << k;
  }
}

/// Depth of a cable that starts within a body: it is in the message.
TEST(CableOnTriangles, RefusesCablesThatStartWithinABody) {
  const Scratch folder;
  write_obj(folder / "box.obj", plate({0.5, 0.5, 0.5}, 2));
  const auto error_of = [&](const std::string& from, double height, const std::string& shape) {
    try {
      Simulation(io::read_model_text(format(R"(
format: 1
bodies:
  rock: {{fixed: true, shape: {}}}
  ball: {{mass: 1, inertia: [1, 1, 1], position: [2, 0, {}]}}
cables:
  rope: {{through: [[{}, [-2, 0, {}]], [ball]], stiffness: 10 kN, mass_per_length: 0.5, elements: 10, contact: {{radius: 10 mm}}}}
contacts: {{}}
analysis: {{duration: 1 ms, step: 1 ms}}
)",
                                            shape, height, from, height),
                                     "start.yaml"))
          .run();
    } catch (const std::exception& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const std::string box = format("{{mesh: {}}}", folder / "box.obj"),
                    field =
                        "{height_field: {spacing: 1, heights: [[0, 0, 0], [0, 0, 0], [0, 0, 0]]}}";
  EXPECT_THAT(error_of("ground", 0.0, box), HasSubstr("rope in rock by 0.26 m"))
      << "through the middle";
  EXPECT_THAT(error_of("ground", 0.255, box), HasSubstr("rope in rock by 0.005 m"));
  EXPECT_EQ(error_of("ground", 0.2601, box), "");
  EXPECT_THAT(error_of("ground", -1.0, field), HasSubstr("rope in rock by 1.01 m"));
  EXPECT_EQ(error_of("ground", 0.0101, field), "");
}

}  // namespace
}  // namespace polhode::test::cable_on_triangles_tests
