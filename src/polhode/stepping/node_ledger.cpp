// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/stepping/node_ledger.hpp>

namespace polhode {

NodeLedger::NodeLedger(const System& system) : system_(&system), nodes_(system) {
  const Nodes& nodes = system.nodes();
  for (int i = 0; i < nodes.count(); ++i)
    if (nodes[i].body == kGround) held_.push_back(i);
  for (const PrescribedComponent& p : nodes.prescribed()) held_.push_back(p.node);
  std::sort(held_.begin(), held_.end());
  held_.erase(std::unique(held_.begin(), held_.end()), held_.end());
  for (int g = 0; g < nodes.group_count(); ++g)
    if (nodes.group(g).external()) external_.push_back(g);
}

void NodeLedger::add_sums(const State& state, BodySums& s) const {
  const Nodes& nodes = system_->nodes();
  const Vec3& g = system_->gravity();
  for (int i = 0; i < nodes.count(); ++i) {
    Vec3 p = Vec3::Zero();
    for (int b = nodes.row_start()[i]; b < nodes.row_start()[i + 1]; ++b)
      p += nodes.mass()[b] * at_node(state.node_v, nodes.column()[b]);
    const Vec3 x = at_node(state.node_x, i), v = at_node(state.node_v, i), l = x.cross(p);
    const double m = nodes.node_mass(i);
    s.kinetic += 0.5 * v.dot(p);
    s.gravity_potential -= m * g.dot(x);
    for (int c = 0; c < 3; ++c) {
      s.p[c] += p[c];
      s.l[c] += l[c];
      s.mr[c] += m * x[c];
    }
    s.p_scale += p.norm();
    s.l_scale += l.norm();
  }
}

double NodeLedger::stored(const State& state) const {
  const Nodes& nodes = system_->nodes();
  StepContext still;
  still.t_n = state.t;
  const NodeStep instant = node_instant(*system_, state, still);
  double potential = 0.0;
  for (int g = 0; g < nodes.group_count(); ++g)
    potential += nodes.group(g)
                     .work(instant, state.element_history.data() + nodes.first_history(g), nullptr)
                     .stored;
  return potential;
}

/// Adds the excess of the mean of prescribed velocities over the mean velocity of the step: the
/// work of the inertia forces uses the former, the increments contain the latter.
/// @eq{prescribed-work}
void NodeLedger::add_lag(Ledger& ledger, const State& state, const Trial& trial,
                         Vec3& moment) const {
  const Nodes& nodes = system_->nodes();
  if (nodes.prescribed().empty()) return;
  const double dt = trial.context.dt;
  std::vector<double> a, v;
  node_accelerations(*system_, state, trial, a);
  end_velocities(*system_, trial, v);
  for (int i : held_) {
    if (nodes.bonded(i)) continue;
    Vec3 lag = Vec3::Zero();  // [m/s]
    for (int c = 0; c < 3; ++c)
      if (nodes.unknown(i, c) < 0)
        lag[c] = 0.5 * (at_node(state.node_v, i)[c] + at_node(v, i)[c]) -
                 at_node(trial.node_u, i)[c] / dt;
    if (lag.isZero(0.0)) continue;
    Vec3 force = Vec3::Zero(), momentum = Vec3::Zero();
    for (int b = nodes.row_start()[i]; b < nodes.row_start()[i + 1]; ++b) {
      const int j = nodes.column()[b];
      force += nodes.mass()[b] * at_node(a, j);
      momentum += 0.5 * nodes.mass()[b] * (at_node(state.node_v, j) + at_node(v, j));
    }
    ledger.put_in.add(dt * lag.dot(force));
    moment -= lag.cross(momentum);
  }
}

double NodeLedger::close(Ledger& ledger, const State& state, Trial& trial, Vec3& force,
                         Vec3& moment) {
  const Nodes& nodes = system_->nodes();
  const NodeStep step = node_step(state, trial);
  double potential = 0.0;
  for (int g = 0; g < nodes.group_count(); ++g) {
    const Work w = nodes.group(g).work(step, state.element_history.data() + nodes.first_history(g),
                                       trial.element_scratch.data() + nodes.first_scratch(g));
    potential += w.stored;
    ledger.dissipated.add(w.dissipated);
    ledger.put_in.add(w.put_in);
  }
  const auto add = [&](int node, const Vec3& f) {
    force += f;
    moment += step.position_alpha(node).cross(f);
  };
  if (!held_.empty()) {
    const std::vector<Mat3> here(nodes.pieces().size(), Mat3::Identity());
    nodes_.assemble(state, trial, false, here);
    for (int i : held_) {
      const bool all = nodes.bonded(i);
      Vec3 f = Vec3::Zero();
      for (int c = 0; c < 3; ++c)
        if (all || nodes.unknown(i, c) < 0) f[c] = nodes_.residual()[3 * i + c];
      ledger.put_in.add(f.dot(at_node(trial.node_u, i)));
      add(i, f);
    }
    add_lag(ledger, state, trial, moment);
  }
  for (int g : external_) {
    forces_.assign(trial.node_x.size(), 0.0);
    const ElementSink sink{forces_.data(), nullptr, nullptr};
    nodes.group(g).evaluate(step, state.element_history.data() + nodes.first_history(g),
                            trial.element_scratch.data() + nodes.first_scratch(g), Mat3::Identity(),
                            sink);
    for (int e = 0; e < nodes.group(g).size(); ++e)
      for (int i : nodes.group(g).nodes(e)) {
        const Vec3 f = at_node(forces_, i);
        if (f.isZero(0.0)) continue;
        add(i, f);
        Eigen::Map<Vec3>(forces_.data() + 3 * i).setZero();  // nodes are shared by elements
      }
  }
  return potential;
}

}  // namespace polhode
