// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <polhode/core/assert.hpp>
#include <polhode/core/format.hpp>
#include <polhode/equations/newton_system.hpp>

namespace polhode {

namespace {

/// Items per virtual call: their terms fit into the second-level cache.
constexpr int kBatch = 64;

}  // namespace

KktMap kkt_map(const System& system) {
  KktMap map;
  map.topology.bodies = system.body_count();
  map.topology.rows = system.rows();
  map.topology.fused = system.fused();
  for (const InteractionRef& ref : system.interactions()) {
    const bool couples = ref.rows > 0 || (ref.a != kGround && ref.b != kGround);
    map.pair.push_back(couples ? static_cast<int>(map.topology.pairs.size()) : -1);
    if (couples) map.topology.pairs.push_back({ref.a, ref.b, ref.rows, ref.first_row});
  }
  return map;
}

namespace {

std::vector<int> all_interactions(const System& system) {
  std::vector<int> all(system.interactions().size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

}  // namespace

bool acts_beside_rows(const System& system, int interaction) {
  return system.tree().in_tree[interaction] != 0 &&
         system.traits(system.interactions()[interaction]).works;
}

InteractionSweep::InteractionSweep(const System& system)
    : InteractionSweep(system, all_interactions(system)) {}

InteractionSweep::InteractionSweep(const System& system, std::vector<int> interactions)
    : system_(&system), interactions_(std::move(interactions)) {
  POLHODE_ASSERT(is_strictly_ascending(interactions_));
  for (int i = 0; i < static_cast<int>(interactions_.size()); ++i) {
    const InteractionRef& ref = system.interactions()[interactions_[i]];
    if (batches_.empty() || batches_.back().group != ref.group || batches_.back().count == kBatch)
      batches_.push_back({ref.group, i, 0, false});
    ++batches_.back().count;
    if (ref.rows > 0) batches_.back().has_rows = true;
    if (ref.shares_row()) batches_.back().has_parts = true;
  }
  const auto most =
      static_cast<std::size_t>(std::min(kBatch, static_cast<int>(interactions_.size())));
  items_.reserve(most);
  pair_steps_.reserve(most);
  terms_.resize(most);
  for (PairTerms& t : terms_) t.set_zero();
}

void InteractionSweep::evaluate(const Batch& batch, std::span<const BodyStep> steps,
                                const StepContext& context, const double* lambda,
                                const double* history) {
  items_.clear();
  pair_steps_.clear();
  const auto step_of = [&](int body) -> const BodyStep& {
    return body == kGround ? steps.back() : steps[body];
  };
  for (int k = 0; k < batch.count; ++k) {
    const InteractionRef& ref = system_->interactions()[interactions_[batch.first + k]];
    items_.push_back(ref.item);
    pair_steps_.push_back({step_of(ref.a), step_of(ref.b), context,
                           lambda ? lambda + ref.first_row : nullptr, history + ref.first_history});
  }
  system_->group(batch.group).evaluate(items_, pair_steps_, std::span(terms_).first(items_.size()));
  if (batch.has_parts) gather_parts(batch);
}

void InteractionSweep::gather_parts(const Batch& batch) {
  for (int k = 0; k < batch.count; ++k) {
    const InteractionRef& ref = system_->interactions()[interactions_[batch.first + k]];
    if (!ref.shares_row()) continue;
    if (!ref.further_part) of_parts_ = 0.0;
    of_parts_ += terms_[k].g[0];
    terms_[k].g[0] = ref.last_part ? of_parts_ : 0.0;
    if (!ref.last_part) terms_[k].weight[0] = 0.0;
  }
}

NewtonSystem::NewtonSystem(const System& system, MomentumRate form)
    : system_(&system),
      form_(form),
      map_(kkt_map(system)),
      own_pairs_(map_.topology.pairs.size()),
      sweep_(system) {
  const auto n = static_cast<std::size_t>(system.body_count());
  steps_.resize(n + 1);
  values_.diagonal.resize(n);
  values_.pairs.resize(map_.topology.pairs.size());
  rhs_ = Vec::Zero(static_cast<Eigen::Index>(6 * n) + system.rows());
  body_residual_.assign(n, Vec6::Zero());
  body_scale_.assign(n, Vec6::Zero());
  row_residual_.assign(system.rows(), 0.0);
  is_spring_.assign(system.rows(), false);
}

void NewtonSystem::couple(const std::vector<linear::KktPair>& more) {
  std::vector<linear::KktPair>& pairs = map_.topology.pairs;
  pairs.resize(own_pairs_);
  pairs.insert(pairs.end(), more.begin(), more.end());
  values_.pairs.resize(pairs.size());
}

std::span<linear::KktValues::Pair> NewtonSystem::cleared_couplings() {
  const auto couplings = std::span(values_.pairs).subspan(own_pairs_);
  for (linear::KktValues::Pair& v : couplings) {
    v.K_ab.setZero();
    v.K_ba.setZero();
  }
  return couplings;
}

void NewtonSystem::take_steps(const State& state, const Trial& trial) {
  for (int b = 0; b < system_->body_count(); ++b) steps_[b] = body_step(*system_, state, trial, b);
  steps_.back() = BodyStep::ground(trial.context.ga.alpha_f);
}

void NewtonSystem::assemble(const State& state, const Trial& trial, bool tangent) {
  take_steps(state, trial);
  const double s = trial.scale(*system_);
  for (int b = 0; b < system_->body_count(); ++b) {
    const BodyData& body = system_->bodies()[b];
    if (static_) {
      const Vec3 weight = trial.context.load_factor * body.mass * system_->gravity();
      body_residual_[b] << -weight, Vec3::Zero();
      body_scale_[b] << weight.cwiseAbs(), Vec3::Zero();
      if (tangent) values_.diagonal[b].setZero();
      continue;
    }
    const MomentumRates m = momentum_rates(body.mass, body.inertia, system_->motion(state, b),
                                           steps_[b], trial.context, form_);
    Vec6& R = body_residual_[b];
    const Vec3 weight = trial.context.load_factor * body.mass * system_->gravity();
    R.head<3>() = m.p_dot - weight;
    R.tail<3>() = m.h_dot;
    body_scale_[b].head<3>() = m.p_dot.cwiseAbs() + weight.cwiseAbs();
    body_scale_[b].tail<3>() = m.h_dot.cwiseAbs();
    if (tangent) {
      Mat6& K = values_.diagonal[b];
      K.setZero();
      K.topLeftCorner<3, 3>().diagonal().setConstant(s * m.K_r);
      K.bottomRightCorner<3, 3>() = s * m.K_theta;
    }
  }
  sweep_.run(steps_, trial.context, trial.lambda.data(), state.history.data(),
             [&](int interaction, const PairStep&, const PairTerms& terms) {
               add_pair(interaction, terms, trial, s, tangent);
             });
  for (int b = 0; b < system_->body_count(); ++b) rhs_.segment<6>(6 * b) = -s * body_residual_[b];
}

void NewtonSystem::add_pair(int interaction, const PairTerms& terms, const Trial& trial, double s,
                            bool tangent) {
  const InteractionRef& ref = system_->interactions()[interaction];
  const auto add_side = [&](int body, const Vec6& wrench, const Mat6& D) {
    if (body == kGround) return;
    body_residual_[body] -= wrench;
    body_scale_[body] += wrench.cwiseAbs();
    if (tangent) values_.diagonal[body] -= s * D;
  };
  add_side(ref.a, terms.wrench_a, terms.D_aa);
  add_side(ref.b, terms.wrench_b, terms.D_bb);
  const int pair = map_.pair[interaction];
  if (pair < 0) return;

  const int first = 6 * system_->body_count();
  for (int k = 0; k < ref.rows; ++k) {
    const int row = ref.first_row + k;
    const double lambda = trial.lambda[row];
    row_residual_[row] = terms.g[k] + terms.compliance[k] * lambda;
    is_spring_[row] = terms.compliance[k] != 0.0;
    const double proximal =
        is_spring_[row] ? 0.0
                        : proximal_ * terms.weight[k] * s * (lambda - trial.lambda_centre[row]);
    rhs_[first + row] = -(row_residual_[row] + proximal);
  }
  if (!tangent) return;
  linear::KktValues::Pair& v = values_.pairs[pair];
  v.K_ab = -s * terms.D_ab;
  v.K_ba = -s * terms.D_ba;
  v.B_a = terms.B_a;
  v.B_b = terms.B_b;
  v.G_a = terms.G_a;
  v.G_b = terms.G_b;
  for (int k = 0; k < ref.rows; ++k)
    v.C[k] = terms.compliance[k] == 0.0 ? proximal_ * terms.weight[k] : terms.compliance[k] / s;
}

void add_rows(const InteractionRef& ref, const PairStep& step, const PairTerms& terms,
              const Trial& trial, double length_scale, ConstraintCheck& check) {
  const double reach =
      length_scale + std::max(step.a.r_n1.cwiseAbs().sum(), step.b.r_n1.cwiseAbs().sum());
  for (int k = 0; k < ref.rows; ++k) {
    const int row = ref.first_row + k;
    const double lambda = trial.lambda[row];
    const double g = terms.g[k] + terms.compliance[k] * lambda;
    if (!(std::abs(g) <= check.residual)) {  // a NaN counts as the largest
      check.residual = std::abs(g);
      check.worst_row = row;
    }
    check.work_defect += std::abs(lambda * g);
    check.work_scale += std::abs(lambda) * reach;
  }
}

ConstraintCheck NewtonSystem::check(const State& state, const Trial& trial) {
  take_steps(state, trial);
  ConstraintCheck check;
  sweep_.run(
      steps_, trial.context, trial.lambda.data(), state.history.data(),
      [&](int interaction, const PairStep& step, const PairTerms& terms) {
        const InteractionRef& ref = system_->interactions()[interaction];
        for (int k = 0; k < ref.rows; ++k)
          row_residual_[ref.first_row + k] =
              terms.g[k] + terms.compliance[k] * trial.lambda[ref.first_row + k];
        add_rows(ref, step, terms, trial, system_->length_scale(), check);
      },
      true);
  return check;
}

std::string WorstResidual::text(const System& system) const {
  if (body < 0) return "no residual";
  return format("{} {} of body '{}': {:.3g} {}, {:.0g} times its round-off",
                component < 3 ? "force" : "moment", "xyz"[component % 3],
                system.bodies()[body].name, value, component < 3 ? "N" : "N m", over_noise);
}

WorstResidual worst_residual(const NewtonSystem& assembled) {
  WorstResidual worst;
  for (int b = 0; b < assembled.system().body_count(); ++b)
    for (int i = 0; i < 6; ++i) {
      const double value = assembled.body_residual(b)[i];
      const double noise =
          std::numeric_limits<double>::epsilon() *
          std::max(assembled.body_residual_scale(b).maxCoeff(), std::numeric_limits<double>::min());
      if (!(std::abs(value) / noise <= worst.over_noise) || worst.body < 0)
        worst = {b, i, value, std::abs(value) / noise};
    }
  return worst;
}

}  // namespace polhode
