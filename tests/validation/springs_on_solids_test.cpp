// SPDX-License-Identifier: Apache-2.0
// Springs, given forces and potentials with ends on points of solids.
#include <cmath>

#include <gmock/gmock.h>

#include <polhode/compile/solid_point.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::springs_on_solids_tests {
namespace {

using testing::HasSubstr;

constexpr const char* kSteps[] = {"10 ms", "2 ms", "0.1 ms"};

Simulation solved(const std::string& text) {
  Simulation s(io::read_model_text(text, "springs.yaml"));
  const RunSummary done = s.run();
  EXPECT_EQ(done.end, RunEnd::finished) << done.message;
  return s;
}

std::string fault(const std::string& text) {
  try {
    const Simulation s(io::read_model_text(text, "springs.yaml"));
    return "none";
  } catch (const io::ModelErrors& e) {
    return e.text();
  } catch (const InputError& e) {
    return e.where() + ": " + e.what_is_wrong();
  }
}

// A body and a solid that is bonded to it with all its nodes. What pulls at a point of the solid
// pulls the body as if it ended there.
std::string carried(const std::string& end, const std::string& load, const std::string& analysis) {
  return "format: 1\ngravity: [0, 0, -9.81]\n"
         "materials: {m: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: "
         "1000}}\n"
         "bodies: {box: {mass: 2, inertia: [0.03, 0.04, 0.05], position: [0.1, 0, 0], velocity: "
         "[0.5, 1, 0], angular_velocity: [2, 1, -3]}}\n"
         "solids: {pad: {mesh: {block: {size: [0.2, 0.1, 0.1], cells: [2, 1, 1]}, position: [0.3, "
         "0, 0], orientation: {axis: z, angle: 20 deg}}, element: hex20, material: m, bonded: "
         "{box: "
         "{box: {from: [-1, -1, -1], to: [1, 1, 1]}}}}}\n"
         "loads: {it: {bodies: [ground, " +
         end + "], at: [[0, 0.2, 1], [0.33, 0.02, 0.03]], " + load + "}}\nanalysis: {" + analysis +
         "}\n";
}

// @tests{spring-gradient}
TEST(SpringsOnSolids, PullABondedSolidAsTheyPullItsBody) {
  for (const char* load :
       {"type: spring_damper, stiffness: 300, damping: 5",
        "type: spring_damper, stiffness: 200, acts: tension, free_length: 0.9, quadratic: 100",
        "type: spring_damper, spring_force: {table: [[-0.5, -80], [0, 0], [0.2, 60], [1, 400]]}",
        "type: axial_force, pull: \"40*cos(9*t) N\", damping: 2",
        "type: potential, energy: 80*log(l/0.7)^2"})
    for (const char* step : kSteps) {
      SCOPED_TRACE(std::string(load) + ", " + step);
      const std::string analysis = "duration: 0.05, step: " + std::string(step);
      Simulation on_body = solved(carried("box", load, analysis));
      Simulation on_solid = solved(carried("pad", load, analysis));
      const BodyMotion a = on_body.body("box"), b = on_solid.body("box");
      EXPECT_LT((a.r - b.r).norm(), 1e-9);
      EXPECT_LT((a.v - b.v).norm(), 1e-8);
      EXPECT_LT(a.q.angularDistance(b.q), 1e-9);
      EXPECT_LT(on_solid.summary().energy_drift, 1e-10);
      EXPECT_LT(on_solid.summary().linear_momentum_drift, 1e-10);
      EXPECT_LT(on_solid.summary().angular_momentum_drift, 1e-10);
      const std::vector<double> one = on_body.load("it"), two = on_solid.load("it");
      ASSERT_EQ(one.size(), two.size());
      for (std::size_t k = 0; k < one.size(); ++k)
        EXPECT_NEAR(one[k], two[k], 1e-6 * (1.0 + std::abs(one[k]))) << k;
    }
}

// Two free solids, thrown and turning, on a spring between points within their elements.
TEST(SpringsOnSolids, KeepEnergyAndMomentum) {
  for (const char* step : kSteps) {
    Simulation s = solved(
        "format: 1\nmaterials: {m: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, "
        "density: 1000}}\nsolids:\n"
        "  one: {mesh: {block: {size: [0.2, 0.1, 0.1], cells: [2, 1, 1]}}, material: m, velocity: "
        "[0, 1, 0]}\n"
        "  two: {mesh: {block: {size: [0.1, 0.1, 0.1], cells: [1, 1, 1]}, position: [0.5, 0, 0]}, "
        "element: tet10, material: m, angular_velocity: [0, 20, 5]}\n"
        "loads: {tie: {type: spring_damper, bodies: [one, two], at: [[0.07, 0.01, 0.02], [0.45, "
        "-0.03, 0.05]], stiffness: 2 kN/m, free_length: 0.2},\n"
        "  inner: {type: spring_damper, bodies: [one, one], at: [[-0.1, -0.05, -0.05], [0.1, 0.05, "
        "0.05]], stiffness: 1 kN/m}}\n"
        "analysis: {duration: 60 ms, step: " +
        std::string(step) + "}\n");
    const RunSummary done = s.summary();
    EXPECT_LT(done.energy_drift, 1e-10) << step;
    EXPECT_LT(done.linear_momentum_drift, 1e-10) << step;
    EXPECT_LT(done.angular_momentum_drift, 1e-10) << step;
  }
}

// A bar without lateral contraction, held at one end, and pulled at the middle of the other one by
// a spring: its force is that of the spring's elongation, and the wall's reaction is its opposite.
TEST(SpringsOnSolids, BalanceInStatics) {
  for (const char* end : {"{type: spring_damper, stiffness: 5 kN/m, free_length: 0.5}",
                          "{type: axial_force, pull: 1 kN}"}) {
    std::string load = end;
    load.insert(1, "bodies: [bar, ground], at: [[1, 0, 0], [2, 0, 0]], ");
    Simulation s = solved(
        "format: 1\nmaterials: {m: {type: elastic, youngs_modulus: 1 MPa, poisson_ratio: 0, "
        "density: 1000}}\n"
        "solids: {bar: {mesh: {block: {size: [1, 0.2, 0.2], cells: [4, 2, 2]}, position: [0.5, 0, "
        "0]}, material: m, prescribed: {wall: {nodes: xmin, x: 0, y: 0, z: 0}}}}\nloads: {pull: " +
        load + "}\nanalysis: {type: statics}\n");
    const std::vector<double> report = s.load("pull");
    const double tip =
        s.solid_point(0, solid_point("", s.solids()[0].plan.mesh, Vec3(0.5, 0, 0)))[0].x();
    EXPECT_NEAR(report[3], 2.0 - tip, 1e-12);
    const double force =
        std::string(end).find("axial") == std::string::npos ? 5000 * (report[3] - 0.5) : 1000.0;
    EXPECT_NEAR(report[0], -force, 1e-8 * force);
    EXPECT_NEAR(s.interface_reaction(0, 0).force.x(), -force, 1e-6 * force);
    EXPECT_GT(tip, 1.01);
  }
}

TEST(SpringsOnSolids, FaultsAreNamed) {
  const auto with = [](const std::string& load, const std::string& more = "") {
    return "format: 1\nmaterials: {m: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: "
           "0.3, density: 1000}}\nsolids: {pad: {mesh: {block: {size: [1, 1, 1], cells: [1, 1, "
           "1]}}, material: m, bonded: {ground: zmin}}}\nloads: {it: {" +
           load + "}}\nanalysis: {duration: 1 ms, step: 1 ms}\n" + more;
  };
  const std::string ends = "bodies: [ground, pad], at: [[0, 0, 2], [0, 0, 0.5]], ";
  EXPECT_EQ(fault(with(ends + "type: spring_damper, stiffness: 1")), "none");
  EXPECT_THAT(fault(with("bodies: [ground, pad], at: [[0, 0, 2], [0, 0, 0.7]], type: "
                         "spring_damper, stiffness: 1")),
              HasSubstr("the point lies in no element of the solid"));
  EXPECT_THAT(fault(with(ends + "type: vector_damper, damping: 1")),
              HasSubstr("a vector_damper does not act on points of solids"));
  EXPECT_THAT(fault(with(ends + "type: spring_damper, damper_force: \"v > 0 ? 3 : -3\"")),
              HasSubstr("has a damper that jumps, and an end on a solid"));
  EXPECT_THAT(fault(with(ends + "type: spring_damper, stiffness: 1",
                         "events: {e: {at: 0.5 ms, off: [it]}}\n")),
              HasSubstr("is a load on a solid, which cannot be switched"));
  EXPECT_THAT(fault(with("bodies: [nobody, pad], at: [[0, 0, 2], [0, 0, 0.5]], type: "
                         "spring_damper, stiffness: 1")),
              HasSubstr("unknown body 'nobody'"));
}

}  // namespace
}  // namespace polhode::springs_on_solids_tests
