// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include <polhode/newton/tangent_check.hpp>

#include "contact/scene.hpp"
#include "engines/mechanisms.hpp"
#include "support/flexible_scene.hpp"

namespace polhode::tangent_check_tests {
namespace {

using namespace test;

const TangentPart* part_of(const TangentReport& report, const std::string& kind) {
  const auto found = std::find_if(report.parts.begin(), report.parts.end(),
                                  [&](const TangentPart& p) { return p.kind.starts_with(kind); });
  return found == report.parts.end() ? nullptr : &*found;
}

bool leaves_out(const TangentReport& report, const std::string& words) {
  return std::any_of(report.left_out.begin(), report.left_out.end(),
                     [&](const std::string& s) { return s.find(words) != std::string::npos; });
}

// @tests{ga-inertia-tangent} @tests{ga-moment-tangent}
TEST(CheckTangents, AgreesWithDifferencesForWholeMechanisms) {
  for (const Mechanism& m : {double_pendulum("universal"), double_pendulum("prismatic"),
                             double_pendulum("fixed"), four_bars(1, 0.8), bricard_system()})
    for (const double rho : {1.0, 0.5, 0.0})
      for (const MomentumRate form : {MomentumRate::momentum, MomentumRate::kinematic_corrected}) {
        const System system = m.system();
        const TangentReport report = check_tangents(system, system.initial_state(), 0.1, rho, form);
        EXPECT_LT(report.error(), kTangentTolerance) << report.text();
        EXPECT_EQ(report.bodies_moved, system.body_count());
        ASSERT_TRUE(part_of(report, "joint"));
        EXPECT_EQ(part_of(report, "joint")->compared, static_cast<int>(m.model.joints.size()));
        EXPECT_TRUE(report.left_out.empty()) << report.left_out.front();
      }
}

/// A spring to the origin whose tangent has the wrong sign.
struct WrongSpring : InteractionItem {
  static constexpr const char* kKind = "spring";
  [[nodiscard]] bool conservative() const { return true; }
  [[nodiscard]] Work work(const PairStep&) const { return {}; }
  void evaluate(const PairStep& step, PairTerms& t) const {
    t.wrench_b.head<3>() = -100.0 * step.b.r_n1;
    t.D_bb.topLeftCorner<3, 3>() = 100.0 * Mat3::Identity();
  }
};

/// A point that stays in the plane x = 0, by a row whose derivative is off by a thousandth.
struct WrongRow : InteractionItem {
  static constexpr const char* kKind = "guide";
  [[nodiscard]] int rows() const { return 1; }
  void acceleration_terms(const PairStep&, Vec6& gamma) const { gamma[0] = 0.0; }
  void evaluate(const PairStep& step, PairTerms& t) const {
    t.B_b.col(0).setZero();
    t.B_b(0, 0) = 1.0;
    t.wrench_b = step.lambda[0] * t.B_b.col(0);
    t.g[0] = step.b.r_n1.x();
    t.G_b.row(0).setZero();
    t.G_b(0, 0) = 1.001;
  }
};

System ball_of_one() {
  System system;
  BodyMotion start;
  start.r = {1.0, 2.0, 3.0};
  system.add_body({"ball", 1.0, Mat3::Identity()}, start);
  return system;
}

TEST(CheckTangents, NamesAnInteractionWithAWrongTangent) {
  System system = ball_of_one();
  WrongSpring spring;
  spring.name = "wrong";
  spring.bodies = {kGround, 0};
  system.group<WrongSpring>().add(spring);
  system.finish();
  const TangentReport report = check_tangents(system, system.initial_state(), 0.1, 1.0);
  EXPECT_NEAR(report.error(), 2.0, 1e-6);
  EXPECT_EQ(report.worst.of, "spring 'wrong'");
  EXPECT_TRUE(report.worst.row.starts_with("force ")) << report.text();
  EXPECT_TRUE(report.worst.column.starts_with("displacement ")) << report.text();
  EXPECT_TRUE(report.worst.row.ends_with(" of body 'ball'")) << report.text();
  // The assembled tangent has the same error, relatively smaller because of the inertia.
  EXPECT_GT(part_of(report, "assembled")->worst.error, 0.1);
}

TEST(CheckTangents, NamesAConstraintRowWithAWrongTangent) {
  System system = ball_of_one();
  WrongRow guide;
  guide.name = "rail";
  guide.bodies = {kGround, 0};
  system.group<WrongRow>().add(guide);
  system.finish();
  const TangentReport report = check_tangents(system, system.initial_state(), 0.1, 1.0);
  EXPECT_NEAR(report.error(), 1e-3, 1e-5);
  EXPECT_EQ(report.worst.of, "guide 'rail'");
  EXPECT_EQ(report.worst.row, "row 1");
  EXPECT_EQ(report.worst.column, "displacement x of body 'ball'");
}

// Elements with internal unknowns, one end on a body with a joint, the other end on another body.
TEST(CheckTangents, AgreesForSolidsOnBodies) {
  for (const double rho_inf : {1.0, 0.6})
    for (const char* element : {"hex8_eas9", "hex8_standard"}) {
      FlexibleScene s({.element = element,
                       .relaxation_time = 0.01,
                       .cells = {2, 1, 1},
                       .two_bodies = true,
                       .hinge = true,
                       .rho_inf = rho_inf});
      s.run(5);
      const TangentReport report = check_tangents(s.system, s.state, 0.02, rho_inf);
      EXPECT_LT(report.error(), kTangentTolerance) << report.text();
      EXPECT_EQ(report.nodes_moved, 4);  // all nodes that are not bonded to a body
      EXPECT_EQ(report.bodies_moved, 3);
      ASSERT_TRUE(part_of(report, "hex8"));
      EXPECT_EQ(part_of(report, "hex8")->compared, 12);
    }
}

/// A spring between two nodes, whose tangent is too small by a tenth.
class WrongTruss final : public ElementGroup {
 public:
  std::string kind() const override { return "truss"; }
  const std::string& name() const override { return name_; }
  int size() const override { return 1; }
  int nodes_per_element() const override { return 2; }
  std::span<const int> nodes(int) const override { return nodes_; }
  bool mass(int, double* M) const override {
    std::copy_n(std::array{2.0, 1.0, 1.0, 2.0}.data(), 4, M);
    return true;
  }
  ElementReport evaluate(const NodeStep& step, const double*, double*, const Mat3&,
                         const ElementSink& sink) const override {
    const Vec3 f = 50.0 * (step.position_alpha(1) - step.position_alpha(0) - Vec3::UnitX());
    const std::array<double, 6> forces{f.x(), f.y(), f.z(), -f.x(), -f.y(), -f.z()};
    sink.add_force(nodes_, forces.data());
    if (!sink.tangent) return {};
    std::array<double, 36> K{};
    for (int i = 0; i < 6; ++i)
      for (int j = i % 3; j < 6; j += 3)
        K[static_cast<std::size_t>(6 * i + j)] = (i / 3 == j / 3 ? -45.0 : 45.0) * step.alpha_f;
    sink.add_tangent(0, 2, K.data());
    return {};
  }
  Work work(const NodeStep&, const double*, const double*) const override { return {}; }

 private:
  std::string name_ = "rig";
  std::vector<int> nodes_{0, 1};
};

TEST(CheckTangents, NamesElementsWithWrongTangents) {
  System system;
  system.add_node({.position = Vec3::Zero()});
  system.add_node({.position = 1.1 * Vec3::UnitX()});
  system.add_elements(std::make_unique<WrongTruss>());
  system.finish();
  const TangentReport report = check_tangents(system, system.initial_state(), 0.1, 1.0);
  EXPECT_NEAR(report.error(), 0.1, 1e-6);
  EXPECT_EQ(report.worst.of, "truss of 'rig'");
  EXPECT_TRUE(report.worst.row.starts_with("force ")) << report.text();
  EXPECT_TRUE(report.worst.row.ends_with(", element 0 of 'rig' (truss)")) << report.text();
}

/// Balls and boxes at rest on each other and on the floor, and one in flight.
struct SmallHeap : Scene {
  explicit SmallHeap(bool with_solid = false) {
    BodyMotion start;
    const auto at = [&](const Vec3& r) {
      start.r = r;
      start.v = Vec3(0.1, 0.05, 0.0);
      return start;
    };
    const int box = add_box("low", {0.4, 0.4, 0.2}, 2.0, at({0, 0, 0.101}));
    add_box("high", {0.2, 0.2, 0.2}, 1.0, at({0.02, 0.01, 0.303}));
    add_ball("ball", 0.1, 1.0, at({0.6, 0, 0.101}));
    add_ball("flying", 0.1, 1.0, at({0, 0, 3.0}));
    if (with_solid) add_bar(box, {.from = {0.2, 0.0, 0.0}, .size = {0.2, 0.1, 0.1}});
    add_floor();
    law(0.4, 0.0);
    begin(2e-3);
  }
};

// Friction that sticks and slides, points on faces and balls, with a solid on one of the bodies.
TEST(CheckTangents, AgreesForContacts) {
  for (const bool solid : {false, true}) {
    SmallHeap s(solid);
    for (const double longer : {0.02, 0.1, 0.2}) {
      ASSERT_TRUE(s.run(longer)) << s.last.text();
      const TangentReport report = check_tangents(s.system, s.state, 2e-3, 1.0);
      EXPECT_LT(report.error(), kTangentTolerance) << s.state.t << ": " << report.text();
      ASSERT_TRUE(part_of(report, "contact")) << s.state.t;
      EXPECT_GE(part_of(report, "contact")->compared, 2);
    }
  }
}

TEST(CheckTangents, ReportsThatNoContactActs) {
  Scene s;
  BodyMotion start;
  start.r = {0, 0, 2.0};
  s.add_ball("ball", 0.1, 1.0, start);
  s.add_floor();
  s.begin(2e-3);
  const TangentReport report = check_tangents(s.system, s.state, 2e-3, 1.0);
  EXPECT_FALSE(part_of(report, "contact"));
  EXPECT_TRUE(leaves_out(report, "contacts between bodies: none of the"));
}

TEST(CheckTangents, ReportsThatImpulsesHaveNoTangent) {
  Scene s;
  BodyMotion start;
  start.r = {0, 0, 0.1};
  s.add_ball("ball", 0.1, 1.0, start);
  s.add_floor();
  s.contacts->set_impulses({100, 1e-3});
  s.begin(2e-3);
  const TangentReport report = check_tangents(s.system, s.state, 2e-3, 1.0);
  EXPECT_TRUE(leaves_out(report, "contacts, which act by impulses"));
}

/// One pair of bodies that repel each other, by the distance of their centres along x. Its tangent
/// has no terms of one of them.
class WrongContacts final : public BodyContacts {
 public:
  void prepare(const System&) override {}
  bool begin_step(const State&, std::span<const BodyStep>, const StepContext&) override {
    return false;
  }
  const std::vector<Participants>& pairs() const override { return pairs_; }
  bool cover(std::span<const BodyStep>, const StepContext&, std::span<const Vec6>) override {
    return false;
  }
  void evaluate(std::span<const BodyStep> steps, const StepContext& context,
                std::span<PairTerms> terms) override {
    PairTerms& t = terms[0];
    context.tangents ? t.set_sums_zero() : t.set_values_zero();
    const double f = 10.0 / (steps[1].r_n1.x() - steps[0].r_n1.x());
    const double slope = f * f / 10.0;
    t.wrench_a[0] = -f;
    t.wrench_b[0] = f;
    t.D_aa(0, 0) = -slope;
    t.D_ba(0, 0) = slope;
  }
  double filter(std::span<const BodyStep>, std::span<const Vec6>) override { return 1.0; }
  double stored(const State&, std::span<const BodyStep>) override { return 0.0; }
  Work commit(State&, std::span<const BodyStep>, const StepContext&) override { return {}; }
  bool touched() const override { return true; }
  Work impacts(State&, std::vector<PairImpact>&) override { return {}; }
  void settled(State&, std::span<const ResolvedImpact>) override {}
  std::string tightest() const override { return {}; }

 private:
  std::vector<Participants> pairs_{{0, 1}};
};

TEST(CheckTangents, NamesAContactWithAWrongTangent) {
  System system = ball_of_one();
  BodyMotion start;
  start.r = {2.0, 2.0, 3.0};
  system.add_body({"other", 1.0, Mat3::Identity()}, start);
  system.set_contacts(std::make_shared<WrongContacts>());
  system.finish();
  const TangentReport report = check_tangents(system, system.initial_state(), 0.1, 1.0);
  EXPECT_NEAR(report.error(), 1.0, 1e-3);
  EXPECT_EQ(report.worst.of, "contact of 'ball' and 'other'");
  EXPECT_EQ(report.worst.column, "displacement x of body 'other'");
}

}  // namespace
}  // namespace polhode::tangent_check_tests
