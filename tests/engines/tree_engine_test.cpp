// SPDX-License-Identifier: Apache-2.0
// Tree elimination against the block LU: the same equations, so the same iterates.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <polhode/compile/build_system.hpp>
#include <polhode/engines/sparse_engine.hpp>
#include <polhode/engines/tree_engine.hpp>
#include <polhode/joints/registry.hpp>
#include <polhode/kernels/dispatch.hpp>
#include <polhode/stepping/single_step.hpp>
#include <polhode/stepping/start.hpp>

namespace polhode::tree_engine_tests {
namespace {

/// Random mechanisms with a fixed seed; frames of a joint coincide at the start.
class Mechanism {
 public:
  explicit Mechanism(unsigned seed) : random_(seed) { model_.gravity = {0.3, -1.0, -9.0}; }

  int body() {
    BodySpec b;
    b.name = "b" + std::to_string(model_.bodies.size());
    b.mass = 1.0 + number();
    const Vec3 d = Vec3(2.0, 2.5, 3.0) + vector();
    b.inertia = 0.02 * Mat3(d.asDiagonal());
    b.inertia(0, 1) = b.inertia(1, 0) = 0.004 * number();
    b.position = vector();
    b.orientation = quaternion();
    b.velocity = vector();
    b.angular_velocity = 2.0 * vector();
    model_.bodies.push_back(b);
    return static_cast<int>(model_.bodies.size()) - 1;
  }

  void joint(const std::string& type, int a, int b, std::vector<std::string> free = {}) {
    JointSpec j;
    j.name = "j" + std::to_string(model_.joints.size());
    j.type = type;
    j.a = a;
    j.b = b;
    j.free = std::move(free);
    const Vec3 at = vector();
    const Mat3 axes = quaternion().toRotationMatrix();
    place(a, at, axes, j.Z_a, j.R_a);
    place(b, joint_kind(type).points_apart ? Vec3(at + vector()) : at, axes, j.Z_b, j.R_b);
    if (type == "slack_link") j.limits = JointLimitsSpec{.upper = 4.0};
    model_.joints.push_back(j);
  }

  /// Gives the last joint a constant friction, and stops if it has one coordinate, near both of
  /// which it starts.
  void resist() {
    JointSpec& j = model_.joints.back();
    j.friction = JointFrictionSpec{.constant = 0.3};
    if (j.type == "revolute" || j.type == "prismatic")
      j.limits = JointLimitsSpec{.lower = -0.04, .upper = 0.05, .band = 0.045};
  }

  void spring(int a, int b) {
    LoadSpec l;
    l.name = "s" + std::to_string(model_.loads.size());
    l.type = "spring_damper";
    l.a = a;
    l.b = b;
    l.Z_a = vector();
    l.Z_b = vector();
    l.parameters = {{"stiffness", 300.0}, {"damping", 2.0}, {"free_length", 0.4}};
    model_.loads.push_back(l);
  }

  void torsion(const std::string& joint) {
    LoadSpec l;
    l.name = "t" + std::to_string(model_.loads.size());
    l.type = "torsional_spring";
    l.joint = joint;
    l.parameters = {{"stiffness", 5.0}, {"damping", 0.1}, {"free_angle", 0.3}};
    model_.loads.push_back(l);
  }

  [[nodiscard]] const Model& model() const { return model_; }

 private:
  double number() { return std::uniform_real_distribution<double>(-0.5, 0.5)(random_); }
  Vec3 vector() { return {number(), number(), number()}; }
  Quat quaternion() { return Quat(0.7 + number(), number(), number(), number()).normalized(); }
  void place(int body, const Vec3& at, const Mat3& axes, Vec3& Z, Mat3& R) const {
    Z = at;
    R = axes;
    if (body == kGround) return;
    const BodySpec& b = model_.bodies[body];
    Z = b.orientation.conjugate() * (at - b.position);
    R = b.orientation.conjugate() * axes;
  }

  Model model_;
  std::mt19937 random_;
};

/// Takes a few steps with both engines from the same consistent start and compares.
void expect_same_motion(const Model& model, double rho_inf, const std::string& isa = "automatic") {
  const System system = build_system(model);
  const auto ga = GeneralizedAlpha::from_spectral_radius(rho_inf);
  const double dt = 0.004;
  State by_tree = system.initial_state();
  const StartReport started = start(system, by_tree, ga, dt);
  ASSERT_TRUE(started.assembled);
  State by_lu = by_tree;
  const LaneKernels& kernels = lane_kernels(isa);
  SingleStep tree(system, std::make_unique<TreeEngine>(system, isa), ga, kernels, true);
  SingleStep lu(system, std::make_unique<SparseEngine>(system, "block_lu"), ga, kernels, true);
  for (int i = 0; i < 8; ++i) {
    const NewtonReport t = tree.take(by_tree, dt, {}, {1, false});
    const NewtonReport l = lu.take(by_lu, dt, {}, {1, false});
    ASSERT_TRUE(t.converged) << t.text();
    ASSERT_TRUE(l.converged) << l.text();
    EXPECT_NEAR(t.iterations, l.iterations,
                1);  // the last iteration may be just above or below the tolerance
    // Increments of a Newton iteration agree to the round-off of a linear solve.
    EXPECT_NEAR(t.increments.front(), l.increments.front(), 1e-8 * (1.0 + l.increments.front()));
    EXPECT_LT(t.constraints.residual, 1e-13);
  }
  for (int b = 0; b < system.body_count(); ++b) {
    const BodyMotion x = system.motion(by_tree, b), y = system.motion(by_lu, b);
    EXPECT_LT((x.r - y.r).norm(), 1e-11) << system.bodies()[b].name;
    EXPECT_LT((x.q.coeffs() - y.q.coeffs()).norm(), 1e-11) << system.bodies()[b].name;
    EXPECT_LT((x.v - y.v).norm(), 1e-8) << system.bodies()[b].name;
  }
}

class TreeOfEveryJoint : public testing::TestWithParam<std::tuple<std::string, double>> {};

/// Every kind between the ground and a body, between bodies, with either side as the parent.
TEST_P(TreeOfEveryJoint, AgreesWithBlockLuOnTheGround) {
  const auto& [kind, rho_inf] = GetParam();
  const std::vector<std::string> free =
      kind == "generic" ? std::vector<std::string>{"rx", "y"} : std::vector<std::string>{};
  Mechanism m(7);
  const int a = m.body(), b = m.body(), c = m.body(), d = m.body();
  m.joint(kind, kGround, a, free);
  m.joint(kind, a, b, free);
  m.joint("revolute", c, b);
  m.joint(kind, d, c, free);
  expect_same_motion(m.model(), rho_inf);
}

/// The same without the ground: a free root carries them.
TEST_P(TreeOfEveryJoint, AgreesWithBlockLuWithAFreeRoot) {
  const auto& [kind, rho_inf] = GetParam();
  const std::vector<std::string> free =
      kind == "generic" ? std::vector<std::string>{"rz", "rx", "z"} : std::vector<std::string>{};
  Mechanism m(11);
  const int a = m.body(), b = m.body(), c = m.body();
  m.joint(kind, a, b, free);
  m.joint(kind, b, c, free);
  m.body();  // and one without joints
  expect_same_motion(m.model(), rho_inf);
}

/// Every kind closes a loop between two moving bodies whose paths meet at a body, and at the
/// ground.
TEST_P(TreeOfEveryJoint, AgreesWithBlockLuWithLoops) {
  const auto& [kind, rho_inf] = GetParam();
  const std::vector<std::string> free =
      kind == "generic" ? std::vector<std::string>{"x", "ry", "rz"} : std::vector<std::string>{};
  Mechanism m(23);
  std::vector<int> b;
  for (int i = 0; i < 7; ++i) b.push_back(m.body());
  m.joint("universal", kGround, b[0]);
  m.joint("spherical", b[0], b[1]);
  m.joint("spherical", b[1], b[2]);
  m.joint("universal", b[2], b[3]);
  m.joint("spherical", b[0], b[4]);
  m.joint("cylindrical", b[4], b[5]);
  m.joint("spherical", kGround, b[6]);
  m.joint(kind, b[3], b[5], free);  // meets at b[0]
  m.joint("distance", b[6], b[1]);  // meets at the ground
  m.joint("point_in_plane", b[2], kGround);
  expect_same_motion(m.model(), rho_inf);
}

std::vector<std::string> kind_names() {
  std::vector<std::string> names;
  for (const JointKind& kind : joint_kinds()) names.push_back(kind.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Kinds, TreeOfEveryJoint,
                         testing::Combine(testing::ValuesIn(kind_names()),
                                          testing::Values(1.0, 0.5)),
                         [](const auto& c) {
                           return std::get<0>(c.param) +
                                  (std::get<1>(c.param) == 1.0 ? "" : "_damped");
                         });

TEST(TreeEngine, SolvesSpringsBetweenNeighboursDistantBodiesAndGround) {
  for (double rho_inf : {1.0, 0.5, 0.0}) {
    Mechanism m(31);
    std::vector<int> b;
    for (int i = 0; i < 5; ++i) b.push_back(m.body());
    m.joint("revolute", kGround, b[0]);
    m.joint("prismatic", b[0], b[1]);
    m.joint("universal", b[1], b[2]);
    m.joint("spherical", b[0], b[3]);
    m.spring(b[0], b[1]);  // parent and child
    m.spring(b[2], b[1]);  // child and parent
    m.spring(b[2], b[3]);  // distant, meeting at b[0]
    m.spring(b[4], b[2]);  // a free body and a chain
    m.spring(kGround, b[3]);
    m.torsion("j0");
    expect_same_motion(m.model(), rho_inf);
  }
}

// Stops and friction that do not depend on reactions, beside the rows of joints in the tree and
// those of loops.
TEST(TreeEngine, SolvesStopsAndConstantFrictionOfJoints) {
  for (double rho_inf : {1.0, 0.5, 0.0})
    for (const char* root : {"revolute", "prismatic"}) {
      Mechanism m(83);
      std::vector<int> b;
      for (int i = 0; i < 5; ++i) b.push_back(m.body());
      m.joint(root, kGround, b[0]);
      m.resist();
      int from = b[0];
      for (const char* kind : {"revolute", "prismatic", "cylindrical", "universal"}) {
        const int to = b[static_cast<std::size_t>(from) + 1];
        m.joint(kind, from, to);
        m.resist();
        from = to;
      }
      const System tree = build_system(m.model());
      EXPECT_TRUE(TreeEngine(tree).plan().loops.empty());
      expect_same_motion(m.model(), rho_inf);
      const int last = m.body();
      m.joint("spherical", b[2], last);
      m.resist();
      m.joint("revolute", last, b[4]);
      m.resist();
      expect_same_motion(m.model(), rho_inf);
    }
}

TEST(TreeEngine, SolvesManyOverlappingLoops) {
  Mechanism m(43);
  std::vector<int> left{m.body()}, right{m.body()};
  m.joint("spherical", kGround, left[0]);
  m.joint("spherical", kGround, right[0]);
  for (int i = 1; i < 5; ++i) {
    left.push_back(m.body());
    right.push_back(m.body());
    m.joint("spherical", left[i - 1], left[i]);
    m.joint("universal", right[i - 1], right[i]);
    m.joint("distance", left[i], right[i]);
    m.spring(left[i], right[i - 1]);
  }
  expect_same_motion(m.model(), 1.0);
}

/// Different kinds of joints in one chunk, and more than one chunk.
TEST(TreeEngine, SolvesMixedJointsOverSeveralChunks) {
  Mechanism m(57);
  const std::vector<std::string> kinds{"revolute", "spherical", "universal", "cylindrical",
                                       "planar",   "prismatic", "fixed"};
  std::vector<int> b;
  for (int i = 0; i < 2 * kChunkBodies + 9; ++i) {
    b.push_back(m.body());
    m.joint(kinds[i % kinds.size()], i < 3 ? kGround : b[(i - 1) / 2], b[i]);
  }
  expect_same_motion(m.model(), 1.0);
}

/// Sets differ by fused operations only: the motion agrees to round-off growth.
TEST(TreeEngine, GivesTheSameMotionWithEveryInstructionSet) {
  Mechanism m(61);
  std::vector<int> b;
  for (int i = 0; i < 12; ++i) {
    b.push_back(m.body());
    m.joint(i % 3 == 0   ? "universal"
            : i % 3 == 1 ? "revolute"
                         : "spherical",
            i == 0 ? kGround : b[i - 1], b[i]);
  }
  m.joint("distance", b[3], b[11]);
  for (const std::string& isa : available_instruction_sets()) {
    SCOPED_TRACE(isa);
    expect_same_motion(m.model(), 1.0, isa);
  }
}

/// Two runs of one instruction set give equal bits.
TEST(TreeEngine, GivesTheSameBitsTwice) {
  Mechanism m(71);
  const int a = m.body(), b = m.body();
  m.joint("spherical", kGround, a);
  m.joint("revolute", a, b);
  const System system = build_system(m.model());
  const auto ga = GeneralizedAlpha::from_spectral_radius(1.0);
  std::vector<BodyMotion> ends;
  for (int run = 0; run < 2; ++run) {
    State s = system.initial_state();
    start(system, s, ga, 0.01);
    SingleStep step(system, std::make_unique<TreeEngine>(system), ga, lane_kernels("automatic"),
                    true);
    for (int i = 0; i < 20; ++i) ASSERT_TRUE(step.take(s, 0.01, {}, {3, false}).converged);
    ends.push_back(system.motion(s, b));
  }
  EXPECT_EQ(ends[0].r, ends[1].r);
  EXPECT_EQ(ends[0].W, ends[1].W);
}

}  // namespace
}  // namespace polhode::tree_engine_tests
