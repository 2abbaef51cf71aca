// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/compile/build_system.hpp>
#include <polhode/dynamics/momentum_step.hpp>
#include <polhode/equations/newton_engine.hpp>

namespace polhode::test {

/// Builds mechanisms from world coordinates: bodies where they are, joints by point and axis.
class Mechanism {
 public:
  Model model;

  int body(const std::string& name, const Vec3& r, double mass = 1.0,
           const Vec3& inertia = {0.1, 0.2, 0.25}, const Quat& q = Quat::Identity()) {
    BodySpec b;
    b.name = name;
    b.position = r;
    b.mass = mass;
    b.inertia = inertia.asDiagonal();
    b.orientation = q;
    model.bodies.push_back(b);
    return static_cast<int>(model.bodies.size()) - 1;
  }
  void joint(const std::string& name, const std::string& type, int a, int b, const Vec3& point,
             const Vec3& axis = Vec3::UnitZ()) {
    JointSpec j;
    j.name = name;
    j.type = type;
    j.a = a;
    j.b = b;
    const Mat3 R = Quat::FromTwoVectors(Vec3::UnitZ(), axis).toRotationMatrix();
    const auto place = [&](int body, Vec3& Z, Mat3& axes) {
      const bool ground = body == kGround;
      const Vec3 r = ground ? Vec3(Vec3::Zero()) : model.bodies[body].position;
      const Mat3 Lambda =
          ground ? Mat3(Mat3::Identity()) : model.bodies[body].orientation.toRotationMatrix();
      Z = Lambda.transpose() * (point - r);
      axes = Lambda.transpose() * R;
    };
    place(a, j.Z_a, j.R_a);
    place(b, j.Z_b, j.R_b);
    model.joints.push_back(j);
  }
  /// Initial velocity of a body. Velocities of one rigid motion of all bodies satisfy any tree of
  /// joints.
  void velocity(int body, const Vec3& v, const Vec3& omega) {
    model.bodies[body].velocity = v;
    model.bodies[body].angular_velocity = omega;
  }
  [[nodiscard]] System system() const { return build_system(model); }
};

inline const Vec3 kGravity{0.0, 0.0, -9.81};

/// Two skew bars on a revolute and a spherical or universal joint, swinging.
inline Mechanism double_pendulum(const std::string& second = "universal") {
  Mechanism m;
  m.model.gravity = kGravity;
  const int upper = m.body("upper", {0.5, 0.1, 0.0}, 2.0, {0.02, 0.2, 0.21},
                           Quat(Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized())));
  const int lower = m.body("lower", {1.5, 0.3, 0.1}, 1.0, {0.01, 0.1, 0.1});
  m.joint("shoulder", "revolute", kGround, upper, {0, 0, 0}, Vec3(0.1, 1.0, 0.2));
  m.joint("elbow", second, upper, lower, {1.0, 0.2, 0.0}, Vec3(0.3, 0.2, 1.0));
  m.velocity(upper, {0.3, 0.0, -0.5}, {0.1, 1.0, 0.2});
  m.velocity(lower, {0.5, 0.1, -1.5}, {0.7, -1.1, 2.0});
  return m;
}

/// Four bars in a row of N squares in the x-y plane, every hinge a spatial revolute: 3N redundant
/// rows. Cranks have length one, the couplers too.
inline Mechanism four_bars(int n, double crank_angle = 1.5707963267948966) {
  Mechanism m;
  m.model.gravity = {0.0, -9.81, 0.0};
  const Vec3 arm(std::cos(crank_angle), std::sin(crank_angle), 0.0);
  const Quat turn(Eigen::AngleAxisd(crank_angle, Vec3::UnitZ()));
  const Vec3 rod(1e-3, 1.0 / 12.0, 1.0 / 12.0);
  const Vec3 spin = Vec3::UnitZ();
  std::vector<int> crank, coupler;
  for (int i = 0; i <= n; ++i) {
    crank.push_back(m.body("crank" + std::to_string(i), Vec3(i, 0, 0) + 0.5 * arm, 1.0, rod, turn));
    m.velocity(crank.back(), spin.cross(0.5 * arm), spin);
  }
  for (int i = 0; i < n; ++i) {
    coupler.push_back(m.body("coupler" + std::to_string(i), Vec3(i + 0.5, 0, 0) + arm, 1.0, rod));
    m.velocity(coupler.back(), spin.cross(arm), Vec3::Zero());
  }
  for (int i = 0; i <= n; ++i)
    m.joint("base" + std::to_string(i), "revolute", kGround, crank[i], Vec3(i, 0, 0));
  for (int i = 0; i < n; ++i) {
    m.joint("left" + std::to_string(i), "revolute", crank[i], coupler[i], Vec3(i, 0, 0) + arm);
    m.joint("right" + std::to_string(i), "revolute", coupler[i], crank[i + 1],
            Vec3(i + 1, 0, 0) + arm);
  }
  return m;
}

/// Bricard's trihedral linkage: six bars along edges of a cube, the last one fixed, each hinge
/// normal to both its bars.
inline Mechanism bricard_system() {
  Mechanism m;
  m.model.gravity = kGravity;
  const Vec3 vertex[6] = {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}, {1, 0, 1}};
  for (int i = 0; i < 5; ++i) {
    const Vec3 along = vertex[i + 1] - vertex[i];
    const Vec3 inertia = Vec3::Constant(1.0 / 12.0) - (1.0 / 12.0 - 1e-3) * along.cwiseAbs();
    m.body("bar" + std::to_string(i), 0.5 * (vertex[i] + vertex[i + 1]), 1.0, inertia);
  }
  for (int i = 0; i < 6; ++i) {
    const Vec3 before = vertex[i] - vertex[(i + 5) % 6], after = vertex[(i + 1) % 6] - vertex[i];
    m.joint("hinge" + std::to_string(i), "revolute", i == 0 ? kGround : i - 1, i == 5 ? kGround : i,
            vertex[i], before.cross(after));
  }
  return m;
}

/// A door on two hinges of one axis: five redundant rows.
inline Mechanism door_system() {
  Mechanism m;
  m.model.gravity = kGravity;
  const int leaf = m.body("leaf", {0.5, 0.0, 1.0}, 20.0, {7.0, 8.0, 1.7});
  m.joint("lower hinge", "revolute", kGround, leaf, {0, 0, 0.2});
  m.joint("upper hinge", "revolute", kGround, leaf, {0, 0, 1.8});
  return m;
}

inline Mechanism spherical_chain(int n) {
  Mechanism m;
  m.model.gravity = kGravity;
  for (int i = 0; i < n; ++i) {
    const int b = m.body("link" + std::to_string(i), {i + 0.5, 0.0, 0.0}, 1.0, {0.01, 0.09, 0.09});
    m.joint("ball" + std::to_string(i), "spherical", b - 1, b, {1.0 * i, 0.0, 0.0});
  }
  return m;
}

/// One step of fixed length with any engine: predicted with constant velocity, without step
/// control. @returns largest increment of each iteration.
inline std::vector<double> take_step(const System& system, State& state, NewtonEngine& engine,
                                     double dt, double rho_inf) {
  Trial trial;
  trial.context.ga = GeneralizedAlpha::from_spectral_radius(rho_inf);
  trial.context.t_n = state.t;
  trial.context.dt = dt;
  start_trial(system, state, trial);
  for (int b = 0; b < system.body_count(); ++b) {
    const BodyMotion m = system.motion(state, b);
    move_body(state, trial, system.slot(b), dt * m.v, dt * m.omega());
  }
  engine.begin_step(state, trial);
  std::vector<double> increments;
  bool converged = false;
  for (int i = 0; i < 20; ++i) {
    const Iteration done = engine.iterate(state, trial, true, 1.0);
    if (!done.solved) return {};
    increments.push_back(done.increment);
    if (converged) break;
    converged = done.increment < 1e-6;
    if (converged) trial.lambda_centre = trial.lambda;
  }
  engine.end_step(state, trial);
  State next = state;
  for (int b = 0; b < system.body_count(); ++b)
    next.set_motion(system.slot(b), end_motion(system.bodies()[b].inertia, system.motion(state, b),
                                               body_step(system, state, trial, b), trial.context));
  next.lambda = trial.lambda;
  next.t = trial.context.t_n1();
  state = next;
  return increments;
}

inline double energy(const System& system, const State& state) {
  double sum = 0.0;
  for (int b = 0; b < system.body_count(); ++b) {
    const BodyMotion m = system.motion(state, b);
    const BodyData& body = system.bodies()[b];
    sum += 0.5 * body.mass * m.v.squaredNorm() + 0.5 * m.W.dot(body.inertia * m.W) -
           body.mass * system.gravity().dot(m.r);
  }
  return sum;
}

}  // namespace polhode::test
