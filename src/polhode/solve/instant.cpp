// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <span>

#include <polhode/so3/quaternion.hpp>
#include <polhode/solve/instant.hpp>
#include <polhode/solve/node_inertia.hpp>

namespace polhode {

namespace {

constexpr double kRoundOff = std::numeric_limits<double>::epsilon();
/// ε where multipliers count: rounding of the redundant part is divided by it, repeats do the rest.
constexpr double kInstantProximal = 1e-8;
constexpr int kMaxRepeats = 40;
constexpr int kMaxAssemblyIterations = 100;
/// Assembly has come to a halt if |g| does not halve within so many iterations.
constexpr int kPatience = 12;
/// Largest move of one assembly iteration, |Δr|/ℓ or |Δθ| [-].
constexpr double kLargestMove = 0.5;

}  // namespace

struct InstantSolver::Impl {
  const System& system;
  std::string solver_name;
  InteractionSweep sweep;
  KktMap map;
  std::vector<BodyStep> steps;
  std::vector<double> no_lambda;
  struct CoupledMass {
    int a, b, pair;
    double mass;
  };
  std::vector<CoupledMass> coupled;
  StepContext context;
  std::unique_ptr<LinearSolver> solver;  // with `values`, from the first use on
  KktValues values;
  Vec rhs, x, correction;
  std::unique_ptr<NodeInertia> nodes;  ///< Of deformable solids, if there are any.
  /// Positions and time that the factorisation at hand belongs to.
  std::vector<BodyBlock> factored_at;
  double factored_t = 0.0;
  Vec G_x, M_x;

  Impl(const System& s, std::string name)
      : system(s), solver_name(std::move(name)), sweep(s), map(kkt_map(s)) {
    steps.resize(static_cast<std::size_t>(system.body_count()) + 1);
    no_lambda.assign(system.rows(), 0.0);
    for (std::size_t i = 0; i < system.interactions().size(); ++i) {
      const InteractionRef& ref = system.interactions()[i];
      const double mass = system.group(ref.group).coupled_mass(ref.item);
      if (mass != 0.0) coupled.push_back({ref.a, ref.b, map.pair[i], mass});
    }
    context.ga = GeneralizedAlpha::from_spectral_radius(0.0);  // α_f = 1: the instant itself
    context.conserving = false;
  }

  void take(const State& state) {
    for (int b = 0; b < system.body_count(); ++b) steps[b] = system.instant(state, b);
    steps.back() = BodyStep::ground(1.0);
    context.t_n = state.t;
  }
  template <class Visit>
  void run(const State& state, Visit&& visit, bool rows_only = false) {
    sweep.run(steps, context, no_lambda.data(), state.history.data(), visit, rows_only);
  }

  void prepare() {
    if (solver) return;
    solver = make_linear_solver(solver_name);
    if (!system.nodes().empty()) {
      nodes = std::make_unique<NodeInertia>(system);
      const auto& more = nodes->pairs();
      map.topology.pairs.insert(map.topology.pairs.end(), more.begin(), more.end());
    }
    solver->analyse(map.topology);
    values.diagonal.assign(map.topology.bodies, Mat6::Zero());
    values.pairs.resize(map.topology.pairs.size());
    for (KktValues::Pair& v : values.pairs) {
      v.K_ab.setZero();
      v.K_ba.setZero();
    }
    for (const CoupledMass& m : coupled) {
      if (m.pair < 0) continue;
      KktValues::Pair& v = values.pairs[m.pair];
      v.K_ab.topLeftCorner<3, 3>().diagonal().array() += m.mass / system.mean_mass();
      v.K_ba = v.K_ab;
    }
    rhs = Vec::Zero(6 * map.topology.bodies + map.topology.rows);
    x = correction = rhs;
  }

  void put_masses() {
    const double per_mass = 1.0 / system.mean_mass();
    for (int b = 0; b < system.body_count(); ++b) {
      const BodyData& body = system.bodies()[b];
      const Mat3& Lambda = steps[b].Lambda_n1;
      Mat6& M = values.diagonal[b];
      M.setZero();
      M.topLeftCorner<3, 3>().diagonal().setConstant(per_mass * body.mass);
      M.bottomRightCorner<3, 3>() = per_mass * Lambda * body.inertia * Lambda.transpose();
    }
    for (const CoupledMass& m : coupled)
      for (int body : {m.a, m.b})
        if (body != kGround)
          values.diagonal[body].topLeftCorner<3, 3>().diagonal().array() -= per_mass * m.mass;
  }
  /// Blocks of the pairs of bodies that solids couple: the last ones.
  [[nodiscard]] std::span<KktValues::Pair> cliques() {
    return std::span(values.pairs).last(nodes->pairs().size());
  }
  void clear_cliques() {
    if (!nodes) return;
    for (KktValues::Pair& v : cliques()) {
      v.K_ab.setZero();
      v.K_ba.setZero();
    }
  }
  /// Adds masses and forces of the solids to the bodies'.
  [[nodiscard]] bool add_nodes(const State& state) {
    if (!nodes) return true;
    if (!nodes->take(state)) return false;
    const double per_mass = 1.0 / system.mean_mass();
    std::vector<Vec6> force(static_cast<std::size_t>(system.body_count()), Vec6::Zero());
    nodes->put(per_mass, force, values.diagonal, cliques());
    for (int b = 0; b < system.body_count(); ++b) rhs.segment<6>(6 * b) += force[b];
    return true;
  }
  void put_rows(int interaction, const PairTerms& terms, double epsilon) {
    const int pair = map.pair[interaction];
    if (pair < 0) return;
    KktValues::Pair& v = values.pairs[pair];
    v.G_a = terms.G_a;
    v.G_b = terms.G_b;
    for (int k = 0; k < map.topology.pairs[pair].rows; ++k) {
      v.C[k] = epsilon;
      if (terms.compliance[k] == 0.0) continue;
      v.C[k] = 1.0;
      v.G_a.row(k).setZero();
      v.G_b.row(k).setZero();
    }
    v.B_a = v.G_a.transpose();
    v.B_b = v.G_b.transpose();
  }

  /// G x by row into `out`, and the largest sum of magnitudes of its terms.
  double rows_times(const Vec& field, Eigen::Ref<Vec> out) const {
    double scale = 0.0;
    for (std::size_t p = 0; p < map.topology.pairs.size(); ++p) {
      const KktPair& pair = map.topology.pairs[p];
      const KktValues::Pair& v = values.pairs[p];
      for (int k = 0; k < pair.rows; ++k) {
        double sum = 0.0, size = 0.0;
        for (int i = 0; i < 6; ++i) {
          const double a = pair.a == kGround ? 0.0 : v.G_a(k, i) * field[6 * pair.a + i];
          const double b = pair.b == kGround ? 0.0 : v.G_b(k, i) * field[6 * pair.b + i];
          sum += a + b;
          size += std::abs(a) + std::abs(b);
        }
        out[pair.first_row + k] = sum;
        scale = std::max(scale, size);
      }
    }
    return scale;
  }
  /// M x − Gᵀ y into the first part of `out`.
  void bodies_times(const Vec& all, Eigen::Ref<Vec> out) const {
    const int first = 6 * map.topology.bodies;
    for (int b = 0; b < map.topology.bodies; ++b)
      out.segment<6>(6 * b) = values.diagonal[b] * all.segment<6>(6 * b);
    for (std::size_t p = 0; p < map.topology.pairs.size(); ++p) {
      const KktPair& pair = map.topology.pairs[p];
      const KktValues::Pair& v = values.pairs[p];
      if (pair.a != kGround && pair.b != kGround) {
        out.segment<6>(6 * pair.a) += v.K_ab * all.segment<6>(6 * pair.b);
        out.segment<6>(6 * pair.b) += v.K_ba * all.segment<6>(6 * pair.a);
      }
      for (int k = 0; k < pair.rows; ++k) {
        const double y = all[first + pair.first_row + k];
        if (pair.a != kGround) out.segment<6>(6 * pair.a) -= y * v.B_a.col(k);
        if (pair.b != kGround) out.segment<6>(6 * pair.b) -= y * v.B_b.col(k);
      }
    }
  }

  struct Outcome {
    bool solved = false, consistent = true;
    double residual = 0.0;
    int solves = 0;
  };
  /// Factors the matrix unless that has been done: positions and time make it. (Solids' masses
  /// stand in that of accelerations alone.)
  bool factor(const State& state) {
    const auto same_positions = [](const BodyBlock& x, const BodyBlock& y) {
      return std::memcmp(&x, &y, offsetof(BodyBlock, v)) == 0;
    };
    if (!nodes && state.t == factored_t &&
        std::equal(state.blocks.begin(), state.blocks.end(), factored_at.begin(), factored_at.end(),
                   same_positions))
      return true;
    factored_at.clear();
    if (!solver->factor(values)) return false;
    factored_at = state.blocks;
    factored_t = state.t;
    return true;
  }
  /// Solves for x with the right-hand side `rhs`, repeating until the rows hold to round-off.
  Outcome solve(const State& state) {
    Outcome outcome;
    x.setZero();
    if (!factor(state)) return outcome;
    outcome.solved = true;
    const int bodies = 6 * map.topology.bodies, rows = map.topology.rows;
    correction = rhs;
    G_x.resize(rows);
    M_x.resize(bodies);
    double before = std::numeric_limits<double>::infinity();
    while (outcome.solves < kMaxRepeats) {
      solver->solve(correction);
      ++outcome.solves;
      if (!correction.allFinite()) return {};
      x += correction;
      if (rows == 0) return outcome;
      const double scale = rows_times(x, G_x) + rhs.lpNorm<Eigen::Infinity>();
      G_x = rhs.tail(rows) - G_x;  // what is left
      outcome.residual = G_x.lpNorm<Eigen::Infinity>();
      if (outcome.residual <= 16.0 * kRoundOff * scale) return outcome;
      if (outcome.residual > 0.9 * before) {
        // What no x can satisfy adds the same redundant multipliers each time: take them out.
        outcome.consistent = outcome.residual < 1e-6 * scale;
        if (!outcome.consistent) x.tail(rows) -= outcome.solves * correction.tail(rows);
        return outcome;
      }
      before = outcome.residual;
      bodies_times(x, M_x);
      correction.head(bodies) = rhs.head(bodies) - M_x;
      correction.tail(rows) = G_x;
    }
    return outcome;
  }
};

InstantSolver::InstantSolver(const System& system, std::string solver)
    : impl_(std::make_unique<Impl>(system, std::move(solver))) {}
InstantSolver::~InstantSolver() = default;

namespace {

/// Constraint values of an instant.
struct PositionDefect {
  double largest = 0.0;
  bool at_round_off = true;
  std::vector<std::pair<int, double>> by_interaction;  ///< Largest |g| of each that has rows.
};

/// Rounding of a constraint value: that of the positions and of the turned arms.
double row_noise(const PairStep& step, const PairTerms& t, int k, double length) {
  const double reach = length + std::max(step.a.r_n1.lpNorm<1>(), step.b.r_n1.lpNorm<1>());
  const double G_r =
      std::max(t.G_a.row(k).head<3>().lpNorm<1>(), t.G_b.row(k).head<3>().lpNorm<1>());
  const double G_theta = t.G_a.row(k).tail<3>().lpNorm<1>() + t.G_b.row(k).tail<3>().lpNorm<1>();
  return 8.0 * kRoundOff * (G_r * reach + G_theta);
}

BodyMotion moved(BodyMotion m, const Vec3& D_r, const Vec3& D_theta) {
  m.r += D_r;
  m.q = (quaternion_from_cayley(D_theta) * m.q).normalized();
  return m;
}

}  // namespace

PositionReport InstantSolver::assemble_positions(State& state, double tolerance) {
  Impl& s = *impl_;
  const System& system = s.system;
  const double length = system.length_scale();
  const int bodies = system.body_count();
  PositionReport report;
  std::vector<double> history;  // largest |g| by iteration
  std::vector<BodyMotion> given;

  PositionDefect defect;
  const auto measure = [&](bool with_matrix) {
    defect = {};
    s.run(
        state,
        [&](int i, const PairStep& step, const PairTerms& terms) {
          const InteractionRef& ref = system.interactions()[i];
          double largest = 0.0;
          for (int k = 0; k < ref.rows; ++k) {
            const double g = terms.compliance[k] == 0.0 ? terms.g[k] : 0.0;
            if (!(std::abs(g) <= row_noise(step, terms, k, length))) defect.at_round_off = false;
            if (!(std::abs(g) <= largest)) largest = std::abs(g);
            if (with_matrix) s.rhs[6 * bodies + ref.first_row + k] = -g;
          }
          if (ref.rows > 0) defect.by_interaction.emplace_back(i, largest);
          defect.largest = std::max(defect.largest, largest);
          if (with_matrix) s.put_rows(i, terms, 0.0);
        },
        true);
  };

  s.take(state);
  measure(false);
  report.residual_before = report.residual = defect.largest;
  if (defect.at_round_off) return report;
  s.prepare();
  for (int b = 0; b < bodies; ++b) given.push_back(system.motion(state, b));

  for (;; ++report.iterations) {
    if (report.iterations > 0) s.take(state);
    s.rhs.setZero();
    measure(true);
    report.residual = defect.largest;
    history.push_back(defect.largest);
    const std::size_t n = history.size();
    if (defect.at_round_off) break;
    if (defect.largest <= tolerance && n > 1 && defect.largest > 0.5 * history[n - 2]) break;
    const bool halted = n > kPatience && defect.largest > 0.5 * history[n - 1 - kPatience];
    if (halted || report.iterations == kMaxAssemblyIterations || !std::isfinite(defect.largest)) {
      report.assembled = defect.largest <= tolerance;
      break;
    }
    // ε falls with |g|²: steps stay bounded where rows are nearly redundant, and convergence is
    // quadratic in the end (Levenberg-Marquardt).
    const double epsilon = std::clamp(1e-2 * defect.largest * defect.largest, kProximal, 1e-3);
    for (std::size_t p = 0; p < s.values.pairs.size(); ++p)
      for (int k = 0; k < s.map.topology.pairs[p].rows; ++k)
        if (s.values.pairs[p].C[k] != 1.0) s.values.pairs[p].C[k] = epsilon;
    s.put_masses();
    s.factored_at.clear();
    if (!s.solver->factor(s.values)) {
      report.assembled = false;
      break;
    }
    s.solver->solve(s.rhs);
    double size = 0.0;
    for (int b = 0; b < bodies; ++b)
      size = std::max(
          {size, s.rhs.segment<3>(6 * b).norm() / length, s.rhs.segment<3>(6 * b + 3).norm()});
    if (!std::isfinite(size)) {
      report.assembled = false;
      break;
    }
    const double part = std::min(1.0, kLargestMove / size);
    for (int b = 0; b < bodies; ++b)
      state.set_motion(system.slot(b),
                       moved(system.motion(state, b), part * s.rhs.segment<3>(6 * b),
                             part * s.rhs.segment<3>(6 * b + 3)));
  }

  for (int b = 0; b < bodies; ++b) {
    const BodyMotion now = system.motion(state, b);
    const double move = std::max((now.r - given[b].r).norm() / length,
                                 rotation_vector(now.q * given[b].q.conjugate()).norm());
    if (move > report.largest_move) {
      report.largest_move = move;
      report.moved_body = b;
    }
  }
  if (!report.assembled)
    for (const auto& [interaction, g] : defect.by_interaction)
      if (!(g <= std::max(tolerance, 1e-2 * defect.largest)))
        report.unsatisfied.push_back(interaction);
  return report;
}

VelocityReport InstantSolver::project_velocities(State& state) {
  Impl& s = *impl_;
  const System& system = s.system;
  const int bodies = system.body_count();
  VelocityReport report;
  s.take(state);
  double largest_scale = 0.0;
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
        for (int k = 0; k < ref.rows; ++k) {
          if (terms.compliance[k] != 0.0) continue;
          double sum = 0.0, scale = 0.0;
          for (int c = 0; c < 6; ++c) {
            const double a = ref.a == kGround ? 0.0 : terms.G_a(k, c) * v_a[c];
            const double b = ref.b == kGround ? 0.0 : terms.G_b(k, c) * v_b[c];
            sum += a + b;
            scale += std::abs(a) + std::abs(b);
          }
          if (!(std::abs(sum) <= report.residual_before)) report.residual_before = std::abs(sum);
          largest_scale = std::max(largest_scale, scale);
        }
      },
      true);
  report.residual = report.residual_before;
  if (report.residual <= 32.0 * kRoundOff * largest_scale) return report;

  s.prepare();
  s.put_masses();
  s.run(
      state,
      [&](int i, const PairStep&, const PairTerms& terms) {
        s.put_rows(i, terms, kInstantProximal);
      },
      true);
  Vec given(6 * bodies);
  for (int b = 0; b < bodies; ++b) given.segment<6>(6 * b) = velocity(b);
  s.rhs.setZero();
  s.rows_times(given, s.rhs.tail(system.rows()));
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
    for (int i = 0; i < 3; ++i) {  // positions keep what rounding took from them
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
InstantSolution InstantSolver::accelerations(const State& state) {
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
  }
  s.run(state, [&](int i, const PairStep& step, const PairTerms& terms) {
    const InteractionRef& ref = system.interactions()[i];
    Vec6 wrench_a = terms.wrench_a, wrench_b = terms.wrench_b;
    Vec6 gamma = Vec6::Zero();
    if (ref.rows > 0) system.group(ref.group).acceleration_terms(ref.item, step, gamma);
    for (int k = 0; k < ref.rows; ++k) {
      const int row = ref.first_row + k;
      if (terms.compliance[k] == 0.0) {
        s.rhs[6 * bodies + row] = -gamma[k];
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
  s.clear_cliques();
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
  s.prepare();
  s.put_masses();
  s.run(
      state,
      [&](int i, const PairStep&, const PairTerms& terms) {
        s.put_rows(i, terms, kInstantProximal);
      },
      true);
  s.rhs.setZero();
  s.x.setZero();
  for (int b = 0; b < s.system.body_count(); ++b) s.x.segment<6>(6 * b) = field[b];
  s.bodies_times(s.x, s.rhs.head(6 * s.system.body_count()));
  if (!s.solve(state).solved) return;
  for (int b = 0; b < s.system.body_count(); ++b) field[b] = s.x.segment<6>(6 * b);
}

PositionReport assemble_positions(const System& system, State& state, double tolerance) {
  return InstantSolver(system).assemble_positions(state, tolerance);
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
