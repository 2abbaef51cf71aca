// SPDX-License-Identifier: Apache-2.0
#include <Eigen/QR>

#include <polhode/equations/node_motion.hpp>
#include <polhode/stepping/instant_system.hpp>
#include <polhode/stepping/rows_of_nodes.hpp>

namespace polhode {

namespace {

/// Corrections by the responses: the second removes the rounding of the first.
constexpr int kRowCorrections = 2;

}  // namespace

InstantSolver::InstantSolver(const System& system, std::string solver)
    : impl_(std::make_unique<Impl>(system, std::move(solver))) {}
InstantSolver::~InstantSolver() = default;

void InstantSolver::set_load_factor(double factor) { impl_->context.load_factor = factor; }

VelocityReport InstantSolver::Impl::project_bodies(State& state) {
  Impl& s = *this;
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
InstantSolution InstantSolver::Impl::unrestrained(const State& state, std::span<const Vec6> more) {
  Impl& s = *this;
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

/// The solution is linear in the wrenches, so that multipliers follow from those of the responses.
InstantSolution InstantSolver::accelerations(const State& given, std::span<const Vec6> more) {
  Impl& s = *impl_;
  if (!has_rows(s.system)) return s.unrestrained(given, more);
  State state = given;
  bond_nodes(s.system, state);
  s.context.t_n = state.t;
  const RowsOfNodes of(s.system, state, s.context);
  std::vector<Vec6> wrenches(more.begin(), more.end());
  wrenches.resize(static_cast<std::size_t>(s.system.body_count()), Vec6::Zero());
  InstantSolution solution = s.unrestrained(state, wrenches);
  Vec lambda = Vec::Zero(of.count());
  if (!solution.solved) return solution;
  Mat K(of.count(), of.count());
  const Vec before = of.times(solution.node_a);
  const double unit = s.system.mean_mass();
  for (Eigen::Index r = 0; r < of.count(); ++r) {
    std::vector<Vec6> with = wrenches;
    of.add(unit * Vec::Unit(of.count(), r), with);
    K.col(r) = (of.times(s.unrestrained(state, with).node_a) - before) / unit;
  }
  const Eigen::CompleteOrthogonalDecomposition<Mat> inverse(K);
  for (int i = 0; i < kRowCorrections; ++i) {
    lambda += inverse.solve(of.targets(&NodeRow::second) - of.times(solution.node_a));
    std::vector<Vec6> with = wrenches;
    of.add(lambda, with);
    solution = s.unrestrained(state, with);
  }
  of.subtract(lambda, solution.node_force);
  return solution;
}

VelocityReport InstantSolver::project_velocities(State& state) {
  VelocityReport report = impl_->project_bodies(state);
  Impl& s = *impl_;
  if (!has_rows(s.system)) return report;
  bond_nodes(s.system, state);
  s.context.t_n = state.t;
  const RowsOfNodes of(s.system, state, s.context);
  const auto residual = [&] { return Vec(of.targets(&NodeRow::rate) - of.times(state.node_v)); };
  const double before = residual().lpNorm<Eigen::Infinity>();
  report.residual_before = std::max(report.residual_before, before);
  report.residual = std::max(report.residual, before);
  if (before <= 32.0 * kInstantRoundOff * report.scale || !take_impulses(state)) return report;
  Mat K(of.count(), of.count());
  std::vector<std::vector<Vec6>> response;
  const double unit = s.system.mean_mass();
  for (std::size_t r = 0; r < of.rows.size(); ++r) {
    std::vector<Vec6> impulse = of.on_bodies[r];
    for (Vec6& w : impulse) w *= unit;
    response.push_back(jumps(impulse));
    K.col(static_cast<Eigen::Index>(r)) = of.times(response.back());
  }
  const Eigen::CompleteOrthogonalDecomposition<Mat> inverse(K);
  for (int i = 0; i < kRowCorrections; ++i) {
    const Vec lambda = inverse.solve(residual());
    std::vector<Vec6> change(static_cast<std::size_t>(s.system.body_count()), Vec6::Zero());
    for (std::size_t r = 0; r < of.rows.size(); ++r)
      for (std::size_t b = 0; b < change.size(); ++b)
        change[b] += lambda[static_cast<Eigen::Index>(r)] * response[r][b];
    add_jumps(s.system, change, node_jumps(change), state);
    bond_nodes(s.system, state);
    for (std::size_t b = 0; b < change.size(); ++b) {
      const double size = std::max(change[b].head<3>().norm(),
                                   s.system.length_scale() * change[b].tail<3>().norm());
      if (size <= report.largest_change) continue;
      report.largest_change = size;
      report.changed_body = static_cast<int>(b);
    }
  }
  report.residual = residual().lpNorm<Eigen::Infinity>();
  return report;
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
