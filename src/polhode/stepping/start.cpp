// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/core/format.hpp>
#include <polhode/equations/node_motion.hpp>
#include <polhode/math/quaternion.hpp>
#include <polhode/stepping/start.hpp>
#include <polhode/stepping/stored_rates.hpp>

namespace polhode {

namespace {

/// Rates of change at an instant that the start needs, by body.
struct Rates {
  bool consistent = true;
  std::vector<double> lambda;
  std::vector<Vec3> a, A, h_dot;  ///< Accelerations; A in body components.
  std::vector<double> node_a;     ///< Of nodes, three each.
};

Rates rates(const System& system, InstantSolver& solver, const State& state) {
  const InstantSolution s = solver.accelerations(state);
  Rates rates{s.solved && s.consistent, s.lambda, s.r_ddot, {}, {}, s.node_a};
  for (int b = 0; b < system.body_count(); ++b) {
    const BodyMotion m = system.motion(state, b);
    const Mat3 Lambda = m.Lambda();
    const Mat3& J_r = system.bodies()[b].inertia;
    const Vec3 A = Lambda.transpose() * s.alpha[b];
    rates.A.push_back(A);
    rates.h_dot.push_back(Lambda * (J_r * A + m.W.cross(J_r * m.W)));
  }
  return rates;
}

/// State a short time later or earlier, by Taylor expansion: sufficient for rates of accelerations.
State taylor(const System& system, const State& state, const Rates& now, double tau) {
  State later = state;
  later.t += tau;
  for (int b = 0; b < system.body_count(); ++b) {
    BodyMotion m = system.motion(state, b);
    m.r += tau * m.v + 0.5 * tau * tau * now.a[b];
    // Body axes: the mean angular velocity, accurate to order τ³.
    m.q = (m.q * quaternion_from_rotation_vector(tau * m.W + 0.5 * tau * tau * now.A[b]))
              .normalized();
    m.v += tau * now.a[b];
    m.W += tau * now.A[b];
    later.set_motion(system.slot(b), m);
  }
  for (std::size_t k = 0; k < now.node_a.size(); ++k) {
    later.node_x[k] += tau * (state.node_v[k] + 0.5 * tau * now.node_a[k]);
    later.node_v[k] += tau * now.node_a[k];
  }
  bond_nodes(system, later);
  return later;
}

/// A time with little motion, for steps that are not yet known [s].
double short_time(const System& system, const State& state, const Rates& now) {
  constexpr double kLittle = 1e-3;  // of a radian, or of the mechanism's size
  const double per_length = 1.0 / system.length_scale();
  double fastest = 0.0;
  for (int b = 0; b < system.body_count(); ++b) {
    const BodyMotion m = system.motion(state, b);
    fastest = std::max({fastest, per_length * m.v.norm(), m.W.norm(),
                        std::sqrt(per_length * now.a[b].norm()), std::sqrt(now.A[b].norm())});
  }
  return fastest > 0.0 ? kLittle / fastest : kLittle;
}

/// Rates of the accelerations by a central difference over t ± Δt; over t and t + Δt at the start
/// of drives, which may have a kink there.
Rates jerks(const System& system, InstantSolver& solver, const State& state, const Rates& now,
            double dt) {
  Rates plus = rates(system, solver, taylor(system, state, now, dt));
  const bool begins = !system.drives().empty() || !system.nodes().prescribed().empty();
  const Rates minus = begins ? now : rates(system, solver, taylor(system, state, now, -dt));
  const double per_time = (begins ? 1.0 : 0.5) / dt;
  for (int b = 0; b < system.body_count(); ++b) {
    plus.a[b] = per_time * (plus.a[b] - minus.a[b]);
    plus.A[b] = per_time * (plus.A[b] - minus.A[b]);
    plus.h_dot[b] = per_time * (plus.h_dot[b] - minus.h_dot[b]);
  }
  return plus;
}

void set_velocity(BodyBlock& block, int lane, const Vec3& v, const Vec3& W) {
  for (int i = 0; i < 3; ++i) {
    block.v[i][lane] = v[i];
    block.W[i][lane] = W[i];
  }
}

void set_accelerations(const System& system, State& state, const Rates& rates) {
  for (int b = 0; b < system.body_count(); ++b) {
    BodyBlock& block = state.blocks[system.slot(b) / kLanes];
    const int lane = system.slot(b) % kLanes;
    for (int i = 0; i < 3; ++i) {
      block.a[i][lane] = rates.a[b][i];
      block.A[i][lane] = rates.A[b][i];
      block.h_dot[i][lane] = rates.h_dot[b][i];
    }
  }
}

bool start_accelerations(const System& system, InstantSolver& solver, State& state,
                         const GeneralizedAlpha& ga, double dt) {
  Rates now = rates(system, solver, state);
  state.lambda = now.lambda;
  if (!state.node_a.empty() && now.node_a.size() == state.node_a.size()) state.node_a = now.node_a;
  Rates change;
  if (ga.delta != 0.0)
    change = jerks(system, solver, state, now, dt > 0.0 ? dt : short_time(system, state, now));
  for (int b = 0; b < system.body_count() && ga.delta != 0.0; ++b) {
    now.a[b] += ga.delta * dt * change.a[b];
    now.A[b] += ga.delta * dt * change.A[b];
    now.h_dot[b] += ga.delta * dt * change.h_dot[b];
  }
  set_accelerations(system, state, now);
  begin_stored_rates(state, ga, dt);
  for (int b = 0; b < system.body_count() && ga.delta != 0.0; ++b)
    set_stored_rate(state, system.slot(b), change.a[b], change.A[b], change.h_dot[b]);
  return now.consistent;
}

void start_smooth_multipliers(const System& system, InstantSolver& solver, State& state,
                              const GeneralizedAlpha& ga, double dt) {
  const Rates now = rates(system, solver, state);
  const Rates change = jerks(system, solver, state, now, dt);
  const double kappa_v = 1.0 / 6.0 - 0.5 * ga.delta - ga.beta;
  std::vector<Vec6> w(system.body_count()), admissible;
  for (int b = 0; b < system.body_count(); ++b) {
    const BodyMotion m = system.motion(state, b);
    w[b].head<3>() = kappa_v * dt * dt * change.a[b];
    const Vec3 w_W = kappa_v * dt * dt * change.A[b] +
                     // phase error of the Cayley transform
                     dt * dt / 12.0 * (m.W.cross(now.A[b]) + m.W.squaredNorm() * m.W);
    w[b].tail<3>() = m.q * w_W;
  }
  admissible = w;
  solver.keep_admissible(state, admissible);
  for (int b = 0; b < system.body_count(); ++b) {
    const Vec6 normal = w[b] - admissible[b];
    const BodyMotion m = system.motion(state, b);
    set_velocity(state.blocks[system.slot(b) / kLanes], system.slot(b) % kLanes,
                 m.v + normal.head<3>(), m.W + m.q.conjugate() * normal.tail<3>());
  }
}

}  // namespace

void initialize_histories(const System& system, State& state) {
  StepContext context;
  context.ga = GeneralizedAlpha::from_spectral_radius(0.0);
  context.t_n = state.t;
  context.conserving = false;
  for (const InteractionRef& ref : system.interactions()) {
    const InteractionGroup& group = system.group(ref.group);
    if (group.traits(ref.item).history_size == 0) continue;
    PairView view = system.instant(state, ref, state.lambda.data());
    view.context = context;
    group.initialize(ref.item, view.step(), state.history.data() + ref.first_history);
  }
}

bool start_accelerations(const System& system, State& state, const GeneralizedAlpha& ga,
                         double dt) {
  InstantSolver solver(system);
  return start_accelerations(system, solver, state, ga, dt);
}

void restart_accelerations(const System& system, State& state, const GeneralizedAlpha& ga,
                           double t) {
  if (ga.delta == 0.0) return;
  InstantSolver solver(system);
  State after = state;
  after.t = t;
  (void)solver.project_velocities(after);
  const Rates now = rates(system, solver, after);
  if (!now.consistent) return;
  set_accelerations(system, state, now);
  if (now.node_a.size() == state.node_a.size()) state.node_a = now.node_a;
  begin_stored_rates(state, ga, 0.0);
}

void start_smooth_multipliers(const System& system, State& state, const GeneralizedAlpha& ga,
                              double dt) {
  InstantSolver solver(system);
  start_smooth_multipliers(system, solver, state, ga, dt);
}

StartReport start(const System& system, State& state, const GeneralizedAlpha& ga, double dt,
                  const StartOptions& options) {
  InstantSolver solver(system);
  solver.set_load_factor(options.load_factor);
  StartReport report;
  const PositionReport positions = solver.assemble_positions(state, options.position_tolerance);
  report.position_residual = positions.residual_before;
  report.largest_move = positions.largest_move;
  if (positions.moved_body >= 0) report.moved_body = system.bodies()[positions.moved_body].name;
  report.iterations = positions.iterations;
  report.assembled = positions.assembled;
  for (int i : positions.unsatisfied) {
    const InteractionRef& ref = system.interactions()[i];
    report.unsatisfied.push_back(
        format("{} '{}'", system.group(ref.group).kind(), system.name(ref)));
  }
  if (!report.assembled) return report;

  const VelocityReport velocities = solver.project_velocities(state);
  report.velocity_residual = velocities.residual_before;
  report.velocity_change = velocities.largest_change;
  initialize_histories(system, state);
  if (options.load_factor > 0.0) start_prescribed(system, state);
  bond_nodes(system, state);
  if (options.multipliers || ga.rho_inf < 1.0)
    report.consistent = start_accelerations(system, solver, state, ga, dt);
  if (options.smooth_multipliers) start_smooth_multipliers(system, solver, state, ga, dt);
  bond_nodes(system, state);
  return report;
}

}  // namespace polhode
