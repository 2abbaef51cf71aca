// SPDX-License-Identifier: Apache-2.0
#include <polhode/equations/node_system.hpp>

namespace polhode {

NodeSystem::NodeSystem(const System& system) : system_(&system) {
  const Nodes& nodes = system.nodes();
  residual_.assign(3 * static_cast<std::size_t>(nodes.count()), 0.0);
  for (int g = 0; g < nodes.group_count(); ++g)
    if (const ChangingSparsity* pattern = nodes.group(g).changing_sparsity())
      moving_groups_.push_back({g, pattern, 0});
}

void NodeSystem::gather_moving(const State& state) {
  moving_ = {};
  for (MovingGroup& m : moving_groups_) {
    m.first = moving_.row.size();
    const NodeBlocks& own =
        m.pattern->blocks(state.element_history.data() + system_->nodes().first_history(m.group));
    moving_.row.insert(moving_.row.end(), own.row.begin(), own.row.end());
    moving_.column.insert(moving_.column.end(), own.column.begin(), own.column.end());
  }
}

ElementReport NodeSystem::assemble(const State& state, Trial& trial, bool tangent,
                                   const std::vector<Mat3>& turns) {
  const Nodes& nodes = system_->nodes();
  std::fill(residual_.begin(), residual_.end(), 0.0);
  if (tangent) {
    gather_moving(state);
    tangent_.assign(9 * (nodes.column().size() + moving_.row.size()), 0.0);
  }
  NodeStep step = node_step(state, trial);
  step.mixed_point = mixed_point_;
  if (static_) {
    step.x_n = step.x_n1;
    step.alpha_f = 1.0;
    step.rate = 0.0;
  }
  ElementReport report;
  const Mat3 here = Mat3::Identity();
  for (int g = 0; g < nodes.group_count(); ++g) {
    const ElementGroup& group = nodes.group(g);
    const bool has_slots = !nodes.slots(g).empty();
    ElementSink sink{residual_.data(), tangent && has_slots ? tangent_.data() : nullptr,
                     nodes.slots(g).data()};
    for (const MovingGroup& m : moving_groups_)
      if (tangent && m.group == g)
        sink.tangent = tangent_.data() + 9 * (nodes.column().size() + m.first);
    const int piece = nodes.piece_of_group(g);
    const ElementReport one =
        group.evaluate(step, state.element_history.data() + nodes.first_history(g),
                       trial.element_scratch.data() + nodes.first_scratch(g),
                       tangent || piece < 0 ? here : turns[piece], sink);
    if (one.worst_element < 0 || one.least_volume >= report.least_volume) continue;
    report = one;
    worst_group_ = g;
  }
  for (double& f : residual_) f = -f;
  if (tangent)
    for (double& k : tangent_) k = -k;
  add_inertia(state, trial, tangent);
  return report;
}

void NodeSystem::add_inertia(const State& state, const Trial& trial, bool tangent) {
  const Nodes& nodes = system_->nodes();
  const Vec3 g = trial.context.load_factor * system_->gravity();
  for (int i = 0; i < nodes.count(); ++i)
    for (int c = 0; c < 3; ++c) residual_[3 * i + c] -= nodes.node_mass(i) * g[c];
  if (static_) return;
  node_accelerations(*system_, state, trial, acceleration_);
  const double dt = trial.context.dt;
  const double k = trial.context.ga.alpha_m / (trial.context.ga.beta * dt * dt);
  for (int i = 0; i < nodes.count(); ++i)
    for (int b = nodes.row_start()[i]; b < nodes.row_start()[i + 1]; ++b) {
      const double m = nodes.mass()[b];
      const int j = nodes.column()[b];
      for (int c = 0; c < 3; ++c) residual_[3 * i + c] += m * acceleration_[3 * j + c];
      if (!tangent) continue;
      for (int c = 0; c < 3; ++c) tangent_[9 * static_cast<std::size_t>(b) + 4 * c] += k * m;
    }
}

double NodeSystem::advance(const double* du, Trial& trial, const std::vector<Mat3>& turns) const {
  const Nodes& nodes = system_->nodes();
  const Mat3 here = Mat3::Identity();
  double most = 0.0;
  for (int g = 0; g < nodes.group_count(); ++g) {
    const int piece = nodes.piece_of_group(g);
    most = std::max(most,
                    nodes.group(g).advance(du, piece < 0 ? here : turns[piece],
                                           trial.element_scratch.data() + nodes.first_scratch(g)));
  }
  return most;
}

}  // namespace polhode
