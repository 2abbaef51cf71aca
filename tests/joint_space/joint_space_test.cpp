// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/joint_space/joint_space.hpp>
#include <polhode/joints/registry.hpp>
#include <polhode/simulation/simulation.hpp>

namespace polhode {
namespace joint_space_test {

using Motions = JointSpace::Motions;
using Numbers = std::vector<double>;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kRoundOff = 1e-12;

Model model_of(const std::string& text) { return io::read_model_text(text, "m.yaml", {}); }

std::vector<std::string> names_of(const JointSpace& space) {
  std::vector<std::string> names;
  for (const IndependentCoordinate& c : space.coordinates()) names.push_back(c.name);
  return names;
}

/// Motions and accelerations of all bodies in a simulation.
struct Seen {
  explicit Seen(const Simulation& simulation) {
    for (int i = 0; i < static_cast<int>(simulation.model().bodies.size()); ++i) {
      motions.push_back(simulation.body(i));
      linear.push_back(simulation.point(i, Vec3::Zero()).acceleration);
      angular.push_back(simulation.angular_acceleration(i));
    }
  }
  Motions motions;
  std::vector<Vec3> linear, angular;
};

void expect_near(const Numbers& found, const Numbers& expected, double tolerance) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_NEAR(found[i], expected[i], tolerance) << "at " << i;
}

/// Two bars in a vertical plane, with the closed form of their equations in relative angles.
struct DoublePendulum {
  static constexpr double m1 = 2.0, m2 = 1.5, l1 = 1.0, c1 = 0.4, c2 = 0.3, I1 = 0.3, I2 = 0.2,
                          g = 9.81;
  static Model model() {
    return model_of(
        "format: 1\ngravity: [0, -9.81, 0]\nbodies:\n"
        "  one: {mass: 2, inertia: [0.1, 0.2, 0.3], position: [0.4, 0, 0]}\n"
        "  two: {mass: 1.5, inertia: [0.1, 0.1, 0.2], position: [1.3, 0, 0]}\n"
        "joints:\n"
        "  shoulder: {type: revolute, bodies: [ground, one], at: [0, 0, 0], axis: z}\n"
        "  elbow: {type: revolute, bodies: [two, one], at: [1, 0, 0], axis: -z}\n"
        "analysis: {duration: 1, step: 1 ms}\n");
  }
};

/// @tests{joint-space}
TEST(JointSpace, OfADoublePendulumHasItsClosedForm) {
  using P = DoublePendulum;
  const Model model = P::model();
  const JointSpace space(model);
  EXPECT_THAT(names_of(space), ElementsAre("shoulder", "elbow"));
  for (const auto& [q1, q2, w1, w2] :
       {std::array{0.3, -1.2, 2.0, -0.7}, std::array{3.0, 2.8, -9.0, 4.0}}) {
    const Motions at = space.place(space.model_motions(), Numbers{q1, q2}, Numbers{w1, w2});
    const double both = P::m2 * P::l1 * P::c2;
    const double M12 = P::I2 + P::m2 * P::c2 * P::c2 + both * std::cos(q2);
    const double M22 = P::I2 + P::m2 * P::c2 * P::c2;
    const double M11 =
        P::I1 + P::m1 * P::c1 * P::c1 + P::m2 * P::l1 * P::l1 + M22 + 2.0 * both * std::cos(q2);
    expect_near(space.mass_matrix(at), {M11, M12, M12, M22}, kRoundOff);
    expect_near(space.velocity_forces(at),
                {-both * std::sin(q2) * (2.0 * w1 * w2 + w2 * w2), both * std::sin(q2) * w1 * w1},
                1e-10);
    const double second = P::m2 * P::c2 * P::g * std::cos(q1 + q2);
    expect_near(space.gravity_forces(at),
                {(P::m1 * P::c1 + P::m2 * P::l1) * P::g * std::cos(q1) + second, second}, 1e-12);
    expect_near(space.positions(at, Numbers{q1, q2}), {q1, q2}, kRoundOff);
    expect_near(space.rates(at), {w1, w2}, 1e-11);
  }
}

TEST(JointSpace, LeavesOutWhatIsSwitchedOff) {
  // Without the elbow the second bar is free, and the arm a pendulum about its shoulder.
  using P = DoublePendulum;
  const JointSpace open(P::model(), {}, std::vector<std::string>{"elbow"});
  EXPECT_THAT(names_of(open),
              ElementsAre("shoulder", "two.x", "two.y", "two.z", "two.rx", "two.ry", "two.rz"));
  const Numbers M = open.mass_matrix(open.model_motions());
  EXPECT_NEAR(M[0], P::I1 + P::m1 * P::c1 * P::c1, kRoundOff);
  EXPECT_NEAR(M[1], 0.0, kRoundOff);
  EXPECT_NEAR(M[8], P::m2, kRoundOff);

  // A weld that closes a loop leaves the elbow alone; switched off it takes nothing.
  Model held = P::model();
  JointSpec weld = held.joints[0];
  weld.name = "weld";
  weld.type = "fixed";
  held.joints.push_back(weld);
  EXPECT_THAT(names_of(JointSpace(held)), ElementsAre("elbow"));
  EXPECT_THAT(names_of(JointSpace(held, {}, std::vector<std::string>{"weld"})),
              ElementsAre("shoulder", "elbow"));
}

TEST(JointSpace, CountsTurnsNearGivenAngles) {
  const JointSpace space(DoublePendulum::model());
  const Motions at = space.place(space.model_motions(), Numbers{20.0, -31.0});
  expect_near(space.positions(at, Numbers{19.0, -30.0}), {20.0, -31.0}, 1e-12);
  const double turn = 2.0 * std::numbers::pi;
  expect_near(space.positions(at), {20.0 - 3.0 * turn, -31.0 + 5.0 * turn}, 1e-12);
}

/// A turning arm with a body in a joint of some kind, and a body beyond it, all askew.
Model chain_with(const JointKind& kind) {
  std::string keys = "at: [0.5, 0.1, 0.2]";
  if (kind.name == "universal")
    keys += ", axes: [[1, 0.2, 0], [-0.2, 1, 0]]";
  else if (kind.name == "generic")
    keys += ", axis: [0.3, 0.1, 1], free: [x, z, rx, ry, rz]";
  else if (kind.name != "spherical" && kind.name != "fixed")
    keys += ", axis: [0.3, 0.1, 1]";
  return model_of(
      "format: 1\ngravity: [1, 2, -9]\nbodies:\n"
      "  arm: {mass: 2, inertia: {xx: 0.2, yy: 0.3, zz: 0.4, xy: 0.05}, position: [0.2, 0, 0.1],\n"
      "        orientation: {axis: [1, 2, 3], angle: 0.7}, angular_velocity: [0.5, -0.4, 1.1]}\n"
      "  tool: {mass: 1.3, inertia: [0.1, 0.12, 0.2], position: [0.7, 0.3, 0.2],\n"
      "         orientation: {axis: [0, 1, 1], angle: 0.4}, velocity: [0.3, 0.6, -0.9],\n"
      "         angular_velocity: [1.2, 0.3, -0.8]}\n"
      "  tip: {mass: 0.4, inertia: [0.02, 0.03, 0.01], position: [0.9, 0.5, 0.4],\n"
      "        angular_velocity: [-2, 1, 0.3]}\n"
      "joints:\n"
      "  base: {type: revolute, bodies: [arm, ground], at: [0, 0, 0], axis: [0, 0.3, 1]}\n"
      "  wrist: {type: " +
      kind.name + ", bodies: [arm, tool], " + keys + "}\n" +
      "  ball: {type: spherical, bodies: [tip, tool], at: [0.8, 0.4, 0.3]}\n"
      "analysis: {duration: 0.2, step: 1 ms}\n");
}

/// The engine accelerates by gravity alone, so that no other force is along the coordinates.
TEST(JointSpace, HasTheAccelerationsOfTheEngineInEveryKindOfJoint) {
  for (const JointKind& kind : joint_kinds()) {
    if (kind.points_apart) continue;
    SCOPED_TRACE(kind.name);
    Simulation simulation(chain_with(kind));
    simulation.run();
    const Seen seen(simulation);
    const JointSpace space(simulation.model());
    const Numbers q = space.positions(seen.motions);
    const Numbers second = space.second_rates(seen.motions, seen.linear, seen.angular);
    for (const double force : space.inverse_dynamics(seen.motions, second))
      EXPECT_NEAR(force, 0.0, 2e-9);
    // The reports of the engine, of the joint in the middle.
    std::size_t k = 1;
    const JointReport wrist = simulation.joint("wrist");
    for (std::size_t i = 0; i < wrist.coordinates.size(); ++i, ++k) {
      EXPECT_NEAR(q[k], wrist.coordinates[i], 1e-11);
      EXPECT_NEAR(space.rates(seen.motions)[k], wrist.rates[i], 1e-9);
    }
    // Placed at its own coordinates and rates it is where it was.
    const Motions again = space.place(seen.motions, q, space.rates(seen.motions));
    for (std::size_t i = 0; i < again.size(); ++i) {
      EXPECT_LT((again[i].r - seen.motions[i].r).norm(), 1e-11);
      EXPECT_LT(again[i].q.angularDistance(seen.motions[i].q), 1e-7);
      EXPECT_LT((again[i].v - seen.motions[i].v).norm(), 1e-9);
      EXPECT_LT((again[i].W - seen.motions[i].W).norm(), 1e-9);
    }
  }
}

TEST(JointSpace, JacobianIsTheDerivativeOfPositionsAlongRates) {
  for (const JointKind& kind : joint_kinds()) {
    if (kind.points_apart) continue;
    SCOPED_TRACE(kind.name);
    const JointSpace space(chain_with(kind));
    const Vec3 point(0.1, -0.2, 0.05);
    Numbers q;
    for (int k = 0; k < space.size(); ++k) q.push_back(0.3 * std::sin(2.0 + k));
    const Motions at = space.place(space.model_motions(), q);
    const Numbers J = space.jacobian(at, 2, point);
    const int n = space.size();
    for (int k = 0; k < n; ++k) {
      Numbers rates(static_cast<std::size_t>(n), 0.0);
      rates[static_cast<std::size_t>(k)] = 1.0;
      const BodyMotion tip = space.place(at, q, rates)[2];
      const Vec3 v = tip.v + (tip.q * tip.W).cross(tip.q * point), omega = tip.q * tip.W;
      for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(J[static_cast<std::size_t>(i * n + k)], v[i], kRoundOff);
        EXPECT_NEAR(J[static_cast<std::size_t>((i + 3) * n + k)], omega[i], kRoundOff);
      }
      // Rotation vectors have other rates than their components, see IndependentCoordinate.
      if (k >= n - 3 || (kind.name != "revolute" && kind.name != "universal" &&
                         kind.name != "cylindrical" && kind.name != "constant_velocity"))
        continue;
      constexpr double h = 1e-5;
      Numbers more = q, less = q;
      more[static_cast<std::size_t>(k)] += h;
      less[static_cast<std::size_t>(k)] -= h;
      const auto x = [&](const Numbers& there) -> Vec3 {
        const BodyMotion m = space.place(at, there)[2];
        return m.r + m.q * point;
      };
      EXPECT_LT(((x(more) - x(less)) / (2.0 * h) - v).norm(), 1e-9);
    }
  }
}

/// Four bars, of which the rows of three hinges are redundant; moved by gravity.
Model four_bar(double speed) {
  return model_of(format(
      "format: 1\ngravity: [0, 0, -9.81]\nbodies:\n"
      "  crank: {{mass: 1, inertia: [0.02, 0.03, 0.02], position: [0, 0, 0.15]}}\n"
      "  coupler: {{mass: 2, inertia: [0.1, 0.2, 0.1], position: [0.5, 0.02, 0.45]}}\n"
      "  rocker: {{mass: 1.5, inertia: [0.04, 0.05, 0.03], position: [1, 0, 0.3]}}\n"
      "joints:\n"
      "  A: {{type: revolute, bodies: [ground, crank], at: [0, 0, 0], axis: y, start_rate: {}}}\n"
      "  B: {{type: revolute, bodies: [crank, coupler], at: [0, 0, 0.3], axis: y}}\n"
      "  C: {{type: revolute, bodies: [coupler, rocker], at: [1, 0, 0.6], axis: y}}\n"
      "  D: {{type: revolute, bodies: [rocker, ground], at: [1, 0, 0], axis: y}}\n"
      "analysis: {{duration: 0.3, step: 1 ms}}\n",
      speed));
}

TEST(JointSpace, OfALoopHasTheAccelerationsOfTheEngine) {
  Simulation simulation(four_bar(3.0));
  simulation.run();
  const Seen seen(simulation);
  const JointSpace space(simulation.model());
  EXPECT_THAT(names_of(space), ElementsAre("A"));
  const Numbers second = space.second_rates(seen.motions, seen.linear, seen.angular);
  EXPECT_NEAR(space.inverse_dynamics(seen.motions, second)[0], 0.0, 1e-9);
  EXPECT_NEAR(space.rates(seen.motions)[0], simulation.joint("A").rates[0], 1e-10);
  // The kinetic energy is that of the engine.
  const double rate = space.rates(seen.motions)[0];
  EXPECT_NEAR(0.5 * rate * rate * space.mass_matrix(seen.motions)[0], simulation.balance().kinetic,
              1e-8);
}

/// Freudenstein's equation of the linkage: crank 0.3, coupler √(1 + 0.3²), rocker 0.6, ground 1.
double rocker_of(double crank) {
  const double a = 0.3, b = std::hypot(1.0, 0.3), c = 0.6, d = 1.0;
  // Points of the crank and of the rocker are b apart: A cos ψ + B sin ψ = C.
  const double x = a * std::sin(crank) - d, z = a * std::cos(crank);
  const double C = (x * x + z * z + c * c - b * b) / (2.0 * c);
  return std::atan2(x, z) + std::acos(C / std::hypot(x, z));
}

TEST(JointSpace, FollowsALoopOnItsBranch) {
  const JointSpace space(four_bar(0.0));
  for (const double crank : {0.4, -1.0, 3.0, 2.0 * std::numbers::pi + 0.4}) {
    const Motions at = space.place(space.model_motions(), Numbers{crank}, Numbers{1.0});
    const Vec3 along = at[2].q * Vec3(0.0, 0.0, 1.0);  // of the rocker
    EXPECT_NEAR(std::atan2(along.x(), along.z()), rocker_of(crank), 1e-11) << crank;
    const Vec3 B_crank = at[0].r + at[0].q * Vec3(0, 0, 0.15);
    const Vec3 B_coupler = at[1].r + at[1].q * Vec3(-0.5, -0.02, -0.15);
    EXPECT_LT((B_crank - B_coupler).norm(), 1e-13);
    const double h = 1e-6;
    EXPECT_NEAR((at[2].q * at[2].W).y(), (rocker_of(crank + h) - rocker_of(crank - h)) / (2 * h),
                1e-8);
  }
}

TEST(JointSpace, NamesTheJointOfALoopThatCannotBeClosed) {
  Model model = four_bar(0.0);
  const JointSpace space(model, std::array{std::string("D")});
  EXPECT_THAT(names_of(space), ElementsAre("D"));
  try {
    (void)space.place(space.model_motions(), Numbers{2.5});
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(std::string(e.where()), HasSubstr("joint '"));
    EXPECT_THAT(std::string(e.what_is_wrong()), HasSubstr("cannot be closed"));
  }
}

/// The engine's mass of the inerter accelerates along the joint.
TEST(JointSpace, HasTheAccelerationsOfTheEngineWithInerters) {
  Model model = DoublePendulum::model();
  LoadSpec rotor;
  rotor.name = "rotor";
  rotor.type = "rotary_inerter";
  rotor.joint = "elbow";
  rotor.parameters["inertance"] = 2.0;
  model.loads.push_back(rotor);
  model.bodies[0].angular_velocity = {0, 0, 3};
  model.bodies[0].velocity = {0, 1.2, 0};
  model.bodies[1].velocity = {0, 3, 0};
  Simulation simulation(model);
  simulation.run();
  const Seen seen(simulation);
  const JointSpace space(simulation.model());
  const Numbers second = space.second_rates(seen.motions, seen.linear, seen.angular);
  EXPECT_NEAR(second[0], seen.angular[0].z(), 1e-9);
  EXPECT_NEAR(second[1], seen.angular[1].z() - seen.angular[0].z(), 1e-9);
  for (const double force : space.inverse_dynamics(seen.motions, second))
    EXPECT_NEAR(force, 0.0, 1e-8);
}

/// Two wheels: J is that of the first with the second's by the square of the ratio.
TEST(JointSpace, ProjectsOntoCouplingsAndInerters) {
  const Model model = model_of(
      "format: 1\nbodies:\n"
      "  one: {mass: 1, inertia: [1, 1, 2], position: [0, 0, 0]}\n"
      "  two: {mass: 1, inertia: [3, 3, 5], position: [1, 0, 0]}\n"
      "joints:\n"
      "  p: {type: revolute, bodies: [ground, one], at: [0, 0, 0], axis: z}\n"
      "  q: {type: revolute, bodies: [ground, two], at: [1, 0, 0], axis: z}\n"
      "loads:\n"
      "  train: {type: gear, joints: [q, p], ratio: -3}\n"
      "  rotor: {type: rotary_inerter, joint: p, inertance: 0.7}\n"
      "analysis: {duration: 1, step: 10 ms}\n");
  const JointSpace space(model);
  EXPECT_THAT(names_of(space), ElementsAre("p"));
  Motions at = space.place(space.model_motions(), Numbers{10.0}, Numbers{2.0});
  EXPECT_NEAR((at[1].q * at[1].W).z(), -6.0, 1e-12);
  // Whole turns of the train do not open it: it goes on from there.
  at = space.place(at, Numbers{10.5});
  const Vec3 x = at[1].q * Vec3::UnitX();
  EXPECT_NEAR(std::remainder(std::atan2(x.y(), x.x()) + 31.5, 2.0 * std::numbers::pi), 0.0, 1e-11);
  EXPECT_NEAR(space.mass_matrix(at)[0], 2.0 + 0.7 + 9.0 * 5.0, 1e-11);
}

TEST(JointSpace, OfAFreeBodyHasItsSixCoordinates) {
  const Model model = model_of(
      "format: 1\ngravity: [0, 0, -2]\nbodies:\n"
      "  hull: {mass: 3, inertia: [1, 2, 3], position: [1, 2, 3], velocity: [0.1, 0, 0],\n"
      "         angular_velocity: [0.3, 0.2, -0.5]}\n"
      "  wheel: {mass: 1, inertia: [0.2, 0.2, 0.3], position: [1, 2, 4]}\n"
      "joints:\n"
      "  axle: {type: revolute, bodies: [hull, wheel], at: [1, 2, 4], axis: z}\n"
      "analysis: {duration: 1, step: 10 ms}\n");
  const JointSpace space(model);
  EXPECT_THAT(names_of(space),
              ElementsAre("axle", "hull.x", "hull.y", "hull.z", "hull.rx", "hull.ry", "hull.rz"));
  const Motions at = space.place(space.model_motions(), Numbers{0.4, 1, 2, 3, 0.2, -0.3, 0.5});
  expect_near(space.positions(at), {0.4, 1, 2, 3, 0.2, -0.3, 0.5}, kRoundOff);
  const Numbers weight = space.gravity_forces(at);
  EXPECT_NEAR(weight[3], 8.0, kRoundOff);
  EXPECT_NEAR(space.mass_matrix(at)[1 * 7 + 1], 4.0, kRoundOff);
}

TEST(JointSpace, RefusesWhatHasNoJointCoordinates) {
  const auto message_of = [](const std::string& text) -> std::string {
    try {
      const JointSpace space(model_of(text));
    } catch (const InputError& e) {
      return format("{} {}", e.where(), e.what_is_wrong());
    }
    return "";
  };
  EXPECT_THAT(
      message_of("format: 1\nbodies:\n"
                 "  ball: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [0, 0, 0.5]}\n"
                 "loads:\n"
                 "  r: {type: rolling, bodies: [ground, ball], at: [[0, 0, 0], [0, 0, 0.5]],"
                 " axis: z, axle: y, radius: 0.5}\n"
                 "analysis: {duration: 1, step: 1 ms}\n"),
      HasSubstr("loads.r rolls"));
  EXPECT_THAT(message_of("format: 1\nbodies:\n"
                         "  arm: {mass: 1, inertia: [0.1, 0.1, 0.1]}\n"
                         "joints:\n"
                         "  j: {type: fixed, bodies: [ground, arm], at: [0, 0, 0],"
                         " motion: {x: 0.1*sin(2*t)}}\n"
                         "analysis: {duration: 1, step: 1 ms}\n"),
              HasSubstr("joints.j.motion moves"));
  const std::array unknown{std::string("elbw")};
  try {
    const JointSpace space(DoublePendulum::model(), unknown);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(e.where(), "elbw");
    EXPECT_THAT(std::string(e.hint()), HasSubstr("elbow"));
  }
}

}  // namespace joint_space_test
}  // namespace polhode
