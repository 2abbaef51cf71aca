// SPDX-License-Identifier: Apache-2.0
#include <polhode/equations/node_motion.hpp>
#include <polhode/system/lane_access.hpp>

namespace polhode {

namespace {

/// Index of a prescribed component among those of all nodes.
std::size_t place(const PrescribedComponent& p) {
  return 3 * static_cast<std::size_t>(p.node) + static_cast<std::size_t>(p.component);
}

}  // namespace

void predict_nodes(const System& system, const State& state, Trial& trial,
                   const PredictWeights& weights) {
  const Nodes& nodes = system.nodes();
  if (nodes.empty()) return;
  const StepContext& c = trial.context;
  trial.node_u.resize(state.node_x.size());
  trial.node_x.resize(state.node_x.size());
  trial.node_v.resize(state.node_x.size());
  trial.element_scratch.resize(nodes.scratch_size());
  for (std::size_t k = 0; k < state.node_x.size(); ++k) {
    double v = state.node_v[k];
    if (weights.count > 0) {
      v = 0.0;
      for (int p = 0; p < kPast; ++p)
        v += weights.weight[p] * state.node_past[p * state.node_x.size() + k];
    }
    trial.node_u[k] = c.dt * v;
    trial.node_x[k] = state.node_x[k] + trial.node_u[k];
  }
  // The step is closed at its end: at a kink the limit from inside the step counts.
  const TimeSide within = c.dt >= 0.0 ? TimeSide::kBefore : TimeSide::kAfter;
  trial.prescribed_v.clear();
  for (const PrescribedComponent& p : nodes.prescribed()) {
    const std::size_t k = place(p);
    const TimeRates d = p.displacement->rates(c.t_n1(), within);
    trial.node_x[k] = nodes[p.node].position[p.component] + d.value;
    trial.node_u[k] = trial.node_x[k] - state.node_x[k];
    trial.prescribed_v.push_back(d.rate);
  }
  follow_bodies(system, state, trial);
  update_node_velocities(system, state, trial);
  for (int g = 0; g < nodes.group_count(); ++g)
    nodes.group(g).begin_step(state.element_history.data() + nodes.first_history(g),
                              trial.element_scratch.data() + nodes.first_scratch(g));
}

/// @eq{eq:rbm-position}
void follow_bodies(const System& system, const State& state, Trial& trial) {
  const Nodes& nodes = system.nodes();
  for (int i = 0; i < nodes.count(); ++i) {
    const NodeData& node = nodes[i];
    if (node.body == kFreeNode) continue;
    if (node.body == kGround) {
      at_node(trial.node_x, i) = at_node(state.node_x, i);
      at_node(trial.node_u, i).setZero();
      continue;
    }
    const int slot = system.slot(node.body), l = slot % kLanes;
    const TrialBlock& t = trial.blocks[slot / kLanes];
    const Vec3 z_n = get(t.Lambda_n, l) * node.Z, z_n1 = get(t.Lambda, l) * node.Z;
    // Λ_{n+1} = cay[θ] Λ_n: the increment by the averaged lever arm, without cancellation.
    at_node(trial.node_u, i) = get(t.u, l) + get(t.theta, l).cross(0.5 * (z_n + z_n1));
    at_node(trial.node_x, i) = get(t.r, l) + z_n1;
  }
}

void update_node_velocities(const System&, const State& state, Trial& trial) {
  const GeneralizedAlpha& ga = trial.context.ga;
  const double dt = trial.context.dt, rate = ga.c / dt;
  for (std::size_t k = 0; k < trial.node_v.size(); ++k)
    trial.node_v[k] = rate * trial.node_u[k] + (1.0 - ga.c) * state.node_v[k];
  if (ga.c_A == 0.0) return;
  for (std::size_t k = 0; k < trial.node_v.size(); ++k)
    trial.node_v[k] += dt * ga.c_A * state.node_a[k];
}

/// @eq{prescribed-velocity}
void end_velocities(const System& system, const Trial& trial, std::vector<double>& v) {
  v = trial.node_v;
  const auto& prescribed = system.nodes().prescribed();
  for (std::size_t i = 0; i < prescribed.size(); ++i)
    v[place(prescribed[i])] = trial.prescribed_v[i];
}

void shorten_motion(const System& system, const State& state, double part, Trial& trial) {
  for (int slot = 0; slot < system.tree().slots; ++slot) {
    const TrialBlock& t = trial.blocks[static_cast<std::size_t>(slot / kLanes)];
    const int l = slot % kLanes;
    move_body(state, trial, slot, part * get(t.u, l), part * get(t.theta, l));
  }
  if (system.nodes().empty()) return;
  std::vector<double> given;
  for (const PrescribedComponent& p : system.nodes().prescribed())
    given.push_back(trial.node_u[place(p)]);
  for (double& u : trial.node_u) u *= part;
  for (std::size_t k = 0; k < given.size(); ++k)
    trial.node_u[place(system.nodes().prescribed()[k])] = given[k];
  for (std::size_t k = 0; k < trial.node_u.size(); ++k)
    trial.node_x[k] = state.node_x[k] + trial.node_u[k];
  follow_bodies(system, state, trial);
  update_node_velocities(system, state, trial);
}

NodeStep node_step(const State& state, const Trial& trial) {
  const StepContext& c = trial.context;
  return {.x_n = state.node_x.data(),
          .x_n1 = trial.node_x.data(),
          .u = trial.node_u.data(),
          .v_n = state.node_v.data(),
          .v_n1 = trial.node_v.data(),
          .context = c,
          .alpha_f = c.ga.alpha_f,
          .rate = c.ga.c / c.dt};
}

NodeStep node_instant(const System& system, const State& state, const StepContext& context) {
  return {.x_n = state.node_x.data(),
          .x_n1 = state.node_x.data(),
          .u = system.nodes().no_displacement().data(),
          .v_n = state.node_v.data(),
          .v_n1 = state.node_v.data(),
          .context = context,
          .alpha_f = 1.0,
          .rate = 0.0};
}

void node_accelerations(const System& system, const State& state, const Trial& trial,
                        std::vector<double>& a) {
  const GeneralizedAlpha& ga = trial.context.ga;
  const double per_dt = ga.kappa / trial.context.dt;
  end_velocities(system, trial, a);
  for (std::size_t k = 0; k < a.size(); ++k)
    a[k] = per_dt * (a[k] - state.node_v[k]) + (1.0 - ga.kappa) * state.node_a[k];
}

void commit_nodes(const System& system, State& state, const Trial& trial) {
  const Nodes& nodes = system.nodes();
  if (nodes.empty()) return;
  const NodeStep step = node_step(state, trial);
  for (int g = 0; g < nodes.group_count(); ++g)
    nodes.group(g).commit(step, state.element_history.data() + nodes.first_history(g),
                          trial.element_scratch.data() + nodes.first_scratch(g));
  const GeneralizedAlpha& ga = trial.context.ga;
  const double dt = trial.context.dt;
  double* past = state.node_past.data() + state.past_next * state.node_x.size();
  std::vector<double> v, prescribed_a;
  end_velocities(system, trial, v);
  // Newmark accelerations: from the positions, and for prescribed components from the velocities.
  for (const PrescribedComponent& p : nodes.prescribed()) {
    const std::size_t k = place(p);
    const double mean = (v[k] - state.node_v[k]) / dt;
    prescribed_a.push_back(mean + (1.0 - 1.0 / ga.gamma) * (state.node_a[k] - mean));
  }
  for (std::size_t k = 0; k < state.node_x.size(); ++k) {
    past[k] = trial.node_u[k] / dt;
    state.node_a[k] = (trial.node_u[k] / dt - state.node_v[k]) / (ga.beta * dt) +
                      (1.0 - 0.5 / ga.beta) * state.node_a[k];
    state.node_v[k] = v[k];
    state.node_x[k] = trial.node_x[k];
  }
  for (std::size_t i = 0; i < prescribed_a.size(); ++i)
    state.node_a[place(nodes.prescribed()[i])] = prescribed_a[i];
}

void start_prescribed(const System& system, State& state) {
  const Nodes& nodes = system.nodes();
  for (const PrescribedComponent& p : nodes.prescribed()) {
    const TimeRates d = p.displacement->rates(state.t, TimeSide::kAfter);
    state.node_x[place(p)] = nodes[p.node].position[p.component] + d.value;
    state.node_v[place(p)] = d.rate;
  }
}

/// @eq{eq:rbm-position} @eq{eq:rbm-rigid-point-velocity}
void bond_nodes(const System& system, State& state) {
  const Nodes& nodes = system.nodes();
  for (int i = 0; i < nodes.count(); ++i) {
    if (nodes[i].body == kFreeNode) continue;
    if (nodes[i].body == kGround) {
      at_node(state.node_v, i).setZero();
      continue;
    }
    const BodyMotion m = system.motion(state, nodes[i].body);
    const Vec3 z = m.q * nodes[i].Z;
    at_node(state.node_x, i) = m.r + z;
    at_node(state.node_v, i) = m.v + m.omega().cross(z);
  }
}

}  // namespace polhode
