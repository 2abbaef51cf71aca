// SPDX-License-Identifier: Apache-2.0
#include <polhode/math/quaternion.hpp>
#include <polhode/stepping/instant_system.hpp>

namespace polhode {

namespace {

constexpr int kMaxAssemblyIterations = 100;
/// Number of iterations within which |g| has to be halved; otherwise assembly has stalled.
constexpr int kPatience = 12;
/// Largest displacement of one assembly iteration, |Δr|/ℓ or |Δθ| [-].
constexpr double kLargestMove = 0.5;

/// Constraint values of an instant.
struct PositionDefect {
  double largest = 0.0;
  bool at_round_off = true;
  std::vector<std::pair<int, double>> by_interaction;  ///< Largest |g| of each that has rows.
};

/// Rounding of a constraint value: that of the positions and of the rotated lever arms.
double row_noise(const PairStep& step, const PairTerms& t, int k, double length) {
  const double reach = length + std::max(step.a.r_n1.lpNorm<1>(), step.b.r_n1.lpNorm<1>());
  const double G_r =
      std::max(t.G_a.row(k).head<3>().lpNorm<1>(), t.G_b.row(k).head<3>().lpNorm<1>());
  const double G_theta = t.G_a.row(k).tail<3>().lpNorm<1>() + t.G_b.row(k).tail<3>().lpNorm<1>();
  return 8.0 * kInstantRoundOff * (G_r * reach + G_theta);
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
  double noise_of_parts = 0.0;  // sum over a row's parts so far
  const auto measure = [&](bool with_matrix) {
    defect = {};
    s.run(
        state,
        [&](int i, const PairStep& step, const PairTerms& terms) {
          const InteractionRef& ref = system.interactions()[i];
          double largest = 0.0;
          for (int k = 0; k < ref.rows; ++k) {
            const double g = terms.compliance[k] == 0.0 ? terms.g[k] : 0.0;
            const double noise = noise_of_parts + row_noise(step, terms, k, length);
            noise_of_parts = ref.last_part ? 0.0 : noise;
            if (!(std::abs(g) <= noise)) defect.at_round_off = false;
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
    // ε decreases with |g|²: steps stay bounded where rows are nearly redundant, and the final
    // convergence is quadratic (Levenberg-Marquardt).
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

PositionReport assemble_positions(const System& system, State& state, double tolerance) {
  return InstantSolver(system).assemble_positions(state, tolerance);
}

}  // namespace polhode
