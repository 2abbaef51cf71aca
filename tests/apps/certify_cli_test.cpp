// SPDX-License-Identifier: Apache-2.0
// The command `certify`, and the results folder of an earlier run when a model is run again.
#include <filesystem>
#include <regex>

#include <gmock/gmock.h>
#include <polhode/core/format.hpp>

#include "command_line.hpp"

namespace polhode::certify_cli_tests {
namespace {

using test::CommandLine;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST_F(CommandLine, CertifiesAModelWithATableAPictureAndNumbers) {
  const auto result = run({"certify", "model.yaml"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.err,
              AllOf(HasSubstr("Run 1 of 3: step 10 ms."), HasSubstr("Run 3 of 3: step 2.5 ms.")));
  EXPECT_THAT(result.out, AllOf(HasSubstr("tip x y z [m]"), HasSubstr("A fx fy fz [N]"),
                                HasSubstr("Picture and tables: model.certificate")));
  EXPECT_THAT(read("model.certificate/certificate.svg"), testing::StartsWith("<svg "));
  EXPECT_THAT(read("model.certificate/certificate.json"), HasSubstr("\"refines\": \"step\""));
  EXPECT_THAT(read("model.certificate/certificate/tip_x_y_z.csv"),
              testing::StartsWith("t [s],x [m],y [m],z [m],x extrapolated [m],y extrapolated [m],"
                                  "z extrapolated [m],error bar [m],order [-]\n0,"));
  EXPECT_FALSE(exists("model.certificate/results.h5"));
}

TEST_F(CommandLine, CertifiesWithJsonOutput) {
  const auto result = run({"certify", "model.yaml", "--json", "--quiet", "-o", "kept"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(value(result.out, "exit_code"), "0");
  EXPECT_EQ(value(result.out, "converges"), "true");
  EXPECT_NEAR(std::stod(value(result.out, "order")), 2.0, 0.2);
  // Results of the finest run, kept in the folder of the option: 1 s in steps of 2.5 ms.
  EXPECT_TRUE(exists("kept/results.h5"));
  EXPECT_TRUE(exists("kept/probes/tip.csv"));
  EXPECT_EQ(result.out, read("kept/certificate.json"));
  // The same command, the same numbers.
  const auto strip = [](std::string text) {
    return std::regex_replace(text, std::regex("\"(wall|cpu)_time_s\": [^\n]*"), "");
  };
  const auto again = run({"certify", "model.yaml", "--json", "--quiet", "-o", "kept"});
  EXPECT_EQ(strip(result.out), strip(again.out));
}

TEST_F(CommandLine, EndsWith6WhereAnErrorBarIsTooWide) {
  const auto wide = run({"certify", "model.yaml", "--quiet", "--within", "1e-9"});
  EXPECT_EQ(wide.code, 6);
  EXPECT_THAT(wide.err, HasSubstr("warning: the error bar of 'tip x y z' is more than 1e-09 of its "
                                  "size. Take a shorter step or a smaller tolerance.\n"));
  EXPECT_EQ(run({"certify", "model.yaml", "--quiet", "--within", "0.5"}).code, 0);
  EXPECT_EQ(run({"certify", "model.yaml", "--within", "0"}).code, 2);
}

// Released level, the double pendulum of the fixture is chaotic.
TEST_F(CommandLine, EndsWith6AndReportsWhenConvergenceIsLost) {
  const auto result = run({"certify", "model.yaml", "--json", "--set", "analysis.duration=60 s"});
  EXPECT_EQ(result.code, 6) << result.err;
  EXPECT_THAT(result.err, testing::ContainsRegex(
                              "warning: 'tip x y z' does not converge from t = [0-9.]+ s on: no "
                              "number after that is certain"));
  EXPECT_EQ(value(result.out, "converges"), "false");
  EXPECT_THAT(result.out, HasSubstr("\"lost_from\": "));
  EXPECT_THAT(result.out, HasSubstr("\"error_bar\": null"));
}

TEST_F(CommandLine, RunsAndCertifiesInOne) {
  const auto result = run({"run", "model.yaml", "--certify", "--json", "--quiet"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(value(result.out, "steps"), "100");
  EXPECT_THAT(result.out, HasSubstr("\"certificate\": {"));
  EXPECT_TRUE(exists("model.results/results.h5"));
  EXPECT_TRUE(exists("model.results/certificate.svg"));
  EXPECT_EQ(run({"run", "model.yaml", "--certify", "--restart", "x"}).code, 2);
  EXPECT_EQ(run({"run", "model.yaml", "--within", "0.1"}).code, 2);
  // A run without `certify` removes the certificate of an earlier one.
  EXPECT_EQ(run({"run", "model.yaml", "--quiet"}).code, 0);
  EXPECT_FALSE(exists("model.results/certificate.svg"));
}

TEST_F(CommandLine, RefusesToCertifyAnalysesWithoutTimeSteps) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"certify", "model.yaml"}, {"run", "model.yaml", "--certify"}}) {
    std::vector<std::string> all = words;
    all.insert(all.end(), {"--set", "analysis={type: statics}"});
    const auto result = run(all);
    EXPECT_EQ(result.code, 3);
    EXPECT_THAT(result.err, HasSubstr("analysis.type: is statics, which takes no steps in time"));
  }
}

TEST_F(CommandLine, StopsCertifyingAtTheWallLimit) {
  const auto result = run({"certify", "model.yaml", "--wall-limit", "0"});
  EXPECT_EQ(result.code, 75);
  EXPECT_THAT(result.err, HasSubstr("Stopped at the wall-time limit; nothing is certified."));
  EXPECT_FALSE(exists("model.certificate"));
}

TEST_F(CommandLine, RefusesANegativeWallLimitInOneLine) {
  for (const char* command : {"run", "certify"}) {
    const auto result = run({command, "model.yaml", "--wall-limit", "-1"});
    EXPECT_EQ(result.code, 2);
    EXPECT_EQ(result.err, format("polhode {0}: --wall-limit: must not be below 0, but is -1. Run "
                                 "'polhode {0} --help' for its options.\n",
                                 command));
  }
}

TEST_F(CommandLine, RemovesResultsOfAnEarlierRunFromTheFolder) {
  ASSERT_EQ(run({"run", "model.yaml", "--quiet", "--set", "output.every=10 ms"}).code, 0);
  ASSERT_TRUE(exists("model.results/paraview/results/000100.vtp"));
  write("model.results/notes.txt", "mine");
  write("model.results/probes/mine.csv", "a,b\n1,2\n");
  ASSERT_EQ(run({"run", "model.yaml", "--quiet", "--set", "output.every=100 ms", "--set",
                 "output.probes={A: {joint: A}}"})
                .code,
            0);
  std::size_t pictures = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(folder_ / "model.results/paraview/results"))
    pictures += entry.is_regular_file() ? 1 : 0;
  EXPECT_EQ(pictures, 11U);
  EXPECT_THAT(read("model.results/paraview/results.pvd"), HasSubstr("000010.vtp"));
  EXPECT_FALSE(exists("model.results/probes/tip.csv"));
  EXPECT_TRUE(exists("model.results/probes/A.csv"));
  EXPECT_TRUE(exists("model.results/notes.txt"));
  EXPECT_TRUE(exists("model.results/probes/mine.csv"));
  // Outputs that the model no longer has are removed, too.
  ASSERT_EQ(run({"run", "model.yaml", "--quiet", "--set", "output.paraview=false", "--set",
                 "output.hdf5=false"})
                .code,
            0);
  EXPECT_FALSE(exists("model.results/paraview/results.pvd"));
  EXPECT_FALSE(exists("model.results/paraview/results/000000.vtp"));
  EXPECT_FALSE(exists("model.results/results.h5"));
}

TEST_F(CommandLine, ContinuesTheFilesOfARunThatIsRestarted) {
  ASSERT_EQ(run({"run", "model.yaml", "--quiet"}).code, 0);
  ASSERT_EQ(run({"run", "model.yaml", "--quiet", "--restart", "model.results/checkpoint.pst",
                 "--set", "analysis.duration=2 s"})
                .code,
            0);
  EXPECT_TRUE(exists("model.results/paraview/results/000000.vtp"));
  EXPECT_TRUE(exists("model.results/paraview/results/000100.vtp"));
  EXPECT_THAT(read("model.results/probes/tip.csv"), AllOf(HasSubstr("\n0,"), HasSubstr("\n2,")));
}

}  // namespace
}  // namespace polhode::certify_cli_tests
