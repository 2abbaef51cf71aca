// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include <polhode/beams/beam_element.hpp>
#include <polhode/compile/build_system.hpp>
#include <polhode/core/error.hpp>
#include <polhode/equations/newton_system.hpp>
#include <polhode/newton/tangent_check.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <support/beam_models.hpp>

namespace polhode::test::beam_dynamics_tests {
namespace {

RunSummary run(Model model, double step, double duration) {
  model.analysis.step = step;
  model.analysis.duration = duration;
  model.output.every = duration;
  Simulation simulation(std::move(model));
  return simulation.run();
}

/// Mass and stiffness of a system about its start, bodies only.
struct Matrices {
  Mat M, K;
};
Matrices matrices(const System& system) {
  const int n = 6 * system.body_count();
  Matrices m{Mat::Zero(n, n), Mat::Zero(n, n)};
  State state = system.initial_state();
  initialize_histories(system, state);
  std::vector<BodyStep> steps;
  for (int b = 0; b < system.body_count(); ++b) {
    steps.push_back(system.instant(state, b));
    const Mat3& Lambda = steps.back().Lambda_n1;
    m.M.block<3, 3>(6 * b, 6 * b).diagonal().setConstant(system.bodies()[b].mass);
    m.M.block<3, 3>(6 * b + 3, 6 * b + 3) =
        Lambda * system.bodies()[b].inertia * Lambda.transpose();
  }
  steps.push_back(BodyStep::ground(1.0));
  StepContext context;
  context.ga = GeneralizedAlpha::from_spectral_radius(0.0);
  context.conserving = false;
  InteractionSweep sweep(system);
  sweep.run(steps, context, nullptr, state.history.data(),
            [&](int i, const PairStep&, const PairTerms& t) {
              const InteractionRef& ref = system.interactions()[i];
              m.K.block<6, 6>(6 * ref.a, 6 * ref.a) -= t.D_aa;
              m.K.block<6, 6>(6 * ref.a, 6 * ref.b) -= t.D_ab;
              m.K.block<6, 6>(6 * ref.b, 6 * ref.a) -= t.D_ba;
              m.K.block<6, 6>(6 * ref.b, 6 * ref.b) -= t.D_bb;
              const double c = system.traits(ref).coupled_mass;
              for (int k = 0; k < 3; ++k) {
                m.M(6 * ref.a + k, 6 * ref.a + k) -= c;
                m.M(6 * ref.b + k, 6 * ref.b + k) -= c;
                m.M(6 * ref.a + k, 6 * ref.b + k) += c;
                m.M(6 * ref.b + k, 6 * ref.a + k) += c;
              }
            });
  return m;
}

/// Frequencies of a free steel bar 2 × 0.1 × 0.1 m [Hz], rising, without its six zeros.
Vec free_bar_frequencies(int elements, double consistent) {
  const double E = 2e11, nu = 0.3, side = 0.1;
  SectionShape shape = rectangle_section(side, side, nu);
  shape.shear_y = shape.shear_z = 5.0 / 6.0;
  BeamSpec beam;
  beam.name = "bar";
  beam.points = {{0, 0, 0}, {2, 0, 0}};
  beam.elements = elements;
  beam.section.section = elastic_section(shape, E, nu, 7800.0);
  beam.consistent_mass = consistent;
  Model model;
  add_beam(model, beam);
  const Matrices m = matrices(build_system(model));
  EXPECT_LT((m.K - m.K.transpose()).norm(), 1e-12 * m.K.norm());
  const Eigen::GeneralizedSelfAdjointEigenSolver<Mat> solver(0.5 * (m.K + m.K.transpose()), m.M);
  const Vec omega_2 = solver.eigenvalues();
  EXPECT_LT(omega_2.head<6>().cwiseAbs().maxCoeff(), 1e-9 * omega_2.maxCoeff());
  return omega_2.tail(omega_2.size() - 6).cwiseSqrt() / (2.0 * std::numbers::pi);
}

}  // namespace

// @tests{mass-coupling}
// Timoshenko's free-free bar, exact: 128.957, 349.698, 670.034 Hz, each in two planes. Errors of 16
// elements, in percent, from the dispersion of the mass: lumped −1.2, −1.9, −2.7; averaged −0.40,
// −0.29, 0.07; consistent 0.39, 1.45, 3.0.
TEST(BeamFrequencies, OfAFreeBarAreTimoshenkos) {
  const double exact[] = {128.957, 349.698, 670.034};
  const double errors[3][3] = {{-1.2, -1.9, -2.7}, {-0.40, -0.29, 0.07}, {0.39, 1.45, 3.0}};
  for (int i = 0; i < 3; ++i) {
    const Vec f = free_bar_frequencies(16, 0.5 * i);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(100.0 * (f[2 * k] / exact[k] - 1.0), errors[i][k], 0.06) << i << ' ' << k;
      EXPECT_NEAR(f[2 * k + 1], f[2 * k], 1e-6 * f[2 * k]);
    }
  }
}

TEST(BeamFrequencies, ConvergeWithTheSquareOfTheElementLength) {
  const double coarse = free_bar_frequencies(16, 0.5)[0] / 128.957 - 1.0;
  const double fine = free_bar_frequencies(32, 0.5)[0] / 128.957 - 1.0;
  EXPECT_NEAR(coarse / fine, 4.0, 0.2);
}

TEST(BeamInModel, BecomesBodiesElementsAndJoints) {
  Model m = right_angle_cantilever(4);
  ASSERT_EQ(m.bodies.size(), 9u);
  EXPECT_EQ(m.bodies[0].name, "beam.0");
  EXPECT_EQ(m.bodies[8].name, "beam.8");
  EXPECT_LT((m.bodies[4].position - Vec3(0, 10, 0)).norm(), 1e-14);
  double mass = 0.0;
  for (const BodySpec& b : m.bodies) mass += b.mass;
  EXPECT_NEAR(mass, 20.0, 1e-13);
  ASSERT_EQ(m.joints.size(), 1u);
  EXPECT_EQ(m.joints[0].name, "beam.start");
  SystemMap map;
  const System system = build_system(m, &map);
  ASSERT_EQ(map.beam.size(), 1u);
  EXPECT_EQ(map.beam[0].size(), 8u);
  EXPECT_EQ(system.name(system.interactions()[static_cast<std::size_t>(map.beam[0][3])]), "beam.3");
}

// Rotary inertia of the corner: the mean of the inertias of both legs, each about its own axes.
TEST(BeamInModel, SharesItsCornersBetweenLegs) {
  const Model m = right_angle_cantilever(4);
  const BodySpec& corner = m.bodies[4];
  const Mat3 J = corner.orientation.toRotationMatrix() * corner.inertia *
                 corner.orientation.toRotationMatrix().transpose();
  const double half = 0.5 * 2.5;
  EXPECT_LT((J - Mat3(Vec3(half * 30, half * 30, half * 20).asDiagonal())).norm(), 1e-12);
}

TEST(BeamInModel, FollowsAnArc) {
  Model m;
  BeamSpec beam = beam_through({{0, 0, 0}, {70.71067811865476, 29.28932188134524, 0}}, 8,
                               {1e7, 5e6, 1e6, 1e6, 1.0, {2, 1, 1}});
  const double mid = std::numbers::pi / 8;
  beam.points = {{0, 0, 0}, {100 * std::sin(mid), 100 - 100 * std::cos(mid), 0}, beam.points[1]};
  beam.arc = true;
  add_beam(m, beam);
  double length = 0.0;
  for (const BeamSpec::Element& e : m.beams[0].mesh) length += e.length;
  EXPECT_NEAR(length, 25.0 * std::numbers::pi, 1e-10);
  for (const BodySpec& b : m.bodies)
    EXPECT_NEAR((b.position - Vec3(0, 100, 0)).norm(), 100.0, 1e-10);
  EXPECT_LT((m.bodies[0].orientation * Vec3::UnitX() - Vec3::UnitX()).norm(), 1e-12);
  EXPECT_LT((m.bodies[8].orientation * Vec3::UnitY() - Vec3::UnitZ()).norm(), 1e-12);
  const System system = build_system(m);  // stress-free: nothing moves
  EXPECT_EQ(system.body_count(), 9);
  const RunSummary r = run(m, 0.1, 1.0);
  EXPECT_EQ(r.end, RunEnd::finished) << r.message;
  EXPECT_LT(r.linear_momentum_drift, 1e-9);
}

TEST(BeamInModel, RefusesBeamsThatCannotBeMeshed) {
  const SectionNumbers n{1e4, 1e4, 500, 500, 1, {20, 10, 10}};
  const auto refused = [&](auto&& change) {
    BeamSpec beam = beam_through({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, 4, n);
    change(beam);
    Model m;
    EXPECT_THROW(add_beam(m, beam), InputError);
  };
  refused([](BeamSpec& b) { b.elements = 1; });
  refused([](BeamSpec& b) { b.elements = 0; });
  refused([](BeamSpec& b) { b.points.pop_back(), b.points.pop_back(); });
  refused([](BeamSpec& b) { b.points[1] = b.points[0]; });
  refused([](BeamSpec& b) { b.up = Vec3::UnitX(); });
  refused([](BeamSpec& b) { b.section.section.mass_per_length = 0.0; });
  refused([](BeamSpec& b) { b.consistent_mass = 1.5; });
  refused([](BeamSpec& b) { b.arc = true, b.points[2] = {2, 0, 0}; });
}

// A mast that hangs from the ground at rest, and a rope beside it: section forces are the weight
// below the section.
TEST(BeamSystem, ReportsSectionForcesAndTensions) {
  Model m;
  m.gravity = {0, 0, -10.0};
  BeamSpec mast = beam_through({{0, 0, 0}, {0, 0, -2}}, 4, {1e9, 1e9, 1e9, 1e9, 3.0, {1, 1, 1}});
  mast.bonds = {{kGround, false}};
  add_beam(m, mast);
  CableLineSpec rope;
  rope.name = "rope";
  rope.through = {{kGround, {0.5, 0, 0}}, {4, {0, 0.5, 0}}};  // y of the section is along x
  rope.stiffness = 1e3;
  rope.free_length = 1.0;
  add_cable(m, rope);
  m.analysis.step = 1e-3;
  m.analysis.duration = 1e-3;
  Simulation s(m);
  const std::vector<double> tension = s.cable(0).tension;
  ASSERT_EQ(tension.size(), 1u);
  EXPECT_DOUBLE_EQ(tension[0], 1e3);  // twice as long as free
  m.cables.clear();
  m.analysis.rho_inf = 0.0;
  m.analysis.step = 1.0;  // much longer than the periods of vibration: the model comes to rest
  m.analysis.duration = 60.0;
  Simulation hanging(m);
  ASSERT_EQ(hanging.run().end, RunEnd::finished);
  const std::vector<Vec6> forces = hanging.beam(0).forces;
  ASSERT_EQ(forces.size(), 4u);
  for (int k = 0; k < 4; ++k)
    EXPECT_NEAR(forces[static_cast<std::size_t>(k)][0], 30.0 * (1.75 - 0.5 * k), 1e-4) << k;
}

TEST(BeamSystem, HasTheTangentOfItsResidual) {
  for (const double rho_inf : {1.0, 0.25}) {
    Model m = flying_beam(6);
    for (BodySpec& b : m.bodies) b.velocity = Vec3(0.3, b.position.x(), -0.2 * b.position.y());
    m.beams[0].section.relaxation_time = 0.01;
    const System system = build_system(m);
    State state = system.initial_state();
    start(system, state, GeneralizedAlpha::from_spectral_radius(rho_inf), 0.02);
    const TangentReport report = check_tangents(system, state, 0.02, rho_inf);
    EXPECT_LT(report.error(), kTangentTolerance) << report.text();
  }
}

// Loads for 5 s, then free flight: the energy balance covers both.
TEST(BeamSystem, ConservesEnergyAndMomentaInFlight) {
  const RunSummary r = run(flying_beam(10), 0.05, 10.0);
  ASSERT_EQ(r.end, RunEnd::finished) << r.message;
  EXPECT_LT(r.energy_drift, 1e-12);
  EXPECT_LT(r.linear_momentum_drift, 1e-13);
  EXPECT_LT(r.angular_momentum_drift, 1e-12);
}

TEST(BeamSystem, LosesExactlyTheEnergyDissipatedByViscosity) {
  Model m = flying_beam(8);
  m.beams[0].section.relaxation_time = 0.02;
  const RunSummary r = run(m, 0.05, 10.0);
  ASSERT_EQ(r.end, RunEnd::finished) << r.message;
  EXPECT_LT(r.energy_drift, 1e-12);
  EXPECT_LT(r.angular_momentum_drift, 1e-12);
}

// Free flight: a sudden load would enter the momenta with the lag of a generalised-α step.
TEST(BeamSystem, LosesEnergyButNoMomentumBelowRhoOne) {
  Model m = flying_beam(8);
  m.loads.clear();
  for (BodySpec& b : m.bodies) b.velocity = Vec3(3.0, 0.5 * b.position.x(), 0.3 * b.position.y());
  m.analysis.rho_inf = 0.8;
  m.analysis.step = 0.05;
  m.analysis.duration = 10.0;
  Simulation s(m);
  const double before = s.balance().kinetic + s.balance().potential;
  const RunSummary r = s.run();
  ASSERT_EQ(r.end, RunEnd::finished) << r.message;
  EXPECT_LT(r.linear_momentum_drift, 1e-12);
  const double after = s.balance().kinetic + s.balance().potential;
  EXPECT_LT(after, before);
  EXPECT_GT(after, 0.95 * before);
}

// A plate with a mast, a cable to the mast's end, and a hinge and a spring at its middle.
TEST(BeamSystem, CanBeCombinedWithJointsSpringsAndCables) {
  ModelBuilder m;
  const int plate = m.body("plate", {0, 0, 0}, 3.0, {0.2, 0.3, 0.4});
  m.at(plate).angular_velocity = {0.2, 0.5, -0.3};
  BeamSpec mast = beam_through({{0.1, 0, 0}, {0.1, 0, 1.0}}, 6,
                               {1e4, 4e3, 10.0, 15.0, 0.4, {4e-4, 2e-4, 2e-4}});
  mast.bonds = {{plate, false}};
  mast.angular_velocity = m.at(plate).angular_velocity;
  mast.velocity = mast.angular_velocity.cross(Vec3(0.1, 0, 0));
  add_beam(m.model, mast);
  const int middle = 1 + 3, end = 1 + 6;
  const int arm = m.body("arm", {0.3, 0, 0.5}, 0.2, {1e-3, 2e-3, 2e-3});
  m.at(arm).velocity = mast.angular_velocity.cross(Vec3(0.3, 0, 0.5));
  m.at(arm).angular_velocity = mast.angular_velocity + Vec3(0, 1.0, 0);
  m.at(arm).velocity += Vec3(0, 1.0, 0).cross(Vec3(0.2, 0, 0));
  m.joint("hinge", "revolute", middle, arm, {0.1, 0, 0.5}, Vec3::UnitY());
  m.spring("spring", plate, {0.5, 0, 0}, arm, {0.4, 0, 0.5}, {{"stiffness", 30.0}});
  for (const double mass : {0.0, 0.05}) {
    Model model = m.model;
    CableLineSpec stay;
    stay.name = "stay";
    stay.through = {{plate, {-0.4, 0, 0}}, {end, Vec3::Zero()}};
    stay.stiffness = 200.0;
    stay.mass_per_length = mass;
    stay.elements = 4;
    add_cable(model, stay);
    // Where a cable becomes taut, Newton converges slowly, so its tolerance is larger.
    model.analysis.newton_tolerance = 1e-8;
    const RunSummary r = run(model, 0.005, 5.0);
    ASSERT_EQ(r.end, RunEnd::finished) << r.message;
    EXPECT_LT(r.energy_drift, 2e-12) << mass;
    EXPECT_LT(r.linear_momentum_drift, 1e-12) << mass;
    EXPECT_LT(r.angular_momentum_drift, 2e-12) << mass;
    EXPECT_LT(r.constraint_residual_max, 1e-12) << mass;
  }
}

}  // namespace polhode::test::beam_dynamics_tests
