// SPDX-License-Identifier: Apache-2.0
// Statics follows a path: turns of bodies, contact on the way, histories of joints.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <support/run_text.hpp>

namespace polhode::load_steps_tests {
namespace {

using test::finished;
using test::made;

constexpr double kPi = std::numbers::pi;

/// Analysis with this number of load steps; 0: automatic.
std::string statics(int load_steps) {
  return load_steps > 0 ? "analysis: {type: statics, load_steps: " + std::to_string(load_steps) +
                              "}\noutput: {hdf5: false, probes: "
                        : "analysis: {type: statics}\noutput: {hdf5: false, probes: ";
}

double column(const Simulation& s, const std::string& probe, const std::string& name) {
  const std::vector<std::string> names = s.probe_columns(probe);
  const std::vector<double> values = s.probe(probe);
  for (std::size_t k = 0; k < names.size(); ++k)
    if (names[k].starts_with(name + " [")) return values[values.size() - names.size() + k];
  ADD_FAILURE() << "no column " << name;
  return 0.0;
}

/// Root of an increasing function between two numbers.
double root(double low, double high, const std::function<double(double)>& f) {
  for (int k = 0; k < 200; ++k) (f(0.5 * (low + high)) < 0.0 ? low : high) = 0.5 * (low + high);
  return low;
}

/// A round bar, clamped at one end, whose other end is turned about its axis.
std::string twisted_bar(const std::string& body, const std::string& joints, int load_steps) {
  return R"(
format: 1
materials: {s: {type: elastic, youngs_modulus: 2 GPa, poisson_ratio: 0.0, density: 1000}}
sections: {c: {type: circle, diameter: 20 mm, material: s}}
bodies: {grip: {mass: 1, inertia: [1, 1, 1], position: [0, 0, 1])" +
         body + "}}\n" + joints +
         R"(beams: {bar: {points: [[0, 0, 0], [0, 0, 1]], elements: 8, section: c, bonded: {ground: start, grip: end}}}
)" + statics(load_steps) +
         "{bar: {beam: bar}}}\n";
}

}  // namespace

// M = G J θ/L. The rows of the drive hold as well half a turn and a whole turn away.
TEST(LoadSteps, ABarIsTwistedByTheWholeOfAnyAngle) {
  for (const double degrees : {60.0, 91.7, 120.0, 181.0, 270.0, 360.0}) {
    const double torque = 1e9 * kPi * std::pow(0.02, 4) / 32.0 * degrees * kPi / 180.0;
    const std::string angle = std::to_string(degrees) + " deg";
    const std::string in_body[] = {
        ", motion: {x: 0, y: 0, z: 0, rotation_vector: [0, 0, " + angle + "]}",
        ", motion: {x: 0, y: 0, z: 0, euler: {sequence: zyx, angles: [" + angle + ", 0, 0]}}"};
    const std::string in_joint[] = {
        "joints: {h: {type: fixed, bodies: [ground, grip], at: [0, 0, 1], motion: "
        "{rotation_vector: [0, 0, " +
            angle + "]}}}\n",
        "joints: {h: {type: revolute, bodies: [ground, grip], at: [0, 0, 1], axis: z}}\n"
        "loads: {m: {type: rotary_motor, joint: h, angle: " +
            angle + "}}\n"};
    for (const int load_steps : {0, 1, 4, 50})
      for (int kind = 0; kind < 4; ++kind) {
        Simulation s = made(twisted_bar(kind < 2 ? in_body[kind] : "",
                                        kind < 2 ? "" : in_joint[kind - 2], load_steps));
        finished(s);
        EXPECT_NEAR(column(s, "bar", "mx"), torque, 1e-8 * torque)
            << degrees << " degrees, kind " << kind << ", load steps " << load_steps;
      }
  }
}

// R. S. Rivlin, Phil. Trans. R. Soc. A 241 (1948) 379-397: an incompressible neo-Hookean rod that
// is turned by psi per length and kept at its length has the moment pi mu psi a^4/2 and is pressed
// with pi mu psi^2 a^4/4. Eight cells around and along it have a tenth of error, whatever the load
// steps.
TEST(LoadSteps, ARubberRodIsTurnedByAWholeTurn) {
  const double psi = 2.0 * kPi, moment = kPi * 1e5 * psi * 1e-4 / 2.0;
  const double force = kPi * 1e5 * psi * psi * 1e-4 / 4.0;
  std::vector<Vec3> moments;
  for (const int load_steps : {0, 16}) {
    Simulation s = made(R"(
format: 1
materials: {r: {type: mooney_rivlin_uncoupled, c1: 5e4, bulk_modulus: 1e8, density: 1000}}
bodies: {d: {mass: 1, inertia: [1, 1, 1], position: [0, 0, 0.5]}}
joints: {h: {type: fixed, bodies: [ground, d], at: [0, 0, 0.5], motion: {rotation_vector: [0, 0, 360 deg]}}}
solids: {b: {mesh: {cylinder: {diameter: 0.2, length: 1, cells: [1, 8, 8]}}, element: hex8, material: r, bonded: {ground: start, d: end}}}
)" + statics(load_steps) +
                        "{h: {joint: h}}}\n");
    finished(s);
    const JointReport h = s.joint(0);
    moments.push_back(h.moment);
    EXPECT_NEAR(h.moment.z(), moment, 0.1 * moment) << load_steps;
    EXPECT_NEAR(-h.force.z(), force, 0.1 * force) << load_steps;
  }
  EXPECT_LT((moments[1] - moments[0]).norm(), 1e-6 * moment);
}

// A motion by more than half a turn in a step of time leaves no trace either.
TEST(LoadSteps, AStepOfTimeInWhichAFrameTurnsByMoreThanHalfATurnIsRefused) {
  const auto turned = [](const std::string& step) {
    Simulation s = made(R"(
format: 1
bodies: {b: {mass: 1, inertia: [1, 1, 1], motion: {x: 0, y: 0, z: 0, rotation_vector: [0, 0, "6.283185307179586*t"]}}}
analysis: {type: dynamics, duration: 1.2 s, max_step_rotation: 100, step: )" +
                        step + ", min_step: " + step + "}\noutput: {hdf5: false}\n");
    return s.run();
  };
  const RunSummary once = turned("0.6 s");
  EXPECT_EQ(once.end, RunEnd::not_converged);
  EXPECT_NE(once.message.find("half a turn"), std::string::npos) << once.message;
  for (const char* step : {"100 ms", "1 ms"}) EXPECT_EQ(turned(step).end, RunEnd::finished) << step;
}

namespace {

/// Rubber between two plates, the upper one driven down to a height of the block; no friction.
std::string pressed_block(double height, int load_steps) {
  return R"(
format: 1
materials: {s: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}}
bodies:
  lo: {fixed: true, shape: {box: [0.5, 0.5, 0.02]}, position: [0, 0, -0.0601]}
  up: {mass: 1, inertia: [1, 1, 1], shape: {box: [0.5, 0.5, 0.02]}, position: [0, 0, 0.0601], motion: {x: 0, y: 0, z: )" +
         std::to_string(height - 0.1002) + R"(, rotation_vector: [0, 0, 0]}}
solids:
  b:
    mesh: {block: {size: [0.1, 0.1, 0.1], cells: [2, 2, 2]}}
    element: hex20
    material: s
    prescribed: {sx: {nodes: {plane: {axis: x, at: 0}}, x: 0}, sy: {nodes: {plane: {axis: y, at: 0}}, y: 0}}
contacts: {default: {friction: 0, restitution: 0}, exclude: [[lo, up]]}
)" + statics(load_steps) +
         "{up: {contact: [b, up]}, lo: {contact: [b, lo]}}}\n";
}

/// Force on a face of 0.1 m side of the same material, free of friction, by root finding of the
/// lateral stretch: P = μ (F − F^-T) + λ ln J F^-T.
double uniaxial_force(double stretch) {
  const double mu = 1e6 / 2.6, lambda = 1e6 * 0.3 / (1.3 * 0.4);
  const double lateral = root(0.8, 1.5, [&](double l) {
    return mu * (l - 1.0 / l) + lambda * std::log(stretch * l * l) / l;
  });
  return -0.01 * (mu * (stretch - 1.0 / stretch) +
                  lambda * std::log(stretch * lateral * lateral) / stretch);
}

}  // namespace

// The plate, 20 mm thick, moves by more than its thickness.
TEST(LoadSteps, NoPlatePassesThroughABlock) {
  for (const double height : {0.08, 0.06})
    for (const int load_steps : {0, 4}) {
      Simulation s = made(pressed_block(height, load_steps));
      finished(s);
      // The bands of both contacts, 0.1 mm, leave more or less of the height.
      EXPECT_NEAR(column(s, "up", "normal") / uniaxial_force(height / 0.1), 1.0, 3e-3)
          << height << ", load steps " << load_steps;
      EXPECT_NEAR(column(s, "lo", "normal"), column(s, "up", "normal"), 1e-6);
    }
}

// The cable is held down by the drum like the two sides of a triangle around its end.
TEST(LoadSteps, NoDrumPassesACable) {
  for (const int load_steps : {0, 10}) {
    Simulation s = made(R"(
format: 1
bodies: {drum: {mass: 1, inertia: [1, 1, 1], shape: {cylinder: [0.1, 0.3]}, orientation: {axis: x, angle: 90 deg}, position: [0, 0, 0.0601], motion: {x: 0, y: 0, z: -0.13, rotation_vector: [0, 0, 0]}}}
cables: {c: {through: [[ground, [-0.5, 0, 0]], [ground, [0.5, 0, 0]]], stiffness: 1e5, free_length: 0.999, mass_per_length: 0.1, elements: 40, contact: {radius: 0.01}}}
contacts: {}
)" + statics(load_steps) +
                        "{k: {contact: [c, drum]}, t: {cable: c}}}\n");
    finished(s);
    // Two tangents from the ends and an arc of 60 mm radius about the drum's axis, 69.9 mm below
    // them. The cable is a polygon with sides of 25 mm, which lie up to 1.3 mm outside of the arc.
    const double height = 0.13 - 0.0601, across = 0.5, radius = 0.06;
    const double apart = std::hypot(across, height), tangent = std::sqrt(apart * apart - 0.0036);
    const double turn = std::asin(radius / apart) + std::atan2(height, across);
    const double length = 2.0 * tangent + 2.0 * radius * turn;
    EXPECT_NEAR(column(s, "t", "tension") / (1e5 * (length / 0.999 - 1.0)), 1.0, 2e-2)
        << "load steps " << load_steps;
  }
}

// 300 N press a pad of 4 mm against a roller; without it the carrier would move by 100 mm.
TEST(LoadSteps, NoPadPassesARoller) {
  for (const int load_steps : {0, 20}) {
    Simulation s = made(R"(
format: 1
materials: {rubber: {type: neo_hookean, youngs_modulus: 8 MPa, poisson_ratio: 0.42, density: 1000}}
bodies:
  roller: {fixed: true, shape: {cylinder: [44 mm, 60 mm]}, position: [0, 0, 22 mm], orientation: {axis: x, angle: 90 deg}}
  carrier: {mass: 1, inertia: [0.01, 0.01, 0.01], position: [0, 0, -30 mm]}
joints: {guide: {type: prismatic, bodies: [ground, carrier], at: [0, 0, -30 mm], axis: z}}
loads:
  spring: {type: translational_spring, joint: guide, stiffness: 3000 N/m}
  push: {type: force, body: carrier, force: [0, 0, 300]}
solids: {pad: {mesh: {block: {size: [60 mm, 50 mm, 4 mm], cells: [8, 4, 2]}, position: [0, 0, -2.05 mm]}, element: hex8, material: rubber, bonded: {carrier: zmin}, contact: {surface: zmax}}}
contacts: {default: {friction: 0}}
)" + statics(load_steps) +
                        "{carrier: {body: carrier}, k: {contact: [pad, roller]}}}\n");
    finished(s);
    const double z = column(s, "carrier", "z");
    EXPECT_GT(z, -0.03);
    EXPECT_LT(z, -0.029);
    EXPECT_NEAR(column(s, "k", "normal"), 300.0 - 3000.0 * (z + 0.03),
                5.0);  // inclined by 3 degrees
  }
}

namespace {

/// A slider along z on a spring.
std::string slider(const std::string& joint, double force, int load_steps) {
  return R"(
format: 1
bodies: {s: {mass: 2, inertia: [0.01, 0.01, 0.01], shape: {box: [0.1, 0.1, 0.1]}}}
joints: {j: {type: prismatic, bodies: [ground, s], at: [0, 0, 0], axis: z, )" +
         joint + R"(}}
loads:
  k: {type: translational_spring, joint: j, stiffness: 100}
  f: {type: force, body: s, force: [30, 0, )" +
         std::to_string(force) + "]}\n" + statics(load_steps) + "{j: {joint: j}}}\n";
}

}  // namespace

// Stop and spring carry the force, at either end and whichever end was nearer at the start.
TEST(LoadSteps, StopsOfASliderAct) {
  for (const char* limits :
       {"limits: {lower: -0.05, upper: 0.2}", "limits: {lower: -0.2, upper: 0.05}",
        "limits: {lower: -0.05, upper: 0.05}", "limits: {lower: -0.05}", "limits: {upper: 0.05}"})
    for (const int load_steps : {0, 30})
      for (const double force : {-19.62, 19.62, 3.0}) {
        Simulation s = made(slider(limits, force, load_steps));
        finished(s);
        const double z = column(s, "j", "z"), stop = column(s, "j", "stop z");
        const std::string text(limits);
        const bool lower = text.find("lower: -0.05") != std::string::npos,
                   upper = text.find("upper: 0.05") != std::string::npos;
        const double free = force / 100.0;
        const double end = free < -0.05 && lower ? -0.05 : free > 0.05 && upper ? 0.05 : free;
        EXPECT_NEAR(z, end, 1e-4) << limits << force << ", load steps " << load_steps;
        EXPECT_NEAR(stop, 100.0 * z - force, 1e-6) << limits << force;
        if (end == free) {
          EXPECT_NEAR(z, free, 1e-12) << limits << force;
        }
      }
}

// Friction holds the slider up to μ N, and reduces the spring's force by it beyond that.
TEST(LoadSteps, FrictionOfASliderHoldsIt) {
  for (const int load_steps : {0, 1, 10, 100}) {
    Simulation sticks = made(slider("friction: {mu: 0.2}", 5.0, load_steps));
    finished(sticks);
    EXPECT_NEAR(column(sticks, "j", "z"), 0.0, 1e-5);
    Simulation slips = made(slider("friction: {mu: 0.2}", 20.0, load_steps));
    finished(slips);
    EXPECT_NEAR(column(slips, "j", "z"), (20.0 - 0.2 * 30.0) / 100.0, 1e-9) << load_steps;
  }
}

// A ball joint with friction, loaded by a force through its centre and a moment about it.
TEST(LoadSteps, FrictionOfABallJointHoldsIt) {
  for (const int load_steps : {0, 1, 10, 100})
    for (const double moment : {0.5, 3.0}) {
      Simulation s = made(R"(
format: 1
bodies: {b: {mass: 1, inertia: [0.01, 0.01, 0.01]}}
joints: {j: {type: spherical, bodies: [ground, b], at: [0, 0, 0], friction: {mu: 0.2, radius: 0.1}}}
loads:
  f: {type: force, body: b, force: [50, 0, 0]}
  m: {type: moment, body: b, moment: [0, 0, )" +
                          std::to_string(moment) + R"(]}
  k: {type: bushing, bodies: [ground, b], at: [0, 0, 0], stiffness: [1, 1, 1], turning_stiffness: [1000, 1000, 1000]}
)" + statics(load_steps) + "{b: {body: b, rotation: vector}}}\n");
      finished(s);
      const double slips = 0.2 * 0.1 * 50.0;
      EXPECT_NEAR(column(s, "b", "thetaz"), std::max(0.0, moment - slips) / 1000.0, 3e-5)
          << moment << ", load steps " << load_steps;
    }
}

namespace {

std::string rolling_wheel(double moment, int load_steps) {
  return R"(
format: 1
gravity: [0, 0, -9.81]
bodies: {w: {mass: 2, inertia: [0.03, 0.05, 0.03], position: [0, 0, 0.2]}}
joints: {pl: {type: generic, bodies: [ground, w], at: [0, 0, 0.2], free: [x, z, ry]}}
loads:
  r: {type: rolling, bodies: [ground, w], at: [[0, 0, 0], [0, 0, 0.2]], radius: 0.2, axle: y}
  k: {type: spring_damper, bodies: [ground, w], at: [[-1, 0, 0.2], [0, 0, 0.2]], stiffness: 100}
  m: {type: moment, body: w, moment: [0, )" +
         std::to_string(moment) + ", 0]}\n" + statics(load_steps) + "{w: {joint: pl}}}\n";
}

}  // namespace

// The way is the radius times the angle: 0.75 rad, and with a larger moment more than half a turn.
TEST(LoadSteps, AWheelRollsByItsRadiusTimesItsAngle) {
  for (const double moment : {3.0, 9.0, 20.0})
    for (const int load_steps : {0, 1, 2, 10, 100}) {
      Simulation s = made(rolling_wheel(moment, load_steps));
      finished(s);
      const double x = moment / 0.2 / 100.0;
      EXPECT_NEAR(column(s, "w", "x"), x, 1e-9) << load_steps;
      EXPECT_NEAR(column(s, "w", "ry"), x / 0.2, 1e-9) << moment << ", load steps " << load_steps;
    }
}

// T(l) = 196.2 N; from the start, where the force falls with the length, only downhill leads there.
TEST(LoadSteps, AMuscleBeyondItsOptimalLengthLiftsItsWeight) {
  for (const int load_steps : {0, 1, 10}) {
    Simulation s = made(R"(
format: 1
gravity: [0, 0, -9.81]
bodies: {m: {mass: 20, inertia: [0.1, 0.1, 0.1], position: [0, 0, -0.30]}}
joints: {g: {type: prismatic, bodies: [ground, m], at: [0, 0, -0.3], axis: z}}
cables:
  mu: {through: [[ground, [0, 0, 0]], [m]], muscle: {max_force: 900, optimal_length: 0.14, tendon_length: 0.15, activation: 0.3}}
)" + statics(load_steps) +
                        "{mu: {cable: mu}}}\n");
    finished(s);
    EXPECT_NEAR(column(s, "mu", "length"), 0.2550505162, 1e-9) << load_steps;
    EXPECT_NEAR(column(s, "mu", "tension"), 196.2, 1e-6) << load_steps;
  }
}

// A weight between two level springs, which have no stiffness against it: 2 k (l − 1) z/l = m g.
TEST(LoadSteps, AToggleLeavesItsDeadCentre) {
  const double sag = root(0.0, 1.0, [](double z) {
    const double l = std::hypot(1.0, z);
    return 2000.0 * (l - 1.0) * z / l - 2.0 * 9.81;
  });
  for (const int load_steps : {0, 1, 10, 100}) {
    Simulation s = made(R"(
format: 1
gravity: [0, 0, -9.81]
bodies: {m: {mass: 2, inertia: [0.01, 0.01, 0.01], position: [1, 0, 0]}}
joints: {pl: {type: generic, bodies: [ground, m], at: [1, 0, 0], free: [x, z]}}
loads:
  k1: {type: spring_damper, bodies: [ground, m], at: [[0, 0, 0], [1, 0, 0]], stiffness: 1000}
  k2: {type: spring_damper, bodies: [ground, m], at: [[2, 0, 0], [1, 0, 0]], stiffness: 1000}
)" + statics(load_steps) +
                        "{m: {body: m}}}\n");
    finished(s);
    EXPECT_NEAR(column(s, "m", "z"), -sag, 1e-9) << load_steps;
  }
}

// A block of rubber moves along the top of a box and over its edge: the way out turns by a right
// angle, which is no way through the box.
TEST(LoadSteps, APointMaySlideAroundAnEdge) {
  const auto weight = [](int load_steps) {
    Simulation s = made(R"(
format: 1
bodies:
  table: {fixed: true, shape: {box: [0.2, 0.2, 0.1]}, position: [0, 0, -0.05]}
  hand: {mass: 1, inertia: [1, 1, 1], position: [0.02, 0, 0.06], motion: {x: 0.07, y: 0, z: -0.001, rotation_vector: [0, 0, 0]}}
materials: {r: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}}
solids: {b: {mesh: {block: {size: [0.1, 0.1, 0.05], cells: [4, 2, 2]}, position: [0.02, 0, 0.0255]}, material: r, bonded: {hand: zmax}}}
contacts: {default: {friction: 0}}
)" + statics(load_steps) +
                        "{k: {contact: [b, table]}}}\n");
    finished(s);
    return column(s, "k", "fz");
  };
  const double fine = weight(40);
  EXPECT_GT(fine, 1.0);
  for (const int load_steps : {0, 1, 4})
    EXPECT_NEAR(weight(load_steps), fine, 1e-6 * fine) << load_steps;
}

TEST(LoadSteps, AFreeBodyUnderLoadIsNamedSoon) {
  Simulation s = made(R"(
format: 1
bodies: {b: {mass: 1, inertia: [1, 1, 1]}}
joints: {j: {type: prismatic, bodies: [ground, b], at: [0, 0, 0], axis: x}}
loads: {f: {type: force, body: b, force: [1, 0, 0]}}
)" + statics(0) + "{b: {body: b}}}\n");
  const RunSummary r = s.run();
  EXPECT_EQ(r.end, RunEnd::not_converged);
  EXPECT_NE(r.message.find("Free motion: body 'b' moves along x"), std::string::npos) << r.message;
  EXPECT_LT(r.newton_iterations, 450);  // 175 of them Newton's
}

// Two weights on a rope over a peg: any height is an equilibrium, the one near the start is found.
TEST(LoadSteps, EqualWeightsOnASlidingCableBalance) {
  for (const int load_steps : {0, 1, 10}) {
    Simulation s = made(R"(
format: 1
gravity: [0, 0, -9.81]
bodies:
  l: {mass: 2, inertia: [0.1, 0.1, 0.1], position: [-0.5, 0, -1]}
  r: {mass: 2, inertia: [0.1, 0.1, 0.1], position: [0.5, 0, -1]}
joints:
  gl: {type: prismatic, bodies: [ground, l], at: [-0.5, 0, -1], axis: z}
  gr: {type: prismatic, bodies: [ground, r], at: [0.5, 0, -1], axis: z}
cables:
  c: {through: [[l], [ground, [0, 0, 0]], [r]], stiffness: 1e5, slides: true}
)" + statics(load_steps) +
                        "{c: {cable: c}, l: {body: l}, r: {body: r}}}\n");
    finished(s);
    const double T = column(s, "c", "tension"), l = column(s, "c", "length");
    EXPECT_NEAR(column(s, "l", "z"), column(s, "r", "z"), 1e-9) << load_steps;
    EXPECT_NEAR(T * std::sqrt(0.25 * l * l - 0.25) / (0.5 * l), 2.0 * 9.81, 1e-6) << load_steps;
  }
}

}  // namespace polhode::load_steps_tests
