// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include <polhode/core/disjoint_sets.hpp>
#include <polhode/equations/newton_system.hpp>
#include <polhode/joints/joint.hpp>
#include <polhode/newton/least_reactions.hpp>
#include <polhode/newton/rank_report.hpp>
#include <polhode/newton/redundant_rows.hpp>

namespace polhode {

namespace {

/// Whether a joint's friction depends on its reaction.
bool rubs_by_reaction(const System& system, const InteractionRef& ref) {
  if (!system.group(ref.group).is_of(kTypeTag<Joint>)) return false;
  const Joint& joint = items_of<Joint>(system.group(ref.group))[static_cast<std::size_t>(ref.item)];
  const Resistance* resistance = joint.resistance();
  return resistance && resistance->rubs_by_reaction() && !joint.penalised();
}

/// Connected components of the interactions with rows.
class RowComponents {
 public:
  explicit RowComponents(const System& system)
      : system_(system), sets_(static_cast<std::size_t>(system.body_count())) {
    for (const InteractionRef& ref : system.interactions()) {
      if (ref.rows > 0 && ref.a != kGround && ref.b != kGround) sets_.join(ref.a, ref.b);
      if (ref.further_part)
        sets_.join(moving_body(ref), moving_body(system.interactions()[ref.first_part]));
    }
  }
  /// Component of an interaction with rows, by its first body.
  [[nodiscard]] int of(const InteractionRef& ref) {
    return sets_.first_of(ref.a != kGround ? ref.a : ref.b);
  }
  /// By first body: 1 where friction depends on reactions and interactions with rows form a loop.
  [[nodiscard]] std::vector<char> with_friction() {
    const auto n = static_cast<std::size_t>(system_.body_count());
    std::vector<char> rubs(n, 0);
    std::vector<int> joints(n, 0), most(n, -1);
    for (int b = 0; b < system_.body_count(); ++b)
      ++most[static_cast<std::size_t>(sets_.first_of(b))];
    std::vector<char> grounded(n, 0);
    for (const InteractionRef& ref : system_.interactions()) {
      if (ref.rows == 0 || (ref.a == kGround && ref.b == kGround)) continue;
      const auto c = static_cast<std::size_t>(of(ref));
      ++joints[c];
      if (ref.a == kGround || ref.b == kGround) grounded[c] = 1;
      if (rubs_by_reaction(system_, ref)) rubs[c] = 1;
    }
    // A tree of n bodies has n − 1 joints between them, and one to the ground at most.
    for (std::size_t c = 0; c < n; ++c)
      if (joints[c] <= most[c] + grounded[c]) rubs[c] = 0;
    return rubs;
  }

 private:
  const System& system_;
  DisjointSets sets_;
};

}  // namespace

struct LeastReactions::Impl {
  const System& system;
  std::vector<int> interactions;  ///< Those that take part.
  std::vector<int> bodies;        ///< Theirs.
  std::vector<int> row;           ///< By own row: that of the system.
  std::vector<int> pair;          ///< By interaction of the system: own pair, or −1.
  linear::KktTopology topology;
  InteractionSweep sweep;
  std::vector<BodyStep> steps;  ///< By body of the system, the ground last.
  std::optional<RedundantRows> at_n, at_n1;
  /// At n + 1, with ε = 0 in rows that have no proximal centre; nothing if all have one.
  std::optional<RedundantRows> without_centres;
  std::vector<char> has_centre;  ///< By own pair.
  Vec lambda, part, mean;        ///< By own row.
  double weight_n1 = 0.5;        ///< α_f

  Impl(const System& s, std::vector<int> members)
      : system(s), interactions(std::move(members)), sweep(s, interactions) {
    std::vector<int> place(static_cast<std::size_t>(system.body_count()), -1);
    const auto own = [&](int body) {
      if (body == kGround) return kGround;
      int& at = place[static_cast<std::size_t>(body)];
      if (at < 0) {
        at = static_cast<int>(bodies.size());
        bodies.push_back(body);
      }
      return at;
    };
    pair.assign(system.interactions().size(), -1);
    for (const int i : interactions) {
      const InteractionRef& ref = system.interactions()[static_cast<std::size_t>(i)];
      pair[static_cast<std::size_t>(i)] = static_cast<int>(topology.pairs.size());
      const int a = own(ref.a), b = own(ref.b);
      if (ref.further_part) {  // the row of the part before
        topology.pairs.push_back({a, b, ref.rows, static_cast<int>(row.size()) - 1});
        continue;
      }
      topology.pairs.push_back({a, b, ref.rows, static_cast<int>(row.size())});
      for (int k = 0; k < ref.rows; ++k) row.push_back(ref.first_row + k);
    }
    topology.bodies = static_cast<int>(bodies.size());
    topology.rows = static_cast<int>(row.size());
    topology.fused = system.fused();
    steps.resize(static_cast<std::size_t>(system.body_count()) + 1);
    lambda = part = mean = Vec::Zero(topology.rows);
    at_n.emplace(topology, system.length_scale());
    at_n1.emplace(topology, system.length_scale());
  }

  /// Finds which rows have a proximal centre in the engine.
  void take_centres(const NewtonEngine& engine) {
    if (!has_centre.empty()) return;
    for (const int i : interactions) has_centre.push_back(engine.has_centre(i) ? 1 : 0);
    if (std::find(has_centre.begin(), has_centre.end(), 0) != has_centre.end())
      without_centres.emplace(topology, system.length_scale());
  }
  void put(RedundantRows& rows, const StepContext& context, const Trial& trial,
           const State& state) {
    sweep.run(
        steps, context, trial.lambda.data(), state.history.data(),
        [&](int i, const PairStep&, const PairTerms& terms) {
          rows.put(pair[static_cast<std::size_t>(i)], terms);
        },
        true);
  }
};

bool LeastReactions::may_act(const System& system) {
  const std::vector<char> rubs = RowComponents(system).with_friction();
  return std::find(rubs.begin(), rubs.end(), 1) != rubs.end();
}

LeastReactions::LeastReactions(const System& system, const State& assembled) {
  RowComponents components(system);
  const std::vector<char> rubs = components.with_friction();
  std::vector<char> redundant(rubs.size(), 0);
  const auto mark = [&](int interaction) {
    const InteractionRef& ref = system.interactions()[static_cast<std::size_t>(interaction)];
    if (ref.a != kGround || ref.b != kGround)
      redundant[static_cast<std::size_t>(components.of(ref))] = 1;
  };
  State all_on = assembled;  // what is switched on later may make rows redundant
  for (const InteractionRef& ref : system.interactions())
    if (const int off = system.traits(ref).off; off >= 0)
      all_on.history[static_cast<std::size_t>(ref.first_history + off)] = 0.0;
  for (const int i : rank_report(system, all_on).involved) mark(i);
  std::vector<int> members;
  const auto count = static_cast<int>(system.interactions().size());
  for (int i = 0; i < count; ++i) {
    const InteractionRef& ref = system.interactions()[static_cast<std::size_t>(i)];
    if (ref.rows == 0 || (ref.a == kGround && ref.b == kGround)) continue;
    const auto c = static_cast<std::size_t>(components.of(ref));
    if (rubs[c] != 0 && redundant[c] != 0) members.push_back(i);
  }
  if (!members.empty()) impl_ = std::make_unique<Impl>(system, std::move(members));
}

LeastReactions::~LeastReactions() = default;
LeastReactions::LeastReactions(LeastReactions&&) noexcept = default;

bool LeastReactions::act() const { return impl_ != nullptr; }

bool LeastReactions::begin_step(const State& state, const Trial& trial, NewtonEngine& engine) {
  Impl& s = *impl_;
  engine.set_proximal(kLeastProximal);
  s.take_centres(engine);
  s.weight_n1 = trial.context.ga.alpha_f;
  StepContext instant;
  instant.ga = GeneralizedAlpha::from_spectral_radius(0.0);
  instant.t_n = state.t;
  instant.conserving = false;
  for (const int body : s.bodies)
    s.steps[static_cast<std::size_t>(body)] = s.system.instant(state, body);
  s.steps.back() = BodyStep::ground(1.0);
  s.put(*s.at_n, instant, trial, state);
  return s.at_n->factor();
}

/// @eq{least-reactions}
bool LeastReactions::apply(const State& state, Trial& trial, NewtonEngine& engine) {
  Impl& s = *impl_;
  for (const int body : s.bodies)
    s.steps[static_cast<std::size_t>(body)] = body_step(s.system, state, trial, body);
  s.steps.back() = BodyStep::ground(trial.context.ga.alpha_f);
  s.put(*s.at_n1, trial.context, trial, state);
  if (s.without_centres) s.without_centres->put(*s.at_n1, s.has_centre);
  if (!s.at_n1->factor() || (s.without_centres && !s.without_centres->factor())) return false;

  engine.store_multipliers(trial);
  for (int k = 0; k < s.topology.rows; ++k)
    s.lambda[k] = trial.lambda[static_cast<std::size_t>(s.row[static_cast<std::size_t>(k)])];
  s.at_n->redundant_part(s.lambda, s.mean);
  s.mean = (1.0 - s.weight_n1) * s.mean + s.weight_n1 * s.lambda;
  s.at_n1->redundant_part(s.mean, s.part);
  s.lambda -= s.part;
  (s.without_centres ? *s.without_centres : *s.at_n1).unreachable_part(s.part);
  if (!s.lambda.allFinite() || !s.part.allFinite()) return false;
  const double per_scale = 1.0 / trial.scale(s.system);
  for (int p = 0; p < static_cast<int>(s.topology.pairs.size()); ++p) {
    const linear::KktPair& own = s.topology.pairs[static_cast<std::size_t>(p)];
    for (int k = 0; k < own.rows; ++k) {
      const int r = own.first_row + k;
      const auto at = static_cast<std::size_t>(s.row[static_cast<std::size_t>(r)]);
      const double softness = s.at_n1->softness(p, k);
      trial.lambda[at] = trial.lambda_centre[at] = s.lambda[r];
      // εW s (λ − λ_c) cancels the part of the row that no motion can change.
      if (softness > 0.0 && softness != 1.0 && s.has_centre[static_cast<std::size_t>(p)] != 0)
        trial.lambda_centre[at] += per_scale / softness * s.part[r];
    }
  }
  engine.load_multipliers(trial);
  return true;
}

}  // namespace polhode
