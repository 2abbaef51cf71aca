// SPDX-License-Identifier: Apache-2.0
// Modes about a steady spin, seen from the turning frame, against closed forms and published
// values.
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/modal.hpp>

namespace polhode::spin_modes_tests {
namespace {

using testing::HasSubstr;

constexpr double kPi = std::numbers::pi;

ModesReport modes_of(const std::string& text, const io::Overrides& overrides = {}) {
  const ModalAnalysis analysis(io::read_model_text(text, "spin.yaml", overrides));
  EXPECT_TRUE(analysis.converged()) << analysis.message();
  return analysis.report();
}

/// The |Im λ| next to a value [rad/s].
double nearest(const ModesReport& r, double wanted) {
  double best = 0.0;
  for (const Mode& mode : r.modes)
    if (std::abs(mode.eigenvalue.imag() - wanted) < std::abs(best - wanted))
      best = mode.eigenvalue.imag();
  return best;
}

/// Frequencies in the world of one whirl, ascending [Hz].
std::vector<double> in_world(const ModesReport& r, Whirl whirl) {
  std::vector<double> list;
  for (const Mode& mode : r.modes)
    if (!mode.rigid && mode.whirl == whirl) list.push_back(mode.world_frequency.value());
  std::sort(list.begin(), list.end());
  return list;
}

std::string refusal(const std::string& text) {
  try {
    (void)ModalAnalysis(io::read_model_text(text, "spin.yaml"));
  } catch (const InputError& e) {
    return e.what();
  }
  return {};
}

// A free body about its axis of largest inertia: Euler's nutation, in body axes
// Ω √((C − A)(C − B)/(AB)).
// @tests{spin-body}
TEST(SpinModes, OfAFreeBodyHaveEulersNutation) {
  constexpr const char* kFree = R"(
format: 1
variables: {spin: 10, A: 2, B: 2}
bodies: {top: {mass: 3, inertia: [A, B, 3], position: [0, 0, 0.7]}}
analysis: {type: modes, count: 8, spin: spin, spin_axis: z}
)";
  for (const double spin : {0.1, 10.0, 1000.0})
    for (const double B : {2.0, 2.5}) {
      const ModesReport r =
          modes_of(kFree, {format("variables.spin={}", spin), format("variables.B={}", B)});
      const double wobble = spin * std::sqrt((3.0 - 2.0) * (3.0 - B) / (2.0 * B));
      EXPECT_NEAR(nearest(r, wobble), wobble, 1e-7 * spin);
      // At rest in the world where it drifts or tilts: Ω in the frame.
      EXPECT_NEAR(nearest(r, spin), spin, 1e-6 * spin);
    }
}

// A hinged bar on a turntable. Flap ω² = Ω² [(J_z − J_x) + m c (R + c)]/(J_y + m c²), lag
// ω² = Ω² m R c/(J_z + m c²): for a thin bar Ω √(1 + 3R/2L) and Ω √(3R/2L).
// @tests{spin-matrices} @tests{spin-body}
TEST(SpinModes, OfAHingedBladeAreThoseOfACentrifugalPendulum) {
  constexpr const char* kBlade = R"(
format: 1
variables: {R: 0.2}
bodies: {blade: {mass: 2, inertia: [0.001, 0.16, 0.161], position: [R + 0.5, 0, 0]}}
joints: {hinge: {type: revolute, bodies: [ground, blade], at: [R, 0, 0], axis: y}}
analysis: {type: modes, count: 1, spin: 50, spin_axis: z, spin_ground: turns}
)";
  for (const double R : {0.0, 0.2, 3.0})
    for (const bool flap : {true, false}) {
      if (!flap && R == 0.0) continue;
      const ModesReport r = modes_of(
          kBlade,
          {format("variables.R={}", R), flap ? "joints.hinge.axis=y" : "joints.hinge.axis=z"});
      const double m = 2.0, c = 0.5;
      const double square = flap ? (0.161 - 0.001 + m * c * (R + c)) / (0.16 + m * c * c)
                                 : m * R * c / (0.161 + m * c * c);
      ASSERT_EQ(r.modes.size(), 1u);
      EXPECT_NEAR(r.modes[0].eigenvalue.imag(), 50.0 * std::sqrt(square), 1e-8 * 50.0);
    }
}

// A mass on isotropic springs (Jeffcott's rotor): in the world it swings at √(k/m) both ways at any
// speed, below and above the critical one. With dampers on the ground the decay stays that at rest.
// @tests{spin-whirl} @tests{spin-ground-damping} @tests{spin-invariance}
TEST(SpinModes, OfJeffcottsRotorAreThoseAtRestInTheWorld) {
  constexpr const char* kRotor = R"(
format: 1
variables: {spin: 0, c: 0}
bodies: {disc: {mass: 2, inertia: [0.01, 0.01, 0.02], position: [0, 0, 0]}}
loads: {bearing: {type: bushing, bodies: [ground, disc], at: [0, 0, 0], axis: z, stiffness: [800, 800, 5000], damping: [c, c, 0], turning_stiffness: [0, 0, 0]}}
analysis: {type: modes, count: 9, spin: spin, spin_axis: z}
)";
  for (const double spin : {0.0, 5.0, 20.5, 100.0, -100.0})
    for (const double c : {0.0, 4.0}) {
      const ModesReport r =
          modes_of(kRotor, {format("variables.spin={}", spin), format("variables.c={}", c)});
      const std::complex<double> world(-0.25 * c, std::sqrt(400.0 - 0.0625 * c * c));
      int found = 0;
      for (const Mode& mode : r.modes)
        for (const double w : {world.imag() - spin, world.imag() + spin})
          if (std::abs(mode.eigenvalue - std::complex<double>(world.real(), std::abs(w))) <
              1e-6 * (20.0 + std::abs(spin)))
            ++found;
      EXPECT_EQ(found, spin == 0.0 ? 4 : 2) << spin << " rad/s, c = " << c;
      if (spin == 0.0) continue;
      for (const Whirl whirl : {Whirl::forward, Whirl::backward}) {
        const std::vector<double> list = in_world(r, whirl);
        EXPECT_TRUE(std::any_of(
            list.begin(), list.end(),
            [&](double f) { return std::abs(f - world.imag() / (2.0 * kPi)) < 1e-6 * f; }))
            << spin << " rad/s, " << whirl_name(whirl);
      }
    }
}

// A clamped blade: frequencies ω √(ρA L⁴/EI) by Ω √(ρA L⁴/EI), of A. D. Wright, C. E. Smith,
// R. W. Thresher, J. L. C. Wang, J. Appl. Mech. 49 (1982) 197-202, no hub. Lag: ω² − Ω².
// @tests{spin-matrices}
TEST(SpinModes, OfAClampedBeamAreThoseOfWrightAndOthers) {
  constexpr const char* kBeam = R"(
format: 1
variables: {n: 8, spin: 2}
sections: {s: {type: general, EA: 1e6, GA_y: 1e6, GA_z: 1e6, GJ: 10, EI_y: 1, EI_z: 1, mass_per_length: 1, inertia_per_length: [2e-6, 1e-6, 1e-6]}}
beams: {blade: {points: [[0, 0, 0], [1, 0, 0]], elements: n, section: s, bonded: {ground: start}}}
analysis: {type: modes, count: 6, spin: spin, spin_axis: z, spin_ground: turns}
)";
  struct Published {
    double spin, first, second;
  };
  for (const Published& p : {Published{2.0, 4.1373, 22.6149}, Published{10.0, 11.2023, 33.6404}})
    for (const int n : {8, 24}) {
      const ModesReport r =
          modes_of(kBeam, {format("variables.n={}", n), format("variables.spin={}", p.spin)});
      const double within = n == 8 ? 6e-3 : 7e-4;
      EXPECT_NEAR(nearest(r, p.first), p.first, within * p.first);
      EXPECT_NEAR(nearest(r, p.second), p.second, 2.0 * within * p.second);
      const double lag = std::sqrt(p.first * p.first - p.spin * p.spin);
      EXPECT_NEAR(nearest(r, lag), lag, 2.0 * within * p.first);
    }
}

// A rope that the spin stretches: Legendre's equation gives Ω √(n(n + 1)/2), n odd, for flap, here
// √6 Ω, and by ω² − Ω² √5 Ω for lag, whatever its mass. The second difference of pieces is of
// order one over their square.
// @tests{spin-matrices}
TEST(SpinModes, OfARopeAreThoseOfLegendre) {
  constexpr const char* kRope = R"(
format: 1
variables: {n: 10, spin: 3}
bodies: {tip: {mass: 1e-7, inertia: [1e-9, 1e-9, 1e-9], position: [1, 0, 0]}}
cables: {rope: {through: [[ground, [0, 0, 0]], [tip, [0, 0, 0]]], stiffness: 1e6 N, mass_per_length: 1, elements: n}}
analysis: {type: modes, count: 12, spin: spin, spin_axis: z, spin_ground: turns}
)";
  for (const double spin : {0.3, 3.0})
    for (const int n : {10, 40}) {
      const ModesReport r =
          modes_of(kRope, {format("variables.n={}", n), format("variables.spin={}", spin)});
      for (const double square : {6.0, 5.0})
        EXPECT_NEAR(nearest(r, spin * std::sqrt(square)), spin * std::sqrt(square),
                    spin * 4.0 / (n * n) + 1e-4 * spin)
            << n;
    }
}

// The same blade as a solid of square section, h = L/10: shear and rotary inertia lower the
// frequencies at rest by some (h/L)², so that the stiffening is compared, ω² − ω_0² (Southwell).
// @tests{spin-matrices}
TEST(SpinModes, OfASolidBladeAreStiffenedByTheSpin) {
  constexpr const char* kSolid = R"(
format: 1
variables: {spin: 0, cells: 8}
materials: {m: {type: elastic, youngs_modulus: 1.2e9, poisson_ratio: 0, density: 1000}}
solids: {blade: {mesh: {block: {size: [1, 0.1, 0.1], cells: [cells, 1, 1]}, position: [0.5, 0, 0]}, element: hex20, material: m, bonded: {ground: xmin}}}
analysis: {type: modes, count: 4, spin: spin, spin_axis: z, spin_ground: turns}
)";
  // EI/ρA = E h²/(12 ρ) = 1000: the unit of ω is √1000 rad/s.
  const double unit = std::sqrt(1000.0);
  for (const int cells : {6, 12}) {
    const auto at = [&](double gamma) {
      return modes_of(
          kSolid, {format("variables.spin={}", gamma * unit), format("variables.cells={}", cells)});
    };
    const double rest = nearest(at(0.0), 3.516 * unit) / unit;
    EXPECT_NEAR(rest, 3.516, 0.03);
    const ModesReport r = at(2.0);
    const double stiffening = 4.1373 * 4.1373 - 3.5160 * 3.5160;
    const double flap = nearest(r, 4.1373 * unit) / unit;
    EXPECT_NEAR(flap * flap - rest * rest, stiffening, 0.03 * stiffening);
    const double lag = nearest(r, std::sqrt(4.1373 * 4.1373 - 4.0) * unit) / unit;
    EXPECT_NEAR(lag * lag, flap * flap - 4.0, 0.03 * lag * lag);
  }
}

// Stodola's overhung disc at 300 rad/s, in the world 6.597, 13.407, 41.972 and 127.075 Hz with a
// rigid disc: as a body, and as a stiff solid on coarse and fine meshes.
// @tests{spin-matrices} @tests{spin-whirl}
TEST(SpinModes, OfStodolasDiscAreTheSameAsABodyAndAsASolid) {
  const std::string shaft = R"(
format: 1
variables: {spin: 300, n: 16}
materials: {s: {type: elastic, youngs_modulus: 200 GPa, poisson_ratio: 0.3, density: 7800}, stiff: {type: elastic, youngs_modulus: 2e14, poisson_ratio: 0.3, density: 7800}}
sections: {c: {type: circle, diameter: 30 mm, material: s}}
beams: {b: {points: [[0, 0, -0.5], [0, 0, 0]], elements: 10, section: c}}
joints: {brg: {type: revolute, bodies: [ground, b.start], at: [0, 0, -0.5], axis: z}, w: {type: fixed, bodies: [b.end, hub], at: [0, 0, 0]}}
analysis: {type: modes, count: 6, spin: spin, spin_axis: z}
)";
  const std::string solid = shaft + R"(
bodies: {hub: {mass: 1e-3, inertia: [1e-6, 1e-6, 1e-6], position: [0, 0, 0]}}
solids: {disc: {mesh: {cylinder: {diameter: 0.4, length: 0.04, cells: [1, n, 1]}, position: [0, 0, 0.02]}, element: hex20, material: stiff, bonded: {hub: start}}}
)";
  const double mass = 7800.0 * kPi * 0.2 * 0.2 * 0.04;
  const double J_p = 0.5 * mass * 0.04, J_t = mass * (0.04 / 4.0 + 0.0016 / 12.0);
  const std::string rigid =
      shaft + format(
                  "bodies: {{hub: {{mass: {0:.12g}, inertia: [{1:.12g}, {1:.12g}, {2:.12g}], "
                  "position: [0, 0, 0.02]}}}}\n",
                  mass, J_t, J_p);
  const auto expect = [&](const ModesReport& r, double within) {
    const std::vector<double> forward = in_world(r, Whirl::forward);
    const std::vector<double> backward = in_world(r, Whirl::backward);
    ASSERT_EQ(forward.size(), 2u);
    ASSERT_EQ(backward.size(), 2u);
    EXPECT_NEAR(backward[0], 6.597, within * 6.597);
    EXPECT_NEAR(forward[0], 13.407, within * 13.407);
    EXPECT_NEAR(backward[1], 41.972, within * 41.972);
    EXPECT_NEAR(forward[1], 127.075, within * 127.075);
  };
  expect(modes_of(rigid), 2e-3);
  for (const int n : {8, 16}) expect(modes_of(solid, {format("variables.n={}", n)}), 4e-3);
}

// A free thin ring: for n waves (1 + n²) ω² − 4nΩω = k n² (n² − 1)² + Ω² n² (n² − 3) with
// k = EI/(ρA R⁴), inextensional with the tension of the spin (G. H. Bryan, 1890).
// @tests{spin-matrices}
TEST(SpinModes, OfAFreeRingAreThoseOfBryan) {
  constexpr const char* kRing = R"(
format: 1
variables: {n: 16, spin: 3}
sections: {s: {type: general, EA: 1e6, GA_y: 1e6, GA_z: 1e6, GJ: 50, EI_y: 1, EI_z: 50, mass_per_length: 1, inertia_per_length: [2e-6, 1e-6, 1e-6]}}
beams:
  p: {arc: [[1, 0, 0], [0, 1, 0], [-1, 0, 0]], elements: n, section: s, up: z}
  q: {arc: [[-1, 0, 0], [0, -1, 0], [1, 0, 0]], elements: n, section: s, up: z}
joints: {a: {type: fixed, bodies: [p.end, q.start], at: [-1, 0, 0]}, b: {type: fixed, bodies: [q.end, p.start], at: [1, 0, 0]}}
analysis: {type: modes, count: 14, spin: spin, spin_axis: z}
)";
  for (const double spin : {0.5, 3.0})
    for (const int n : {8, 32}) {
      const ModesReport r =
          modes_of(kRing, {format("variables.n={}", n), format("variables.spin={}", spin)});
      const double k = 1.0, waves = 2.0, w = waves * waves;
      const double root =
          std::sqrt(w * (w - 1) * (w - 1) * (spin * spin / ((w + 1) * (w + 1)) + k / (w + 1)));
      for (const double side : {1.0, -1.0}) {
        const double omega = std::abs(2.0 * waves * spin / (w + 1) + side * root);
        EXPECT_NEAR(nearest(r, omega), omega, (n == 8 ? 3e-2 : 3e-3) * root) << spin;
      }
    }
}

TEST(SpinModes, AreSeenAboutTheModelsOwnRotationWithoutAnAxis) {
  const std::string text = R"(
format: 1
bodies: {disc: {mass: 2, inertia: [0.01, 0.01, 0.02], position: [0, 0.4, 0], angular_velocity: [0, 0, -7], velocity: [2.1, 0, 0]}}
joints: {pin: {type: revolute, bodies: [ground, disc], at: [0, 0.1, 0], axis: z}}
analysis: {type: modes, spin: 20}
)";
  const ModesReport r = modes_of(text);
  ASSERT_EQ(r.modes.size(), 1u);
  EXPECT_TRUE(r.modes[0].rigid);
  EXPECT_THAT(r.modes[0].motion, HasSubstr("rotates about z"));
}

// @tests{spin-invariance}
TEST(SpinModes, RefuseWhatIsNotSteadyInTheTurningFrame) {
  const auto rotor = [](const std::string& more, const std::string& analysis = "") {
    return R"(
format: 1
bodies: {disc: {mass: 2, inertia: [0.01, 0.01, 0.02], position: [0, 0, 0]}}
)" + more + "\nanalysis: {type: modes, spin: 20" +
           (analysis.empty() ? std::string(", spin_axis: z") : analysis) + "}\n";
  };
  EXPECT_EQ(refusal(rotor(
                "joints: {j: {type: revolute, bodies: [ground, disc], at: [0, 0, 0], axis: z}}")),
            "");
  EXPECT_THAT(refusal(rotor("joints: {j: {type: fixed, bodies: [ground, disc], at: [0, 0, 0]}}")),
              HasSubstr("joints.j: holds other motions of the model as it turns on the ground. Use "
                        "what is the same in all directions about the axis"));
  EXPECT_EQ(refusal(rotor("joints: {j: {type: fixed, bodies: [ground, disc], at: [0, 0, 0]}}",
                          ", spin_axis: z, spin_ground: turns")),
            "");
  EXPECT_THAT(refusal(rotor(
                  "joints: {j: {type: revolute, bodies: [ground, disc], at: [0, 0, 0], axis: x}}")),
              HasSubstr("joints.j: holds other motions"));
  EXPECT_THAT(refusal(rotor("loads: {k: {type: bushing, bodies: [ground, disc], at: [0, 0, 0], "
                            "axis: z, stiffness: [1, 2, 1]}}")),
              HasSubstr("loads.k: exerts another force as the model turns on the ground"));
  EXPECT_THAT(refusal(rotor("loads: {f: {type: force, body: disc, at: [0, 0, 0], force: [1, 0, "
                            "0]}}")),
              HasSubstr("loads.f: exerts another force"));
  EXPECT_EQ(refusal(rotor("gravity: [0, 0, -9.81]\njoints: {j: {type: revolute, bodies: [ground, "
                          "disc], at: [0, 0, 0], axis: z}}")),
            "");
  EXPECT_THAT(refusal(rotor("gravity: [0, -9.81, 0]")),
              HasSubstr("gravity: is not along the axis of the spin, in whose frame it turns"));
  EXPECT_THAT(refusal(rotor("", " ")),
              HasSubstr("analysis.spin_axis: is missing, and no body turns at the start"));
  EXPECT_THAT(
      refusal(R"(
format: 1
bodies: {disc: {mass: 2, inertia: [1, 1, 2], position: [0, 0, 0], angular_velocity: [0, 0, 4]}, housing: {mass: 1, inertia: [1, 1, 1], position: [0, 0, 1]}}
analysis: {type: modes, spin: 20}
)"),
      HasSubstr("bodies.housing: does not turn with the others about one axis at the start"));
  EXPECT_THAT(
      refusal(rotor("joints: {j: {type: revolute, bodies: [ground, disc], at: [0, 0, 0], axis: z, "
                    "friction: {mu: 0.2, radius: 8 mm}}}")),
      HasSubstr("joints.j: has friction or damping on the ground"));
}

TEST(SpinModes, AreFoundForAListOrARangeOfSpeeds) {
  const auto speeds = [](const std::string& spin) {
    return io::read_model_text(
               "{format: 1, bodies: {b: {mass: 1, inertia: [1, 1, 1]}}, analysis: {type: modes, "
               "spin_axis: z, spin: " +
                   spin + "}}",
               "spin.yaml")
        .analysis.spin;
  };
  EXPECT_EQ(speeds("[0, 7]"), (std::vector<double>{0.0, 7.0}));
  EXPECT_EQ(speeds("\"0:300:100 rad/s\""), (std::vector<double>{0.0, 100.0, 200.0, 300.0}));
  const std::vector<double> rpm = speeds("\"0:600:600 rpm\"");
  ASSERT_EQ(rpm.size(), 2u);
  EXPECT_NEAR(rpm[1], 20.0 * kPi, 1e-12);
  EXPECT_EQ(speeds("\"9:3:-3\"").size(), 3u);
  for (const char* wrong : {"\"0:5\"", "\"0:5:-1\"", "\"0:5:0\"", "\"0:1e9:1\""})
    EXPECT_THROW((void)speeds(wrong), io::ModelErrors) << wrong;
}

}  // namespace
}  // namespace polhode::spin_modes_tests
