// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/core/format.hpp>
#include <polhode/equations/node_motion.hpp>
#include <polhode/math/hat.hpp>
#include <polhode/statics/follower_loads.hpp>

namespace polhode {

namespace {

/// Asymmetry of a load's stiffness, as a part of its largest entry, above which it has no
/// potential. Rounding gives 1e-15; a force that follows its body is of the order of one.
constexpr double kHasPotential = 1e-9;

using Mat12 = FollowerLoad::Stiffness;

/// Largest entry of A − Aᵀ as a part of the largest of A.
double unsymmetric_part(const Mat12& A) {
  const double size = A.cwiseAbs().maxCoeff();
  return size > 0.0 ? (A - A.transpose()).cwiseAbs().maxCoeff() / size : 0.0;
}

StepContext context_of(double load_factor) {
  StepContext context;
  context.load_factor = load_factor;
  context.t_n = load_factor;  // statics evaluates functions of time there
  context.conserving = false;
  return context;
}

struct PairStiffness {
  Mat12 K, change;
  double force = 0.0;
};
PairStiffness evaluate_pair(const System& system, const State& state, const StepContext& context,
                            const InteractionRef& ref) {
  const BodyStep a = system.instant(state, ref.a), b = system.instant(state, ref.b);
  const PairStep step{a, b, context, state.lambda.data() + ref.first_row,
                      state.history.data() + ref.first_history};
  PairTerms terms;
  terms.set_zero();
  const int item = ref.item;
  system.group(ref.group).evaluate({&item, 1}, {&step, 1}, {&terms, 1});
  PairStiffness pair;
  pair.change << terms.D_aa, terms.D_ab, terms.D_ba, terms.D_bb;
  const Vec3 M_a = terms.wrench_a.tail<3>(), M_b = terms.wrench_b.tail<3>();
  pair.K = -pair.change;
  pair.K.block<3, 3>(3, 3) -= 0.5 * hat(M_a);
  pair.K.block<3, 3>(9, 9) -= 0.5 * hat(M_b);
  const double length = system.length_scale();
  pair.force = std::max({terms.wrench_a.head<3>().norm(), terms.wrench_b.head<3>().norm(),
                         M_a.norm() / length, M_b.norm() / length});
  return pair;
}

void find_of_bodies(const System& system, const State& state, const StepContext& context,
                    std::vector<FollowerLoad>& found) {
  for (int i = 0; i < static_cast<int>(system.interactions().size()); ++i) {
    const InteractionRef& ref = system.interactions()[static_cast<std::size_t>(i)];
    if (ref.rows > 0) continue;
    const PairStiffness pair = evaluate_pair(system, state, context, ref);
    if (!pair.K.allFinite() || unsymmetric_part(pair.K) <= kHasPotential) continue;
    found.push_back({format("{} '{}'", system.group(ref.group).kind(), system.name(ref)),
                     pair.force, i, pair.K, pair.change});
  }
}

/// A product xᵀ(K y) − yᵀ(K x) with unrelated numbers vanishes for a symmetric K only.
void find_of_solids(const System& system, const State& state, const StepContext& context,
                    std::vector<FollowerLoad>& found) {
  const Nodes& nodes = system.nodes();
  const auto x = [](int k) { return std::sin(1.0 + 7.3 * k); };
  const auto y = [](int k) { return std::sin(2.0 + 3.7 * k); };
  std::vector<double> force, tangent, scratch;
  for (int g = 0; g < nodes.group_count(); ++g) {
    const ElementGroup& group = nodes.group(g);
    if (!group.external() || !group.has_tangent() || nodes.slots(g).empty()) continue;
    force.assign(3 * static_cast<std::size_t>(nodes.count()), 0.0);
    tangent.assign(9 * nodes.column().size(), 0.0);
    scratch.assign(nodes.scratch_size(), 0.0);
    const double* history = state.element_history.data() + nodes.first_history(g);
    group.begin_step(history, scratch.data() + nodes.first_scratch(g));
    (void)group.evaluate(node_instant(system, state, context), history,
                         scratch.data() + nodes.first_scratch(g), Mat3::Identity(),
                         ElementSink{force.data(), tangent.data(), nodes.slots(g).data()});
    double twist = 0.0, size = 0.0, most = 0.0;
    for (int i = 0; i < nodes.count(); ++i)
      for (int k = nodes.row_start()[i]; k < nodes.row_start()[i + 1]; ++k)
        for (int e = 0; e < 9; ++e) {
          const int row = 3 * i + e / 3, column = 3 * nodes.column()[k] + e % 3;
          const double v = tangent[9 * static_cast<std::size_t>(k) + static_cast<std::size_t>(e)];
          twist += v * (x(row) * y(column) - y(row) * x(column));
          size += std::abs(v);
        }
    for (const double f : force) most = std::max(most, std::abs(f));
    if (most > 0.0 && std::abs(twist) > kHasPotential * size)
      found.push_back({format("{} '{}'", group.kind(), group.name()), most});
  }
}

}  // namespace

std::vector<FollowerLoad> follower_loads(const System& system, const State& state,
                                         double load_factor) {
  const StepContext context = context_of(load_factor);
  std::vector<FollowerLoad> found;
  find_of_bodies(system, state, context, found);
  find_of_solids(system, state, context, found);
  return found;
}

FollowerLoad::Stiffness pair_stiffness(const System& system, const State& state, double load_factor,
                                       int interaction) {
  return evaluate_pair(system, state, context_of(load_factor),
                       system.interactions()[static_cast<std::size_t>(interaction)])
      .K;
}

}  // namespace polhode
