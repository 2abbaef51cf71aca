// SPDX-License-Identifier: Apache-2.0
#include <polhode/stepping/instant_system.hpp>

namespace polhode {

InstantSolver::InstantSolver(const System& system, std::string solver)
    : impl_(std::make_unique<Impl>(system, std::move(solver))) {}
InstantSolver::~InstantSolver() = default;

void InstantSolver::set_load_factor(double factor) { impl_->context.load_factor = factor; }

VelocityReport InstantSolver::project_velocities(State& state) {
  Impl& s = *impl_;
  const System& system = s.system;
  const int bodies = system.body_count();
  VelocityReport report;
  s.take(state);
  double largest_scale = 0.0;
  double of_parts = 0.0;  // sum of the rates of a row's parts so far
  const auto velocity = [&](int body) {
    Vec6 v = Vec6::Zero();
    if (body != kGround) v << s.steps[body].v_n1, s.steps[body].Lambda_n1 * s.steps[body].W_n1;
    return v;
  };
  s.run(
      state,
      [&](int i, const PairStep&, const PairTerms& terms) {
        const InteractionRef& ref = system.interactions()[i];
        const Vec6 v_a = velocity(ref.a), v_b = velocity(ref.b);
        const bool driven = system.traits(ref).prescribes;
        const Vec6 rate = driven ? s.rates(state, ref, TimeSide::kAfter) : Vec6::Zero();
        for (int k = 0; k < ref.rows; ++k) {
          if (terms.compliance[k] != 0.0) continue;
          double sum = -rate[k] + of_parts, scale = std::abs(rate[k]);
          for (int c = 0; c < 6; ++c) {
            const double a = ref.a == kGround ? 0.0 : terms.G_a(k, c) * v_a[c];
            const double b = ref.b == kGround ? 0.0 : terms.G_b(k, c) * v_b[c];
            sum += a + b;
            scale += std::abs(a) + std::abs(b);
          }
          largest_scale = std::max(largest_scale, scale);
          of_parts = ref.last_part ? 0.0 : sum;
          if (!ref.last_part) continue;
          if (!(std::abs(sum) <= report.residual_before)) report.residual_before = std::abs(sum);
        }
      },
      true);
  report.residual = report.residual_before;
  report.scale = largest_scale;
  for (int b = 0; b < bodies; ++b)  // rows of bodies at rest have no scale of their own
    report.scale = std::max({report.scale, s.steps[b].v_n1.lpNorm<Eigen::Infinity>(),
                             system.length_scale() * s.steps[b].W_n1.norm()});
  for (const double v : state.node_v) report.scale = std::max(report.scale, std::abs(v));
  if (report.residual <= 32.0 * kInstantRoundOff * largest_scale) return report;

  s.put_masses_and_rows(state);
  Vec given(6 * bodies);
  for (int b = 0; b < bodies; ++b) given.segment<6>(6 * b) = velocity(b);
  s.rhs.setZero();
  s.rows_times(given, s.rhs.tail(system.rows()));
  s.subtract_rates(state, TimeSide::kAfter, s.rhs.tail(system.rows()));
  s.rhs = -s.rhs;
  const Impl::Outcome outcome = s.solve(state);
  report.solves = outcome.solves;
  if (!outcome.solved) return report;
  report.residual = outcome.residual;
  for (int b = 0; b < bodies; ++b) {
    const Vec3 D_v = s.x.segment<3>(6 * b), D_omega = s.x.segment<3>(6 * b + 3);
    BodyMotion m = system.motion(state, b);
    m.v += D_v;
    m.W += m.Lambda().transpose() * D_omega;
    BodyBlock& block = state.blocks[system.slot(b) / kLanes];
    const int lane = system.slot(b) % kLanes;
    for (int i = 0; i < 3; ++i) {  // positions keep their compensated rounding
      block.v[i][lane] = m.v[i];
      block.W[i][lane] = m.W[i];
    }
    const double change = std::max(D_v.norm(), system.length_scale() * D_omega.norm());
    if (change > report.largest_change) {
      report.largest_change = change;
      report.changed_body = b;
    }
  }
  return report;
}

/// @eq{eq:rbm-linear-momentum-balance} @eq{eq:rbm-angular-momentum-balance}
InstantSolution InstantSolver::accelerations(const State& state, std::span<const Vec6> more) {
  Impl& s = *impl_;
  const System& system = s.system;
  const int bodies = system.body_count();
  const double per_mass = 1.0 / system.mean_mass();
  InstantSolution solution;
  solution.lambda.assign(system.rows(), 0.0);
  s.take(state);
  s.prepare();
  s.put_masses();
  s.rhs.setZero();
  for (int b = 0; b < bodies; ++b) {
    const BodyStep& step = s.steps[b];
    const Vec3 h = step.Lambda_n1 * (system.bodies()[b].inertia * step.W_n1);
    s.rhs.segment<3>(6 * b) = per_mass * system.bodies()[b].mass * system.gravity();
    s.rhs.segment<3>(6 * b + 3) = -per_mass * (step.Lambda_n1 * step.W_n1).cross(h);
    if (!more.empty()) s.rhs.segment<6>(6 * b) += per_mass * more[b];
  }
  s.run(state, [&](int i, const PairStep& step, const PairTerms& terms) {
    const InteractionRef& ref = system.interactions()[i];
    Vec6 wrench_a = terms.wrench_a, wrench_b = terms.wrench_b;
    Vec6 gamma = Vec6::Zero();
    if (ref.rows > 0) system.group(ref.group).acceleration_terms(ref.item, step, gamma);
    for (int k = 0; k < ref.rows; ++k) {
      const int row = ref.first_row + k;
      if (terms.compliance[k] == 0.0) {
        s.rhs[6 * bodies + row] -= gamma[k];
      } else {
        const double lambda = solution.lambda[row] = -terms.g[k] / terms.compliance[k];
        wrench_a += lambda * terms.B_a.col(k);
        wrench_b += lambda * terms.B_b.col(k);
      }
    }
    if (ref.a != kGround) s.rhs.segment<6>(6 * ref.a) += per_mass * wrench_a;
    if (ref.b != kGround) s.rhs.segment<6>(6 * ref.b) += per_mass * wrench_b;
    s.put_rows(i, terms, kInstantProximal);
  });
  if (!s.add_nodes(state)) {
    solution.solved = false;
    return solution;
  }
  const Impl::Outcome outcome = s.solve(state);
  solution.solved = outcome.solved;
  solution.consistent = outcome.consistent;
  solution.residual = outcome.residual;
  solution.r_ddot.reserve(static_cast<std::size_t>(bodies));
  solution.alpha.reserve(static_cast<std::size_t>(bodies));
  for (int b = 0; b < bodies; ++b) {
    solution.r_ddot.emplace_back(s.x.segment<3>(6 * b));
    solution.alpha.emplace_back(s.x.segment<3>(6 * b + 3));
  }
  if (s.nodes) {
    solution.node_a = s.nodes->accelerations(s.x.data());
    solution.node_force = s.nodes->reactions();
  }
  for (int row = 0; row < system.rows(); ++row)
    solution.lambda[row] += system.mean_mass() * s.x[6 * bodies + row];
  return solution;
}

void InstantSolver::keep_admissible(const State& state, std::vector<Vec6>& field) {
  Impl& s = *impl_;
  s.take(state);
  s.put_masses_and_rows(state);
  s.rhs.setZero();
  s.x.setZero();
  for (int b = 0; b < s.system.body_count(); ++b) s.x.segment<6>(6 * b) = field[b];
  s.bodies_times(s.x, s.rhs.head(6 * s.system.body_count()));
  if (!s.solve(state).solved) return;
  for (int b = 0; b < s.system.body_count(); ++b) field[b] = s.x.segment<6>(6 * b);
}

VelocityReport project_velocities(const System& system, State& state) {
  return InstantSolver(system).project_velocities(state);
}

InstantSolution instant_solution(const System& system, const State& state) {
  InstantSolver solver(system);
  State projected = state;
  solver.project_velocities(projected);
  return solver.accelerations(projected);
}

}  // namespace polhode
