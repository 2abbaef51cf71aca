// SPDX-License-Identifier: Apache-2.0
// Clamped beams under dead loads at the tip, by load steps, against the solution of the beam's own
// differential equations (tests/validation/data/static_beams.csv) and closed forms. Tolerances are
// the error of the element, of second order in its length; docs/validation.md has the table.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>

#include <polhode/beams/beam_element.hpp>
#include <polhode/beams/section.hpp>
#include <polhode/math/exp_map.hpp>
#include <polhode/statics/statics.hpp>
#include <statics/static_models.hpp>
#include <support/paths.hpp>

namespace polhode::static_beams_tests {
namespace {

constexpr double kPi = std::numbers::pi;

/// A beam of small bodies along a line or an arc in the xy plane, clamped at its first node.
class ClampedBeam {
 public:
  /// @param arc  Angle of the arc [rad]; 0: straight along x.
  ClampedBeam(const Mat6& C, double length, int elements, double arc = 0.0) {
    const double h = length / elements;
    const auto frame = [&](int i) { return exp_map(Vec3(0, 0, arc * i / elements)); };
    const auto position = [&](int i) -> Vec3 {
      if (arc == 0.0) return {h * i, 0, 0};
      const double R = length / arc, phi = arc * i / elements;
      return R * Vec3(std::sin(phi), 1.0 - std::cos(phi), 0.0);
    };
    for (int i = 1; i <= elements; ++i) {
      BodyMotion start;
      start.r = position(i);
      system_.add_body({"node " + std::to_string(i), 1.0, h * h * Mat3::Identity()}, start);
    }
    for (int i = 0; i < elements; ++i) {
      BeamElementSpec spec;
      spec.name = "element " + std::to_string(i + 1);
      spec.bodies = {i - 1, i};  // kGround is −1: the clamp
      spec.end_1 = {i == 0 ? position(0) : Vec3::Zero(), frame(i)};
      spec.end_2 = {Vec3::Zero(), frame(i + 1)};
      spec.stiffness = C;
      const auto at = [&](int node) {
        return BodyStep::at_instant(node == 0 ? Vec3::Zero() : position(node), Mat3::Identity(),
                                    Vec3::Zero(), Vec3::Zero());
      };
      set_reference(spec, at(i), at(i + 1));
      system_.group<BeamElement>().add(spec);
    }
    tip_ = elements - 1;
    start_ = position(elements);
  }
  void load(const std::string& type, const Vec3& value) {
    test::add_load(system_, type,
                   {.name = type, .bodies = {kGround, tip_}, .vector = test::constant(value)});
  }
  StaticReport solve(const StaticOptions& options = {}) {
    system_.finish();
    state_ = system_.initial_state();
    return solve_statics(system_, state_, options);
  }
  [[nodiscard]] Vec3 tip() const { return system_.motion(state_, tip_).r; }
  [[nodiscard]] Vec3 displacement() const { return tip() - start_; }
  [[nodiscard]] Mat3 turn() const { return system_.motion(state_, tip_).Lambda(); }

 private:
  System system_;
  State state_;
  int tip_ = 0;
  Vec3 start_;
};

Mat6 stiffness(double EA, double GA_y, double GA_z, double GJ, double EI_y, double EI_z) {
  Mat6 C = Mat6::Zero();
  C.diagonal() << EA, GA_y, GA_z, GJ, EI_y, EI_z;
  return C;
}

std::map<std::string, std::vector<double>> references() {
  std::map<std::string, std::vector<double>> all;
  std::ifstream file(test::test_data_dir() + "/static_beams.csv");
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream fields(line);
    std::string name, number;
    std::getline(fields, name, ',');
    while (std::getline(fields, number, ',')) all[name].push_back(std::stod(number));
  }
  return all;
}

/// M = 2π EI/L rolls a beam up to a circle: exact for elements with constant strain.
TEST(StaticBeams, AMomentRollsABeamUpInOneLoadStep) {
  const double L = 10.0, EI = 100.0;
  for (double ratio : {1e2, 1e5})
    for (int elements : {5, 10, 40}) {
      ClampedBeam beam(stiffness(ratio * EI, ratio * EI, ratio * EI, EI, EI, EI), L, elements);
      beam.load("moment", {0, 0, 2.0 * kPi * EI / L});
      const StaticReport report = beam.solve();
      ASSERT_TRUE(report.converged) << report.message;
      EXPECT_EQ(report.steps.size(), 1u) << elements;
      EXPECT_LE(report.iterations, 8) << elements << " elements, EA/EI " << ratio;
      // Rounding: 16 ε times the ratio of the stiffest and the softest motion.
      EXPECT_LT(beam.tip().norm(), std::max(1e-10, 4e-15 * ratio * elements * elements * L));
    }
}

TEST(StaticBeams, ACantileverBendsByTheDifferentialEquations) {
  const auto reference = references();
  const double L = 2.0, h = 0.5, w = 0.1, E = 2.07e11, nu = 0.3;
  const double A = h * w, I_z = w * h * h * h / 12.0, I_y = h * w * w * w / 12.0;
  const double G = E / (2.0 * (1.0 + nu)), k = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu);
  const Mat6 C = stiffness(E * A, k * G * A, k * G * A, G * (I_y + I_z), E * I_y, E * I_z);
  const auto error = [&](const std::string& name, double force, int elements) {
    ClampedBeam beam(C, L, elements);
    beam.load("force", {0, force, 0});
    const StaticReport report = beam.solve();
    EXPECT_TRUE(report.converged) << report.message;
    EXPECT_EQ(report.steps.size(), 1u);
    EXPECT_LE(report.iterations, 7);
    const std::vector<double>& ref = reference.at(name);
    return std::max(std::abs(-beam.displacement().x() - ref[0]),
                    std::abs(beam.displacement().y() - ref[1]));
  };
  // The deflection: four elements have it to a thousandth, and the order is 2.
  const double deflection = reference.at("cantilever_large")[1];
  const double coarse = error("cantilever_large", 6.25e7, 4),
               medium = error("cantilever_large", 6.25e7, 16),
               fine = error("cantilever_large", 6.25e7, 64);
  EXPECT_LT(coarse, 1e-3 * deflection);
  EXPECT_NEAR(std::log(coarse / medium) / std::log(4.0), 2.0, 0.3);
  EXPECT_NEAR(std::log(medium / fine) / std::log(4.0), 2.0, 0.1);
  // A small deflection is linear in the force, and an element has the linear solution.
  EXPECT_LT(error("cantilever_small", 62500.0, 8), 1e-6 * reference.at("cantilever_small")[1]);
}

TEST(StaticBeams, MomentsAboutTwoAxesBendAndTwist) {
  const std::vector<double> ref = references().at("general_bending");
  const double L = 2.0, h = 0.2, w = 0.4, E = 2.07e11, nu = 0.3;
  const double A = h * w, I_y = h * w * w * w / 12.0, I_z = w * h * h * h / 12.0;
  const double G = E / (2.0 * (1.0 + nu));
  const Mat6 C =
      stiffness(E * A, 0.8331 * G * A, 0.7961 * G * A, 0.5768 * G * (I_y + I_z), E * I_y, E * I_z);
  for (const auto& [elements, error] :
       {std::pair(2, 4e-5), std::pair(8, 3e-6), std::pair(32, 2e-7)}) {
    ClampedBeam beam(C, L, elements);
    beam.load("moment", {0.5e6, 2e6, 0});
    const StaticReport report = beam.solve();
    ASSERT_TRUE(report.converged) << report.message;
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(beam.displacement()[i], ref[i], error) << i;
  }
}

/// Dowell, Traybar, Hodges: a blade in bending and twist under a tip weight at seven angles.
TEST(StaticBeams, ThePrincetonBladeTakesOneLoadStepInAllCases) {
  const auto reference = references();
  const double L = 0.508, h = 0.0123777, w = 0.0032024, E = 7.17e10, nu = 0.31;
  const double A = h * w, I_z = w * h * h * h / 12.0, I_y = h * w * w * w / 12.0;
  const double G = E / (2.0 * (1.0 + nu));
  const Mat6 C = stiffness(E * A, G * A, G * A, 0.198 * G * (I_y + I_z), E * I_y, E * I_z);
  const double loads[] = {4.448, 8.896, 13.345};
  for (const auto& [elements, error] : {std::pair(8, 3.5e-5), std::pair(16, 9e-6)}) {
    double worst = 0.0;
    int most = 0;
    for (int f = 0; f < 3; ++f)
      for (int angle = 0; angle <= 90; angle += 15) {
        const double b = angle * kPi / 180.0;
        ClampedBeam beam(C, L, elements);
        beam.load("force", loads[f] * Vec3(0, -std::cos(b), std::sin(b)));
        const StaticReport report = beam.solve();
        ASSERT_TRUE(report.converged) << report.message;
        EXPECT_EQ(report.steps.size(), 1u) << f << " " << angle;
        most = std::max(most, report.iterations);
        const auto& ref =
            reference.at("princeton_F" + std::to_string(f + 1) + "_" + std::to_string(angle));
        for (int i = 0; i < 3; ++i)
          worst = std::max(worst, std::abs(beam.displacement()[i] - ref[i]));
        EXPECT_NEAR(std::atan2(beam.turn()(2, 1), beam.turn()(1, 1)), ref[3], 2e-3);
      }
    EXPECT_LT(worst, error) << elements;
    EXPECT_LE(most, 7);
    RecordProperty("error_" + std::to_string(elements), std::to_string(worst));
  }
}

/// Bathe, Bolourchi (1979): an arc of 45 degrees bent out of its plane.
TEST(StaticBeams, TheArcOf45DegreesBendsOutOfItsPlane) {
  const auto reference = references();
  const double E = 1e7, G = 5e6;
  const Mat6 C = stiffness(E, 5.0 / 6.0 * G, 5.0 / 6.0 * G, G / 6.0, E / 12.0, E / 12.0);
  for (const auto& [F, elements, error] :
       {std::tuple(300, 8, 0.0065), std::tuple(450, 8, 0.012), std::tuple(600, 16, 0.003)}) {
    ClampedBeam beam(C, 100.0 * kPi / 4.0, elements, kPi / 4.0);
    beam.load("force", {0, 0, double(F)});
    const StaticReport report = beam.solve();
    ASSERT_TRUE(report.converged) << report.message;
    const auto& ref = reference.at("bend_" + std::to_string(F));
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(beam.tip()[i], ref[i], error) << F << " " << i;
    EXPECT_EQ(report.unstable, 0);
  }
}

}  // namespace
}  // namespace polhode::static_beams_tests
