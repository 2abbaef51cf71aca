// SPDX-License-Identifier: Apache-2.0
// States at which a force has no derivative: a tangent is not wrong there.
#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include <polhode/io/read/read_model.hpp>
#include <polhode/newton/tangent_check.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::tangent_kinks_tests {
namespace {

TangentReport check(const std::string& text) {
  const Simulation s(io::read_model_text(text, "kink.yaml"));
  return check_tangents(s.system(), s.state(), 1e-3, 0.9);
}

bool is_named(const TangentReport& report) {
  return std::any_of(report.left_out.begin(), report.left_out.end(), [](const std::string& s) {
    return s.find("not differentiable") != std::string::npos;
  });
}

/// Fibres that carry tension only, before their first strain: each point of integration is at the
/// kink of its own.
TEST(TangentKinks, FibresBeforeTheirFirstStrainAreComparedBesideIt) {
  const TangentReport report = check(R"(
format: 1
materials: {m: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000, fibre: {law: toe, c3: 0.6 MPa, c4: 46, c5: 350 MPa, straight_stretch: 1.06, direction: [1, 0.5, 0]}}}
solids:
  b: {mesh: {block: {size: [1, 1, 1], cells: [1, 1, 1]}}, element: hex20, material: m, bonded: {ground: xmin}}
analysis: {duration: 1 s, step: 1 ms}
)");
  EXPECT_LT(report.error(), kTangentTolerance) << report.text();
  EXPECT_TRUE(is_named(report));
}

}  // namespace
}  // namespace polhode::tangent_kinks_tests
