// SPDX-License-Identifier: Apache-2.0
// Linear system of InstantSolver; included only by its source files.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <span>

#include <polhode/equations/node_inertia.hpp>
#include <polhode/stepping/instant.hpp>

namespace polhode {

inline constexpr double kInstantRoundOff = std::numeric_limits<double>::epsilon();
/// ε where multipliers matter: rounding of the redundant part is divided by it, iterations do the
/// rest.
inline constexpr double kInstantProximal = 1e-8;
inline constexpr int kMaxInstantRepeats = 40;

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
  std::unique_ptr<linear::LinearSolver> solver;  // with `values`, from the first use on
  linear::KktValues values;
  Vec rhs, x, correction;
  std::unique_ptr<NodeInertia> nodes;  ///< Of deformable solids, if there are any.
  std::vector<Vec6> of_nodes;          ///< By body: condensed impulses on free nodes.
  /// Positions and time of the present factorisation.
  std::vector<BodyBlock> factored_at;
  double factored_t = 0.0;
  Vec G_x, M_x;

  Impl(const System& s, std::string name)
      : system(s), solver_name(std::move(name)), sweep(s), map(kkt_map(s)) {
    steps.resize(static_cast<std::size_t>(system.body_count()) + 1);
    no_lambda.assign(system.rows(), 0.0);
    for (std::size_t i = 0; i < system.interactions().size(); ++i) {
      const InteractionRef& ref = system.interactions()[i];
      const double mass = system.traits(ref).coupled_mass;
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
    solver = linear::make_linear_solver(solver_name);
    if (!system.nodes().empty()) {
      nodes = std::make_unique<NodeInertia>(system);
      const auto& more = nodes->pairs();
      map.topology.pairs.insert(map.topology.pairs.end(), more.begin(), more.end());
    }
    solver->analyse(map.topology);
    values.diagonal.assign(map.topology.bodies, Mat6::Zero());
    values.pairs.resize(map.topology.pairs.size());
    for (linear::KktValues::Pair& v : values.pairs) {
      v.K_ab.setZero();
      v.K_ba.setZero();
    }
    for (const CoupledMass& m : coupled) {
      if (m.pair < 0) continue;
      linear::KktValues::Pair& v = values.pairs[m.pair];
      v.K_ab.topLeftCorner<3, 3>().diagonal().array() += m.mass / system.mean_mass();
      v.K_ba = v.K_ab;
    }
    rhs = Vec::Zero(6 * map.topology.bodies + map.topology.rows);
    x = correction = rhs;
  }

  /// Sets the masses of the bodies; add_nodes() adds those of solids.
  void put_masses() {
    clear_cliques();
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
  /// Sets the matrix of velocity jumps: masses of the bodies, and active rows.
  void put_masses_and_rows(const State& state) {
    prepare();
    put_masses();
    run(
        state,
        [&](int i, const PairStep&, const PairTerms& terms) {
          put_rows(i, terms, kInstantProximal);
        },
        true);
  }
  /// Blocks of the pairs of bodies coupled by solids, which come last.
  [[nodiscard]] std::span<linear::KktValues::Pair> cliques() {
    return std::span(values.pairs).last(nodes->pairs().size());
  }
  void clear_cliques() {
    if (!nodes) return;
    for (linear::KktValues::Pair& v : cliques()) {
      v.K_ab.setZero();
      v.K_ba.setZero();
    }
  }
  /// Adds masses and forces of the solids to those of the bodies; for impulses there are no forces.
  [[nodiscard]] bool add_nodes(const State& state) {
    return !nodes || (nodes->take(state) && put_nodes());
  }
  /// Adds masses for impulses, with given jumps of prescribed components.
  [[nodiscard]] bool add_node_masses(const State& state, std::span<const double> given = {}) {
    return !nodes || (nodes->take_masses(state, given) && put_nodes());
  }
  bool put_nodes() {
    const double per_mass = 1.0 / system.mean_mass();
    std::vector<Vec6> force(static_cast<std::size_t>(system.body_count()), Vec6::Zero());
    nodes->put(per_mass, force, values.diagonal, cliques());
    for (int b = 0; b < system.body_count(); ++b) rhs.segment<6>(6 * b) += force[b];
    return true;
  }
  void put_rows(int interaction, const PairTerms& terms, double epsilon) {
    const int pair = map.pair[interaction];
    if (pair < 0) return;
    linear::KktValues::Pair& v = values.pairs[pair];
    v.G_a = terms.G_a;
    v.G_b = terms.G_b;
    for (int k = 0; k < map.topology.pairs[pair].rows; ++k) {
      v.C[k] = epsilon * terms.weight[k];
      if (terms.compliance[k] == 0.0) continue;
      v.C[k] = 1.0;
      v.G_a.row(k).setZero();
      v.G_b.row(k).setZero();
    }
    v.B_a = v.G_a.transpose();
    v.B_b = v.G_b.transpose();
  }

  /// Subtracts the prescribed rates of rows from numbers by row.
  void subtract_rates(const State& state, TimeSide side, Eigen::Ref<Vec> rows) const {
    for (const int i : system.drives()) {
      const InteractionRef& ref = system.interactions()[i];
      rows.segment(ref.first_row, ref.rows) -= rates(state, ref, side).head(ref.rows);
    }
  }
  [[nodiscard]] Vec6 rates(const State& state, const InteractionRef& ref, TimeSide side) const {
    const PairView view = system.instant(state, ref, no_lambda.data());
    return context.load_factor *
           system.group(ref.group).prescribed(ref.item, view.step(), side).rate;
  }

  /// G x by row into `out`, and the largest sum of magnitudes of its terms.
  double rows_times(const Vec& field, Eigen::Ref<Vec> out) const {
    double scale = 0.0;
    out.setZero();
    for (std::size_t p = 0; p < map.topology.pairs.size(); ++p) {
      const linear::KktPair& pair = map.topology.pairs[p];
      const linear::KktValues::Pair& v = values.pairs[p];
      for (int k = 0; k < pair.rows; ++k) {
        double sum = 0.0, size = 0.0;
        for (int i = 0; i < 6; ++i) {
          const double a = pair.a == kGround ? 0.0 : v.G_a(k, i) * field[6 * pair.a + i];
          const double b = pair.b == kGround ? 0.0 : v.G_b(k, i) * field[6 * pair.b + i];
          sum += a + b;
          size += std::abs(a) + std::abs(b);
        }
        out[pair.first_row + k] += sum;
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
      const linear::KktPair& pair = map.topology.pairs[p];
      const linear::KktValues::Pair& v = values.pairs[p];
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

  /// InstantSolver::accelerations() without rows of nodes.
  [[nodiscard]] InstantSolution unrestrained(const State& state, std::span<const Vec6> more);
  /// InstantSolver::project_velocities() without rows of nodes.
  VelocityReport project_bodies(State& state);

  struct Outcome {
    bool solved = false, consistent = true;
    double residual = 0.0;
    int solves = 0;
  };
  /// Factors the matrix unless positions and time are those of the factorisation. (Solids' masses
  /// are only in that of accelerations.)
  bool factor(const State& state) {
    const auto same_positions = [](const BodyBlock& one, const BodyBlock& other) {
      return std::memcmp(&one, &other, offsetof(BodyBlock, v)) == 0;
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
  /// Solves for x with the right-hand side `rhs`, iterating until the rows hold to round-off.
  Outcome solve(const State& state) { return factor(state) ? solve_factored() : Outcome{}; }
  Outcome solve_factored() {
    Outcome outcome;
    x.setZero();
    outcome.solved = true;
    const int bodies = 6 * map.topology.bodies, rows = map.topology.rows;
    correction = rhs;
    G_x.resize(rows);
    M_x.resize(bodies);
    double before = std::numeric_limits<double>::infinity();
    while (outcome.solves < kMaxInstantRepeats) {
      solver->solve(correction);
      ++outcome.solves;
      if (!correction.allFinite()) return {};
      x += correction;
      if (rows == 0) return outcome;
      const double scale = rows_times(x, G_x) + rhs.lpNorm<Eigen::Infinity>();
      G_x = rhs.tail(rows) - G_x;  // the remaining residual
      outcome.residual = G_x.lpNorm<Eigen::Infinity>();
      if (outcome.residual <= 16.0 * kInstantRoundOff * scale) return outcome;
      if (outcome.residual > 0.9 * before) {
        // A part that no x can satisfy adds the same redundant multipliers each time: they are
        // removed.
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
  /// Sets the right-hand side to impulses on bodies and free nodes; rows to zero.
  void press(std::span<const Vec6> impulses) {
    const double per_mass = 1.0 / system.mean_mass();
    rhs.setZero();
    for (std::size_t b = 0; b < impulses.size(); ++b)
      rhs.segment<6>(6 * static_cast<Eigen::Index>(b)) = per_mass * impulses[b];
    for (std::size_t b = 0; b < of_nodes.size(); ++b)
      rhs.segment<6>(6 * static_cast<Eigen::Index>(b)) += of_nodes[b];
  }
  /// Multipliers of the solution, by row.
  [[nodiscard]] std::vector<double> solved_rows() const {
    const Vec rows = system.mean_mass() * x.tail(system.rows());
    return {rows.begin(), rows.end()};
  }
  /// Solution for the bodies; zero if it cannot be computed.
  std::vector<Vec6> solution_by_body() {
    std::vector<Vec6> by_body(static_cast<std::size_t>(system.body_count()), Vec6::Zero());
    if (!solve_factored().solved) return by_body;
    for (int b = 0; b < system.body_count(); ++b) by_body[b] = x.segment<6>(6 * b);
    return by_body;
  }
};

}  // namespace polhode
