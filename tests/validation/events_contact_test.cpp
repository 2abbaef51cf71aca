// SPDX-License-Identifier: Apache-2.0
// Contacts switched by events: a lid that opens, a net that catches, against closed forms.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <polhode/simulation/simulation_details.hpp>
#include <polhode/system/state_archive.hpp>
#include <support/run_text.hpp>

namespace polhode::test::events_contact_tests {
namespace {

constexpr double kG = 9.81;

/// A ball of radius 50 mm above, on or within a lid whose upper side is at z = 0, and a floor at −1
/// m.
/// @param z  Of the ball's centre [m].
std::string lid(const std::string& z, const std::string& events, const std::string& T,
                const std::string& law = "restitution: 0", const std::string& joints = "") {
  return R"(
format: 1
gravity: [0, 0, -9.81]
variables: {h: 1 ms}
bodies:
  ball: {shape: {sphere: 100 mm}, mass: 0.4, position: [0, 0, )" +
         z + R"(]}
  lid: {shape: {box: [0.4, 0.4, 0.02]}, fixed: true, position: [0, 0, -0.01]}
  floor: {shape: {plane: z}, fixed: true, position: [0, 0, -1]}
)" + joints +
         R"(
contacts: {default: {)" +
         law + R"(}, pairs: {on_lid: {between: [ball, lid]}}}
events:
)" + events +
         R"(
analysis: {type: dynamics, duration: )" +
         T + R"( s, step: h}
output: {hdf5: false}
)";
}

}  // namespace

// A lid opens under a ball that lies on it: the ball falls freely through the lid, and the energy
// of the spring that carried it is lost. @tests{switch-loss}
TEST(ContactEvents, LetABallFallThroughALid) {
  for (const double h : {0.01, 0.001, 0.00002}) {
    const double t_e = h < 1e-4 ? 0.03 : 0.3, T = t_e + (h < 1e-4 ? 0.07 : 0.4);
    const std::string at = std::to_string(t_e);
    Simulation s =
        made(lid("50 mm", "  open: {at: " + at + " s, off: [on_lid]}", std::to_string(T)),
             {"h=" + std::to_string(h)});
    while (s.time() < t_e - 1e-12) ASSERT_TRUE(s.step(t_e).accepted);
    const double z = s.body(0).r[2], v = s.body(0).v[2], tau = T - t_e;
    EXPECT_NEAR(z, 0.05, 1e-4) << h;
    EXPECT_NEAR(v, 0.0, h < 1e-4 ? 2e-3 : 1e-4) << h;
    const RunSummary r = finished(s);
    EXPECT_EQ(r.events[0].count, 1);
    EXPECT_NEAR(s.body(0).r[2], z + v * tau - 0.5 * kG * tau * tau, 1e-11) << h;
    EXPECT_NEAR(s.body(0).v[2], v - kG * tau, 1e-11) << h;
    EXPECT_LT(r.energy_drift, 1e-11) << h;
  }
}

// A ball held on a lid whose contact is off, then released as the contact is switched on: it stays
// at rest, and the energy changes only by that of the contact that carries it.
TEST(ContactEvents, SwitchOnALidUnderABallAtRest) {
  for (const double h : {0.01, 0.001, 0.0001}) {
    Simulation s =
        made(lid("50 mm",
                 "  begin: {at: 0, off: [on_lid]}\n"
                 "  over: {at: 0.1 s, on: [on_lid], off: [hook]}",
                 "0.5", "restitution: 0",
                 "joints: {hook: {type: fixed, bodies: [ground, ball], at: [0, 0, 0.05]}}"),
             {"h=" + std::to_string(h)});
    const RunSummary r = finished(s);
    EXPECT_NEAR(s.body(0).r[2], 0.05, 1e-4) << h;
    EXPECT_NEAR(s.body(0).v[2], 0.0, 1e-4) << h;
    EXPECT_LT(r.energy_drift, 1e-9) << h;
  }
}

// A contact switched on again while the ball is above the lid: it rebounds with its whole speed;
// before, it passes through the lid upwards.
TEST(ContactEvents, SwitchOnALidBelowABallInFlight) {
  // Upwards from below at v, through the lid, which is off; on at the top; then the ball stays
  // above.
  const double v = 4.0, start = -0.5, top = start + 0.5 * v * v / kG;
  for (const double h : {0.002, 0.0005}) {
    std::string text = lid("-0.5",
                           "  begin: {at: 0, off: [on_lid]}\n"
                           "  top: {when: {body: ball, channel: vz, below: 0}, on: [on_lid]}",
                           "0.95", "restitution: 1");
    text.replace(text.find("mass: 0.4,"), 10, "mass: 0.4, velocity: [0, 0, 4],");
    Simulation s = made(text, {"h=" + std::to_string(h)});
    const RunSummary r = finished(s);
    EXPECT_NEAR(r.events[1].time, v / kG, 1e-9) << h;
    EXPECT_LT(r.energy_drift, 1e-9) << h;
    // It falls from the top onto the lid and rises to the top again.
    const double fall = std::sqrt(2.0 * (top - 0.05) / kG), since = 0.95 - v / kG - 2.0 * fall;
    EXPECT_NEAR(s.body(0).r[2], top - 0.5 * kG * since * since, 5e-3) << h;
    EXPECT_GT(s.body(0).r[2], 0.05);
  }
}

// A ball all of whose contacts are switched off falls freely through lid and floor; if those of the
// lid are switched off, the floor remains. @tests{switch-loss}
TEST(ContactEvents, SwitchAllContactsOfABody) {
  for (const double h : {0.01, 0.001, 0.00002}) {
    const double t_e = h < 1e-4 ? 0.03 : 0.3, T = t_e + (h < 1e-4 ? 0.07 : 0.6);
    for (const char* body : {"ball", "lid"}) {
      Simulation s =
          made(lid("50 mm", "  open: {at: " + std::to_string(t_e) + " s, off: [" + body + "]}",
                   std::to_string(T)),
               {"h=" + std::to_string(h)});
      while (s.time() < t_e - 1e-12) ASSERT_TRUE(s.step(t_e).accepted);
      const double z = s.body(0).r[2], v = s.body(0).v[2];
      // Until it reaches the floor, if it does.
      const double fall = std::sqrt(2.0 * (z + 0.95) / kG), tau = T - t_e;
      const RunSummary r = finished(s);
      EXPECT_LT(r.energy_drift, 1e-9) << h;
      if (std::string(body) == "lid" && tau > fall) {
        EXPECT_NEAR(s.body(0).r[2], -0.95, 1e-2) << h;
        EXPECT_NEAR(s.body(0).v[2], 0.0, 0.2) << h;
      } else {
        EXPECT_NEAR(s.body(0).r[2], z + v * tau - 0.5 * kG * tau * tau, 1e-11) << h;
      }
    }
  }
}

// A pair and a body of it are switched independently: there is contact while both are on.
TEST(ContactEvents, SwitchAPairAndABodyOfIt) {
  const auto lies = [](const std::string& events) {
    Simulation s = made(lid("50 mm", events, "0.3"));
    const RunSummary r = finished(s);
    EXPECT_LT(r.energy_drift, 1e-9);
    return s.body(0).r[2] > 0.04;
  };
  const std::string both = "  a: {at: 0.1 s, off: [on_lid, ball]}\n";
  EXPECT_FALSE(lies(both + "  b: {at: 0.1001 s, on: [on_lid]}"));
  EXPECT_FALSE(lies(both + "  b: {at: 0.1001 s, on: [ball]}"));
  EXPECT_TRUE(lies("  a: {at: 0, off: [lid, on_lid]}\n  b: {at: 0, on: [on_lid, lid]}"));
  EXPECT_FALSE(lies("  a: {at: 0, off: [lid]}"));
}

TEST(ContactEvents, RefuseToSwitchOnOverlappingShapes) {
  Simulation s = made(lid("0.2",
                          "  begin: {at: 0, off: [on_lid]}\n"
                          "  in: {when: {body: ball, channel: z, below: 0}, on: [on_lid]}",
                          "1"));
  const RunSummary r = s.run();
  EXPECT_EQ(r.end, RunEnd::not_converged);
  EXPECT_NE(r.message.find("event 'in' at t = 0.20"), std::string::npos) << r.message;
  EXPECT_NE(r.message.find("shapes whose contact would begin overlap: 'ball' in 'lid' by 0.0"),
            std::string::npos)
      << r.message;
}

// A run in two parts, divided before, between and after the events: the same bits.
TEST(ContactEvents, ContinueBitForBitAfterARestart) {
  const std::string text =
      lid("0.1",
          "  open: {at: 0.25 s, off: [on_lid]}\n"
          "  shut: {when: {body: ball, channel: z, below: -0.3}, on: [on_lid]}",
          "0.9", "restitution: 0.5, friction: 0.3");
  for (const char* law : {"h=1 ms", "contacts.default.law=nonsmooth"}) {
    Simulation straight = made(text, {law});
    (void)finished(straight);
    for (const double cut : {0.1, 0.3, 0.7}) {
      Simulation first = made(text, {law});
      while (first.time() < cut) ASSERT_TRUE(first.step(1.0).accepted);
      const std::string bytes = state_bytes(first.system(), first.state());
      Model model = first.model();
      Simulation second(std::move(model), state_from_bytes(first.system(), bytes, "here"));
      (void)finished(second);
      EXPECT_EQ(second.state_hash(), straight.state_hash()) << law << ' ' << cut;
      EXPECT_LT(straight.body(0).r[2], -0.3) << law;
    }
  }
}

TEST(ContactEvents, ReportErrors) {
  const auto with = [](const std::string& names) {
    return lid("0.1", "  e: {at: 1 s, off: [" + names + "]}", "1");
  };
  expect_fault(
      with("on_lidd"),
      "events.e.off: unknown joint, load, pair of contacts or body 'on_lidd'. Did you mean "
      "'on_lid'?");
  expect_fault(with("bal"),
               "events.e.off: unknown joint, load, pair of contacts or body 'bal'. Did you "
               "mean 'ball'?");
  std::string both = with("on_lid");
  both.replace(both.find("contacts:"), 9,
               "joints: {on_lid: {type: spherical, bodies: [ground, ball], at: [0, 0, 0.1]}}\n"
               "contacts:");
  expect_fault(both,
               "events.e.off: 'on_lid' is a pair of contacts and a joint. Rename one of them.");
  std::string bare = with("ghost");
  bare.replace(bare.find("  lid:"), 6, "  ghost: {mass: 1, inertia: [1, 1, 1]}\n  lid:");
  expect_fault(
      bare,
      "events.e.off: the body 'ghost' has no contact that could be switched. Give it a shape that "
      "touches.");
}

// Switching of contacts of solids, cables and materials: each is refused by its name.
TEST(ContactEvents, RefuseContactsThatAreNotSwitched) {
  const auto with = [](const std::string& name) {
    return R"(
format: 1
gravity: [0, 0, -9.81]
bodies:
  ball: {shape: {sphere: 100 mm}, mass: 0.4, position: [0, 0, 0.5], contact: {material: steel}}
  drum: {shape: {cylinder: [0.2, 0.2]}, fixed: true, position: [3, 0, 0]}
  one: {mass: 1, inertia: [1, 1, 1], position: [2, 0, 0]}
  two: {mass: 1, inertia: [1, 1, 1], position: [2, 0, -1]}
  far: {shape: {sphere: 100 mm}, mass: 1, position: [9, 0, 0], contact: {groups: [out], meets: [out]}}
materials: {rubber: {type: neo_hookean, youngs_modulus: 2 MPa, poisson_ratio: 0.4, density: 1100}}
solids: {pad: {mesh: {block: {size: [0.1, 0.1, 0.1], cells: [1, 1, 1]}}, material: rubber, bonded: {ground: {plane: {axis: z, at: min}}}}}
cables: {rope: {through: [[one], [two]], stiffness: 100 kN, mass_per_length: 0.1, elements: 4, contact: {radius: 5 mm}}}
contacts:
  materials: {steel: {friction: 0.1}}
  pairs:
    on_pad: {between: [ball, pad]}
    on_rope: {between: [ball, rope]}
    of_steel: {materials: [steel, steel]}
events:
  e: {at: 0.1 s, off: [)" +
           name + R"(]}
analysis: {type: dynamics, duration: 0.2 s, step: 1 ms}
)";
  };
  expect_fault(
      with("on_pad"),
      "events.e.off: 'on_pad' is the contact of a solid, which cannot be switched. Name a pair "
      "of bodies in contacts.pairs.");
  expect_fault(
      with("on_rope"),
      "events.e.off: 'on_rope' is the contact of a cable, which cannot be switched. Name a pair "
      "of bodies in contacts.pairs.");
  expect_fault(
      with("of_steel"),
      "events.e.off: 'of_steel' is a pair of materials, which cannot be switched. Name a pair of "
      "bodies in contacts.pairs.");
  expect_fault(
      with("ball"),
      "events.e.off: 'ball' touches 'pad', a contact that cannot be switched. Name pairs of "
      "bodies instead, or exclude the two in contacts.");
  expect_fault(with("drum"),
               "events.e.off: 'drum' touches 'pad', a contact that cannot be switched.");
  expect_fault(with("pad"), "events.e.off: unknown joint, load, pair of contacts or body 'pad'.");
  EXPECT_EQ(fault_of(with("far")), "");
}

}  // namespace polhode::test::events_contact_tests
