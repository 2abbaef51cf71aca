// SPDX-License-Identifier: Apache-2.0
// Buckling loads of slender beams by statics: located, named in the message, and the same for any
// mesh.
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/modal.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::stability_tests {
namespace {

StaticReport statics_of(const std::string& text, const io::Overrides& overrides) {
  Simulation s(io::read_model_text(text, "beam.yaml", overrides));
  const RunSummary r = s.run();
  EXPECT_EQ(r.end, RunEnd::finished) << r.message;
  return *r.statics;
}

// Argyris et al., Comput. Methods Appl. Mech. Engrg. 20 (1979): legs of 240 mm, 30 mm by 0.6 mm,
// torsion constant b t³/3; Simo and Vu-Quoc (1986) give 1.088 N.
constexpr const char* kFrame = R"(
format: 1
variables: {L: 0.24, n: 10}
materials: {strip: {type: elastic, youngs_modulus: 71.24 GPa, poisson_ratio: 0.31, density: 2700}}
sections:
  strip: {type: rectangle, height: 0.03, width: 0.0006, material: strip, torsion_factor: 1.012763}
beams:
  leg: {points: [[0, 0, 0], [L, 0, 0], [L, -L, 0]], elements: 2*n, section: strip, up: [1, 1, 0], bonded: {ground: start}}
loads: {pull: {type: force, body: leg.end, force: [1.2, 0, 0]}}
analysis: {type: statics}
output: {hdf5: false}
)";

// @tests{statics-supports}
TEST(Stability, OfTheRightAngleFrameIsLostAtItsLoadOnAnyMesh) {
  for (const int n : {5, 10, 20, 40, 80, 200}) {
    const StaticReport r = statics_of(kFrame, {"variables.n=" + std::to_string(n)});
    EXPECT_EQ(r.unstable, 1) << n;
    ASSERT_EQ(r.limit_points.size(), 1u) << n;
    EXPECT_NEAR(1.2 * r.limit_points[0].load_factor, 1.08754, (n == 5 ? 2e-3 : 1e-3) * 1.08754)
        << n;
    EXPECT_EQ(r.limit_points[0].unstable, 1);
    EXPECT_NE(r.limit_points[0].motion.find("moves along z"), std::string::npos)
        << r.limit_points[0].motion;
    EXPECT_TRUE(r.free_motions.empty());
  }
}

/// The lowest squared frequency decreases with the load and is zero where the frame buckles, by
/// interpolation between a load below and one above. Its equilibrium is in the plane, its mode out
/// of it.
TEST(Stability, OfTheRightAngleFrameIsLostWhereItsLowestFrequencyIsZero) {
  for (const int n : {5, 10, 40, 200}) {  // above 33 elements a leg by Lanczos iterations
    const auto lowest = [&](double load) {
      const ModalAnalysis frame(io::read_model_text(
          kFrame, "frame.yaml",
          {"variables.n=" + std::to_string(n), "analysis.type=modes", "analysis.count=2",
           "loads.pull.force=[" + std::to_string(load) + ", 0, 0]"}));
      EXPECT_TRUE(frame.converged()) << frame.message();
      EXPECT_TRUE(frame.report().symmetric);
      EXPECT_TRUE(frame.report().complete);
      return frame.report().modes.at(0);
    };
    const Mode below = lowest(1.08), above = lowest(1.095);
    EXPECT_EQ(below.kind, ModeKind::oscillation);
    EXPECT_EQ(above.kind, ModeKind::divergence);
    const double critical =
        1.08 + 0.015 * below.omega_squared / (below.omega_squared - above.omega_squared);
    EXPECT_NEAR(critical, 1.08754, (n == 5 ? 2e-3 : 1e-3) * 1.08754) << n;
  }
}

constexpr const char* kColumn = R"(
format: 1
variables: {d: 0.01, part: 1.1, steps: 10, n: 20}
materials: {steel: {type: elastic, youngs_modulus: 210 GPa, poisson_ratio: 0.3, density: 7800}}
sections: {bar: {type: circle, diameter: d, material: steel}}
beams:
  bar: {points: [[0, 0, 0], [0, 0, 1]], elements: n, section: bar, up: x, bonded: {ground: start}}
loads: {press: {type: force, body: bar.end, force: [0, 0, -part*pi^2/4 * 210e9*pi*d^4/64]}}
analysis: {type: statics, load_steps: steps}
output: {hdf5: false}
)";

/// π² E I/(4 L²): also on a load step, in a single step, and for slender wires.
TEST(Stability, OfACantileverColumnIsLostAtEulersLoad) {
  struct Case {
    std::string part, steps, d, n;
  };
  for (const Case& c : {Case{"1.1", "10", "0.01", "20"}, Case{"1.0", "1", "0.01", "20"},
                        Case{"1.1", "11", "0.01", "20"}, Case{"1.1", "1", "0.01", "20"},
                        Case{"1.1", "10", "0.001", "50"}, Case{"1.1", "10", "0.0001", "50"},
                        Case{"1.1", "10", "1e-5", "50"}, Case{"1.1", "10", "1e-5", "20"},
                        Case{"0.99", "10", "0.01", "20"}}) {
    const StaticReport r =
        statics_of(kColumn, {"variables.part=" + c.part, "variables.steps=" + c.steps,
                             "variables.d=" + c.d, "variables.n=" + c.n});
    const double part = std::stod(c.part);
    if (part < 1.0) {
      EXPECT_EQ(r.unstable, 0);
      EXPECT_TRUE(r.limit_points.empty());
      continue;
    }
    EXPECT_EQ(r.unstable, 2) << c.part << ' ' << c.steps << ' ' << c.d;
    ASSERT_EQ(r.limit_points.size(), 1u) << c.part << ' ' << c.steps << ' ' << c.d;
    EXPECT_NEAR(r.limit_points[0].load_factor * part, 1.0, 1e-3) << c.d;
  }
}

/// A wire under tension or none: transverse frequencies of a cantilever, (1.875104/L)² √(E I/(ρ
/// A)), for any slenderness, conditions of the stiffness to 1e14 and more.
TEST(Stability, WiresHaveTheirFrequenciesAtAnySlenderness) {
  for (const auto& [d, n] :
       {std::pair("0.01", 20), {"1e-3", 40}, {"1e-4", 40}, {"1e-5", 40}, {"1e-5", 200}}) {
    const ModalAnalysis wire(io::read_model_text(
        kColumn, "wire.yaml",
        {std::string("variables.d=") + d, "variables.part=0", "analysis.load_steps=1",
         "variables.n=" + std::to_string(n), "analysis.type=modes", "analysis.count=4"}));
    ASSERT_TRUE(wire.converged()) << wire.message();
    const double c = std::stod(d) / 4.0 * std::sqrt(210e9 / 7800.0);
    for (int k = 0; k < 4; ++k) {
      const double known = std::pow(k < 2 ? 1.875104 : 4.694091, 2) * c / (2.0 * std::numbers::pi);
      const Mode& mode = wire.report().modes.at(static_cast<std::size_t>(k));
      EXPECT_NEAR(mode.frequency, known, (k < 2 ? 1e-3 : 5e-3) * known)
          << d << ' ' << n << ' ' << k;
      EXPECT_EQ(mode.kind, ModeKind::oscillation) << d << ' ' << n;
    }
  }
}

// K. Mattiasson, Int. J. Numer. Methods Engrg. 17 (1981) 145-153: P L²/(E I) = 1 and 10.
constexpr const char* kElastica = R"(
format: 1
variables: {P: 1, stiff: 1e9}
sections:
  wire: {type: general, EA: stiff, GA_y: stiff, GA_z: stiff, GJ: 1, EI_y: 1, EI_z: 1, mass_per_length: 1, inertia_per_length: [1e-9, 1e-9, 1e-9]}
beams:
  wire: {points: [[0, 0, 0], [1, 0, 0]], elements: 40, section: wire, up: y, bonded: {ground: start}}
loads: {pull: {type: force, body: wire.end, force: [0, P, 0]}}
analysis: {type: statics}
output: {hdf5: false}
)";

TEST(Stability, AnElasticaBendsByTheClosedFormAtAnyAxialStiffness) {
  for (const char* stiff : {"1e5", "1e7", "1e9"})
    for (const auto& [P, u, w] : {std::tuple("1", 0.05643, 0.30172), {"10", 0.55500, 0.81061}}) {
      Simulation s(io::read_model_text(
          kElastica, "beam.yaml",
          {std::string("variables.P=") + P, std::string("variables.stiff=") + stiff}));
      const RunSummary r = s.run();
      ASSERT_EQ(r.end, RunEnd::finished) << stiff << ' ' << P << ' ' << r.message;
      EXPECT_EQ(r.statics->unstable, 0);
      const Vec3 tip = s.beam(0).position.back();
      EXPECT_NEAR(1.0 - tip.x(), u, 5e-4) << stiff << ' ' << P;
      EXPECT_NEAR(tip.y(), w, 5e-4) << stiff << ' ' << P;
    }
}

// A taut string of point masses in two planes: k √(T/m)/(2 L), apart from the effect of the length
// of its pieces.
constexpr const char* kString = R"(
format: 1
cables:
  string: {through: [[ground, [0, 0, 0]], [ground, [1, 0, 0]]], stiffness: 1e5, mass_per_length: 0.1, elements: 40, free_length: 0.999}
analysis: {type: modes, count: 6, about: start}
)";

TEST(Stability, TheModesOfAStringBeginWithItsFundamental) {
  const ModalAnalysis string(io::read_model_text(kString, "string.yaml"));
  ASSERT_TRUE(string.converged()) << string.message();
  const std::vector<Mode>& modes = string.report().modes;
  ASSERT_EQ(modes.size(), 6u);
  const double T = 1e5 * (1.0 / 0.999 - 1.0), mass = 0.1 * 0.999;
  for (int k = 0; k < 6; ++k) {
    const double tone = 0.5 * (1 + k / 2) * std::sqrt(T / mass);
    EXPECT_NEAR(modes[static_cast<std::size_t>(k)].frequency, tone, 5e-3 * tone) << k;
    EXPECT_FALSE(modes[static_cast<std::size_t>(k)].rigid);
  }
}

// Lee, Manuel and Rossow (1968): two hinged legs, loaded a fifth from the corner. The section is
// wide, so that nothing leaves the plane. Limit load by tools/references/lee_frame.py.
constexpr const char* kLee = R"(
format: 1
variables: {k: 4}
materials: {m: {type: elastic, youngs_modulus: 7.2 GPa, poisson_ratio: 0.3, density: 2700}}
sections:
  s: {type: rectangle, height: 0.02, width: 0.3, material: m}
beams:
  frame: {points: [[0, 0, 0], [0, 0, 1.2], [1.2, 0, 1.2]], elements: 10*k, section: s, up: [-1, 0, 1]}
joints:
  foot: {type: revolute, bodies: [ground, frame.start], at: [0, 0, 0], axis: y}
  end: {type: revolute, bodies: [ground, frame.end], at: [1.2, 0, 1.2], axis: y}
loads: {p: {type: force, body: frame.24, force: [0, 0, -20000]}}
analysis: {type: statics}
output: {hdf5: false}
)";

TEST(Stability, OfLeesFrameIsLostAtItsLimitLoadOnAnyMesh) {
  for (const int k : {2, 4, 8}) {
    const StaticReport r = statics_of(
        kLee, {"variables.k=" + std::to_string(k), "loads.p.body=frame." + std::to_string(6 * k)});
    ASSERT_EQ(r.limit_points.size(), 1u) << k;
    EXPECT_NEAR(20000.0 * r.limit_points[0].load_factor, 18544.76,
                (k == 2 ? 2e-4 : 1e-5) * 18544.76)
        << k;
  }
}

}  // namespace
}  // namespace polhode::stability_tests
