// SPDX-License-Identifier: Apache-2.0
// Events and controllers on channels of cables, beams, solids and contacts, against closed forms.
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/system/state_archive.hpp>
#include <support/run_text.hpp>

namespace polhode::test::channels_tests {
namespace {

constexpr double kG = 9.81, kPi = std::numbers::pi;
constexpr double kCoarse = 0.02, kDefault = 0.002, kFine = 0.00002;

std::string step(double h) { return format("h={:.17g}", h); }

/// Time of the event `e`.
double time_of(const std::string& text, double h, const io::Overrides& more = {}) {
  io::Overrides overrides = more;
  overrides.push_back(step(h));
  Simulation s = made(text, overrides);
  const RunSummary r = finished(s);
  EXPECT_EQ(r.events[0].count, 1);
  EXPECT_LT(r.energy_drift, 1e-10);
  return r.events[0].time;
}

/// Checks that the value of `of` converges to the exact one with order 2, from the coarse step to a
/// hundredth of the default one.
template <class Of>
void expect_second_order(Of&& of, double truth) {
  const double first = std::abs(of(kCoarse) - truth), second = std::abs(of(0.5 * kCoarse) - truth);
  EXPECT_NEAR(std::log2(first / second), 2.0, 0.3) << first;
  EXPECT_LT(std::abs(of(kDefault) - truth), 0.02 * first);
  EXPECT_LT(std::abs(of(kFine) - truth), 1e-5 * first + 1e-9);
}

/// A weight of 2 kg released on an elastic cable of 200 N/m that has its free length.
std::string weight(const std::string& more, const std::string& duration = "0.6") {
  return R"(
format: 1
variables: {h: 2 ms}
gravity: [0, 0, -9.81]
bodies: {weight: {mass: 2, inertia: [1, 1, 1], position: [0, 0, -1]}}
joints: {guide: {type: prismatic, bodies: [ground, weight], at: [0, 0, -1], axis: z}}
cables: {rope: {through: [[ground, [0, 0, 0]], [weight]], stiffness: 200 N}}
)" + more +
         R"(
analysis: {type: dynamics, duration: )" +
         duration + R"( s, step: h}
output: {hdf5: false}
)";
}

}  // namespace

// T = m g (1 − cos ωt): 1.5 m g at cos ωt = −1/2. The event ends the run there.
// @tests{event-time}
TEST(Channels, TensionOfACableTriggersAnEvent) {
  const double w = std::sqrt(200.0 / 2.0);
  const std::string text =
      weight("events: {e: {when: {cable: rope, channel: tension, above: 29.43 N}, stop: true}}");
  expect_second_order([&](double h) { return time_of(text, h); }, 2.0 * kPi / 3.0 / w);
}

// A force k_p (T_r − T) on the weight: a spring of k (1 − k_p) about another equilibrium.
// @tests{controller-steps}
TEST(Channels, TensionOfACableIsControlled) {
  const double kp = 0.4, target = 10.0, m = 2.0, k = 200.0, t = 0.6;
  const double w = std::sqrt(k * (1.0 - kp) / m), rest = (kp * target - m * kG) / (k * (1.0 - kp));
  const std::string text = weight(
      "loads: {lift: {type: linear_motor, joint: guide, force: {controller: c}}}\n"
      "controllers: {c: {cable: rope, channel: tension, setpoint: 10 N, proportional: 0.4}}");
  expect_second_order(
      [&](double h) {
        Simulation s = made(text, {step(h)});
        (void)finished(s);
        return s.body(0).r[2];
      },
      -1.0 + rest * (1.0 - std::cos(w * t)));
}

// Control of a cable's rate of length, which is known for running cables: a winch at constant
// speed. m ẍ = u with the cable's length 1 + x, u = −k_p (v_r − ẋ) seen from the cable.
TEST(Channels, RateOfACableThatSlidesIsControlled) {
  const double tau = 0.5, v = 0.2, t = 1.0;
  for (const double h : {kCoarse, kDefault, kFine}) {
    Simulation s = made(R"(
format: 1
variables: {h: 2 ms}
bodies: {cart: {mass: 2, inertia: [1, 1, 1], position: [1, 0, 0]}}
joints: {rail: {type: prismatic, bodies: [ground, cart], at: [1, 0, 0], axis: x}}
cables: {rope: {through: [[ground, [0, 0, 1]], [ground, [0, 0, 0]], [cart]], slides: true, tension: 0}}
loads: {push: {type: linear_motor, joint: rail, force: {controller: c}}}
controllers: {c: {cable: rope, channel: rate, setpoint: 0.2 m/s, proportional: 4}}
analysis: {type: dynamics, duration: 1 s, step: h}
output: {hdf5: false}
)",
                        {step(h)});
    (void)finished(s);
    EXPECT_NEAR(s.body(0).v[0], v * (1.0 - std::exp(-t / tau)), 0.3 * h * h + 1e-9) << h;
  }
}

// A weight under an elastic bar of one element: (m + m_b/3) ü = −(m + m_b/2) g − k u, so that the
// force of the bar is k u = F (1 − cos ωt).
TEST(Channels, ForceOfABeamTriggersAnEventAndIsControlled) {
  const double m = 2.0, m_b = 0.3, k = 2000.0;
  const double w = std::sqrt(k / (m + m_b / 3.0)), F = (m + 0.5 * m_b) * kG;
  const auto text = [](const std::string& more) {
    return R"(
format: 1
variables: {h: 2 ms}
gravity: [0, 0, -9.81]
sections: {bar: {type: general, EA: 2000 N, GA_y: 1e6 N, GA_z: 1e6 N, GJ: 1000 N*m^2, EI_y: 1000 N*m^2, EI_z: 1000 N*m^2, mass_per_length: 0.3, inertia_per_length: [0.001, 0.001, 0.001]}}
beams: {bar: {points: [[0, 0, 0], [0, 0, -1]], elements: 1, section: bar, up: x, consistent_mass: 1, bonded: {ground: start, weight: end}}}
bodies: {weight: {mass: 2, inertia: [1, 1, 1], position: [0, 0, -1]}}
)" + more + R"(
analysis: {type: dynamics, duration: 0.09 s, step: h}
output: {hdf5: false}
)";
  };
  const std::string event =
      text("events: {e: {when: {beam: bar, channel: fx, above: 30 N}, stop: true}}");
  const double t_e = std::acos(1.0 - 30.0 / F) / w;
  for (const double h : {0.01, 0.001, 0.00001})
    EXPECT_NEAR(time_of(event, h), t_e, 10.0 * h * h + 1e-9) << h;
  // k_p (T_r − T) upwards on the weight.
  const double kp = 0.5, target = 10.0, t = 0.09, w_c = std::sqrt((1.0 - kp) * k / (m + m_b / 3.0));
  const double rest = -(F - kp * target) / ((1.0 - kp) * k);
  const std::string controlled = text(
      "loads: {lift: {type: axial_force, bodies: [ground, weight], at: [[0, 0, 1], [0, 0, -1]], "
      "pull: {controller: c}}}\n"
      "controllers: {c: {beam: bar, element: 0, channel: fx, setpoint: 10 N, proportional: 0.5}}");
  for (const double h : {0.01, 0.001, 0.00001}) {
    Simulation s = made(controlled, {step(h)});
    (void)finished(s);
    EXPECT_NEAR(s.body("weight").r[2], -1.0 + rest * (1.0 - std::cos(w_c * t)), 6.0 * h * h + 1e-9)
        << h;
  }
}

// Channels of a node of a beam are those of a body: the tip of a bar in free fall.
TEST(Channels, NodesOfBeamsAndSolidsTriggerEvents) {
  for (const char* of : {"body: bar.end", "solid: cube, node: 0", "solid: cube, point: [0, 0, 0]"})
    for (const double h : {kCoarse, kDefault, kFine})
      for (const char* channel : {"vz, below: -1 m/s", "speed, above: 1 m/s"}) {
        const std::string text = format(R"(
format: 1
variables: {{h: 2 ms}}
gravity: [0, 0, -9.81]
materials: {{rubber: {{type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}}}}
sections: {{bar: {{type: circle, diameter: 20 mm, material: rubber}}}}
beams: {{bar: {{points: [[0, 0, 0], [0.3, 0, 0]], elements: 2, section: bar}}}}
solids: {{cube: {{mesh: {{block: {{size: [0.1, 0.1, 0.1], cells: [1, 1, 1]}}, position: [1, 0, 0]}}, material: rubber}}}}
events: {{e: {{when: {{{}, channel: {}}}, stop: true}}}}
analysis: {{type: dynamics, duration: 0.2 s, step: h}}
output: {{hdf5: false}}
)",
                                        of, channel);
        EXPECT_NEAR(time_of(text, h), 1.0 / kG, 1e-9) << of << ' ' << h;
      }
}

// A block between plates that move apart, all nodes prescribed: the strain is uniaxial, the stress
// of St. Venant-Kirchhoff (1 + e)(λ + 2μ)(e + e²/2) at any step.
TEST(Channels, StressOfASolidTriggersAnEvent) {
  const double c = 1.2e6, e = 0.05 * 0.7, level = (1.0 + e) * c * (e + 0.5 * e * e);
  for (const double h : {kCoarse, kDefault, kFine * 10.0}) {
    const std::string text = format(R"(
format: 1
variables: {{h: 2 ms}}
materials: {{block: {{type: elastic, youngs_modulus: 1 MPa, poisson_ratio: 0.25, density: 1000}}}}
solids:
  block:
    mesh: {{block: {{size: [1, 1, 1], cells: [1, 1, 1]}}}}
    material: block
    prescribed:
      base: {{nodes: zmin, x: 0, y: 0, z: 0}}
      head: {{nodes: zmax, x: 0, y: 0, z: 0.05*t}}
events: {{e: {{when: {{solid: block, point: [0, 0, 0], stress: true, channel: szz, above: {:.17g}}}, stop: true}}}}
analysis: {{type: dynamics, duration: 1 s, step: h}}
output: {{hdf5: false}}
)",
                                    level);
    Simulation s = made(text, {step(h)});
    const RunSummary r = finished(s);
    EXPECT_NEAR(r.events[0].time, 0.7, 1e-9) << h;
  }
}

// A sampled integral controller of the force at an interface: a body accelerates a solid all of
// whose nodes are bonded to it. Its part c = m_s/(m + m_s) of the force gives a recurrence,
// satisfied to rounding.
TEST(Channels, ForceAtAnInterfaceIsControlled) {
  const double T = 0.05, ki = 60.0, target = 3.0, c = 1.0 / 3.0;
  double u = 0.0, sum = 0.0, last = target;
  for (int k = 1; k <= 9; ++k) {  // at k T; the last one acts at 0.45 s
    const double e = target - c * u;
    sum += 0.5 * T * (e + last);
    last = e;
    u = ki * sum;
  }
  for (const double h : {0.025, kDefault, 10.0 * kFine}) {
    Simulation s = made(R"(
format: 1
variables: {h: 2 ms}
bodies: {cart: {mass: 2, inertia: [1, 1, 1], position: [0, 0, 0]}}
joints: {rail: {type: prismatic, bodies: [ground, cart], at: [0, 0, 0], axis: x}}
materials: {rubber: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}}
solids: {cube: {mesh: {block: {size: [0.1, 0.1, 0.1], cells: [1, 1, 1]}}, material: rubber, bonded: {cart: {nodes: [0, 1, 2, 3, 4, 5, 6, 7]}}}}
loads: {push: {type: linear_motor, joint: rail, force: {controller: c}}}
controllers: {c: {solid: cube, interface: cart, channel: fx, setpoint: 3 N, integral: 60, sample: 50 ms}}
analysis: {type: dynamics, duration: 0.49 s, step: h}
output: {hdf5: false, probes: {c: {controller: c}}}
)",
                        {step(h)});
    (void)finished(s);
    EXPECT_NEAR(s.probe("c")[3], u, 1e-9) << h;
    EXPECT_NEAR(s.probe("c")[2], c * u, 1e-9) << h;
  }
}

namespace {

/// Two balls of radius 0.1 m whose surfaces are 0.6 m apart; one approaches.
std::string balls(const std::string& more, const std::string& duration = "1") {
  return R"(
format: 1
variables: {h: 2 ms}
bodies:
  one: {mass: 1, inertia: [1, 1, 1], shape: {sphere: 200 mm}, position: [0, 0, 0], fixed: true}
  two: {mass: 2, inertia: [1, 1, 1], shape: {sphere: 200 mm}, position: [0.8, 0, 0], velocity: [-1, 0, 0]}
joints: {rail: {type: prismatic, bodies: [ground, two], at: [0.8, 0, 0], axis: x}}
)" + more +
         R"(
analysis: {type: dynamics, duration: )" +
         duration + R"( s, step: h}
output: {hdf5: false}
)";
}

}  // namespace

// The gap decreases by 1 m in 1 s, within and beyond the range of contact and for sensors, too.
TEST(Channels, GapsTriggerEvents) {
  for (const double h : {kCoarse, kDefault, kFine})
    for (const double level : {0.55, 0.3, 0.01, -0.05}) {
      const std::string contacts = level > 0.0
                                       ? "contacts: {default: {gap_tolerance: 1 mm}}\n"
                                       : "contacts: {sensors: {near: {between: [one, two]}}}\n";
      const std::string text = balls(
          contacts +
          format("events: {{e: {{when: {{contact: [one, two], channel: gap, below: {} m}}, stop: "
                 "true}}}}",
                 level));
      EXPECT_NEAR(time_of(text, h), 0.6 - level, 1e-10) << h << ' ' << level;
    }
}

// A controller as a spring of the gap: 2 ẍ = −k (g_r − g), with g = x − 0.2.
TEST(Channels, GapsAreControlled) {
  const double w = 5.0, t = 0.8;
  const std::string text = balls(
      "contacts: {}\n"
      "loads: {push: {type: linear_motor, joint: rail, force: {controller: c}}}\n"
      "controllers: {c: {contact: [one, two], channel: gap, setpoint: 0.5 m, "
      "proportional: 50}}",
      "0.8");
  expect_second_order(
      [&](double h) {
        Simulation s = made(text, {step(h)});
        (void)finished(s);
        return s.body("two").r[0];
      },
      0.7 + 0.1 * std::cos(w * t) - std::sin(w * t) / w);
}

namespace {

/// A block of 2 kg that rests on a floor, pressed onto it by the force `push`.
std::string pressed(const std::string& push, const std::string& more) {
  return R"(
format: 1
variables: {h: 2 ms}
gravity: [0, 0, -9.81]
bodies:
  floor: {fixed: true, shape: {plane: z}}
  block: {mass: 2, inertia: [1, 1, 1], shape: {box: [0.2, 0.2, 0.2]}, position: [0, 0, 0.1]}
contacts: {}
loads: {push: {type: axial_force, bodies: [floor, block], at: [[0, 0, -1], [0, 0, 0.1]], pull: )" +
         push + R"(}, idle: {type: force, body: block, force: [0, 0, 0]}}
)" + more +
         R"(
analysis: {type: dynamics, duration: 1 s, step: h}
output: {hdf5: false, probes: {press: {contact: [block, floor]}}}
)";
}

}  // namespace

// m g + 40 t = 39.62 N at half a second: a slow ramp is in equilibrium at any step, apart from
// vibrations of the block on its barrier.
TEST(Channels, ContactForcesTriggerEvents) {
  for (const char* channel : {"normal", "fz", "force"}) {
    const std::string text =
        pressed("40*t", format("events: {{rests: {{at: 0.3 s, off: [idle]}}, e: {{after: rests, "
                               "when: {{contact: [block, floor], channel: {}, above: 39.62 "
                               "N}}, stop: true}}}}",
                               channel));
    for (const double h : {kCoarse, kDefault, 5.0 * kFine}) {
      Simulation s = made(text, {step(h)});
      const RunSummary r = finished(s);
      // The force is a mean over the step that ends there.
      EXPECT_GT(r.events[1].time, 0.5 - 3e-3) << h << channel;
      EXPECT_LT(r.events[1].time, 0.5 + 0.5 * h + 3e-3) << h << channel;
    }
  }
  // The impulse of the weight alone: m g t.
  const std::string text =
      pressed("0",
              "events: {e: {when: {contact: [block, floor], channel: impulse, above: 9.81}, stop: "
              "true}}");
  for (const double h : {kCoarse, kDefault, 5.0 * kFine}) {
    Simulation s = made(text, {step(h)});
    const RunSummary r = finished(s);
    EXPECT_NEAR(r.events[0].time, 0.5, 1e-3) << h;
    EXPECT_NEAR(s.contact(0).impulse, 9.81, 1e-9) << h;
  }
}

// Sampled control of a press to a given force: u_k from the force m g + u_{k−1} of the last step.
TEST(Channels, ContactForcesAreControlledBySamples) {
  const double T = 0.1, ki = 5.0, target = 50.0, weight = 2.0 * kG;
  double u = 0.0, sum = 0.0, last = target;
  for (int k = 1; k <= 9; ++k) {
    const double e = target - (weight + u);
    sum += 0.5 * T * (e + last);
    last = e;
    u = ki * sum;
  }
  for (const double h : {kCoarse, kDefault, 5.0 * kFine}) {
    Simulation s =
        made(pressed("{controller: c}",
                     "controllers: {c: {contact: [block, floor], channel: normal, setpoint: 50 N, "
                     "integral: 5, sample: 100 ms}}"),
             {step(h), "analysis.duration=0.95 s", "output.probes.c={controller: c}"});
    (void)finished(s);
    EXPECT_NEAR(s.probe("c")[3], u, 0.02 * u) << h;
    EXPECT_NEAR(s.probe("press")[2], weight + u, 0.02 * u) << h;
  }
}

// Reports do not depend on whether events or controllers read them: forces of contact are those of
// the step, not of the previous one.
TEST(Channels, DoNotDependOnBeingReadByEvents) {
  const std::string probes = "output.probes.block={body: block}";
  Simulation plain = made(pressed("40*t", ""), {probes});
  Simulation watched =
      made(pressed("40*t",
                   "events: {never: {when: {body: block, channel: az, above: 1e9}, stop: true}}"),
           {probes});
  for (int k = 0; k < 50; ++k) {
    ASSERT_TRUE(plain.step(1.0).accepted && watched.step(1.0).accepted);
    EXPECT_EQ(plain.probe("block"), watched.probe("block")) << k;
  }
}

// A run in two parts, divided before the event: the same bits, since trial steps leave no trace.
TEST(Channels, ContinueBitForBitAfterARestart) {
  const std::string text =
      pressed("40*t",
              "events: {e: {when: {contact: [block, floor], channel: impulse, above: 9}, off: "
              "[push]}}");
  Simulation straight = made(text);
  (void)finished(straight);
  for (const double cut : {0.1, 0.7}) {
    Simulation first = made(text);
    while (first.time() < cut) ASSERT_TRUE(first.step(1.0).accepted);
    const std::string bytes = state_bytes(first.system(), first.state());
    Model model = first.model();
    Simulation second(std::move(model), state_from_bytes(first.system(), bytes, "here"));
    (void)finished(second);
    EXPECT_EQ(second.state_hash(), straight.state_hash()) << cut;
  }
}

TEST(Channels, ReportErrors) {
  const auto event = [](const std::string& when) {
    return weight("events: {e: {when: {" + when + ", above: 1}, stop: true}}");
  };
  expect_fault(event("cable: rope, channel: tensoin"),
               "events.e.when.channel: 'tensoin' is no channel of the cable 'rope'. Did you mean "
               "'tension'? Channels: tension, length.");
  expect_fault(event("cable: rop, channel: tension"), "unknown cable 'rop'. Did you mean 'rope'?");
  expect_fault(event("cable: rope, element: 3, channel: tension"), "events.e.when.element: is 3");
  expect_fault(event("cable: rope, node: 3, channel: tension"),
               "events.e.when.node: cannot be combined with 'cable'. It belongs to a solid.");
  expect_fault(event("cable: rope, joint: guide, channel: tension"), "names more than one object");
  expect_fault(event("contact: [weight, weight], channel: gap"), "events.e.when.contact");
  expect_fault(
      weight("events: {e: {when: {cable: rope, channel: tension, above: 1 m}, stop: true}}"),
      "events.e.when.above: expects a force (N)");
  expect_fault(weight("loads: {lift: {type: linear_motor, joint: guide, force: {controller: c}}}\n"
                      "controllers: {c: {cable: rope, channel: tension, derivative: 1}}"),
               "controllers.c.derivative: needs the rate of 'tension', which is not available.");
  expect_fault(
      pressed("{controller: c}",
              "controllers: {c: {contact: [block, floor], channel: normal, proportional: 1}}"),
      "controllers.c: is missing: 'normal' of a contact is a mean over the step, which a "
      "continuous controller cannot use. Give a sample time.");
  // The same models in code.
  Model model = io::read_model_text(
      pressed("{controller: c}",
              "controllers: {c: {contact: [block, floor], channel: normal, proportional: 1, "
              "sample: 10 ms}}"),
      "model.yaml");
  model.controllers[0].sample.reset();
  try {
    Simulation s(model);
    ADD_FAILURE() << "no error was thrown";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("controllers.c: is continuous, but 'normal' of a contact "
                                         "is a mean over the step. Give it a sample time"),
              std::string::npos)
        << e.what();
  }
}

}  // namespace polhode::test::channels_tests
