// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include <gmock/gmock.h>
#include <polhode/io/text/example_models.hpp>

#include "command_line.hpp"

namespace polhode::cli_tests {
namespace {

using test::CommandLine;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

TEST_F(CommandLine, SuggestsACommandForAMisspeltOne) {
  const auto result = run({"rum", "model.yaml"});
  EXPECT_EQ(result.code, 2);
  EXPECT_EQ(result.err,
            "polhode: there is no command 'rum'. Did you mean 'run'? Commands: run, certify, "
            "gradient, modes, view, plot, report, convert, import, export, check, info, schema, "
            "examples, doctor. Run "
            "'polhode --help' for its options.\n");
}

TEST_F(CommandLine, SuggestsAnOptionForAMisspeltOne) {
  const auto result = run({"run", "model.yaml", "--jsn"});
  EXPECT_EQ(result.code, 2);
  EXPECT_THAT(result.err, HasSubstr("does not take '--jsn'. Did you mean '--json'?"));
}

TEST_F(CommandLine, RequiresAModel) {
  const auto result = run({"run"});
  EXPECT_EQ(result.code, 2);
  EXPECT_THAT(result.err, StartsWith("polhode run: "));
}

TEST_F(CommandLine, EndsWith5ForAMissingFile) {
  const auto result = run({"run", "absent.yaml"});
  EXPECT_EQ(result.code, 5);
  EXPECT_THAT(result.err, HasSubstr("absent.yaml: cannot be opened (No such file or directory)"));
}

TEST_F(CommandLine, EndsWith3ForAnInvalidModelAndNamesTheLocation) {
  write("bad.yaml", "format: 1\nbodies:\n  a: {mass: -1, inertia: [1, 1, 1]}\n");
  for (const char* command : {"run", "check", "info"}) {
    const auto result = run({command, "bad.yaml"});
    EXPECT_EQ(result.code, 3) << command;
    EXPECT_THAT(result.err, HasSubstr("bad.yaml:3:")) << command;
    EXPECT_EQ(result.out, "") << command;
  }
  EXPECT_FALSE(exists("bad.results"));
}

TEST_F(CommandLine, EndsWith5WhenResultsCannotBeWritten) {
  write("taken", "a file where a folder should be");
  const auto result = run({"run", "model.yaml", "-o", "taken/results"});
  EXPECT_EQ(result.code, 5);
  EXPECT_THAT(result.err, HasSubstr("taken/results"));
}

TEST_F(CommandLine, RunsAndWritesTheOutputsOfTheModel) {
  const auto result = run({"run", "model.yaml"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("energy drift"), HasSubstr("steps")));
  EXPECT_THAT(result.err, AllOf(HasSubstr("Double pendulum"), HasSubstr("model.results")));
  EXPECT_THAT(result.err, Not(HasSubstr("\r"))) << "a progress line off a terminal";
  for (const char* file : {"results.h5", "checkpoint.pst", "probes/tip.csv", "probes/A.csv",
                           "paraview/results.pvd", "paraview/results/000050.vtp"})
    EXPECT_TRUE(exists(std::string("model.results/") + file)) << file;
  const std::string tip = read("model.results/probes/tip.csv");
  EXPECT_THAT(tip, StartsWith("t [s],x [m],y [m],z [m],vx [m/s],vy [m/s],vz [m/s],ax [m/s^2],"
                              "ay [m/s^2],az [m/s^2]\n0,2,0,0,0,0,0,"));
  EXPECT_EQ(std::count(tip.begin(), tip.end(), '\n'), 22);  // Header, and 0 to 1 s by 50 ms.
  const std::string hinge = read("model.results/probes/A.csv");
  EXPECT_THAT(hinge, StartsWith("t [s],fx [N],fy [N],fz [N],mx [N m],my [N m],mz [N m],rz [rad],"
                                "rate rz [rad/s]\n"));
  EXPECT_EQ(std::count(hinge.begin(), hinge.end(), '\n'), 52);  // By output.every, 20 ms.
}

TEST_F(CommandLine, PrintsOneJsonObjectAndNothingElse) {
  const auto result = run({"run", "model.yaml", "--json", "--quiet", "-o", "out"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_THAT(result.out, StartsWith("{\n"));
  for (const char* key :
       {"rejected_steps", "newton_iterations", "energy_drift", "linear_momentum_drift",
        "angular_momentum_drift", "constraint_residual_max", "velocity_constraint_residual_max",
        "wall_time_s", "cpu_time_s", "phases", "result_hash"})
    EXPECT_NE(value(result.out, key), "missing") << key;
  EXPECT_EQ(value(result.out, "steps"), "100");
  EXPECT_EQ(value(result.out, "frames"), "51");
  EXPECT_EQ(value(result.out, "end"), "\"finished\"");
  EXPECT_TRUE(exists("out/results.h5"));
}

TEST_F(CommandLine, ContinuesFromACheckpointBitForBit) {
  const auto straight = run({"run", "model.yaml", "--json", "--quiet", "-o", "straight"});
  ASSERT_EQ(straight.code, 0) << straight.err;
  ASSERT_EQ(
      run({"run", "model.yaml", "--quiet", "-o", "part", "--set", "analysis.duration=0.37 s"}).code,
      0);
  const auto rest = run(
      {"run", "model.yaml", "--json", "--quiet", "-o", "part", "--restart", "part/checkpoint.pst"});
  ASSERT_EQ(rest.code, 0) << rest.err;
  EXPECT_EQ(value(rest.out, "result_hash"), value(straight.out, "result_hash"));
  EXPECT_EQ(value(rest.out, "steps"), "100");
  // The tables equal those of the uninterrupted run, except for a frame at 0.37 s, where the part
  // ended.
  EXPECT_EQ(read("part/probes/tip.csv"), read("straight/probes/tip.csv"));
  EXPECT_EQ(value(rest.out, "frames"), "52");
  const auto before = run({"run", "model.yaml", "--quiet", "-o", "part", "--restart",
                           "part/checkpoint.pst", "--duration", "0.5 s"});
  EXPECT_EQ(before.code, 3);
  EXPECT_THAT(before.err, HasSubstr("--restart: the checkpoint is at t = 1 s, and the run ends at "
                                    "0.5 s. Give a longer --duration"));
}

/// Results do not depend on the number of threads: libraries must not divide sums among threads.
TEST_F(CommandLine, GivesTheSameBitsAtAnyThreadCount) {
  for (const std::string example : {"ironing", "stack", "flexible_four_bar"}) {
    write("example.yaml",
          test::text_of(test::source_dir() + "/examples/" + example + "/model.yaml"));
    std::string hash;
    for (const std::string threads : {"1", "2", "4"}) {
      std::vector<std::string> words{"/usr/bin/env"};
      for (const char* library : {"OMP_NUM_THREADS=", "OPENBLAS_NUM_THREADS=", "TBB_NUM_THREADS="})
        words.push_back(library + threads);
      words.insert(words.end(), {test::cli_program(), "run", "example.yaml", "--json", "--quiet",
                                 "--set", "analysis.duration=0.02 s"});
      const auto result = test::Program(words, folder_ / "").wait();
      ASSERT_EQ(result.code, 0) << result.err;
      if (hash.empty()) hash = value(result.out, "result_hash");
      EXPECT_EQ(value(result.out, "result_hash"), hash) << example << ", threads: " << threads;
    }
    EXPECT_NE(hash, "missing");
  }
}

TEST_F(CommandLine, StopsAtTheWallLimitWithACheckpoint) {
  const auto stopped = run({"run", "model.yaml", "--wall-limit", "0"});
  EXPECT_EQ(stopped.code, 75);
  EXPECT_THAT(stopped.err, HasSubstr("--restart model.results/checkpoint.pst"));
  const auto rest =
      run({"run", "model.yaml", "--restart", "model.results/checkpoint.pst", "--json", "--quiet"});
  const auto straight = run({"run", "model.yaml", "--json", "--quiet", "-o", "straight"});
  ASSERT_EQ(rest.code, 0) << rest.err;
  EXPECT_EQ(value(rest.out, "result_hash"), value(straight.out, "result_hash"));
  EXPECT_EQ(value(rest.out, "frames"), "51");
  const auto other = run({"run", "model.yaml", "--set", "analysis.duration=0.4 s", "-o", "other",
                          "--wall-limit", "0"});
  EXPECT_THAT(other.err, HasSubstr("polhode run model.yaml --set 'analysis.duration=0.4 s' "
                                   "-o other --restart other/checkpoint.pst"));
}

/// Steps that are longer than the interval of the output have rows of probes within them.
TEST_F(CommandLine, RecordsProbesBetweenSteps) {
  write("slow.yaml",
        "format: 1\ngravity: [0, 0, -9.81]\n"
        "bodies: {b: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [0.5, 0, 0]}}\n"
        "joints: {j: {type: revolute, bodies: [ground, b], at: [0, 0, 0], axis: y}}\n"
        "analysis: {duration: 5 s, tolerance: 1e-5}\n"
        "output: {every: 10 ms, probes: {j: {joint: j}}}\n");
  const auto result = run({"run", "slow.yaml", "--json", "--quiet"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(value(result.out, "frames"), "501");
  const std::string rows = read("slow.results/probes/j.csv");
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 1 + 501);
  EXPECT_THAT(rows, HasSubstr("\n0.01,"));
}

TEST_F(CommandLine, FinishesTheStepAndSavesWhenInterrupted) {
  for (const int signal : {SIGINT, SIGTERM}) {
    test::Program program = start({"run", "model.yaml", "--set", "analysis.duration=1e7 s", "--set",
                                   "output.paraview=false"});
    for (int i = 0; i < 200 && !exists("model.results/probes/A.csv"); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    program.signal(signal);
    const auto result = program.wait();
    EXPECT_EQ(result.code, 130);
    EXPECT_THAT(result.err, HasSubstr("Stopped at t = "));
    EXPECT_TRUE(exists("model.results/checkpoint.pst"));
    std::filesystem::remove_all(folder_ / "model.results");
  }
}

TEST_F(CommandLine, LeavesReadableFilesWhenItIsKilled) {
  test::Program program = start({"run", "model.yaml", "--set", "analysis.duration=1e7 s", "--set",
                                 "analysis.checkpoint_every=0.05"});
  const auto has_a_picture = [&] {
    return exists("model.results/paraview/results.pvd") &&
           read("model.results/paraview/results.pvd").find("file=\"") != std::string::npos;
  };
  for (int i = 0; i < 500 && !(exists("model.results/checkpoint.pst") && has_a_picture()); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  program.signal(SIGKILL);
  EXPECT_EQ(program.wait().code, -1);
  const std::string table = read("model.results/probes/A.csv");
  EXPECT_GT(table.size(), 100u);
  EXPECT_EQ(table.back(), '\n');
  const std::string list = read("model.results/paraview/results.pvd");
  EXPECT_THAT(list, HasSubstr("</VTKFile>"));
  const std::size_t last = list.rfind("file=\"") + 6;
  const std::string picture = list.substr(last, list.find('"', last) - last);
  EXPECT_THAT(read("model.results/paraview/" + picture), HasSubstr("</VTKFile>"));
  // Results continue from the last checkpoint; frames after it are removed.
  const auto rest = run({"run", "model.yaml", "--restart", "model.results/checkpoint.pst", "--set",
                         "analysis.duration=1e7 s", "--wall-limit", "0.2", "--quiet"});
  EXPECT_EQ(rest.code, 75) << rest.err;
}

TEST_F(CommandLine, RefusesAnUnknownInstructionSet) {
  const auto result = run({"run", "model.yaml", "--isa", "avx1024"});
  EXPECT_EQ(result.code, 2);
  EXPECT_THAT(result.err, HasSubstr("--isa"));
}

TEST_F(CommandLine, RefusesAFileThatIsNoCheckpoint) {
  const auto result = run({"run", "model.yaml", "--restart", "model.yaml"});
  EXPECT_EQ(result.code, 3);
  EXPECT_THAT(result.err, HasSubstr("model.yaml: is not a Polhode checkpoint"));
}

TEST_F(CommandLine, ChecksMobilityAndTangents) {
  const auto result = run({"check", "model.yaml", "--tangents", "--json"});
  ASSERT_EQ(result.code, 0) << result.out << result.err;
  EXPECT_EQ(value(result.out, "mobility"), "4");  // One hinge, one ball.
  EXPECT_EQ(value(result.out, "constraint_rows"), "8");
  EXPECT_EQ(value(result.out, "redundant_rows"), "0");
  EXPECT_EQ(value(result.out, "passed"), "true");
}

/// Length of the path less that of the tendon, over the optimal length.
TEST_F(CommandLine, ChecksTheLengthOfFibres) {
  const auto muscle = [&](const char* optimal) {
    write("muscle.yaml",
          "format: 1\nbodies: {b: {mass: 1, inertia: [1, 1, 1], position: [0.5, 0, 0]}}\n"
          "cables:\n  m: {through: [[ground, [0, 0, 0]], [b, [0, 0, 0]]], muscle: {max_force: 10, "
          "optimal_length: " +
              std::string(optimal) +
              ", tendon_length: 0.38, activation: 0.1}}\n"
              "analysis: {duration: 1, step: 1 ms}\n");
    return run({"check", "muscle.yaml"});
  };
  const auto usual = muscle("0.1");
  EXPECT_THAT(usual.out, HasSubstr("fibres at 1.2 of their optimal length"));
  EXPECT_THAT(usual.err, testing::Not(HasSubstr("fibres of muscle")));
  EXPECT_THAT(muscle("0.05").err, HasSubstr("The fibres of muscle 'm' start at 2.4 of their"));
  EXPECT_THAT(muscle("0.5").err, HasSubstr("The fibres of muscle 'm' start at 0.24 of their"));
  EXPECT_THAT(run({"check", "muscle.yaml", "--json"}).out,
              HasSubstr("\"fibre_over_optimal\": 0.24"));
}

TEST_F(CommandLine, NamesWhatPrescribesAllMotion) {
  const auto model = [](const char* shaft) {
    return std::string(R"yaml(format: 1
bodies:
  arm: {mass: 1, inertia: [1, 1, 1]}
  table: {mass: 1, inertia: [1, 1, 1], position: [1, 0, 0], motion: {x: "0.1*sin(t)", y: 0, z: 0, rotation_vector: [0, 0, 0]}}
joints:
  shaft: {type: )yaml") +
           shaft + R"yaml(, bodies: [ground, arm], at: [0, 0, 0], axis: z}
loads: {motor: {type: rotary_motor, joint: shaft, coordinate: rz, speed: 1 rad/s}}
analysis: {type: dynamics, duration: 1 s, step: 1 ms}
)yaml";
  };
  write("driven.yaml", model("revolute"));
  const auto all = run({"check", "driven.yaml"});
  EXPECT_EQ(all.code, 0) << all.err;
  EXPECT_THAT(all.out, HasSubstr("0  independent motions at the start, besides those of joint "
                                 "'table.motion', rotary_motor 'motor'"));
  EXPECT_THAT(all.out + all.err, Not(HasSubstr("warning")));  // prescribed motion is no fault
  const auto against =
      run({"check", "driven.yaml", "--set", "bodies.arm.angular_velocity=[0, 0, 3]"});
  EXPECT_THAT(against.err, HasSubstr("warning: The initial velocities violate the joints by 2"));
  write("slides.yaml", model("cylindrical"));
  const auto one = run({"check", "slides.yaml"});
  EXPECT_THAT(one.out, HasSubstr("1  independent motions at the start, besides those of joint "
                                 "'table.motion', rotary_motor 'motor'"));
}

TEST_F(CommandLine, NamesRedundantJoints) {
  write("door.yaml", R"(format: 1
bodies:
  door: {mass: 1, inertia: [1, 1, 1], position: [0.5, 0, 0]}
joints:
  low: {type: revolute, bodies: [ground, door], at: [0, 0, -1], axis: z}
  high: {type: revolute, bodies: [ground, door], at: [0, 0, 1], axis: z}
analysis: {duration: 0.1 s, step: 10 ms}
)");
  const auto result = run({"check", "door.yaml"});
  EXPECT_EQ(result.code, 0);
  EXPECT_THAT(result.out, HasSubstr("rank 5, 5 redundant"));
  EXPECT_THAT(result.err, AllOf(HasSubstr("'low'"), HasSubstr("'high'")));
}

TEST_F(CommandLine, NamesLawsThatJump) {
  write("tool.yaml", R"(format: 1
bodies: {tool: {mass: 2, inertia: [1, 1, 1], velocity: [1, 0, 0]}}
joints: {slide: {type: prismatic, bodies: [ground, tool], at: [0, 0, 0], axis: x}}
loads: {cut: {type: translational_spring, joint: slide, damper_force: "v > 2 ? 1470 : v > 0 ? 1500 : 0"}}
analysis: {duration: 0.1 s, step: 10 ms}
)");
  const auto result = run({"check", "tool.yaml", "--tangents"});
  EXPECT_EQ(result.code, 0) << result.out;
  EXPECT_THAT(result.err, HasSubstr("damper_force of load 'cut' jumps by 1500 N at 0 m/s: it holds "
                                    "there like dry friction, to a width of 1e-09 m/s."));
  EXPECT_THAT(result.err, HasSubstr("damper_force of load 'cut' falls by 30 N at 2 m/s: in each "
                                    "step the side is that of its start."));
}

TEST_F(CommandLine, ReportsTheContentsOfAModelAndTheKindsThatExist) {
  const auto info = run({"info", "model.yaml"});
  ASSERT_EQ(info.code, 0) << info.err;
  EXPECT_THAT(info.out, AllOf(HasSubstr("upper"), HasSubstr("2.5"), HasSubstr("spherical"),
                              HasSubstr("constraint rows  8")));
  EXPECT_THAT(run({"info", "--kinds", "joints"}).out,
              AllOf(HasSubstr("revolute"), HasSubstr("universal")));
  EXPECT_THAT(run({"info", "--kinds", "loads"}).out,
              AllOf(HasSubstr("spring_damper"), HasSubstr("nodal_force")));
  EXPECT_THAT(run({"info", "--kinds", "shapes"}).out, HasSubstr("capsule"));
  EXPECT_EQ(run({"info", "--kinds", "jonts"}).code, 2);
  EXPECT_EQ(run({"info"}).code, 2);
}

TEST_F(CommandLine, WritesTheSchemaAndTheReference) {
  EXPECT_THAT(run({"schema"}).out, AllOf(StartsWith("{"), HasSubstr("\"revolute\"")));
  EXPECT_THAT(run({"schema", "--markdown"}).out, AllOf(HasSubstr("#"), HasSubstr("revolute")));
}

TEST_F(CommandLine, ListsAndWritesExamples) {
  const auto list = run({"examples"});
  EXPECT_EQ(list.code, 0);
  EXPECT_THAT(list.out, AllOf(HasSubstr("n_four_bar --set N=40"), HasSubstr("binary_tree")));
  ASSERT_EQ(
      run({"examples", "chain", "--set", "N=3", "--set", "joint=spherical", "-o", "c.yaml"}).code,
      0);
  EXPECT_EQ(run({"run", "c.yaml", "--quiet", "--set", "analysis.duration=50 ms"}).code, 0);
  const auto unknown = run({"examples", "chian"});
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.err,
              HasSubstr("examples: there is no example 'chian'. Did you mean 'chain'?"));
  const auto no_value = run({"examples", "chain", "--set", "N"});
  EXPECT_EQ(no_value.code, 2);
  EXPECT_THAT(no_value.err, HasSubstr("--set: 'N' is not of the form name=value. Write for "
                                      "instance --set N=40."));
  EXPECT_EQ(run({"examples", "chain", "--set", "N=0"}).code, 2);
  EXPECT_EQ(run({"examples", "chain", "--set", "M=3"}).code, 2);
}

TEST_F(CommandLine, PassesItsOwnDiagnosis) {
  const auto result = run({"doctor"});
  EXPECT_EQ(result.code, 0) << result.out;
  EXPECT_THAT(result.out, Not(HasSubstr("FAILED")));
}

#if !defined(__SANITIZE_ADDRESS__) && defined(NDEBUG)
// Processor time, the minimum of a few runs, so that other work on the machine does not count.
TEST_F(CommandLine, StartsWithin50Milliseconds) {
  if (test::cli_program().ends_with("_emulated")) GTEST_SKIP() << "an emulator starts more slowly";
  double least = 1e9;
  for (int i = 0; i < 5; ++i)
    least = std::min(least, run({"run", "model.yaml", "--quiet", "--set", "analysis.duration=10 ms",
                                 "--set", "output.paraview=false"})
                                .cpu_seconds);
  EXPECT_LT(least, 0.05);
}
#endif

}  // namespace
}  // namespace polhode::cli_tests
