// SPDX-License-Identifier: Apache-2.0
// Files of the command line: kills and restarts, several runs, devices, limits, examples, licences.
#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include <fcntl.h>
#include <sys/stat.h>

#include <gmock/gmock.h>
#include <polhode/core/format.hpp>

#include "command_line.hpp"

namespace polhode::cli_files_tests {
namespace {

using test::CommandLine;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

void wait(int milliseconds) {
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

class Files : public CommandLine {
 protected:
  template <class Condition>
  static bool wait_until(const Condition& condition) {
    for (int i = 0; i < 1000; ++i) {
      if (condition()) return true;
      wait(10);
    }
    return false;
  }
  /// A run through the shell, which prepares limits and descriptors.
  test::ProgramResult shell(const std::string& script) const {
    return test::Program({"/bin/sh", "-c", "polhode=" + test::cli_program() + "; " + script},
                         folder_ / "")
        .wait();
  }
};

// All files of a run that is killed at any moment and restarted are those of a run in one go.
TEST_F(Files, OfAKilledAndRestartedRunAreThoseOfOneInOneGo) {
  const std::vector<std::string> model{
      "run",   "model.yaml",         "--set", "analysis.duration=3 s",
      "--set", "analysis.step=1 ms", "--set", "analysis.checkpoint_every=0.02"};
  const auto run_model = [&](std::vector<std::string> more) {
    more.insert(more.begin(), model.begin(), model.end());
    return more;
  };
  ASSERT_EQ(run(run_model({"--quiet", "-o", "whole"})).code, 0);
  ASSERT_EQ(run({"convert", "whole", "whole.csv"}).code, 0);
  for (const int delay : {0, 37, 111}) {
    test::Program program = start(run_model({"--quiet", "-o", "killed"}));
    ASSERT_TRUE(wait_until([&] { return exists("killed/checkpoint.pst"); }));
    wait(delay);
    program.signal(SIGKILL);
    program.wait();
    const auto rest =
        run(run_model({"--quiet", "-o", "killed", "--restart", "killed/checkpoint.pst"}));
    ASSERT_EQ(rest.code, 0) << rest.err;
    ASSERT_EQ(run({"convert", "killed", "killed.csv"}).code, 0);
    EXPECT_EQ(read("killed.csv"), read("whole.csv")) << delay;
    for (const char* file :
         {"probes/tip.csv", "probes/A.csv", "paraview/results.pvd", "paraview/results/000150.vtp"})
      EXPECT_EQ(read(std::string("killed/") + file), read(std::string("whole/") + file))
          << file << " after " << delay;
    std::filesystem::remove_all(folder_ / "killed");
  }
}

TEST_F(Files, OfAnEarlierRunTakeTheirCheckpointWithThem) {
  ASSERT_EQ(run({"run", "model.yaml", "--quiet"}).code, 0);
  test::Program program = start({"run", "model.yaml", "--quiet", "--set", "analysis.duration=1e7"});
  ASSERT_TRUE(wait_until([&] { return !exists("model.results/checkpoint.pst"); }));
  program.signal(SIGKILL);
  program.wait();
}

TEST_F(Files, OfTwoRunsAreInTwoFolders) {
  test::Program first = start({"run", "model.yaml", "--quiet", "-o", "out", "--set",
                               "analysis.duration=1e7", "--set", "output.paraview=false"});
  ASSERT_TRUE(wait_until([&] { return exists("out/probes/A.csv"); }));
  const auto second = run({"run", "model.yaml", "-o", "out"});
  EXPECT_EQ(second.code, 3);
  EXPECT_THAT(second.err, AllOf(StartsWith("out: another run (process "),
                                HasSubstr(", model 'model.yaml') is writing into it. Wait for its "
                                          "end, or name another folder for the results with -o.")));
  first.signal(SIGTERM);
  EXPECT_EQ(first.wait().code, 130);
  EXPECT_FALSE(exists("out/.polhode.lock"));
  EXPECT_EQ(run({"run", "model.yaml", "--quiet", "-o", "out"}).code, 0);
}

TEST_F(Files, AreSavedWhenTheTerminalIsClosedButNotUnderNohup) {
  test::Program program = start({"run", "model.yaml", "--quiet", "--set", "analysis.duration=1e7",
                                 "--set", "output.paraview=false"});
  ASSERT_TRUE(wait_until([&] { return exists("model.results/probes/A.csv"); }));
  wait(200);
  program.signal(SIGHUP);
  EXPECT_EQ(program.wait().code, 130);
  EXPECT_TRUE(exists("model.results/checkpoint.pst"));
  const auto ignored = shell(
      "trap '' HUP; $polhode run model.yaml --quiet --wall-limit 1 --set analysis.duration=1e7 "
      "--set output.paraview=false -o hup & sleep 0.5; kill -HUP $!; wait $!");
  EXPECT_EQ(ignored.code, 75) << ignored.err;
}

TEST_F(Files, ThatReachTheLimitOfTheirLengthAreAnError) {
  const auto table = shell(
      "ulimit -f 8; exec $polhode run model.yaml --quiet --set output.hdf5=false --set "
      "output.paraview=false --set analysis.duration=1e3");
  EXPECT_EQ(table.code, 5);
  EXPECT_THAT(table.err, AllOf(HasSubstr("probes/"), HasSubstr("cannot be written (File too large"),
                               HasSubstr("Raise the limit of the length of files (ulimit -f).")));
  const auto results = shell(
      "ulimit -f 200; exec $polhode run model.yaml --quiet --set output.csv=false --set "
      "output.paraview=false --set analysis.duration=1e3");
  EXPECT_NE(results.code, 0);
  EXPECT_THAT(results.err, HasSubstr("results.h5: cannot be "));
}

TEST_F(Files, HaveNoWordsOfTheConsole) {
  const auto result = shell("exec $polhode run model.yaml 0<&- 1>&- 2>&-");
  EXPECT_EQ(result.code, 5);  // The table cannot be printed.
  const std::string rows = read("model.results/probes/A.csv");
  EXPECT_THAT(rows, AllOf(StartsWith("t [s],"), Not(HasSubstr("energy")),
                          Not(HasSubstr("Double pendulum")), Not(HasSubstr("Results go"))));
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 52);  // The header, and 0 to 1 s by 20 ms.
  EXPECT_EQ(run({"plot", "model.results"}).code, 0);
}

TEST_F(Files, MayBeFifosAndLinks) {
  ASSERT_EQ(::mkfifo((folder_ / "fifo").c_str(), 0600), 0);
  std::string got;
  std::thread reader([&] { got = read("fifo"); });
  EXPECT_EQ(run({"examples", "chain", "-o", "fifo"}).code, 0);
  reader.join();
  EXPECT_THAT(got, StartsWith("format: 1"));
  EXPECT_TRUE(std::filesystem::is_fifo(folder_ / "fifo"));
  ASSERT_EQ(run({"run", "model.yaml", "--quiet"}).code, 0);
  for (const char* kind : {"csv", "vtkhdf", "glb"}) {
    const std::string link = std::string("link.") + kind;
    std::filesystem::create_symlink("target", folder_ / link);
    EXPECT_EQ(run({"convert", "model.results", link}).code, 0);
    EXPECT_TRUE(std::filesystem::is_symlink(folder_ / link)) << kind;
    EXPECT_GT(read("target").size(), 100U) << kind;
  }
}

TEST_F(Files, OfEveryExampleOnTheListLetItRunAsWritten) {
  const auto list = run({"examples"});
  ASSERT_EQ(list.code, 0);
  std::istringstream lines(list.out);
  int examples = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.substr(0, 2) != "  ") continue;
    const std::string name = line.substr(2, line.find(' ', 2) - 2);
    std::filesystem::create_directory(folder_ / name);
    ASSERT_EQ(run({"examples", name, "-o", name + "/model.yaml"}).code, 0) << name;
    const auto check = run({"info", name + "/model.yaml"});
    EXPECT_EQ(check.code, 0) << name << check.err;
    // A step of each, at its size.
    const auto result = run({"run", name + "/model.yaml", "--quiet", "--wall-limit", "0"});
    EXPECT_THAT(result.code, testing::AnyOf(0, 75)) << name << result.err;
    ++examples;
  }
  EXPECT_GT(examples, 40);
  EXPECT_TRUE(exists("gear_pair/pinion.stl"));
  // On stdout the meshes are written beside it, and never over a file of the user.
  const auto again = shell("$polhode examples gear_pair > gears.yaml && $polhode info gears.yaml");
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("The model needs pinion.stl, which was written, too."));
  write("wheel.stl", "mine");
  const auto taken = run({"examples", "gear_pair"});
  EXPECT_EQ(taken.code, 5);
  EXPECT_THAT(taken.err, HasSubstr("wheel.stl: exists with another content, and the example needs "
                                   "this name. Write the example into another folder."));
  EXPECT_EQ(read("wheel.stl"), "mine");
}

TEST_F(Files, ErrorsFoundAfterReadingHaveAPlaceInThem) {
  const auto message = [&](const std::string& text, const char* command = "run") {
    write("bad.yaml", text);
    return run({command, "bad.yaml", "--quiet"});
  };
  // Overlap at the start.
  EXPECT_THAT(message("format: 1\nbodies:\n  a: {shape: {sphere: 1}, mass: 1}\n"
                      "  b: {shape: {sphere: 1}, mass: 1}\ncontacts: {}\n")
                  .err,
              AllOf(StartsWith("bad.yaml:5:"), HasSubstr("error: contacts: shapes overlap")));
  // An assembly that is impossible.
  EXPECT_THAT(message("format: 1\nbodies:\n  a: {mass: 1, inertia: [1, 1, 1]}\njoints:\n"
                      "  one: {type: spherical, bodies: [ground, a], at: [0, 0, 0]}\n"
                      "  two: {type: spherical, bodies: [ground, a], at_body: [[2, 0, 0], [1, 0, "
                      "0]]}\n")
                  .err,
              StartsWith("bad.yaml:5:3: error: the start: cannot be assembled"));
  // A function without a value at a time within the run, whatever the step.
  for (const char* step : {"0.1", "0.01", "0.001"}) {
    const auto ended =
        message(std::string("format: 1\nbodies: {a: {mass: 1, inertia: [1, 1, 1]}}\nloads:\n"
                            "  push: {type: force, body: a, force: [sqrt(0.503 - t), 0, 0]}\n"
                            "analysis: {duration: 1, step: ") +
                step + "}\n");
    EXPECT_EQ(ended.code, 4) << step;
    EXPECT_EQ(ended.err,
              "the load 'push' is not a finite number at t = 0.503 s. Correct its function.\n");
  }
  // The method.
  EXPECT_THAT(message("format: 1\nbodies:\n  a: {mass: 1, inertia: [1, 1, 1]}\nanalysis:\n"
                      "  step: 0.1\n  solver: tree\n  jacobian: never\n")
                  .err,
              StartsWith("bad.yaml:6:11: error: analysis.solver: 'tree' needs"));
  // Modes.
  const auto modes = message(
      "format: 1\nbodies:\n  a: {mass: 1, inertia: [1, 1, 1], velocity: [1, 0, 0]}\n"
      "analysis: {type: modes}\n");
  EXPECT_EQ(modes.code, 3);
  EXPECT_THAT(modes.err, StartsWith("bad.yaml:3:"));
}

TEST_F(Files, ListTheLicencesOfWhatTheProgramContains) {
  const auto told = run({"doctor", "--licences"});
  EXPECT_EQ(told.code, 0);
  EXPECT_EQ(told.out, test::text_of(test::source_dir() + "/THIRD_PARTY.md"));
  // Every package that the build looks for, and what the page of the viewer holds.
  std::string build;
  for (const char* file :
       {"/CMakeLists.txt", "/apps/polhode/CMakeLists.txt", "/python/CMakeLists.txt"})
    build += test::text_of(test::source_dir() + file);
  for (const std::string_view key : {"find_package(", "find_library("})
    for (std::size_t at = build.find(key); at != std::string::npos; at = build.find(key, at + 1)) {
      std::string name = build.substr(at + key.size());
      name = name.substr(0, name.find_first_of(" )"));
      for (const char* ending : {"_LIBRARY", "3"})
        if (name.ends_with(ending)) name.resize(name.size() - std::string(ending).size());
      const std::string found = name == "ZLIB" ? "zlib" : name;
      EXPECT_THAT(told.out, HasSubstr(found));
    }
  ASSERT_EQ(run({"view", "model.yaml", "--html", "page.html"}).code, 0);
  const std::string page = read("page.html");
  for (const char* notice : {"Copyright (c) 2010-2026 three.js authors",
                             "Copyright (c) 2022 Leon Sorokin", "Permission is hereby granted"})
    EXPECT_THAT(page, HasSubstr(notice));
}

}  // namespace
}  // namespace polhode::cli_files_tests
