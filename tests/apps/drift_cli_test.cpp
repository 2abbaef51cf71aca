// SPDX-License-Identifier: Apache-2.0
// One energy drift: of the summary, the results and the page; red above 1e-3.
#include <cstdlib>

#include <gmock/gmock.h>
#include <polhode/core/format.hpp>
#include <polhode/io/results/results_reader.hpp>

#include "command_line.hpp"

namespace polhode::drift_cli_tests {
namespace {

using test::CommandLine;
using testing::HasSubstr;
using testing::Not;

/// A stiff oscillator that numerical dissipation damps at a coarse step, not at a fine one.
constexpr const char* kStiff = R"(format: 1
bodies: {a: {mass: 1, inertia: [1, 1, 1], position: [1.1, 0, 0]}}
joints: {guide: {type: prismatic, bodies: [ground, a], at: [0, 0, 0], axis: x}}
loads: {s: {type: spring_damper, bodies: [ground, a], at: [[0, 0, 0], [1.1, 0, 0]], stiffness: 1000, free_length: 1}}
analysis: {duration: 0.2 s, step: 20 ms, rho_inf: 0}
)";

/// What a program prints on a terminal.
std::string on_a_terminal(const std::vector<std::string>& words, const std::string& folder) {
  const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY);
  if (terminal < 0 || ::grantpt(terminal) != 0 || ::unlockpt(terminal) != 0) return "";
  const std::string name = ::ptsname(terminal);
  const pid_t process = ::fork();
  if (process == 0) {
    ::alarm(100);
    ::dup2(::open(name.c_str(), O_RDWR | O_NOCTTY), STDOUT_FILENO);
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    if (::chdir(folder.c_str()) == 0) ::execv(arguments[0], arguments.data());
    ::_exit(127);
  }
  std::string text;
  char part[4096];
  // The terminal ends with an error when the program has closed it.
  for (ssize_t n = 0; (n = ::read(terminal, part, sizeof part)) > 0;)
    text.append(part, static_cast<std::size_t>(n));
  ::waitpid(process, nullptr, 0);
  ::close(terminal);
  return text;
}

class EnergyDrift : public CommandLine {
 protected:
  EnergyDrift() { write("stiff.yaml", kStiff); }
};

}  // namespace

TEST_F(EnergyDrift, IsOneNumberInTheSummaryTheResultsAndThePage) {
  for (const char* step : {"20 ms", "2 ms", "0.2 ms"})
    for (const char* every : {"20 ms", "70 ms"}) {  // the last frame is no multiple of 70 ms
      const std::vector<std::string> words = {"run",   "stiff.yaml",
                                              "--set", std::string("analysis.step=") + step,
                                              "--set", std::string("output.every=") + every};
      std::vector<std::string> as_json = words;
      as_json.insert(as_json.end(), {"--json", "--quiet"});
      const double drift = std::stod(value(run(as_json).out, "energy_drift"));
      const io::ResultsReader results(folder_ / "stiff.results/results.h5");
      EXPECT_EQ(results.read("/energy/drift").back(), drift);
      EXPECT_THAT(run(words).out, HasSubstr(format("{:.1e}", drift)));
      // A page with all frames, and one that leaves the last one out.
      for (const char* frames : {"1000", "3"}) {
        ASSERT_EQ(run({"view", "stiff.results", "--html", "page.html", "--frames", frames}).code,
                  0);
        const std::string page = read("page.html"), key = "\"energy_drift\":";
        const std::size_t at = page.rfind(key);
        ASSERT_NE(at, std::string::npos);
        EXPECT_EQ(std::strtod(page.c_str() + at + key.size(), nullptr), drift);
      }
    }
}

TEST_F(EnergyDrift, IsRedOnATerminalAboveAThousandth) {
  const auto shown = [&](const std::string& step) {
    return on_a_terminal(
        {test::cli_program(), "run", "stiff.yaml", "--set", "analysis.step=" + step}, folder_ / "");
  };
  ::unsetenv("NO_COLOR");
  bool below = false, above = false;
  for (const char* step : {"20 ms", "1 ms", "0.5 ms", "0.2 ms"}) {
    const auto json = run(
        {"run", "stiff.yaml", "--json", "--quiet", "--set", std::string("analysis.step=") + step});
    const bool red = std::stod(value(json.out, "energy_drift")) > 1e-3;
    const std::string text = shown(step);
    ASSERT_THAT(text, HasSubstr("energy drift"));
    if (red)
      EXPECT_THAT(text, HasSubstr("\033[31menergy drift")) << step;
    else
      EXPECT_THAT(text, Not(HasSubstr("\033["))) << step;
    (red ? above : below) = true;
  }
  EXPECT_TRUE(above && below);
  ::setenv("NO_COLOR", "1", 1);
  EXPECT_THAT(shown("20 ms"), Not(HasSubstr("\033[")));
  ::unsetenv("NO_COLOR");
  EXPECT_THAT(run({"run", "stiff.yaml"}).out, Not(HasSubstr("\033["))) << "not in a file";
}

}  // namespace polhode::drift_cli_tests
