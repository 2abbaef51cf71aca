// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <polhode/engines/tree_engine.hpp>

namespace polhode {

namespace {

/// ε of loop rows. Tree joints have none, so redundant loops need a larger value than the sparse
/// engine's rows.
constexpr double kProximalOfLoops = 1e-11;

/// Interactions evaluated one by one: those of the tree, or outside it.
std::vector<int> not_in_lanes(const System& system, const TreeLoopPlan& plan, bool in_tree) {
  std::vector<int> list;
  for (const OffTreeInteraction& x : plan.extras)
    if (!x.in_lanes && (system.tree().in_tree[x.interaction] != 0) == in_tree)
      list.push_back(x.interaction);
  return list;
}

/// Whether an interaction exerts no force, nor would by a small motion.
bool is_zero(const PairTerms& t) {
  return t.wrench_a.isZero(0.0) && t.wrench_b.isZero(0.0) && t.D_aa.isZero(0.0) &&
         t.D_bb.isZero(0.0);
}

template <class T>
double* doubles(std::vector<T>& v) {
  return v.empty() ? nullptr : v.data()->x;
}

}  // namespace

std::vector<MassBlock> mass_blocks(const System& system) {
  const SpanningTree& tree = system.tree();
  std::vector<MassBlock> mass(tree.slots / kLanes);
  for (int s = 0; s < tree.slots; ++s) {
    const int body = tree.body_of_slot[s];
    const double m = body < 0 ? 1.0 : system.bodies()[body].mass;
    const Mat3 J = body < 0 ? Mat3::Identity() : system.bodies()[body].inertia;
    MassBlock& block = mass[s / kLanes];
    const int lane = s % kLanes;
    block.mass[lane] = m;
    const double entries[6] = {J(0, 0), J(1, 1), J(2, 2), J(0, 1), J(0, 2), J(1, 2)};
    for (int i = 0; i < 6; ++i) block.J[i][lane] = entries[i];
  }
  return mass;
}

void put_joint_constants(const MotionBasis& basis, const JointLayout& l, double* lane) {
  const auto put = [&](int field, const Vec3& x) {
    for (int i = 0; i < 3; ++i) lane[8 * (field + i)] = x[i];
  };
  put(l.Z_a(), basis.Z_a);
  put(l.Z_b(), basis.Z_b);
  const Vec3 x_a = basis.R_a.col(0), z_a = basis.R_a.col(2);
  const Vec3 x_b = basis.R_b.col(0), y_b = basis.R_b.col(1);
  std::vector<Vec3> directors;
  if (l.directions == 1) directors = {x_a, y_b};
  if (l.directions == 2) directors = {z_a, x_b, y_b};
  if (l.directions == 3) directors = {z_a, x_a, x_b, y_b};
  for (int i = 0; i < static_cast<int>(directors.size()); ++i)
    put(l.director() + 3 * i, directors[i]);
  if (l.slides() > 0) {
    put(l.slide(), basis.slide[0]);
    put(l.slide() + 3, l.translation == 2 ? basis.slide[1] : Vec3(basis.slide[0].unitOrthogonal()));
  }
}

TreeEngine::TreeEngine(const System& system, const std::string& isa)
    : system_(&system),
      kernels_(&lane_kernels(isa)),
      plan_(plan_tree_loops(system)),
      sweep_(system, not_in_lanes(system, plan_, false)),
      beside_rows_(system, not_in_lanes(system, plan_, true)),
      mass_(mass_blocks(system)) {
  lay_out();
  lay_out_loop_joints();
  fill_joint_constants();
}

int TreeEngine::trial_offset(int slot) const {
  constexpr int kTrialDoubles = sizeof(TrialBlock) / sizeof(double);
  const int ground = system_->tree().slots / kLanes;  // the trial's last block
  return slot < 0 ? ground * kTrialDoubles : slot / kLanes * kTrialDoubles + slot % kLanes;
}

void TreeEngine::lay_out() {
  const SpanningTree& tree = system_->tree();
  const int blocks = tree.slots / kLanes;
  parent_.assign(tree.slots, -1);
  shape_.assign(tree.slots, 0);
  gather_.assign(tree.slots, trial_offset(-1));
  y_row_.assign(tree.slots, 0);
  has_children_.assign(tree.slots, 0);
  first_child_.assign(tree.slots, 0);
  slot_in_order_.clear();
  for (int body : tree.order) {
    const int s = tree.slot_of_body[body];
    slot_in_order_.push_back(s);
    if (tree.link[body].parent != kGround) parent_[s] = tree.slot_of_body[tree.link[body].parent];
    gather_[s] = trial_offset(parent_[s]);
  }
  for (auto s = slot_in_order_.rbegin(); s != slot_in_order_.rend(); ++s) {
    if (parent_[*s] < 0) continue;
    first_child_[*s] = has_children_[parent_[*s]] ? 0 : 1;
    has_children_[parent_[*s]] = 1;
  }
  joint_.assign(blocks, 0);
  int joint_lanes = 0;
  for (const TreeRun& run : tree.runs)
    for (int b = run.first_block; b < run.first_block + run.blocks; ++b) {
      joint_[b] = joint_lanes * kLanes;
      joint_lanes += JointLayout::of_code(run.shape).size();
      for (int l = 0; l < kLanes; ++l) shape_[b * kLanes + l] = run.shape;
    }
  int rows = 0;
  for (int s : slot_in_order_) {
    y_row_[s] = rows;
    rows += JointLayout::of_code(shape_[s]).free();
  }
  joint_data_.assign(joint_lanes, LaneData{});
  Y_.assign(rows, LaneData{});
  body_.assign(tree.slots + 1, EliminatedBody{});
  body_.back().X[7] = 1.0;  // the ground's increment
  extra_rows_.assign(plan_.extra_count, ExtraRows{});
  couples_.resize(plan_.couple_count);
  edge_rows_.assign(plan_.edge_count, EdgeRows{});
  pair_.assign(plan_.pair_rows, LaneData{});
  kept_.assign(plan_.kept_rows, LaneData{});
  S_.assign((plan_.S_size + 7) / 8, LaneData{});
  nu_.assign(plan_.nu_size / 8, LaneData{});
  y_.assign(plan_.nu_size / 8, LaneData{});
  U_.assign(plan_.U_rows, LaneData{});
  pivots_.assign(plan_.nu_size, 0);

  extra_index_.assign(system_->interactions().size(), -1);
  for (int i = 0; i < static_cast<int>(plan_.extras.size()); ++i) {
    const OffTreeInteraction& x = plan_.extras[i];
    extra_index_[x.interaction] = i;
    if (x.in_lanes) continue;
    loops_outside_ = loops_outside_ || x.rows > 0;
    const InteractionRef& ref = system_->interactions()[x.interaction];
    // Exact rows alone are functions of the configuration; forces beside them are of rates, too.
    rates_ = rates_ || system_->traits(ref).works;
    for (int body : {ref.a, ref.b})
      if (body != kGround) touched_.push_back(body);
  }
  std::sort(touched_.begin(), touched_.end());
  touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
  if (!touched_.empty()) steps_.resize(system_->body_count() + 1);

  TreeView& v = view_;
  v.bodies = system_->body_count();
  v.blocks = blocks;
  v.chunks = static_cast<int>(tree.chunks.size());
  v.run = tree.runs.data();
  v.chunk = tree.chunks.data();
  v.slot_in_order = slot_in_order_.data();
  v.parent = parent_.data();
  v.gather = gather_.data();
  v.shape = shape_.data();
  v.has_children = has_children_.data();
  v.first_child = first_child_.data();
  v.extra = plan_.extra_of_slot.data();
  v.edge = plan_.edge_of_slot.data();
  v.y_row = y_row_.data();
  v.joint = joint_.data();
  v.mass = mass_.data();
  v.joint_data = doubles(joint_data_);
  v.body = body_.data();
  v.Y = reinterpret_cast<RowData*>(doubles(Y_));
  v.extra_rows = extra_rows_.data();
  v.edge_rows = edge_rows_.data();
  v.loops = static_cast<int>(plan_.loops.size());
  v.ground_loops = static_cast<int>(plan_.ground_loops.size());
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
  v.kept_rows = doubles(kept_);
  v.S = doubles(S_);
  v.nu = doubles(nu_);
  v.y = doubles(y_);
  v.pivots = pivots_.data();
  v.U = doubles(U_);
  v.proximal = kProximalOfLoops;
  for (int i = 0; i < 3; ++i) v.gravity[i] = system_->gravity()[i];
  v.inverse_mass = 1.0 / system_->mean_mass();
  v.inverse_length = 1.0 / system_->length_scale();
}

void TreeEngine::fill_joint_constants() {
  const SpanningTree& tree = system_->tree();
  for (int s = 0; s < tree.slots; ++s) {
    const JointLayout l = JointLayout::of_code(shape_[s]);
    if (l.root()) continue;
    // Padding lanes hold a regular joint to the ground, so that no value there is infinite.
    MotionBasis basis;
    const int body = tree.body_of_slot[s];
    if (body >= 0) {
      const InteractionRef& ref = system_->interactions()[tree.link[body].interaction];
      basis = *system_->group(ref.group).describe(ref.item).motion_basis;
      tree_joints_.push_back(
          {joint_[s / kLanes] + 8 * l.lambda() + s % kLanes, ref.first_row, ref.rows});
    }
    put_joint_constants(basis, l, view_.joint_data + joint_[s / kLanes] + s % kLanes);
  }
}

template <class Move>
void TreeEngine::for_each_tree_joint(Move&& move) {
  for (const TreeJoint& joint : tree_joints_)
    for (int i = 0; i < joint.rows; ++i)
      move(view_.joint_data[joint.lambda + 8 * i], joint.first_row + i);
}

void TreeEngine::set_step(const State& state, Trial& trial) {
  const GeneralizedAlpha& ga = trial.context.ga;
  TreeView& v = view_;
  v.state = state.blocks.data();
  v.trial = trial.blocks.data();
  v.scale = trial.scale(*system_);
  v.alpha_f = ga.alpha_f;
  v.alpha_m = ga.alpha_m;
  v.beta = ga.beta;
  v.gamma = ga.gamma;
  v.kappa = ga.kappa;
  v.c = ga.c;
  v.c_A = ga.c_A;
  v.dt = trial.context.dt;
  v.lambda = trial.lambda.data();
  v.lambda_centre = trial.lambda_centre.data();
}

void TreeEngine::begin_step(const State& state, Trial& trial) {
  set_step(state, trial);
  view_.first_iteration = 1;
  load_multipliers(trial);
}

void TreeEngine::load_multipliers(const Trial& trial) {
  for_each_tree_joint([&](double& lane, int row) { lane = trial.lambda[row]; });
}

void TreeEngine::store_multipliers(Trial& trial) {
  for_each_tree_joint([&](double& lane, int row) { trial.lambda[row] = lane; });
}

void TreeEngine::end_step(const State&, Trial& trial) { store_multipliers(trial); }

void TreeEngine::take_steps(const State& state, const Trial& trial, bool first) {
  if (first) {
    for (int body : touched_) steps_[body] = body_step(*system_, state, trial, body);
    steps_.back() = BodyStep::ground(trial.context.ga.alpha_f);
    return;
  }
  for (int body : touched_) update_body_step(*system_, state, trial, body, steps_[body], rates_);
}

void TreeEngine::evaluate_extras(const State& state, const Trial& trial) {
  if (plan_.extras.empty()) return;
  for (ExtraRows& e : extra_rows_) std::memset(e.A, 0, sizeof e.A);
  for (EdgeRows& e : edge_rows_) std::memset(static_cast<void*>(&e), 0, sizeof e);
  if (!S_.empty()) std::memset(S_.data(), 0, S_.size() * sizeof(LaneData));
  if (touched_.empty()) return;
  take_steps(state, trial, view_.first_iteration != 0);
  sweep_.run(steps_, trial.context, trial.lambda.data(), state.history.data(),
             [&](int interaction, const PairStep&, const PairTerms& terms) {
               add_extra(plan_.extras[extra_index_[interaction]], terms, trial);
             });
  beside_rows_.run(steps_, trial.context, nullptr, state.history.data(),
                   [&](int interaction, const PairStep&, const PairTerms& terms) {
                     if (is_zero(terms)) return;  // away from all stops
                     add_extra(plan_.extras[extra_index_[interaction]], terms, trial);
                   });
}

Iteration TreeEngine::iterate(const State& state, Trial& trial, bool /*refactor*/, double damping) {
  Iteration done;
  evaluate_extras(state, trial);
  view_.damping = damping;
  int failed = -1;
  if (!kernels_->up(&view_, &failed)) {
    done.worst_body = failed < 0 ? -1 : system_->tree().body_of_slot[failed];
    return done;
  }
  const SweepResult result = kernels_->down(&view_);
  view_.first_iteration = 0;
  move_multipliers(trial, damping);
  done.increment = result.increment;
  done.rotation = std::sqrt(result.rotation_squared);
  done.solved = std::isfinite(result.increment) && std::isfinite(result.rotation_squared);
  return done;
}

int TreeEngine::worst_body() const {
  int worst = -1;
  double most = -1.0;
  for (int s = 0; s < system_->tree().slots; ++s) {
    if (system_->tree().body_of_slot[s] < 0) continue;
    for (int i = 0; i < 6; ++i) {
      const double size = std::abs(body_[s].X[i]) * (i < 3 ? view_.inverse_length : 1.0);
      if (!(size <= most)) {
        most = std::isnan(size) ? std::numeric_limits<double>::infinity() : size;
        worst = system_->tree().body_of_slot[s];
      }
    }
  }
  return worst;
}

ConstraintCheck TreeEngine::check(const State& state, Trial& trial) {
  ConstraintCheck c;
  LaneCheck lanes;
  kernels_->check(&view_, system_->tree().body_of_slot.data(), &lanes);
  c.residual = lanes.largest;
  c.work_defect = lanes.work_defect;
  c.work_scale = lanes.work_scale;
  c.worst_row = lanes.worst_row;
  if (lanes.worst_slot >= 0) {
    const int body = system_->tree().body_of_slot[lanes.worst_slot];
    c.worst_row = system_->interactions()[system_->tree().link[body].interaction].first_row;
  }
  if (!loops_outside_) return c;
  take_steps(state, trial, false);
  StepContext values_only = trial.context;
  values_only.tangents = false;
  sweep_.run(
      steps_, values_only, trial.lambda.data(), state.history.data(),
      [&](int interaction, const PairStep& step, const PairTerms& terms) {
        const InteractionRef& ref = system_->interactions()[interaction];
        const double reach =
            system_->length_scale() + (ref.b != kGround ? step.b : step.a).r_n1.lpNorm<1>();
        for (int k = 0; k < ref.rows; ++k) {
          const double lambda = std::abs(trial.lambda[ref.first_row + k]);
          const double g =
              std::abs(terms.g[k] + terms.compliance[k] * trial.lambda[ref.first_row + k]);
          if (!(g <= c.residual)) {
            c.residual = g;
            c.worst_row = ref.first_row + k;
          }
          c.work_defect += lambda * g;
          c.work_scale += lambda * reach;
        }
      },
      true);
  return c;
}

std::size_t TreeEngine::memory() const {
  const auto bytes = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return bytes(mass_) + bytes(joint_data_) + bytes(loop_data_) + bytes(loop_joints_) + bytes(Y_) +
         bytes(pair_) + bytes(kept_) + bytes(S_) + bytes(body_) + bytes(extra_rows_) +
         bytes(edge_rows_) + bytes(tree_joints_) + bytes(slot_in_order_) + bytes(parent_) +
         bytes(gather_) + bytes(shape_) + bytes(y_row_) + bytes(joint_) + bytes(has_children_) +
         bytes(first_child_) + bytes(steps_) + bytes(extra_index_) + bytes(plan_.extra_of_slot) +
         bytes(plan_.edge_of_slot) + bytes(plan_.first_open) + bytes(plan_.first_update) +
         bytes(plan_.first_common);
}

}  // namespace polhode
