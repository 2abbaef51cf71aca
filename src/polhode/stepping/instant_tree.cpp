// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>

#include <polhode/core/assert.hpp>
#include <polhode/engines/tree_engine.hpp>
#include <polhode/newton/least_reactions.hpp>
#include <polhode/stepping/instant_system.hpp>
#include <polhode/stepping/instant_tree.hpp>

namespace polhode {

namespace {

std::vector<int> outside_lanes(const TreeLoopPlan& plan) {
  std::vector<int> list;
  for (const OffTreeInteraction& x : plan.extras)
    if (!x.in_lanes) list.push_back(x.interaction);
  return list;
}

constexpr int kBlockDoubles = sizeof(InstantBlock) / sizeof(double);

template <class T>
double* doubles(std::vector<T>& v) {
  return v.empty() ? nullptr : v.data()->x;
}

}  // namespace

bool InstantTree::takes(const System& system) {
  if (!system.nodes().empty() || system.body_count() == 0) return false;
  // The redundant part of reactions is rounding over ε, and friction that depends on it with them.
  if (LeastReactions::may_act(system)) return false;
  return std::none_of(
      system.interactions().begin(), system.interactions().end(),
      [&](const InteractionRef& ref) { return system.traits(ref).coupled_mass != 0.0; });
}

InstantTree::InstantTree(const System& system, const LaneKernels& kernels)
    : system_(&system),
      kernels_(&instant_kernels(kernels)),
      plan_(plan_tree_loops(system, false)),
      sweep_(system, outside_lanes(plan_)),
      mass_(mass_blocks(system)) {
  POLHODE_ASSERT(takes(system));
  context_.ga = GeneralizedAlpha::from_spectral_radius(0.0);  // α_f = 1: the instant itself
  context_.conserving = false;
  no_lambda_.assign(static_cast<std::size_t>(system.rows()), 0.0);
  lay_out();
  lay_out_loop_joints();
}

void InstantTree::lay_out() {
  const SpanningTree& tree = system_->tree();
  const int blocks = tree.slots / kLanes, ground = tree.slots;
  const auto slots = static_cast<std::size_t>(tree.slots);
  shape_.assign(static_cast<std::size_t>(blocks), 0);
  joint_.assign(static_cast<std::size_t>(blocks), 0);
  parent_.assign(slots, ground);
  gather_.assign(slots, blocks * kBlockDoubles);
  int joint_lanes = 0;
  for (const TreeRun& run : tree.runs)
    for (int b = run.first_block; b < run.first_block + run.blocks; ++b) {
      shape_[b] = run.shape;
      joint_[b] = joint_lanes * kLanes;
      joint_lanes += JointLayout::of_code(run.shape).lambda();
    }
  joint_data_.assign(static_cast<std::size_t>(joint_lanes), LaneData{});
  motion_.resize(static_cast<std::size_t>(blocks) + 1);
  lanes_.resize(static_cast<std::size_t>(blocks));
  body_.resize(slots + 1);
  std::memset(static_cast<void*>(motion_.data()), 0, motion_.size() * sizeof(InstantBlock));
  std::memset(static_cast<void*>(lanes_.data()), 0, lanes_.size() * sizeof(JointLanes));
  std::memset(static_cast<void*>(body_.data()), 0, body_.size() * sizeof(InstantBody));
  for (int i : {0, 4, 8}) std::fill_n(motion_.back().Lambda[i], kLanes, 1.0);

  for (const int body : tree.order) {
    const int s = tree.slot_of_body[body];
    order_.push_back(s);
    if (const int parent = tree.link[body].parent; parent != kGround) {
      parent_[s] = tree.slot_of_body[parent];
      gather_[s] = parent_[s] / kLanes * kBlockDoubles + parent_[s] % kLanes;
    }
  }
  for (int s = 0; s < tree.slots; ++s) {
    const JointLayout l = JointLayout::of_code(shape_[s / kLanes]);
    if (l.root()) {
      for (int i = 0; i < 6; ++i) body_[s].B[i][i] = 1.0;
      continue;
    }
    // Padding lanes hold a regular joint to the ground, so that no value there is infinite.
    MotionBasis basis;
    if (const int body = tree.body_of_slot[s]; body >= 0) {
      const InteractionRef& ref = system_->interactions()[tree.link[body].interaction];
      basis = *system_->group(ref.group).describe(ref.item).motion_basis;
      multipliers_.push_back(
          {lanes_[s / kLanes].lambda[0] + s % kLanes, kLanes, ref.first_row, ref.rows});
    }
    put_joint_constants(basis, l, doubles(joint_data_) + joint_[s / kLanes] + s % kLanes);
  }
  pair_.assign(static_cast<std::size_t>(plan_.pair_rows), LaneData{});
  kept_.assign(12 * plan_.open.size(), LaneData{});
  S_.assign(static_cast<std::size_t>(plan_.S_size + 7) / 8, LaneData{});
  loop_.resize(plan_.loops.size());
  std::memset(static_cast<void*>(loop_.data()), 0, loop_.size() * sizeof(InstantLoop));

  InstantView& v = view_;
  v.blocks = blocks;
  v.bodies = system_->body_count();
  v.loops = static_cast<int>(plan_.loops.size());
  v.ground_loops = static_cast<int>(plan_.ground_loops.size());
  v.soft = v.loops > 0;
  v.epsilon = v.soft ? kInstantProximal : 0.0;
  v.inverse_mass = 1.0 / system_->mean_mass();
  v.length = system_->length_scale();
  for (int i = 0; i < 3; ++i) v.gravity[i] = system_->gravity()[i];
  v.block_shape = shape_.data();
  v.slot_in_order = order_.data();
  v.parent = parent_.data();
  v.gather = gather_.data();
  v.joint = joint_.data();
  v.joint_data = doubles(joint_data_);
  v.mass = mass_.data();
  v.motion = motion_.data();
  v.lanes = lanes_.data();
  v.body = body_.data();
  v.loop = plan_.loops.data();
  v.later = plan_.later.data();
  v.product = plan_.product.data();
  v.ground_loop = plan_.ground_loops.data();
  v.first_open = plan_.first_open.data();
  v.open = plan_.open.data();
  v.first_update = plan_.first_update.data();
  v.update = plan_.update.data();
  v.first_common = plan_.first_common.data();
  v.common = plan_.common.data();
  v.pair_rows = doubles(pair_);
  v.kept = reinterpret_cast<RowData*>(doubles(kept_));
  v.S = doubles(S_);
  v.loop_data = loop_.data();
}

void InstantTree::lay_out_loop_joints() {
  const int ground = view_.blocks * kBlockDoubles;
  extra_index_.assign(system_->interactions().size(), -1);
  std::vector<const OffTreeInteraction*> joints;
  for (std::size_t i = 0; i < plan_.extras.size(); ++i) {
    const OffTreeInteraction& x = plan_.extras[i];
    POLHODE_ASSERT(x.loop < 0 || plan_.loops[x.loop].panels == 1);
    extra_index_[x.interaction] = static_cast<int>(i);
    if (x.in_lanes) {
      joints.push_back(&x);
      continue;
    }
    rows_outside_ = rows_outside_ || x.rows > 0;
    const InteractionRef& ref = system_->interactions()[x.interaction];
    for (const int body : {ref.a, ref.b})
      if (body != kGround) touched_.push_back(body);
  }
  std::sort(touched_.begin(), touched_.end());
  touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
  if (!sweep_.empty()) steps_.resize(static_cast<std::size_t>(system_->body_count()) + 1);

  std::stable_sort(joints.begin(), joints.end(),
                   [](const auto* x, const auto* y) { return x->rows < y->rows; });
  int size = 0;  // SIMD lanes of loop_constants_
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const OffTreeInteraction& x = *joints[i];
    const JointLayout layout{3, x.rows - 3};
    if (i == 0 || joints[i - 1]->rows != x.rows || loop_joints_.back().count == kLanes) {
      LoopJoints& fresh = loop_joints_.emplace_back();
      fresh.directions = layout.directions;
      fresh.data = kLanes * size;
      size += layout.lambda();
      loop_constants_.resize(static_cast<std::size_t>(size), LaneData{});
      for (int lane = 0; lane < kLanes; ++lane) {
        fresh.from_a[lane] = fresh.from_b[lane] = ground;
        put_joint_constants(MotionBasis{}, layout, doubles(loop_constants_) + fresh.data + lane);
      }
    }
    LoopJoints& block = loop_joints_.back();
    const int lane = block.count++;
    const InteractionRef& ref = system_->interactions()[x.interaction];
    const auto from = [&](int slot) {
      return slot < 0 ? ground : slot / kLanes * kBlockDoubles + slot % kLanes;
    };
    block.from_a[lane] = from(x.slot_a);
    block.from_b[lane] = from(x.slot_b);
    block.pair_a[lane] = x.pair_a;
    block.pair_b[lane] = x.pair_b;
    block.nu[lane] = x.loop;
    put_joint_constants(*system_->group(ref.group).describe(ref.item).motion_basis, layout,
                        doubles(loop_constants_) + block.data + lane);
    std::fill_n(loop_[x.loop].softness, x.rows, view_.epsilon);
    multipliers_.push_back({loop_[x.loop].y, 1, ref.first_row, ref.rows});
  }
  for (const OffTreeInteraction& x : plan_.extras)
    if (!x.in_lanes && x.rows > 0 && !x.further_part)
      multipliers_.push_back(
          {loop_[x.loop].y, 1, system_->interactions()[x.interaction].first_row, x.rows});
  view_.loop_blocks = static_cast<int>(loop_joints_.size());
  view_.loop_joints = loop_joints_.data();
  view_.loop_constants = doubles(loop_constants_);
}

void InstantTree::take_steps(const State& state) {
  context_.t_n = state.t;
  for (const int body : touched_) steps_[body] = system_->instant(state, body);
  steps_.back() = BodyStep::ground(1.0);
}

void InstantTree::put_rows(const OffTreeInteraction& x, const PairTerms& terms) {
  InstantLoop& loop = loop_[x.loop];
  if (!x.further_part) std::fill_n(loop.softness, kLanes, 0.0);
  const auto side = [&](int pair, bool first, const auto& G) {
    if (pair < 0) return;
    LaneData* rows = pair_.data() + pair;
    for (int i = 0; i < 6; ++i) {
      if (first) std::fill_n(rows[i].x, kLanes, 0.0);
      for (int k = 0; k < x.rows; ++k)
        if (terms.compliance[k] == 0.0) rows[i].x[k] += G(k, i);
    }
  };
  side(x.pair_a, x.first_at_a, terms.G_a);
  side(x.pair_b, x.first_at_b, terms.G_b);
  for (int k = 0; k < x.rows; ++k)
    loop.softness[k] += terms.compliance[k] == 0.0 ? view_.epsilon * terms.weight[k] : 1.0;
}

Vec6 InstantTree::prescribed_rates(const State& state, const InteractionRef& ref) const {
  if (!system_->traits(ref).prescribes) return Vec6::Zero();
  const PairView view = system_->instant(state, ref, no_lambda_.data());
  return system_->group(ref.group).prescribed(ref.item, view.step(), TimeSide::kAfter).rate;
}

void InstantTree::add_rates(const State& state, InstantRates& rates) {
  if (!rows_outside_) return;
  take_steps(state);
  const auto velocity = [&](int body) {
    Vec6 v = Vec6::Zero();
    if (body != kGround) v << steps_[body].v_n1, steps_[body].Lambda_n1 * steps_[body].W_n1;
    return v;
  };
  sweep_.run(
      steps_, context_, no_lambda_.data(), state.history.data(),
      [&](int i, const PairStep&, const PairTerms& terms) {
        const OffTreeInteraction& x = plan_.extras[extra_index_[i]];
        if (x.rows == 0) return;
        put_rows(x, terms);
        const InteractionRef& ref = system_->interactions()[i];
        const Vec6 v_a = velocity(ref.a), v_b = velocity(ref.b);
        const Vec6 rate = prescribed_rates(state, ref);
        double* value = loop_[x.loop].value;
        if (!x.further_part) std::fill_n(value, kLanes, 0.0);
        for (int k = 0; k < x.rows; ++k) {
          if (terms.compliance[k] != 0.0) continue;
          double sum = -rate[k], scale = std::abs(rate[k]);
          for (int c = 0; c < 6; ++c) {
            const double a = ref.a == kGround ? 0.0 : terms.G_a(k, c) * v_a[c];
            const double b = ref.b == kGround ? 0.0 : terms.G_b(k, c) * v_b[c];
            sum += a + b;
            scale += std::abs(a) + std::abs(b);
          }
          value[k] += sum;
          rates.scale = std::max(rates.scale, scale);
          if (ref.last_part && !(std::abs(value[k]) <= rates.value))
            rates.value = std::abs(value[k]);
        }
      },
      true);
}

void InstantTree::add_forces(const State& state, std::vector<double>& lambda) {
  if (sweep_.empty()) return;
  take_steps(state);
  const double per_mass = view_.inverse_mass;
  sweep_.run(steps_, context_, no_lambda_.data(), state.history.data(),
             [&](int i, const PairStep& step, const PairTerms& terms) {
               const OffTreeInteraction& x = plan_.extras[extra_index_[i]];
               const InteractionRef& ref = system_->interactions()[i];
               Vec6 wrench_a = terms.wrench_a, wrench_b = terms.wrench_b;
               if (x.rows > 0) {
                 Vec6 gamma = Vec6::Zero();
                 system_->group(ref.group).acceleration_terms(ref.item, step, gamma);
                 double* value = loop_[x.loop].value;
                 if (!x.further_part) std::fill_n(value, kLanes, 0.0);
                 for (int k = 0; k < x.rows; ++k) {
                   if (terms.compliance[k] == 0.0) {
                     value[k] += gamma[k];
                     continue;
                   }
                   const double force = -terms.g[k] / terms.compliance[k];
                   lambda[ref.first_row + k] = force;
                   wrench_a += force * terms.B_a.col(k);
                   wrench_b += force * terms.B_b.col(k);
                 }
               }
               const auto add = [&](int slot, const Vec6& wrench) {
                 if (slot < 0) return;
                 for (int k = 0; k < 6; ++k) body_[slot].load[k] += per_mass * wrench[k];
               };
               add(x.slot_a, wrench_a);
               add(x.slot_b, wrench_b);
             });
}

void InstantTree::move_centres(bool clear) {
  if (!view_.soft) return;
  for (JointLanes& lanes : lanes_)
    clear ? std::memset(lanes.centre, 0, sizeof lanes.centre)
          : std::memcpy(lanes.centre, lanes.lambda, sizeof lanes.centre);
  for (InstantLoop& loop : loop_)
    clear ? std::memset(loop.centre, 0, sizeof loop.centre)
          : std::memcpy(loop.centre, loop.y, sizeof loop.centre);
}

InstantTree::Outcome InstantTree::solve_rows(double load_scale) {
  Outcome outcome;
  move_centres(true);
  double before = std::numeric_limits<double>::infinity();
  while (outcome.solves < kMaxInstantRepeats) {
    const InstantResidual r = kernels_->solve(&view_);
    ++outcome.solves;
    outcome.solved = std::isfinite(r.residual) && std::isfinite(r.scale);
    if (!outcome.solved || !view_.soft) return outcome;
    outcome.residual = r.residual;
    const double scale = r.scale + load_scale;
    if (r.residual <= 16.0 * kInstantRoundOff * scale) return outcome;
    if (r.residual > 0.9 * before) {
      // As in InstantSolver: what no motion can satisfy adds the same multipliers each time.
      outcome.consistent = r.residual < 1e-6 * scale;
      if (outcome.consistent) return outcome;
      const int n = outcome.solves;
      const auto remove = [n](double& y, double centre) { y -= n * (y - centre); };
      for (JointLanes& lanes : lanes_)
        for (int i = 0; i < 6; ++i)
          for (int k = 0; k < kLanes; ++k) remove(lanes.lambda[i][k], lanes.centre[i][k]);
      for (InstantLoop& loop : loop_)
        for (int k = 0; k < kLanes; ++k) remove(loop.y[k], loop.centre[k]);
      return outcome;
    }
    before = r.residual;
    move_centres(false);
  }
  return outcome;
}

bool InstantTree::solve(State& state, std::span<const Vec6> more, VelocityReport& velocities,
                        InstantSolution& solution) {
  const SpanningTree& tree = system_->tree();
  kernels_->place(&view_, state.blocks.data());
  kernels_->assemble(&view_);
  InstantRates rates = kernels_->rates(&view_);
  add_rates(state, rates);
  velocities = {};
  velocities.residual = velocities.residual_before = rates.value;
  velocities.scale = rates.scale;
  for (const int s : order_) {
    const InstantBlock& m = motion_[s / kLanes];
    const int lane = s % kLanes;
    const Vec3 omega(m.omega[0][lane], m.omega[1][lane], m.omega[2][lane]);
    velocities.scale = std::max({velocities.scale, std::abs(m.v[0][lane]), std::abs(m.v[1][lane]),
                                 std::abs(m.v[2][lane]), view_.length * omega.norm()});
  }
  if (!S_.empty()) std::memset(S_.data(), 0, S_.size() * sizeof(LaneData));
  if (!kernels_->factor(&view_)) return false;
  if (!(rates.value <= 32.0 * kInstantRoundOff * rates.scale)) {
    for (const int s : order_) std::fill_n(body_[s].load, kLanes, 0.0);
    const Outcome outcome = solve_rows(0.0);
    if (!outcome.solved) return false;
    velocities.residual = outcome.residual;
    velocities.solves = outcome.solves;
    kernels_->add_velocities(&view_, state.blocks.data());
  }

  kernels_->velocity_terms(&view_);
  kernels_->loads(&view_);
  solution.lambda.assign(static_cast<std::size_t>(system_->rows()), 0.0);
  add_forces(state, solution.lambda);
  if (!more.empty())
    for (int b = 0; b < system_->body_count(); ++b)
      for (int k = 0; k < 6; ++k)
        body_[tree.slot_of_body[b]].load[k] += view_.inverse_mass * more[b][k];
  double load_scale = 0.0;
  for (const int s : order_)
    for (int k = 0; k < 6; ++k) load_scale = std::max(load_scale, std::abs(body_[s].load[k]));
  const Outcome outcome = solve_rows(load_scale);
  solution.solved = outcome.solved;
  solution.consistent = outcome.consistent;
  solution.residual = outcome.residual;
  if (!outcome.solved) return false;
  solution.r_ddot.resize(static_cast<std::size_t>(system_->body_count()));
  solution.alpha.resize(static_cast<std::size_t>(system_->body_count()));
  for (int b = 0; b < system_->body_count(); ++b) {
    const double* x = body_[tree.slot_of_body[b]].X;
    solution.r_ddot[b] = Vec3(x[0], x[1], x[2]);
    solution.alpha[b] = Vec3(x[3], x[4], x[5]);
  }
  for (const Multipliers& m : multipliers_)
    for (int i = 0; i < m.rows; ++i)
      solution.lambda[m.first_row + i] += system_->mean_mass() * m.from[m.apart * i];
  return true;
}

}  // namespace polhode
