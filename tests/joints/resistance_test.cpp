// SPDX-License-Identifier: Apache-2.0
// Friction and stops of joints over one step.
#include <joints/joint_cases.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/math/exp_map.hpp>
#include <support/derivative.hpp>
#include <support/run_text.hpp>

namespace polhode::test::resistance_tests {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

struct Sample {
  Joint joint;
  PairMotion motion;
};

enum class State { sticks, slips };

JointResistance friction_of(const std::string& type, State state) {
  JointResistance r;
  // Deflections are of size one; the friction cone is wide or narrow.
  r.friction = JointFriction{.mu = 0.3,
                             .radius = 0.4,
                             .face_radius = type == "revolute" || type == "universal" ? 0.2 : 0.0,
                             .length = type == "spherical" ? 0.0 : 1.5,
                             .constant = 0.1,
                             .stiffness = state == State::sticks ? 0.01 : 3.0,
                             .damping = 0.02};
  return r;
}

/// Angles whose turns a joint's history counts, and deflections that follow them.
struct HistoryOf {
  explicit HistoryOf(const std::string& type)
      : angles(type == "universal"                           ? 2
               : type == "revolute" || type == "cylindrical" ? 1
                                                             : 0),
        deflections(type == "spherical"                            ? 3
                    : type == "cylindrical" || type == "universal" ? 2
                                                                   : 1) {}
  int angles, deflections;
};

/// A joint whose angles and displacement are allowed, in a large step; histories of size one.
Sample sample(const std::string& type, const JointResistance& resistance, unsigned seed,
              const StepContext& context) {
  Random random(seed);
  const JointFrames f = random_frames(random);
  Joint joint("j", type, Participants{0, 1}, joint_kind(type).recipe(f, {}));
  joint.set_resistance(resistance);
  PairMotion m(random, context);
  const double start = random.number(2.0), turn = random.number(1.0);
  if (type != "spherical") {
    const auto b_of = [&](const Mat3& Lambda_a, double angle) -> Mat3 {
      const Mat3 turned =
          type == "universal"
              ? Mat3(exp_map(angle * Vec3::UnitX()) * exp_map(-0.8 * angle * Vec3::UnitY()))
              : exp_map(angle * Vec3::UnitZ());
      return Lambda_a * f.R_a * turned * f.R_b.transpose();
    };
    m.b_n.q = Quat(b_of(m.a_n.Lambda(), start)).normalized();
    m.theta_b = cayley_vector(b_of(m.a().Lambda_n1, start + turn) * m.b_n.Lambda().transpose());
  }
  const HistoryOf history(type);
  m.history[0] = start;
  if (history.angles == 2) m.history[1] = -0.8 * start;
  for (int i = 0; i < history.deflections; ++i)
    m.history[history.angles + i] = 0.02 * random.number();
  return {joint, m};
}

JointLimits stops(double lower, double upper, double restitution) {
  JointLimits l;
  l.lower = lower;
  l.upper = upper;
  l.law.stiffness = 2.0;
  l.law.tolerance = 2.0;
  l.restitution = restitution;
  return l;
}

class EveryResistance : public testing::TestWithParam<std::string> {};

void expect_tangents(const Joint& joint, const PairMotion& m) {
  expect_derivative(
      wrench_tangent(evaluate(joint, m)),
      [&](const Vec& d) -> Vec { return wrenches(evaluate(joint, m, d)); }, joint.type() + " D");
  if (joint.rows() == 0) return;
  const PairTerms t = evaluate(joint, m);
  Mat B(12, joint.rows());
  B << t.B_a.leftCols(joint.rows()), t.B_b.leftCols(joint.rows());
  PairMotion pulled = m;
  expect_derivative(
      B,
      [&](const Vec& d) -> Vec {
        for (int k = 0; k < joint.rows(); ++k) {
          const auto row = static_cast<std::size_t>(k);
          pulled.lambda[row] = m.lambda[row] + d[k];
        }
        return wrenches(evaluate(joint, pulled));
      },
      joint.type() + " B");
}

// @tests{joint-friction-limit}
TEST_P(EveryResistance, HasTheTangentsOfItsFrictionByMotionAndReaction) {
  for (const State state : {State::sticks, State::slips})
    for (const double rho_inf : {1.0, 0.5, 0.0})
      for (unsigned seed = 1; seed <= 4; ++seed) {
        auto sampled =
            sample(GetParam(), friction_of(GetParam(), state), seed, context_of(rho_inf));
        auto& joint = sampled.joint;
        auto& m = sampled.motion;
        expect_tangents(joint, m);
        m.a_moves = false;
        m.a_n = BodyMotion{};
        SCOPED_TRACE("a is the ground");
        if (GetParam() == "spherical")
          expect_derivative(
              wrench_tangent(evaluate(joint, m)).rightCols(6),
              [&](const Vec& d) -> Vec {
                Displacement both = Displacement::Zero();
                both.tail<6>() = d;
                return wrenches(evaluate(joint, m, both));
              },
              "ground");
      }
}

void expect_tangents_of_stops(const std::string& type) {
  for (const double e : {1.0, 0.0})
    for (const bool conserving : {true, false})
      for (const double rho_inf : {1.0, 0.5, 0.0})
        for (unsigned seed = 1; seed <= 4; ++seed) {
          StepContext context = context_of(rho_inf);
          context.conserving = conserving;
          JointResistance r;
          auto sampled = sample(type, r, seed, context);
          auto& joint = sampled.joint;
          auto& m = sampled.motion;
          const JointCoordinates c =
              m.at_start([&](const PairStep& s) { return joint.coordinates(s); });
          const std::vector<std::string> names = joint.coordinate_names();
          for (std::size_t k = 0; k < names.size(); ++k)
            (names[k][0] != 'r' ? r.slide : r.turn) = stops(c.value[k] - 1.0, kInf, e);
          joint.set_resistance(r);
          m.with(Displacement::Zero(), [&](const PairStep& s) {
            joint.initialize(s, m.history.data());
            return 0;
          });
          const bool turns = names.back() == "rz";
          if (turns) m.history[0] = c.value[names.size() - 1];
          std::size_t at = (turns ? 1 : 0) + kNumbersOf<BristleMemory>;
          for (std::size_t k = 0; k < names.size(); ++k, at += kNumbersOf<StopMemory>) {
            auto memory = read_record<StopMemory>(&m.history[at]);
            memory.stiffness = 2.0;
            memory.upper = 2.0, memory.lower = -2.0;
            memory.side = 1.0;  // closed at the lower end
            write_record(memory, &m.history[at]);
          }
          expect_tangents(joint, m);
        }
}

TEST_P(EveryResistance, HasTheTangentsOfItsStops) {
  if (GetParam() == "spherical" || GetParam() == "universal") return;
  expect_tangents_of_stops(GetParam());
}

TEST(SlackLink, HasTheTangentsOfItsStops) { expect_tangents_of_stops("slack_link"); }

/// Stops that are rows: the wrench of a unit force does the change of the gap as work, and the
/// gradient at the end is the derivative of the gap there.
void expect_gradients_of_rows(const std::string& type) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    JointResistance r;
    auto sampled = sample(type, r, seed, context_of(1.0));
    auto& joint = sampled.joint;
    auto& m = sampled.motion;
    const JointCoordinates c = m.at_start([&](const PairStep& s) { return joint.coordinates(s); });
    const std::vector<std::string> names = joint.coordinate_names();
    for (std::size_t k = 0; k < names.size(); ++k) {
      JointLimits limits = stops(c.value[k] - 0.1, c.value[k] + 0.2, 0.4);
      limits.by_rows = true;
      limits.radius = 0.7;
      (names[k][0] != 'r' ? r.slide : r.turn) = limits;
    }
    joint.set_resistance(r);
    EXPECT_EQ(joint.unilateral(), 2 * static_cast<int>(names.size()));
    EXPECT_FALSE(joint.has_barrier());
    const auto rows = [&](const Displacement& d) {
      return m.with(d, [&](const PairStep& s) {
        std::vector<UnilateralRow> list;
        joint.unilateral_rows(s, list);
        return list;
      });
    };
    const std::vector<UnilateralRow> found = rows(Displacement::Zero());
    ASSERT_EQ(static_cast<int>(found.size()), joint.unilateral());
    for (std::size_t k = 0; k < found.size(); ++k) {
      const UnilateralRow& row = found[k];
      EXPECT_EQ(row.restitution, 0.4);
      const bool turns = names[k / 2][0] == 'r';
      EXPECT_NEAR(row.gap_n, (turns ? 0.7 : 1.0) * (k % 2 == 0 ? 0.1 : 0.2), 1e-12) << type;
      EXPECT_NEAR(m.with(Displacement::Zero(),
                         [&](const PairStep& s) { return change_of_gap(row, s.a, s.b); }),
                  row.gap_n1 - row.gap_n, 1e-12)
          << type << " seed " << seed;
      Mat by(1, 12);
      by << row.by_a.transpose(), row.by_b.transpose();
      expect_derivative(
          by,
          [&](const Vec& d) -> Vec {
            Displacement both = Displacement::Zero();
            both = d;
            return Vec::Constant(1, rows(both)[k].gap_n1);
          },
          type + " gap");
    }
  }
}

// @tests{contact-rows}
TEST_P(EveryResistance, HasTheGradientsOfItsStopsAsRows) {
  if (GetParam() == "spherical" || GetParam() == "universal") return;
  expect_gradients_of_rows(GetParam());
}

TEST(SlackLink, HasTheGradientsOfItsStopsAsRows) { expect_gradients_of_rows("slack_link"); }

// Work of the wrench: the energy that the bristle stores and dissipates; it never returns more than
// it stored.
// @tests{contact-bristle}
TEST_P(EveryResistance, NeverAddsEnergyByFriction) {
  for (const State state : {State::sticks, State::slips})
    for (unsigned seed = 1; seed <= 60; ++seed) {
      const auto sampled =
          sample(GetParam(), friction_of(GetParam(), state), seed, context_of(1.0));
      const auto& joint = sampled.joint;
      const auto& m = sampled.motion;
      Joint free("j", GetParam(), Participants{0, 1}, JointRecipe{joint.frames(), joint.parts()});
      const double work =
          (wrenches(evaluate(joint, m)) - wrenches(evaluate(free, m))).dot(step_motion(m));
      const Work w = m.with(Displacement::Zero(), [&](const PairStep& s) { return joint.work(s); });
      const auto [angles, n] = HistoryOf(GetParam());
      const Vec3 s_n(m.history[angles], m.history[angles + 1], m.history[angles + 2]);
      const double k = joint.resistance()->data().friction->stiffness;
      const double before = 0.5 * k * s_n.head(n).squaredNorm();
      EXPECT_GE(w.dissipated, 0.0);
      EXPECT_NEAR(-work, w.stored - before + w.dissipated, 1e-12) << "seed " << seed;
    }
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryResistance,
                         testing::Values("revolute", "prismatic", "cylindrical", "spherical",
                                         "universal"),
                         [](const auto& kind) { return kind.param; });

// Radial force 5 N, axial 2 N, moment across the axis 1.3 N m.
TEST(JointFriction, SlipsAtTheLimitOfItsKind) {
  const auto slip_of = [](const std::string& type, const JointFriction& f,
                          const std::vector<double>& lambda, double& stored) {
    Joint joint("j", type, Participants{kGround, 0}, joint_kind(type).recipe(JointFrames{}, {}));
    JointResistance r;
    r.friction = f;
    joint.set_resistance(r);
    std::array<double, 24> history{};
    const Vec3 zero = Vec3::Zero();
    BodyStep b = BodyStep::at_instant(zero, Mat3::Identity(), zero, zero);
    b.alpha_f = 0.5;
    b.theta = type == "universal" ? Vec3(0.2, 0.0, 0.0) : Vec3(0.0, 0.0, 0.2);
    b.Lambda_n1 = cay(b.theta);
    b.u = b.r_n1 = Vec3(0.0, 0.0, type == "prismatic" ? 0.2 : 0.0);
    if (type == "prismatic") {
      b.theta.setZero();
      b.Lambda_n1.setIdentity();
    }
    const BodyStep a = BodyStep::ground(0.5);
    const StepContext context = context_of(1.0, 0.1);
    const PairStep step{a, b, context, lambda.data(), history.data()};
    PairTerms t;
    t.set_zero();
    joint.evaluate(step, t);
    stored = joint.work(step).stored;
    Joint free("j", type, Participants{kGround, 0}, joint_kind(type).recipe(JointFrames{}, {}));
    PairTerms of_rows;
    of_rows.set_zero();
    free.evaluate(step, of_rows);
    return (t.wrench_b - of_rows.wrench_b).eval();
  };
  double stored = 0.0;
  const double k = 1e4;
  Vec6 w = Vec6::Zero();
  w = slip_of("revolute",
              {.mu = 0.3,
               .radius = 0.05,
               .face_radius = 0.1,
               .length = 0.4,
               .constant = 0.02,
               .stiffness = k},
              {3.0, 4.0, 2.0, 0.5, 1.2}, stored);
  const double pin = 0.3 * (0.05 * (5.0 + 2.0 / 0.4 * 1.3) + 0.1 * 2.0) + 0.02;
  EXPECT_NEAR(w[5] * 0.2, -pin * 2.0 * std::atan(0.1), 1e-12);  // θ = 2 tan(φ/2)
  EXPECT_NEAR(stored, 0.5 * pin * pin / k, 1e-15);
  w = slip_of("prismatic",
              {.mu = 0.3, .radius = 0.2, .length = 0.4, .constant = 0.5, .stiffness = k},
              {3.0, 4.0, 0.5, 1.2, -0.7}, stored);
  EXPECT_NEAR(w[2], -(0.3 * (5.0 + 2.0 / 0.4 * 1.3 + 0.7 / 0.2) + 0.5), 1e-12);
  w = slip_of("spherical", {.mu = 0.3, .radius = 0.05, .constant = 0.02, .stiffness = k},
              {3.0, 4.0, 12.0}, stored);
  EXPECT_NEAR(w[5], -(0.3 * 0.05 * 13.0 + 0.02), 1e-12);
  // About the pin x: 5 N across it, 2 N along, and 1.3 N m.
  w = slip_of("universal",
              {.mu = 0.3,
               .radius = 0.05,
               .face_radius = 0.1,
               .length = 0.4,
               .constant = 0.02,
               .stiffness = k},
              {2.0, 3.0, 4.0, -1.3}, stored);
  EXPECT_NEAR(w[3] * 0.2, -pin * 2.0 * std::atan(0.1), 1e-12);
  EXPECT_NEAR(w[4], 0.0, 1e-12);
}

TEST(JointFriction, IsRefusedOnAJointWithoutFreedoms) {
  Joint joint("j", "fixed", Participants{0, 1}, joint_kind("fixed").recipe(JointFrames{}, {}));
  EXPECT_THROW(joint.set_resistance({}), InputError);
}

}  // namespace
/// A link that rests on its stop, with a centre of mass beside the joint along its axis, which has
/// no part in the inertia of the rotation: it does not sink into the stop, at no step.
TEST(JointStops, ALinkAtRestDoesNotSink) {
  for (const std::string step :
       {"duration: 2", "duration: 2, step: 1 ms", "duration: 0.5, step: 0.1 ms"}) {
    Simulation s = test::made(format(R"yaml(
format: 1
gravity: [0, 0, -9.81]
bodies: {{a: {{mass: 2, inertia: [0.03, 0.02, 0.015], position: [0.2, 0.05, 0.02]}}}}
joints: {{j: {{type: revolute, bodies: [ground, a], at: [0, 0, 0], axis: x, limits: {{lower: 0, upper: 1}}}}}}
loads: {{m: {{type: joint_moment, joint: j, moment: -1.5}}}}
analysis: {{{}}}
output: {{hdf5: false}}
)yaml",
                                     step));
    const RunSummary r = test::finished(s);
    EXPECT_GT(s.joint(0).coordinates.at(0), -1e-3) << step;  // the band of its barrier
    EXPECT_LT(r.steps, 6000) << step;
  }
}

}  // namespace polhode::test::resistance_tests
