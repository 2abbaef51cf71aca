// SPDX-License-Identifier: Apache-2.0
// Springs and dampers of joints by polynomials, against MuJoCo 4.0's rule: against the coordinate x
// and its rate v, k0 x + k1 x^2 + k2 x^3 and c0 v + c1 |v| v + c2 v^3.
#include <cmath>

#include "mjcf_fixture.hpp"

namespace polhode::mjcf_laws_tests {
namespace {

using namespace mjcf_tests;

class MjcfLaws : public Mjcf {
 protected:
  /// A body of 2 kg on a slide along x, with a start.
  Model slide(const std::string& attributes, double q, double v) {
    return read(
        format("<option gravity='0 0 0'/><worldbody><body name='a'><joint name='j' "
               "type='slide' axis='1 0 0' {}/>{}</body></worldbody>"
               "<keyframe><key qpos='{}' qvel='{}'/></keyframe>",
               attributes, kBall, q, v));
  }
  static Simulation after(Model model, double time, double step) {
    model.analysis.step = step;
    Simulation s(std::move(model));
    while (s.time() < time - 0.5 * step) s.step(time);
    return s;
  }
};

/// A coarse step, the usual one and a hundredth of that [s].
constexpr double kLawSteps[] = {1e-2, 1e-3, 1e-5};
constexpr double kMass = 2.0;

TEST_F(MjcfLaws, SpringsHaveTheEnergyOfTheirPolynomial) {
  const double k0 = 3.0, k1 = 4.0, k2 = 5.0, rest = 0.25;
  const auto energy = [&](double q) {
    const double x = q - rest;
    return k0 * x * x / 2 + k1 * x * x * x / 3 + k2 * x * x * x * x / 4;
  };
  const Model model = slide("stiffness='3 4 5' springref='0.25'", 1.0, 0.0);
  for (const double step : kLawSteps) {
    const Simulation s = after(model, 0.2, step);
    const double q = s.joint("j").coordinates[0], v = s.joint("j").rates[0];
    EXPECT_LT(q, 0.95) << step;
    EXPECT_NEAR(0.5 * kMass * v * v + energy(q), energy(1.0), 20.0 * step * step + 1e-9) << step;
  }
}

TEST_F(MjcfLaws, DampersHaveTheirClosedForms) {
  const double v0 = 1.5, t = 0.1;
  for (const double step : kLawSteps) {
    const double error = 10.0 * step * step + 1e-9;
    for (const double sign : {1.0, -1.0}) {
      // m v' = -c |v| v, and m v' = -c v^3.
      EXPECT_NEAR(after(slide("damping='0 4'", 0.0, sign * v0), t, step).joint("j").rates[0],
                  sign * v0 / (1.0 + 4.0 / kMass * v0 * t), error);
      EXPECT_NEAR(after(slide("damping='0 0 4'", 0.0, sign * v0), t, step).joint("j").rates[0],
                  sign * v0 / std::sqrt(1.0 + 2.0 * 4.0 / kMass * v0 * v0 * t), error);
    }
  }
}

TEST_F(MjcfLaws, HingesCountTheirTurns) {
  // Far from the rest, over a turn and a half, the moment is that of the whole angle.
  const Model model =
      read(format("<option gravity='0 0 0'/><compiler angle='radian'/><worldbody><body "
                  "name='a'><joint name='j' "
                  "axis='0 0 1' stiffness='0 0.01'/>{}</body></worldbody><keyframe><key "
                  "qpos='9.5'/></keyframe>",
                  kBall));
  const Simulation s = after(model, 1e-3, 1e-3);
  EXPECT_NEAR(s.joint("j").rates[0], -0.01 * 9.5 * 9.5 / 0.1 * 1e-3, 1e-7);
}

}  // namespace
}  // namespace polhode::mjcf_laws_tests
