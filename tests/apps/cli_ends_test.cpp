// SPDX-License-Identifier: Apache-2.0
// Equilibria and modes by the command line, and runs that end early.
#include <fstream>

#include <gmock/gmock.h>
#include <polhode/core/format.hpp>

#include "command_line.hpp"

namespace polhode::cli_ends_tests {
namespace {

using test::CommandLine;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

TEST_F(CommandLine, EndsWith4AndKeepsTheLastStateWhenAStepDoesNotConverge) {
  const auto result = run({"run", "model.yaml", "--set", "analysis.max_iterations=1", "--set",
                           "analysis.min_step=10 ms"});
  EXPECT_EQ(result.code, 4) << result.err;
  EXPECT_THAT(result.err, HasSubstr("body '"));
  EXPECT_TRUE(exists("model.results/checkpoint.pst"));
  EXPECT_TRUE(exists("model.results/results.h5"));
}

// Steps without an end are for programs; a run needs one, from the model or the command.
TEST_F(CommandLine, RunsAnEndlessModelForAGivenTime) {
  const std::vector<std::string> endless = {"--set", "analysis.duration=none"};
  const auto with = [&](std::vector<std::string> words) {
    words.insert(words.end(), endless.begin(), endless.end());
    return run(words);
  };
  for (const auto& [command, more] :
       {std::pair("run", "--quiet"), std::pair("certify", "--quiet")}) {
    const auto refused = with({command, "model.yaml", more});
    EXPECT_EQ(refused.code, 3) << command;
    EXPECT_THAT(refused.err, HasSubstr("analysis.duration: is none, but a run needs an end. Give a "
                                       "duration, in the model or by --duration \"10 s\""));
  }
  EXPECT_FALSE(exists("model.results"));
  EXPECT_THAT(with({"check", "model.yaml"}).out,
              HasSubstr("none     steps from Python or C++; a run needs --duration"));
  EXPECT_THAT(with({"info", "model.yaml"}).out, HasSubstr("without an end"));
  const auto some = with({"run", "model.yaml", "--duration", "0.2 s", "--json"});
  EXPECT_EQ(some.code, 0) << some.err;
  const auto usual = run({"run", "model.yaml", "--set", "analysis.duration=0.2 s", "--json"});
  EXPECT_EQ(value(some.out, "result_hash"), value(usual.out, "result_hash"));
  EXPECT_EQ(value(some.out, "t"), "0.2");
  EXPECT_THAT(with({"check", "model.yaml", "--set", "analysis.step=auto"}).err,
              HasSubstr("analysis.duration: none requires a fixed step."));
}

// A stiff oscillator that numerical dissipation damps at a coarse step, not at a hundredth of it.
TEST_F(CommandLine, EndsWith6WhenAStrictRunIsNotTrusted) {
  write("stiff.yaml", R"(format: 1
bodies: {a: {mass: 1, inertia: [1, 1, 1], position: [1.1, 0, 0]}}
joints: {guide: {type: prismatic, bodies: [ground, a], at: [0, 0, 0], axis: x}}
loads: {s: {type: spring_damper, bodies: [ground, a], at: [[0, 0, 0], [1.1, 0, 0]], stiffness: 1000, free_length: 1}}
analysis: {duration: 0.2 s, step: 20 ms, rho_inf: 0}
)");
  const auto loose = run({"run", "stiff.yaml", "--json"});
  EXPECT_EQ(loose.code, 0);
  EXPECT_EQ(value(loose.out, "trusted"), "false");
  EXPECT_THAT(loose.out, HasSubstr("the balance of energy does not close"));
  EXPECT_THAT(loose.err, HasSubstr("warning: not trusted: the balance of energy"));
  const auto strict = run({"run", "stiff.yaml", "--strict", "--json"});
  EXPECT_EQ(strict.code, 6);
  EXPECT_EQ(value(strict.out, "end"), "\"finished\"");
  EXPECT_TRUE(exists("stiff.results/results.h5")) << "results are kept";
  const auto fine =
      run({"run", "stiff.yaml", "--strict", "--json", "--set", "analysis.step=0.2 ms"});
  EXPECT_EQ(fine.code, 0) << fine.err;
  EXPECT_EQ(value(fine.out, "trusted"), "true");
  const auto certified = run({"certify", "stiff.yaml"});
  EXPECT_EQ(certified.code, 6);
  EXPECT_THAT(certified.err, HasSubstr("nothing is certified, as run 1 is not trusted"));
}

/// A motor in a bar that two hinges lock: the start shows it.
TEST_F(CommandLine, NamesJointsAndDrivesThatContradictEachOther) {
  write("locked.yaml", R"(format: 1
bodies: {a: {shape: {box: [1, 0.1, 0.1]}, density: 1000, position: [0.5, 0, 0]}}
joints:
  A: {type: revolute, bodies: [ground, a], at: [0, 0, 0], axis: y}
  B: {type: revolute, bodies: [ground, a], at: [1, 0, 0], axis: y}
loads: {m: {type: rotary_motor, joint: A, speed: 1}}
analysis: {duration: 1, step: 10 ms}
)");
  const auto result = run({"run", "locked.yaml"});
  EXPECT_EQ(result.code, 4) << result.err;
  EXPECT_THAT(result.err, HasSubstr("At t = 0 s these cannot all hold: joint 'A', joint 'B', "
                                    "rotary_motor 'm'; a step of 0.01 s leaves a gap of "));
  EXPECT_THAT(result.err, HasSubstr("Remove one of them, or change its motion.\n"));
  EXPECT_TRUE(exists("locked.results/results.h5"));
  const auto checked = run({"check", "locked.yaml"});
  EXPECT_EQ(checked.code, 6);
  EXPECT_THAT(checked.err, HasSubstr("These cannot all hold from the start on: joint 'A', joint "
                                     "'B', rotary_motor 'm'. Remove one of them, or change its "
                                     "motion.\n"));
  const auto json = run({"check", "locked.yaml", "--json"});
  EXPECT_EQ(json.code, 6);
  EXPECT_EQ(value(json.out, "valid"), "false");
}

TEST_F(CommandLine, FindsAnEquilibriumAndWritesItsLoadSteps) {
  write("weight.yaml", R"(format: 1
gravity: [0, 0, -10]
bodies:
  weight: {mass: 2, inertia: [1, 1, 1], position: [0, 0, -1]}
joints:
  guide: {type: prismatic, bodies: [ground, weight], at: [0, 0, 0], axis: z}
loads:
  spring: {type: spring_damper, bodies: [ground, weight], at: [[0, 0, 0], [0, 0, -1]],
           stiffness: 400 N/m, free_length: 1 m}
analysis: {type: statics, load_steps: 4}
output:
  probes:
    weight: {body: weight}
)");
  const auto result = run({"run", "weight.yaml", "--json"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(value(result.out, "steps"), "4");
  EXPECT_EQ(value(result.out, "frames"), "5");
  EXPECT_EQ(value(result.out, "unstable_directions"), "0");
  EXPECT_NEAR(std::stod(value(result.out, "strain_energy")), 0.5 * 400 * 0.05 * 0.05, 1e-12);
  const std::string table = read("weight.results/probes/weight.csv");
  EXPECT_THAT(table, HasSubstr("\n1,0,0,-1.0"));  // -1.05, to rounding
  const auto shown = run({"run", "weight.yaml"});
  EXPECT_THAT(shown.out, AllOf(HasSubstr("load carried"), HasSubstr("stable")));
}

TEST_F(CommandLine, StopsInStaticsAtTheWallLimit) {
  write("hung.yaml", R"(format: 1
gravity: [0, 0, -10]
bodies: {weight: {mass: 2, inertia: [1, 1, 1], position: [0, 0, -1]}}
joints: {guide: {type: prismatic, bodies: [ground, weight], at: [0, 0, 0], axis: z}}
loads: {spring: {type: translational_spring, joint: guide, stiffness: 400 N/m}}
analysis: {type: statics, load_steps: 4}
)");
  const auto stopped = run({"run", "hung.yaml", "--wall-limit", "0", "--json"});
  EXPECT_EQ(stopped.code, 75) << stopped.err;
  EXPECT_EQ(run({"run", "hung.yaml", "--json"}).code, 0);
}

TEST_F(CommandLine, StopsInModesAtTheWallLimit) {
  write("hung.yaml", R"(format: 1
bodies: {weight: {mass: 2, inertia: [1, 1, 1], position: [0, 0, -1]}}
joints: {guide: {type: prismatic, bodies: [ground, weight], at: [0, 0, 0], axis: z}}
loads: {spring: {type: translational_spring, joint: guide, stiffness: 400 N/m}}
analysis: {type: modes, about: start}
)");
  const auto stopped = run({"modes", "hung.yaml", "--wall-limit", "0"});
  EXPECT_EQ(stopped.code, 75) << stopped.err;
  EXPECT_THAT(stopped.err, HasSubstr("Stopped before modes were computed"));
  EXPECT_EQ(run({"modes", "hung.yaml"}).code, 0);
}

TEST_F(CommandLine, EndsWith4AndNamesAnUnsupportedBody) {
  write("stone.yaml", R"(format: 1
gravity: [0, 0, -10]
bodies:
  stone: {mass: 2, inertia: [1, 1, 1]}
analysis: {type: statics}
)");
  const auto result = run({"run", "stone.yaml"});
  EXPECT_EQ(result.code, 4) << result.err;
  EXPECT_THAT(result.err, HasSubstr("body 'stone'"));
  EXPECT_TRUE(exists("stone.results/results.h5"));
}

/// Equilibrium of a slack cable: its tangent stiffness is zero, so relaxation finds the shape.
TEST_F(CommandLine, FindsTheShapeOfASlackCableAndReportsTheMethod) {
  write("slack.yaml", R"(format: 1
gravity: [0, 0, -9.81]
cables:
  rope: {through: [[ground, [0, 0, 0]], [ground, [10, 0, 0]]], stiffness: 1e5 N,
         free_length: 10.5 m, mass_per_length: 1.0, elements: 80}
analysis: {type: statics}
)");
  const auto result = run({"run", "slack.yaml"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("found by relaxation"));
  const auto json = run({"run", "slack.yaml", "--json"});
  EXPECT_EQ(value(json.out, "relaxed"), "true");
  EXPECT_EQ(value(json.out, "unstable_directions"), "0");
}

/// Equations that cannot be solved are no internal error.
TEST_F(CommandLine, NamesModesThatCannotBeComputed) {
  write("stiff.yaml", R"(format: 1
bodies: {bob: {mass: 1, inertia: [1, 1, 1], position: [0, 0, 1]}}
loads: {spring: {type: spring_damper, bodies: [ground, bob], at: [[0, 0, 0], [0, 0, 1]], stiffness: 1e308}}
analysis: {type: modes, count: 3}
)");
  const auto result = run({"modes", "stiff.yaml"});
  EXPECT_EQ(result.code, 4);
  EXPECT_EQ(result.err,
            "stiff.yaml:4:1: error: modes: a frequency is not a finite number. Look for a mass, "
            "inertia or stiffness that is far too small or too large.\n"
            "    4 | analysis: {type: modes, count: 3}\n"
            "      | ^~~~~~~~\n");
}

TEST_F(CommandLine, PrintsAndWritesNaturalFrequencies) {
  write("swing.yaml", R"(format: 1
gravity: [0, -10, 0]
bodies:
  bob: {mass: 1, inertia: [1, 1, 1], position: [0, -1, 0]}
joints:
  hinge: {type: revolute, bodies: [ground, bob], at: [0, 0, 0], axis: z}
analysis: {type: modes}
output: {paraview: true}
)");
  for (const char* command : {"modes", "run"}) {
    const auto result = run({command, "swing.yaml", "--json"});
    ASSERT_EQ(result.code, 0) << result.err;
    // ω² = m g a / (J + m a²) = 5.
    EXPECT_NEAR(std::stod(value(result.out, "frequency")), std::sqrt(5.0) / 6.283185307179586,
                1e-12);
    EXPECT_EQ(value(result.out, "complete"), "true");
  }
  EXPECT_TRUE(exists("swing.results/modes.h5"));
  EXPECT_TRUE(exists("swing.results/paraview/modes.pvd"));
  EXPECT_THAT(run({"modes", "swing.yaml"}).out, HasSubstr("0.355881"));
  const auto json = run({"modes", "swing.yaml", "--count", "5", "--json"});
  EXPECT_THAT(json.err, HasSubstr("5 modes were requested, but the model has 1 only"));
  for (const char* key : {"cpu_time_s", "damping_ratio", "\"kind\": \"oscillation\"", "eigenvalue"})
    EXPECT_THAT(json.out, HasSubstr(key));
}

TEST_F(CommandLine, DrawsTheModesOfSolids) {
  write("bar.yaml", R"(format: 1
materials: {m: {type: elastic, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}}
solids:
  bar: {mesh: {block: {size: [1, 0.1, 0.1], cells: [4, 1, 1]}}, element: hex8, material: m, bonded: {ground: xmin}}
analysis: {type: modes, count: 3}
output: {paraview: true}
)");
  const auto result = run({"modes", "bar.yaml"});
  ASSERT_EQ(result.code, 0) << result.err;
  const std::string list = read("bar.results/paraview/modes_solids.pvd");
  EXPECT_THAT(list, AllOf(HasSubstr("timestep=\"1\""), HasSubstr("timestep=\"3\"")));
  EXPECT_THAT(list, testing::Not(HasSubstr("timestep=\"4\"")));
}

// A motor without a limit: the rotor becomes too fast for the smallest step.
TEST_F(CommandLine, EndsWith4NamesTheBodyAndKeepsTheLastStateOfAModelThatRunsAway) {
  write("motor.yaml", R"(format: 1
bodies:
  rotor: {mass: 1, inertia: [0.03, 0.03, 0.05]}
joints:
  shaft: {type: revolute, bodies: [ground, rotor], at: [0, 0, 0], axis: z}
loads:
  motor: {type: moment, body: rotor, moment: [0, 0, 200 N m]}
analysis: {duration: 10 s, step: 2 ms, min_step: 0.5 ms}
output:
  every: 0.1 s
  probes:
    shaft: {joint: shaft}
    motor: {load: motor}
)");
  const auto result = run({"run", "motor.yaml", "--json", "--isa", "baseline"});
  EXPECT_EQ(result.code, 4) << result.err;
  EXPECT_EQ(value(result.out, "end"), "\"not_converged\"");
  EXPECT_EQ(value(result.out, "instruction_set"), "\"baseline\"");
  EXPECT_THAT(result.err, AllOf(HasSubstr("body 'rotor'"), HasSubstr("max_step_rotation")));
  EXPECT_TRUE(exists("motor.results/checkpoint.pst"));
  EXPECT_THAT(read("motor.results/probes/motor.csv"),
              StartsWith("t [s],mx [N m],my [N m],mz [N m]\n0,0,0,200\n"));
  const auto rest = run({"run", "motor.yaml", "--restart", "motor.results/checkpoint.pst"});
  EXPECT_EQ(rest.code, 4) << rest.err;
}

/// A cube of one metre on the ground whose top is pressed, E = 1 Pa, in one nearly static step.
std::string pressed_cube(
    const std::string& material, double pressure,
    const std::string& analysis = "{duration: 50 s, step: 25 s, min_step: 25 s, rho_inf: 0}") {
  return R"(format: 1
materials:
  foam: {type: )" +
         material + R"(, youngs_modulus: 1, poisson_ratio: 0, density: 1}
solids:
  cube:
    mesh: {block: {size: [1, 1, 1], cells: [2, 2, 2]}}
    element: hex8
    material: foam
    bonded: {ground: zmin}
loads:
  press: {type: traction, solid: cube, surface: zmax, traction: [0, 0, )" +
         std::to_string(-pressure) + R"(]}
analysis: )" +
         analysis + R"(
output:
  paraview: true
  probes:
    top: {solid: cube, point: [0, 0, 0.5]}
)";
}

// A load above the maximum that the material can carry.
TEST_F(CommandLine, EndsWith4NamesTheElementAndKeepsTheLastStateOfASolidThatCollapses) {
  write("cube.yaml", pressed_cube("elastic", 1.5));
  const auto result = run({"run", "cube.yaml", "--json"});
  EXPECT_EQ(result.code, 4) << result.err;
  EXPECT_EQ(value(result.out, "end"), "\"not_converged\"");
  EXPECT_THAT(result.err, testing::ContainsRegex("element [0-7] of 'solids.cube'"));
  EXPECT_TRUE(exists("cube.results/checkpoint.pst"));
  EXPECT_TRUE(exists("cube.results/results.h5"));
  EXPECT_THAT(read("cube.results/probes/top.csv"), HasSubstr("\n0,0,0,0.5"));
}

TEST_F(CommandLine, EndsWith4AtTheLastEquilibriumOfASolidThatCollapses) {
  write("cube.yaml", pressed_cube("elastic", 1.5, "{type: statics}"));
  const auto result = run({"run", "cube.yaml", "--json"});
  EXPECT_EQ(result.code, 4) << result.err;
  EXPECT_THAT(result.err, testing::ContainsRegex("element [0-7] of 'solids.cube'"));
  const double reached = std::stod(value(result.out, "load_factor"));
  EXPECT_GT(reached, 0.1);
  EXPECT_LT(reached, 0.2);  // the largest load with guided sides is E/(3 √3)
  EXPECT_EQ(value(result.out, "t"), value(result.out, "load_factor"));
  // A frame, a row and a picture for every load step.
  EXPECT_THAT(read("cube.results/probes/top.csv"), HasSubstr("\n" + value(result.out, "t") + ","));
  const int steps = std::stoi(value(result.out, "steps"));
  EXPECT_GT(steps, 2);
  EXPECT_EQ(std::stoi(value(result.out, "frames")), steps + 1);
  EXPECT_TRUE(exists(format("cube.results/paraview/solids/{:06d}.vtu", steps)));
  EXPECT_FALSE(exists(format("cube.results/paraview/solids/{:06d}.vtu", steps + 1)));
}

TEST_F(CommandLine, WarnsWhenEnhancedElementsWereCompressedTooFar) {
  write("cube.yaml", pressed_cube("neo_hookean", 0.6));
  const auto result = run({"run", "cube.yaml", "--json"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.err, AllOf(HasSubstr("warning: solids.cube: element"), HasSubstr("0.7")));
  EXPECT_THAT(value(result.out, "warnings"), HasSubstr("["));
  write("cube.yaml", pressed_cube("neo_hookean", 0.1));
  // Its numerical dissipation, rho_inf: 0, takes the energy: that warning is right.
  EXPECT_THAT(run({"run", "cube.yaml"}).err, testing::Not(HasSubstr("warning: solids")));
}

#if !defined(__SANITIZE_ADDRESS__)
/// A solid under limits of the address space: a message or a result, never an endless search for
/// memory by the library of matrix products.
TEST_F(CommandLine, EndsWithASolidWhateverTheLimitOfMemory) {
  if (test::cli_program().ends_with("_emulated")) GTEST_SKIP() << "an emulator needs more";
  write("solid.yaml", R"(format: 1
gravity: [0, 0, -10]
materials: {rubber: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}}
solids:
  block: {mesh: {block: {size: [1, 1, 1], cells: [6, 6, 6]}}, element: hex8, material: rubber, bonded: {ground: zmin}}
analysis: {type: statics}
)");
  bool refused = false, finished = false;
  for (const int kilobytes : {100000, 150000, 200000, 300000, 2000000}) {
    SCOPED_TRACE(kilobytes);
    const test::ProgramResult r =
        test::Program({"/bin/sh", "-c",
                       "ulimit -v " + std::to_string(kilobytes) + "; exec timeout -s KILL 60 '" +
                           test::cli_program() + "' run solid.yaml --quiet -o out"},
                      folder_ / "")
            .wait();
    EXPECT_NE(r.code, -1) << "did not end";
    EXPECT_NE(r.code, 137) << "did not end";
    finished = r.code == 0;
    if (finished) continue;
    if (r.code == 4) {
      EXPECT_THAT(r.err, HasSubstr("needs 224 MB of memory at once"));
      EXPECT_THAT(r.err, HasSubstr("ulimit -v"));
      refused = true;
    }
  }
  EXPECT_TRUE(finished);
  EXPECT_TRUE(refused);
}
#endif

}  // namespace
}  // namespace polhode::cli_ends_tests
