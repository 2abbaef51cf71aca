// SPDX-License-Identifier: Apache-2.0
// Every case with every solver: they solve the same equations, so they take the same iterations and
// reach the same state up to round-off, amplified by the motion.
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/simulation/simulation_details.hpp>
#include <support/published_cases.hpp>

namespace polhode::test::solvers_tests {
namespace {

struct SolverCase {
  std::string name;
  Model model;
  double step;
  int steps;
};

std::vector<SolverCase> cases() {
  return {
      {"A01", planar_pendulum(), 1e-2, 200},
      {"A02N1", n_four_bar(1), 1e-2, 200},
      {"A02N2", n_four_bar(2), 1e-2, 200},
      {"A02N10", n_four_bar(10), 1e-2, 200},
      {"A02N40", n_four_bar(40), 1e-2, 200},
      {"A03", andrews_squeezer(), 1e-5, 500},
      {"A04", bricard(), 1e-2, 200},
      {"A05", flyball_governor(), 1e-3, 300},
      {"HeavyTop", heavy_top(), 1e-3, 200},
      {"SliderCrank", spatial_slider_crank(), 2e-3, 300},
      {"FreeTop", free_asymmetric_top(), 1e-2, 300},
      {"SprungChain", sprung_chain(), 2e-3, 300},
      {"Door", door(), 1e-2, 200},
      {"Bennett", bennett(), 1e-2, 50},
  };
}

class EverySolver : public testing::TestWithParam<SolverCase> {};

TEST_P(EverySolver, GivesTheSameMotion) {
  const SolverCase& c = GetParam();
  const std::vector<std::string> names{"tree", "block_lu", "klu", "sparse_lu"};
  std::vector<Simulation> runs;
  for (const std::string& solver : names) {
    Model model = c.model;
    model.analysis.step = c.step;
    model.analysis.duration = c.step * c.steps;
    model.analysis.solver = solver;
    runs.emplace_back(std::move(model));
    EXPECT_EQ(runs.back().summary().solver, solver);
  }
  int different = 0;
  for (int i = 0; i < c.steps; ++i) {
    std::vector<int> iterations;
    for (Simulation& s : runs) {
      const StepReport report = s.step(c.step * c.steps);
      ASSERT_TRUE(report.accepted) << s.summary().solver << ": " << report.message;
      EXPECT_EQ(report.rejected, 0);
      iterations.push_back(report.newton.iterations);
    }
    if (iterations[0] != iterations[1]) ++different;
  }
  EXPECT_EQ(different, 0) << "steps with different iterations of tree and block_lu";
  for (std::size_t k = 1; k < runs.size(); ++k) {
    double most = 0.0;
    for (int b = 0; b < static_cast<int>(c.model.bodies.size()); ++b) {
      const BodyMotion x = runs[0].body(b), y = runs[k].body(b);
      most = std::max({most, (x.r - y.r).norm() / runs[0].system().length_scale(),
                       (x.q.conjugate() * y.q).vec().norm()});
    }
    // A few hundred steps, each a round-off of 1e-15, amplified by the motion (singular positions,
    // where a round-off x turns into √x of the direction that closes, most).
    EXPECT_LE(most, 1e-9) << "tree against " << names[k];
  }
}

INSTANTIATE_TEST_SUITE_P(Of, EverySolver, testing::ValuesIn(cases()),
                         [](const auto& p) { return p.param.name; });

}  // namespace
}  // namespace polhode::test::solvers_tests
