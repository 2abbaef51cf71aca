// SPDX-License-Identifier: Apache-2.0
// The same model on a stage at rest and on one that moves at a constant
// velocity u: what is dissipated and stored is the same, kinetic energy grows
// by u·p, and the work of the stage's drive by u times its impulse. Every kind
// of joint and load, every law of contact, every drive.
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/joints/registry.hpp>
#include <polhode/loads/registry.hpp>
#include <support/run_text.hpp>

namespace polhode::galilean_ledger_tests {

using test::finished;
using test::made;

struct Seen {
  RunSummary summary;
  Balance balance;
  double work = 0.0;            ///< Of the stage's drive [J].
  Vec3 impulse = Vec3::Zero();  ///< Of it [N s].
  Vec3 gained = Vec3::Zero();   ///< Momentum since the start [N s].
  std::vector<Vec3> relative;   ///< Positions relative to the stage [m].
};

/// The stage replaces the ground; S and the bodies' velocities are those seen
/// from it, and "u" moves all of them.
Seen see(const std::string& text, double u, const std::string& step) {
  Simulation s = made(text, {format("variables.u={}", u), "analysis.step=" + step});
  Seen seen;
  const Vec3 before = s.balance().linear_momentum;
  seen.summary = finished(s);
  seen.balance = s.balance();
  seen.gained = seen.balance.linear_momentum - before;
  const JointReport drive = s.joint("stage.motion");
  seen.work = drive.work.at(0);
  seen.impulse = drive.impulses.at(0);
  const Vec3 stage = s.body(0).r;
  for (std::size_t i = 1; i < s.model().bodies.size(); ++i)
    seen.relative.push_back(s.body(static_cast<int>(i)).r - stage);
  return seen;
}

constexpr double kSpeed = 3.0;  ///< u [m/s].

/// @param external  Work of loads that the ground exerts, whose force is not
/// the stage's.
void expect_invariance(const std::string& text, const std::string& what, const std::string& step,
                       bool alone = true, double within = 1e-8) {
  SCOPED_TRACE(what + ", step " + step);
  const Seen rest = see(text, 0.0, step), moves = see(text, kSpeed, step);
  const Vec3 u = kSpeed * Vec3(1.0, -0.5, 0.0);
  const double scale = 1.0 + rest.balance.kinetic + std::abs(rest.balance.put_in) +
                       std::abs(rest.balance.dissipated);
  for (std::size_t i = 0; i < rest.relative.size(); ++i)
    EXPECT_LT((moves.relative[i] - rest.relative[i]).norm(), within * scale) << i;
  EXPECT_NEAR(moves.balance.dissipated, rest.balance.dissipated, within * scale);
  EXPECT_NEAR(moves.balance.potential, rest.balance.potential, within * scale);
  EXPECT_NEAR(moves.balance.put_in, rest.balance.put_in + u.dot(rest.gained), within * scale);
  EXPECT_LT((moves.impulse - rest.impulse).norm(), within * scale);
  EXPECT_NEAR(moves.work, rest.work + u.dot(rest.impulse), within * scale);
  // Nothing but the stage is on the ground: its impulse is all the momentum
  // that came in.
  if (alone) {
    EXPECT_LT((rest.impulse - rest.gained).head<2>().norm(), within * scale);
  }
  for (const Seen* seen : {&rest, &moves}) {
    // Damped springs of contact close to 1.4e-8 in the finest steps, seen from any frame.
    EXPECT_LT(seen->summary.energy_drift, 1e-7);
    EXPECT_LT(seen->summary.linear_momentum_drift, 1e-9);
    EXPECT_LT(seen->summary.angular_momentum_drift, 1e-9);
  }
}

const std::vector<std::string> kSteps{"10 ms", "2 ms", "0.2 ms"};

std::string model(const std::string& bodies, const std::string& sections,
                  const std::string& duration = "0.1 s") {
  return R"(
format: 1
gravity: [0, 0, -9.81]
variables: {u: 0, w: -0.5*u}
bodies:
  stage: {mass: 8, inertia: [1, 1, 1], shape: {box: [10, 10, 0.1]}, position: [0, 0, -0.05], velocity: [u, w, 0], motion: {x: u*t, y: w*t, z: 0, rotation_vector: [0, 0, 0]}}
)" + bodies +
         sections + "analysis: {type: dynamics, duration: " + duration +
         ", step: 1 ms, assembly_tolerance: 3}\noutput: {hdf5: false}\n";
}

constexpr const char* kTwo = R"(
  one: {mass: 2, inertia: [0.1, 0.15, 0.2], position: [0.5, 0.1, 1.2], velocity: [u+0.3, w-0.2, 0.1], angular_velocity: [0.5, -0.8, 1.3]}
  two: {mass: 1, inertia: [0.05, 0.04, 0.06], position: [0.9, 0.3, 1.1], velocity: [u+0.1, w+0.2, 0.4], angular_velocity: [-0.4, 0.2, 0.6]}
)";

// @tests{jump-work}
TEST(GalileanLedger, OfEveryKindOfJoint) {
  for (const JointKind& kind : joint_kinds()) {
    const auto joint = [&](const std::string& bodies, const std::string& at,
                           const std::string& other) {
      std::string text = format("type: {}, bodies: [{}], ", kind.name, bodies);
      text += kind.points_apart ? format("at: [[{}], [{}]]", at, other) : format("at: [{}]", at);
      if (kind.name != "distance" && kind.name != "slack_link") text += ", axis: [0.2, 0.3, 1]";
      if (kind.name == "universal_spherical") text.replace(text.find("axis"), 4, "x_axis");
      if (kind.name == "universal")
        text.replace(text.find("axis"), std::string::npos, "axes: [[1, 0.2, 0], [-0.2, 1, 0]]");
      if (kind.takes_free_list) text += ", free: [x, ry]";
      if (kind.name == "slack_link") text += ", limits: {upper: 0.4, restitution: 0.5}";
      return text;
    };
    const std::string joints = format("joints:\n  a: {{{}}}\n  b: {{{}}}\n",
                                      joint("stage, one", "0.3, 0.1, 1.2", "0.5, 0.2, 1.4"),
                                      joint("one, two", "0.7, 0.2, 1.2", "0.9, 0.3, 1.0"));
    for (const std::string& step : kSteps) expect_invariance(model(kTwo, joints), kind.name, step);
  }
}

/// Loads of every kind, acting on or from the stage. Empty: not invariant or
/// not alone, with the reason in a comment.
const std::map<std::string, std::string>& loads() {
  const std::string hinges = R"(
joints:
  a: {type: revolute, bodies: [stage, one], at: [0.5, 0.1, 1.2], axis: z}
  b: {type: revolute, bodies: [stage, two], at: [0.9, 0.3, 1.1], axis: z}
)";
  const std::string slides = R"(
joints:
  a: {type: prismatic, bodies: [stage, one], at: [0.5, 0.1, 1.2], axis: x}
  b: {type: cylindrical, bodies: [stage, two], at: [0.9, 0.3, 1.1], axis: [1, 1, 0]}
)";
  const std::string pair = "bodies: [stage, one], at: [[0, 0, 1], [0.5, 0.1, 1.2]]";
  static const std::map<std::string, std::string> all{
      {"force", ""},  // of the ground: its potential or work differs
      {"moment", "loads: {it: {type: moment, body: one, moment: [0.3, \"2*t\", 1]}}\n"},
      {"spring_damper", "loads: {it: {type: spring_damper, " + pair +
                            ", stiffness: 300, damping: 4, free_length: 0.4}}\n"},
      {"potential",
       "loads: {it: {type: potential, " + pair + ", energy: \"-0.3/l + 0.01/l^3\"}}\n"},
      {"axial_force", "loads: {it: {type: axial_force, " + pair + ", pull: \"3*sin(20*t) N\"}}\n"},
      {"vector_damper",
       "loads: {it: {type: vector_damper, " + pair + ", damping: 3, turning_damping: 0.2}}\n"},
      {"bushing",
       "loads: {it: {type: bushing, bodies: [stage, one], at: [0.4, "
       "0.1, 1.2], stiffness: [900, "
       "800, 700], "
       "turning_stiffness: [60, 40, 50], damping: [3, 3, 1]}}\n"},
      {"attraction",
       "loads: {it: {type: attraction, bodies: [one, two], "
       "strength: 7 N*m^2}}\n"},
      {"gravity_gradient", "loads: {it: {type: gravity_gradient, bodies: [one, two], mu: 3}}\n"},
      {"rotor",
       "loads: {it: {type: rotor, body: one, axis: [1, 2, 3], inertia: 0.1, moment: 3*t, "
       "start_speed: 20}, other: {type: rotor, body: two, inertia: 0.1, speed: 20 + 30*t}}\n"},
      {"drag", ""},  // through a medium at rest
      {"axis_drag",
       "loads: {it: {type: axis_drag, bodies: [stage, one], at: [0.4, 0.1, 1.2], linear: [3, 1, "
       "2], "
       "quadratic: [1, 2, 1], turning: [0.2, 0.1, 0.3], quadratic_turning: [0.1, 0.2, 0.1]}}\n"},
      {"torsional_spring", hinges + "loads: {it: {type: torsional_spring, "
                                    "joint: a, stiffness: 30, damping: 1}}\n"},
      {"translational_spring", slides +
                                   "loads: {it: {type: translational_spring, joint: a, stiffness: "
                                   "300, damping: 2}}\n"},
      {"rotary_motor", hinges +
                           "loads: {it: {type: rotary_motor, joint: a, speed: \"1.3 + 20*t\"}, "
                           "other: {type: rotary_motor, joint: b, moment: 2}}\n"},
      {"linear_motor", slides + "loads: {it: {type: linear_motor, joint: a, "
                                "displacement: \"0.3*t + t^2\"}}\n"},
      {"rotary_servo", hinges + "loads: {it: {type: rotary_servo, joint: a, "
                                "angle: 2*t, stiffness: 50, damping: 2}}\n"},
      {"linear_servo", slides + "loads: {it: {type: linear_servo, joint: a, "
                                "speed: 2*t, stiffness: 50, damping: 9}}\n"},
      {"rotary_inerter",
       hinges + "loads: {it: {type: rotary_inerter, joint: a, inertance: 0.4}}\n"},
      {"linear_inerter", slides + "loads: {it: {type: linear_inerter, joint: a, inertance: 3}}\n"},
      {"gear", hinges + "loads: {it: {type: gear, joints: [a, b], ratio: -2}}\n"},
      {"coupling", hinges + "loads: {it: {type: coupling, joints: [a, b], factors: [-2]}}\n"},
      {"screw", slides + "loads: {it: {type: screw, joint: b, pitch: 50 mm}}\n"},
      {"point_on_surface",
       "loads: {it: {type: point_on_surface, bodies: "
       "[stage, one], at: [[0.2, 0.1, 1.2], [0.5, "
       "0.1, 1.2]], "
       "semi_axes: [0.3, 0.4, 0.5]}}\n"},
      {"point_on_curve",
       "loads: {it: {type: point_on_curve, bodies: [stage, one], at: [[0.4, "
       "0.1, 1.2], [0.5, 0.1, "
       "1.2]], "
       "curve_x: 0.1*cos(s), curve_y: 0.12*sin(s), holds: point}}\n"},
      {"curve_on_curve", hinges + "loads: {it: {type: curve_on_curve, bodies: [one, "
                                  "two], at: [[0.5, 0.1, 1.1], "
                                  "[0.9, 0.3, 1.1]], curve_x: 0.25*cos(s), curve_y: "
                                  "0.2*sin(s), other_curve_x: "
                                  "0.22*cos(s), other_curve_y: 0.25*sin(s)}}\n"},
      {"slide_on_beam",
       "sections: {s: {type: general, EA: 1e4, GA_y: 4e3, GA_z: 4e3, GJ: 160, EI_y: 200, EI_z: "
       "150, "
       "mass_per_length: 0.5, inertia_per_length: [0.01, 0.005, 0.005]}}\n"
       "beams: {rail: {points: [[-0.5, 0.1, 1.2], [1.5, 0.1, 1.2]], elements: 4, section: s, "
       "bonded: {stage: start}}}\n"
       "loads: {it: {type: slide_on_beam, beam: rail, body: one, stiffness: 30, free_position: 1, "
       "damping: 2}}\n"},
      {"rolling",
       "loads: {it: {type: rolling, bodies: [stage, one], at: [[0, "
       "0, 0.9], [0.5, 0.1, 1.2]], "
       "axle: y, "
       "radius: 0.3}}\n"}};
  return all;
}

TEST(GalileanLedger, OfEveryKindOfLoad) {
  for (const LoadKind& kind : load_kinds()) {
    const auto found = loads().find(kind.name);
    ASSERT_NE(found, loads().end()) << kind.name << " has no sample";
    if (found->second.empty()) continue;
    for (const std::string& step : kSteps)
      expect_invariance(model(kTwo, found->second), kind.name, step);
  }
}

// A ball with spin that is thrown on the stage, with friction, by each law; and
// a box that lands.
TEST(GalileanLedger, OfEveryLawOfContact) {
  const std::string ball =
                        "  ball: {mass: 2, shape: {sphere: 0.1}, position: "
                        "[0, 0, 0.12], velocity: "
                        "[u+1, w+0.5, -1], "
                        "angular_velocity: [3, -5, 2]}\n",
                    box =
                        "  box: {mass: 2, shape: {box: [0.2, 0.2, 0.1]}, "
                        "position: [1, 0, 0.07], "
                        "velocity: [u+0.5, w, -1]}\n";
  for (const char* law :
       {"restitution: 0.5, friction: 0.3", "restitution: 0, friction: 0.3", "restitution: 0.5",
        "restitution: 0.7, law: linear, stiffness: 1e5, friction: 0.2",
        "restitution: 0.7, law: linear, stiffness: 1e5, rebound: damped",
        "restitution: 0.3, law: hertz, hertz_stiffness: 1e7, friction: 0.2"})
    for (const std::string& bodies : {ball, box})
      for (const std::string& step :
           {std::string("5 ms"), std::string("1 ms"), std::string("0.05 ms")})
        expect_invariance(model(bodies, format("contacts: {{default: {{{}}}}}\n", law)),
                          format("{} {}", law, bodies == ball ? "ball" : "box"), step, true, 1e-6);
}

// The non-smooth law has no drives, and so no stage: two balls that meet in
// flight.
TEST(GalileanLedger, OfImpulsesBetweenFreeBodies) {
  for (const char* step : {"5 ms", "1 ms", "0.05 ms"}) {
    Balance lost[2];
    double kinetic[2];
    for (const int moves : {0, 1}) {
      Simulation s =
          made(R"(
format: 1
variables: {u: 0}
bodies:
  one: {mass: 2, shape: {sphere: 0.2}, position: [0, 0, 0], velocity: [u+1, -u, 0], angular_velocity: [3, -5, 2]}
  two: {mass: 1, shape: {sphere: 0.2}, position: [0.23, 0.05, 0], velocity: [u-1, -u, 0.2]}
contacts: {default: {law: nonsmooth, restitution: 0.5, friction: 0.3}}
analysis: {type: dynamics, duration: 0.1, step: 1 ms}
output: {hdf5: false}
)",
               {format("variables.u={}", kSpeed * moves), std::string("analysis.step=") + step});
      const double before = s.balance().kinetic;
      (void)finished(s);
      lost[moves] = s.balance();
      kinetic[moves] = s.balance().kinetic - before;
    }
    EXPECT_GT(lost[0].dissipated, 0.1) << step;
    EXPECT_NEAR(lost[1].dissipated, lost[0].dissipated, 1e-7) << step;
    EXPECT_NEAR(kinetic[1], kinetic[0], 1e-7) << step;
  }
}

// Stops, joints that close and kinks on the stage.
TEST(GalileanLedger, OfJumps) {
  const std::map<std::string, std::string> jumps{
      {"stop",
       "joints: {a: {type: prismatic, bodies: [stage, one], at: [0.5, "
       "0.1, 1.2], axis: x, limits: "
       "{lower: -1, upper: 10 mm, restitution: 0.5}}}\n"},
      {"closing",
       "joints: {a: {type: spherical, bodies: [stage, one], at: "
       "[0.5, 0.1, 1.2]}, b: {type: fixed, "
       "bodies: [one, two], at: [0.7, 0.1, 1.2]}, c: {type: fixed, "
       "bodies: [stage, two], at: [0, "
       "0, "
       "1]}}\nevents: {start: {at: 0, off: [b, c]}, b: {at: 30 ms, "
       "on: [b]}, c: {at: 70 ms, on: "
       "[c]}}\n"},
      {"kink",
       "joints: {a: {type: prismatic, bodies: [stage, one], at: [0.5, "
       "0.1, 1.2], axis: [1, 1, 0]}, "
       "b: "
       "{type: fixed, bodies: [one, two], at: [0.6, 0, 1.2]}}\nloads: "
       "{it: {type: linear_motor, "
       "joint: a, "
       "displacement: \"t < 0.055 ? t : 0.055 + 3*(t - 0.055)\"}}\n"}};
  for (const auto& [what, sections] : jumps)
    for (const std::string& step : kSteps)
      expect_invariance(model(kTwo, sections), what, step, true, 1e-6);
}

}  // namespace polhode::galilean_ledger_tests
