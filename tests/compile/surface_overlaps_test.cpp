// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::surface_overlaps_tests {
namespace {

using testing::HasSubstr;

/// A block of 1 m about the origin, of elements of 0.25 m.
Model model_of(const std::string& more, const std::string& contacts = "contacts: {}",
               const std::string& block = "") {
  return io::read_model_text(R"(
format: 1
gravity: [0, 0, 0]
materials:
  rubber: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.25, density: 1000}
  steel: {type: elastic, youngs_modulus: 200 GPa, poisson_ratio: 0.3, density: 7800}
solids:
  block:
    mesh: {block: {size: [1, 1, 1], cells: [4, 4, 4]}}
    material: rubber
    )" + block + "\n" + more + "\n" +
                                 contacts + "\nanalysis: {duration: 10 ms, step: 1 ms}\n",
                             "m.yaml");
}

std::string complaint(Model model) {
  try {
    const Simulation simulation(std::move(model));
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

std::string body(const std::string& shape, const std::string& position = "[0.05, 0.1, 0.15]") {
  return "bodies:\n  thing: {mass: 1, inertia: [1, 1, 1], shape: " + shape +
         ", position: " + position + "}\n";
}

std::string bar(const std::string& position, const std::string& size = "[0.1, 0.1, 0.1]",
                const std::string& cells = "[1, 1, 1]") {
  return "  bar: {mesh: {block: {size: " + size + ", cells: " + cells + "}, position: " + position +
         "}, material: rubber}\n";
}

std::string rope(const std::string& from, const std::string& to) {
  return "bodies:\n  post: {fixed: true}\ncables:\n  rope: {through: [[post, " + from +
         "], [post, " + to +
         "]], stiffness: 10 kN, mass_per_length: 0.5, elements: 10, contact: {radius: 5 mm}}\n";
}

TEST(SurfaceOverlaps, FindBodiesOfAnyShapeWithinASolid) {
  for (const char* shape :
       {"{sphere: 0.1}", "{capsule: [0.05, 0.3]}", "{box: [0.1, 0.1, 0.1]}",
        "{cylinder: [0.1, 0.1]}", "{cone: [0.1, 0.1]}", "{ellipsoid: [0.1, 0.08, 0.06]}",
        "{tube: [0.1, 0.06, 0.1]}",
        "{hull: {points: [[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]]}}"}) {
    EXPECT_THAT(complaint(model_of(body(shape))), HasSubstr("thing in block by 0.")) << shape;
    EXPECT_EQ(complaint(model_of(body(shape, "[0.05, 0.7, 0.15]"))), "") << shape;
    EXPECT_EQ(complaint(model_of(body(shape), "contacts: {exclude: [[block, thing]]}")), "");
  }
  // The ball's centre is 0.35 m below the top.
  EXPECT_THAT(complaint(model_of(body("{sphere: 0.1}"))), HasSubstr("thing in block by 0.4 m"));
}

TEST(SurfaceOverlaps, FindBodiesAndCablesWithinABodyOfAnyShape) {
  const std::string within[] = {
      "  small: {mass: 1, inertia: [1, 1, 1], position: [0.05, 0.1, 0.1], shape: {sphere: 0.1}}\n",
      "  small: {mass: 1, inertia: [1, 1, 1], position: [0.05, 0.1, 0.1], shape: {box: [0.1, 0.1, "
      "0.1]}}\n",
      "  post: {fixed: true}\ncables:\n  rope: {through: [[post, [0, -0.2, 0]], [post, [0, 0.2, "
      "0]]],"
      " stiffness: 10 kN, mass_per_length: 0.5, elements: 4, contact: {radius: 5 mm}}\n"};
  for (const char* shape :
       {"{sphere: 2}", "{capsule: [2, 4]}", "{box: [2, 2, 2]}", "{cylinder: [2, 2]}",
        "{cone: [4, 4]}", "{ellipsoid: [2, 3, 4]}", "{plane: z, position: [0, 0, 5]}",
        "{hull: {points: [[-2, -2, -2], [6, -2, -2], [-2, 6, -2], [-2, -2, 6]]}}"})
    for (const std::string& one : within)
      EXPECT_THAT(complaint(model_of(
                      "bodies:\n  big: {fixed: true, shape: " + std::string(shape) + "}\n" + one,
                      "contacts: {}", "contact: {touches: false}")),
                  testing::ContainsRegex("('big' in 'small'|rope in big) by"))
          << shape << one;
}

/// Bodies outside the solid although within its bounding box or its mirror image.
TEST(SurfaceOverlaps, IgnoreBodiesOutsideASolid) {
  EXPECT_EQ(
      complaint(model_of(body("{hull: {points: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]}}",
                              "[-0.9, -0.9, -0.9]"))),
      "");
  EXPECT_EQ(complaint(model_of(
                body("{cone: [2, 2]}", "[1.3, 0, 0.8], orientation: {axis: x, angle: 180 deg}"))),
            "")
      << "upside down: wide above the block only";
}

TEST(SurfaceOverlaps, FindBodiesThatPierceASolidBetweenItsNodes) {
  // A rod whose ends are outside and which no node of the block is in.
  EXPECT_THAT(complaint(model_of(body("{box: [3, 0.02, 0.02]}", "[0, 0.1, 0.13]"))),
              HasSubstr("thing in block by 0."));
  EXPECT_THAT(complaint(model_of(body("{capsule: [0.02, 3]}", "[0.1, 0.13, 0]"))),
              HasSubstr("thing in block by 0."));
  EXPECT_EQ(complaint(model_of(body("{box: [3, 0.02, 0.02]}", "[0, 0.1, 0.53]"))), "");
}

TEST(SurfaceOverlaps, FindSolidsAndCablesWithinSolids) {
  EXPECT_THAT(complaint(model_of(bar("[0.1, 0.12, 0.2]"))), HasSubstr("bar in block by 0."));
  EXPECT_EQ(complaint(model_of(bar("[0.1, 0.12, 0.7]"))), "");
  EXPECT_THAT(complaint(model_of(bar("[0, 0, 0]", "[4, 4, 4]"))), HasSubstr("block in bar by"))
      << "the large one has no point in the small one";
  EXPECT_THAT(complaint(model_of(rope("[-0.3, 0.1, 0.12]", "[0.3, 0.1, 0.12]"))),
              HasSubstr("rope in block by 0.385 m"));
  EXPECT_THAT(complaint(model_of(rope("[-3, 0.1, 0.12]", "[3, 0.1, 0.12]"))),
              HasSubstr("rope in block by 0.3"));
  EXPECT_EQ(complaint(model_of(rope("[-3, 0.1, 0.6]", "[3, 0.1, 0.6]"))), "");
}

/// Two cells of 1 m that overlap by 0.4 m.
TEST(SurfaceOverlaps, FindSelfOverlapsOfASolid) {
  const auto folded = [](const char* touches) {
    return "  folded: {mesh: {nodes: [[4, 0, 0], [5, 0, 0], [5, 1, 0], [4, 1, 0], "
           "[4, 0, 1], [5, 0, 1], [5, 1, 1], [4, 1, 1], [4.6, 0, 0], [5.6, 0, 0], [5.6, 1, 0], "
           "[4.6, 1, 0], [4.6, 0, 1], [5.6, 0, 1], [5.6, 1, 1], [4.6, 1, 1]], "
           "elements: [[0, 1, 2, 3, 4, 5, 6, 7], [8, 9, 10, 11, 12, 13, 14, 15]]}, "
           "material: rubber, contact: " +
           std::string(touches) + "}\n";
  };
  EXPECT_THAT(complaint(model_of(folded("{self: true}"))), HasSubstr("folded in itself by 0.16"));
  EXPECT_EQ(complaint(model_of(folded("{}"))), "");
}

TEST(SurfaceOverlaps, FindBeamsWithinASolid) {
  const std::string beam = R"(
sections: {round: {type: circle, diameter: 0.02, material: steel}}
beams:
  mast: {points: [[-0.2, 0.1, 0.12], [0.2, 0.1, 0.12]], elements: 4, section: round, contact: {}}
)";
  EXPECT_THAT(complaint(model_of(beam)), HasSubstr("mast.0 in block by 0.36 m, mast.1 in block"));
}

TEST(SurfaceOverlaps, AreFoundOnTheWholeSolidIfOnlyAPartMayTouch) {
  EXPECT_THAT(complaint(model_of(body("{sphere: 0.1}", "[0, 0, -0.2]"), "contacts: {}",
                                 "contact: {surface: zmax}")),
              HasSubstr("thing in block by 0."));
}

TEST(SurfaceOverlaps, IgnoreBodiesThatASolidIsBondedTo) {
  const std::string insert = body("{sphere: 0.1}", "[0, 0, 0.4]");
  EXPECT_EQ(
      complaint(model_of(insert, "contacts: {joint_neighbours: true}", "bonded: {thing: zmax}")),
      "");
}

TEST(SurfaceOverlaps, IgnoreBondedBodiesThatACableIsAttachedTo) {
  const std::string held = R"(bodies:
  core: {mass: 1, inertia: [1, 1, 1], position: [0, 0, 0]}
  post: {fixed: true}
cables:
  rope: {through: [[core, [0, 0, 0]], [post, [0, 0, 2]]], stiffness: 10 kN, mass_per_length: 0.5,
         elements: 20, contact: {radius: 5 mm}}
)";
  EXPECT_EQ(complaint(model_of(held, "contacts: {}", "bonded: {core: zmin}")), "");
  EXPECT_THAT(complaint(model_of(held)), HasSubstr("rope in block by"));
}

/// Mean position of the nodes of a solid.
Vec3 middle(const Simulation& simulation, std::size_t solid) {
  const SolidMap& map = simulation.solids().at(solid);
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < map.node_count(); ++k)
    sum += NodeStep::at(simulation.state().node_x.data(), map.first_node + k);
  return sum / map.node_count();
}

const char* kResolve = "contacts: {overlaps: resolve}";

TEST(SurfaceOverlaps, MoveABodyAndASolidApartByTheirMasses) {
  // Moved out through the nearest face, the top, by 0.15 m and the radius.
  Simulation simulation(
      model_of("bodies:\n  thing: {mass: 500, inertia: [1, 1, 1], shape: {sphere: 0.1}, "
               "position: [0.05, 0.1, 0.35]}\n",
               kResolve));
  const double way = simulation.body(0).r.z() - 0.35, back = middle(simulation, 0).z();
  EXPECT_NEAR(way - back, 0.2 + 2e-3 * 0.05, 1e-6) << "with the gap at which there is no force";
  EXPECT_NEAR(way, -2.0 * back, 1e-6) << "the block weighs twice as much";
  EXPECT_NEAR(simulation.body(0).r.x(), 0.05, 1e-12);
  EXPECT_THAT(simulation.summary().narration, HasSubstr("'thing' was moved by 0.13"));
  EXPECT_THAT(simulation.summary().narration, HasSubstr("'block' was moved by 0.06"));
  const double to_a_node = Vec3(0.05, 0.1, 0.05 + 2e-3 * 0.05).norm() - 0.05;
  EXPECT_NEAR(simulation.summary().contacts->least_gap, to_a_node, 1e-6) << "where they are now";
  // Without contact forces nothing moves.
  for (int k = 0; k < 10; ++k) ASSERT_TRUE(simulation.step(1.0).accepted);
  EXPECT_LT(simulation.body(0).v.norm(), 1e-9);
  EXPECT_LT((middle(simulation, 0) - Vec3(0, 0, back)).norm(), 1e-9);
}

TEST(SurfaceOverlaps, MoveSolidsApartWithTheBodiesTheyAreBondedTo) {
  Simulation simulation(
      model_of(bar("[0.1, 0.12, 0.42]", "[0.2, 0.2, 0.2]", "[2, 2, 2]") +
                   "bodies:\n  head: {mass: 3, inertia: [1, 1, 1], position: [0.1, 0.12, 0.42]}\n",
               "contacts: {overlaps: resolve}", "bonded: {head: zmin}"));
  EXPECT_NEAR((simulation.body(0).r - Vec3(0.1, 0.12, 0.42) - middle(simulation, 0)).norm(), 0.0,
              1e-12)
      << "block and head move as one";
  const Vec3 way = middle(simulation, 1) - Vec3(0.1, 0.12, 0.42), back = middle(simulation, 0);
  EXPECT_GT(way.norm(), 0.17) << "the bar reaches 0.18 m into the block";
  EXPECT_LT((8.0 * way + 1003.0 * back).norm(), 1e-9) << "by their masses";
  for (int k = 0; k < 10; ++k) ASSERT_TRUE(simulation.step(1.0).accepted);
  EXPECT_LT(simulation.body(0).v.norm(), 1e-9);
}

TEST(SurfaceOverlaps, AreRefusedIfBothSidesAreFixed) {
  EXPECT_THAT(complaint(model_of("bodies:\n  thing: {fixed: true, shape: {sphere: 0.1}}\n",
                                 kResolve, "prescribed: {hold: {nodes: zmin, x: 0, y: 0, z: 0}}")),
              HasSubstr("could not be moved apart"));
  EXPECT_THAT(complaint(model_of(rope("[-3, 0.1, 0.12]", "[3, 0.1, 0.12]"), kResolve,
                                 "prescribed: {hold: {nodes: zmin, x: 0, y: 0, z: 0}}")),
              HasSubstr("could not be moved apart"));
}

}  // namespace
}  // namespace polhode::surface_overlaps_tests
