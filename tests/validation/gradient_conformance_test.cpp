// SPDX-License-Identifier: Apache-2.0
// Gradients of every kind of load and of every example against differences of runs.
#include <filesystem>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <gradient/gradient_models.hpp>
#include <polhode/core/error.hpp>
#include <polhode/gradient/differentiable.hpp>
#include <polhode/gradient/event_margin.hpp>
#include <polhode/loads/registry.hpp>

namespace polhode::test::gradient_conformance_tests {
namespace {

/// A load on two bodies, and the parameters by which is differentiated.
struct LoadCase {
  std::string text;
  std::vector<std::string> by{};
  const char* moves = "one";  ///< The body that the load moves.
};

const std::string kHinges = R"yaml(
joints:
  a: {type: revolute, bodies: [ground, one], at: [0.5, 0, 1.2], axis: [0.2, 0, 1]}
  b: {type: revolute, bodies: [ground, two], at: [0.9, 0.2, 1.1], axis: [0.3, 0.1, 1]}
)yaml";
const std::string kSlides = R"yaml(
joints:
  a: {type: prismatic, bodies: [ground, one], at: [0.5, 0.1, 1.2], axis: [1, 0, 0.5]}
  b: {type: cylindrical, bodies: [ground, two], at: [0.9, 0.3, 1.1], axis: [1, 1, 0.4]}
)yaml";
const std::string kCam = R"yaml(
joints:
  a: {type: revolute, bodies: [ground, one], at: [0.5, 0.1, 1.2], axis: z}
  b: {type: prismatic, bodies: [ground, two], at: [0.5, 0.3, 1.2], axis: y}
)yaml";

/// A sample of every kind of load.
std::map<std::string, LoadCase> load_cases() {
  const auto loads = [](const std::string& it) { return "loads: {it: {" + it + "}}\n"; };
  const std::string pair = ", bodies: [ground, one], at: [[0, 0, 1], [0.5, 0.1, 1.3]], ";
  return {
      {"force", {loads("type: force, body: one, at: [0.5, 0.2, 1.2], force: [p*sin(9*t), 1, -p]")}},
      {"moment", {loads("type: moment, body: one, moment: [0.3*p, 2*t, 1]")}},
      {"spring_damper",
       {loads("type: spring_damper" + pair + "stiffness: 300*p, damping: 4, free_length: 0.4"),
        {"loads.it.damping", "loads.it.free_length"}}},
      {"potential", {loads("type: potential" + pair + "energy: -0.3*p/l + 0.01/l^3")}},
      {"axial_force",
       {loads("type: axial_force" + pair + "pull: 3*p*sin(20*t), damping: 2"),
        {"loads.it.damping"}}},
      {"vector_damper",
       {loads("type: vector_damper" + pair + "damping: 3*p, turning_damping: 0.2"),
        {"loads.it.turning_damping"}}},
      {"bushing",
       {loads("type: bushing, bodies: [ground, one], at: [0.4, 0.1, 1.2], stiffness: [900*p, 800, "
              "700], turning_stiffness: [60, 40*p, 50], damping: [3, 3, 1]"),
        {"loads.it.damping.1"}}},
      {"attraction", {loads("type: attraction, bodies: [one, two], strength: 0.3*p")}},
      {"gravity_gradient", {loads("type: gravity_gradient, bodies: [one, two], mu: 0.1*p")}},
      {"drag",
       {loads("type: drag, body: one, linear: p, quadratic: 0.3, turning: 0.05"),
        {"loads.it.quadratic", "loads.it.turning"}}},
      {"axis_drag",
       {loads("type: axis_drag, bodies: [ground, one], at: [0.4, 0.1, 1.2], linear: [3*p, 1, 2], "
              "quadratic: [1, 2, 1], turning: [0.2, 0.1, 0.3], quadratic_turning: [0.1, 0.2, 0.1]"),
        {"loads.it.quadratic.1", "loads.it.turning.0"}}},
      {"rotor",
       {"loads: {it: {type: rotor, body: one, axis: [1, 2, 3], inertia: 0.1*p, moment: 3*p*t, "
        "start_speed: 20}, other: {type: rotor, body: two, inertia: 0.1, speed: 20 + 30*p*t}}\n",
        {"loads.it.start_speed", "loads.other.inertia", "bodies.one.angular_velocity.0"}}},
      {"torsional_spring",
       {kHinges + loads("type: torsional_spring, joint: a, stiffness: 30*p, damping: 1"),
        {"loads.it.damping"}}},
      {"translational_spring",
       {kSlides + loads("type: translational_spring, joint: a, stiffness: 300*p, damping: 2"),
        {"loads.it.damping"}}},
      {"rotary_motor",
       {kHinges + "loads: {it: {type: rotary_motor, joint: a, speed: p + 20*t}, "
                  "other: {type: rotary_motor, joint: b, moment: 2*p}}\n"}},
      {"linear_motor",
       {kSlides + loads("type: linear_motor, joint: b, displacement: 0.3*p*t + t^2"), {}, "two"}},
      {"rotary_servo",
       {kHinges + loads("type: rotary_servo, joint: a, angle: 2*p*t^2, stiffness: 50, damping: 2"),
        {"loads.it.stiffness"}}},
      {"linear_servo",
       {kSlides +
            loads("type: linear_servo, joint: a, displacement: p*t^2, stiffness: 50, damping: 9"),
        {"loads.it.damping"}}},
      {"rotary_inerter", {kHinges + loads("type: rotary_inerter, joint: a, inertance: 0.4*p")}},
      {"linear_inerter", {kSlides + loads("type: linear_inerter, joint: a, inertance: 3*p")}},
      {"gear", {kHinges + loads("type: gear, joints: [a, b], ratio: -2*p")}},
      {"screw", {kSlides + loads("type: screw, joint: b, pitch: 0.05*p"), {}, "two"}},
      {"coupling",
       {kHinges + loads("type: coupling, joints: [a, b], factors: [-2*p]"), {"joints.b.at.1"}}},
      {"point_on_surface",
       {loads("type: point_on_surface, bodies: [ground, one], at: [[0.2, 0.1, 1.2], [0.2 + 0.3*p, "
              "0.1, 1.2]], semi_axes: [0.3*p, 0.4, 0.5]"),
        {"loads.it.semi_axes.1"}}},
      {"point_on_curve",
       {loads("type: point_on_curve, bodies: [ground, one], at: [[0.4, 0.1, 1.2], [0.5, 0.1, "
              "1.2]], curve_x: 0.1*cos(s), curve_y: 0.12*p*sin(s), holds: point")}},
      {"curve_on_curve",
       {kCam + "loads: {it: {type: curve_on_curve, bodies: [one, two], at: [[0.5, 0.1, 1.2], [0.5, "
               "0.18, 1.2]], curve_x: 0.06*cos(s), curve_y: 0.02 + 0.06*sin(s), other_points: "
               "[[-0.1, 0, 0], [0, 0, 0], [0.1, 0, 0]]}, k: {type: translational_spring, joint: "
               "b, stiffness: 40*p}}\n",
        {"bodies.one.angular_velocity.2", "bodies.one.inertia.2"}}},
      {"slide_on_beam",
       {"sections: {s: {type: general, EA: 1e4, GA_y: 4e3, GA_z: 4e3, GJ: 160, EI_y: 200*p, EI_z: "
        "150, mass_per_length: 0.5, inertia_per_length: [0.01, 0.005, 0.005]}}\n"
        "beams: {rail: {points: [[-0.5, 0.1, 1.2], [1.5, 0.1, 1.2]], elements: 4, section: s, "
        "bonded: {ground: start}}}\n"
        "loads: {it: {type: slide_on_beam, beam: rail, body: one, stiffness: 30, free_position: 1, "
        "damping: 2}}\n",
        {"loads.it.stiffness", "loads.it.free_position"}}},
      {"rolling",
       {loads("type: rolling, bodies: [ground, one], at: [[0, 0, 0.9], [0.5, 0.1, 0.9 + 0.3*p]], "
              "axle: y, radius: 0.3*p") +
        "joints: {}\n"}}};
}

std::string text_of(const LoadCase& c, bool rolls) {
  return std::string(R"yaml(
format: 1
gravity: [0, 0, -9.81]
variables: {p: 1.0}
bodies:
  one: {mass: 2, inertia: [0.1, 0.15, 0.2], position: [0.5, 0.1, )yaml") +
         (rolls ? "0.9 + 0.3*p" : "1.2") +
         R"yaml(], velocity: [0.3, -0.2, 0.1], angular_velocity: [0.5, -0.8, 1.3]}
  two: {mass: 1, inertia: [0.05, 0.04, 0.06], position: [0.9, 0.3, 1.1], velocity: [0.1, 0.2, 0.4], angular_velocity: [-0.4, 0.2, 0.6]}
analysis: {duration: 0.2 s, step: 10 ms}
output: {probes: {tip: {body: )yaml" +
         c.moves + ", point: [0.6, 0.3, 1.4]}}}\n" + c.text;
}

/// Whether the gradient of a model is refused before it runs.
bool is_refused(const Model& model) {
  try {
    SystemMap map;
    const System system = build_system(model, &map);
    require_differentiable(model, system);
    require_differentiable_events(model, system, map);
    return false;
  } catch (const InputError&) {
    return true;
  }
}

struct Way {
  double step;
  int steps, order;
  double rho_inf, check, bound;
};

TEST(GradientConformance, OfEveryKindOfLoadIsThatOfRuns) {
  // At small steps the run is 20 ms long, whose effects are small beside the rounding of runs.
  const Way ways[] = {{0.02, 8, 2, 1.0, 1e-11, 3e-8},
                      {0.01, 16, 2, 1.0, 1e-11, 3e-8},
                      {2e-4, 100, 2, 1.0, 1e-9, 1e-5},
                      {0.01, 16, 2, 0.8, 1e-11, 3e-8},
                      {0.02, 6, 4, 1.0, 1e-11, 1e-7}};
  const std::map<std::string, LoadCase> cases = load_cases();
  for (const LoadKind& kind : load_kinds()) {
    const auto found = cases.find(kind.name);
    ASSERT_NE(found, cases.end()) << kind.name << " has no sample";
    if (kind.name == "slide_on_beam") {  // along nodes
      EXPECT_TRUE(is_refused(io::read_model_text(text_of(found->second, false), "model.yaml")));
      continue;
    }
    std::vector<std::string> by = found->second.by;
    by.insert(by.end(), {"p", "bodies.one.mass", "bodies.one.velocity.1"});
    for (const Way& way : ways) {
      SCOPED_TRACE(kind.name + " " + std::to_string(way.step) + " " + std::to_string(way.order));
      try {
        for (const char* outcome : {"probes.tip.x", "probes.tip.vx"})
          EXPECT_LT(difference_from_runs({text_of(found->second, kind.name == "rolling"),
                                          way.step,
                                          way.steps,
                                          by,
                                          {outcome},
                                          way.order,
                                          way.rho_inf},
                                         1e-2, way.check),
                    way.bound)
              << outcome;
      } catch (const std::exception& error) {
        ADD_FAILURE() << error.what();
      }
    }
  }
}

struct ExampleCase {
  double step = 0.0;
  int steps = 0, order = 2;
  std::vector<std::string> by;
  std::string outcome;
  double bound = 2e-8;
};

/// Examples that have gradients; all others are refused.
std::map<std::string, ExampleCase> example_cases() {
  return {
      {"andrews_squeezer",
       {5e-5,
        10,
        6,
        {"motor", "bodies.K3.mass", "loads.spring.stiffness"},
        "bodies.K1.angular_velocity.z",
        1e-7}},
      {"bicycle", {0.005, 30, 2, {"variables.v", "bodies.frame.mass"}, "bodies.frame.velocity.y"}},
      {"bricard", {0.02, 10, 6, {"variables.L", "bodies.rod_1.mass"}, "bodies.rod_4.velocity.x"}},
      {"crank_rocker",
       {0.001, 100, 2, {"variables.rocker", "variables.coupler"}, "bodies.rocker_arm.velocity.x"}},
      {"door_on_two_hinges", {0.005, 40, 2, {"variables.width"}, "bodies.door.angular_velocity.z"}},
      {"double_pendulum",
       {0.01, 20, 6, {"bodies.upper.density", "gravity.2"}, "bodies.lower.velocity.x"}},
      {"excavator", {0.005, 40, 2, {"variables.boom_stroke"}, "bodies.boom.position.z"}},
      {"falling_cat", {0.002, 60, 2, {"variables.bend"}, "bodies.front.angular_velocity.y"}},
      {"flexible_four_bar",
       {0.001,
        15,
        2,
        {"materials.polyamide.youngs_modulus", "variables.speed"},
        "bodies.rocker.position.x"}},
      {"flyball_governor",
       {0.0025, 40, 2, {"variables.m_ball", "variables.turn"}, "bodies.slider.velocity.z"}},
      {"governor_on_motor", {0.002, 50, 2, {"variables.ball"}, "bodies.arm_b.velocity.x"}},
      {"gyroscope",
       {0.001, 40, 6, {"variables.spin", "variables.arm"}, "bodies.weight.position.y"}},
      {"heavy_top", {0.001, 40, 8, {"gravity.2"}, "bodies.top.angular_velocity.x"}},
      {"n_four_bar", {0.01, 12, 6, {"gravity.2"}, "bodies.bar_2.velocity.y"}},
      {"planetary_gearbox", {0.002, 40, 2, {"variables.r"}, "bodies.planet_1.velocity.x"}},
      {"reaction_wheels", {0.01, 20, 2, {"slew"}, "bodies.satellite.angular_velocity.x"}},
      {"spatial_slider_crank", {0.002, 30, 6, {"variables.speed"}, "bodies.rod.velocity.x"}},
      {"stewart_platform",
       {0.002, 30, 2, {"variables.w", "variables.H"}, "bodies.cylinder_2.velocity.x"}},
      {"suspension_corner",
       {0.002, 60, 2, {"loads.strut.stiffness", "bodies.wheel.mass"}, "bodies.wheel.velocity.z"}},
      {"three_rrr", {0.002, 40, 2, {"variables.l", "variables.w"}, "bodies.upper_3.velocity.x"}},
      {"tumbling_body",
       {0.01, 20, 8, {"variables.spin", "variables.bar"}, "bodies.handle.angular_velocity.y"}},
  };
}

TEST(GradientConformance, OfEveryExampleIsEitherTestedOrRefused) {
  const std::map<std::string, ExampleCase> cases = example_cases();
  int refused = 0;
  for (const auto& folder : std::filesystem::directory_iterator(source_dir() + "/examples")) {
    const std::string file = folder.path().string() + "/model.yaml";
    const std::string name = folder.path().filename().string();
    // Three located balls, and the cradle, have tests of their own.
    if (!std::filesystem::exists(file) || cases.contains(name) || name == "bouncing_ball" ||
        name == "newtons_cradle" || name == "delta_robot")
      continue;
    EXPECT_TRUE(is_refused(io::read_model_text(io::read_file(file), file))) << name;
    ++refused;
  }
  EXPECT_GT(refused, 10);
}

TEST(GradientConformance, OfEverySmoothExampleIsThatOfRuns) {
  for (const auto& [name, c] : example_cases()) {
    SCOPED_TRACE(name);
    try {
      EXPECT_LT(difference_from_runs(
                    {example_text(name), c.step, c.steps, c.by, {c.outcome}, c.order}, 1e-3, 1e-10),
                c.bound);
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what();
    }
  }
}

}  // namespace
}  // namespace polhode::test::gradient_conformance_tests
