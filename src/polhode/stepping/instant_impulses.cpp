// SPDX-License-Identifier: Apache-2.0
#include <polhode/stepping/instant_system.hpp>

namespace polhode {

/// @eq{solid-impulse}
bool InstantSolver::take_impulses(const State& state) {
  Impl& s = *impl_;
  s.take(state);
  s.put_masses_and_rows(state);
  s.of_nodes.clear();
  return s.add_node_masses(state) && s.factor(state);
}

/// @eq{solid-impulse}
void InstantSolver::press_nodes(std::span<const double> impulses) {
  Impl& s = *impl_;
  if (!s.nodes || (impulses.empty() && s.of_nodes.empty())) return;
  const std::vector<double> none(impulses.empty() ? s.system.nodes().no_displacement().size() : 0);
  s.of_nodes.assign(static_cast<std::size_t>(s.system.body_count()), Vec6::Zero());
  s.nodes->press(impulses.empty() ? std::span<const double>(none) : impulses,
                 1.0 / s.system.mean_mass(), s.of_nodes);
  if (impulses.empty()) s.of_nodes.clear();
}

std::vector<Vec6> InstantSolver::jumps(std::span<const Vec6> impulses) {
  impl_->press(impulses);
  return impl_->solution_by_body();
}

/// @eq{jump-work}
std::vector<double> InstantSolver::row_impulses(std::span<const Vec6> impulses,
                                                std::span<const Vec6> jumps) {
  Impl& s = *impl_;
  s.press(impulses);
  Vec moved(6 * s.system.body_count());
  for (int b = 0; b < s.system.body_count(); ++b) moved.segment<6>(6 * b) = jumps[b];
  s.rows_times(moved, s.rhs.tail(s.system.rows()));
  if (!s.solve_factored().solved) return {};
  return s.solved_rows();
}

std::vector<Vec6> InstantSolver::jumps_to_admissible(const State& state) {
  Impl& s = *impl_;
  Vec given(6 * s.system.body_count());
  for (int b = 0; b < s.system.body_count(); ++b) {
    const BodyMotion m = s.system.motion(state, b);
    given.segment<6>(6 * b) << m.v, m.omega();
  }
  s.rhs.setZero();
  s.rows_times(given, s.rhs.tail(s.system.rows()));
  s.subtract_rates(state, TimeSide::kBefore, s.rhs.tail(s.system.rows()));
  s.rhs = -s.rhs;
  return s.solution_by_body();
}

/// @eq{prescribed-kink}
bool InstantSolver::jumps_by_kinks(const State& state, std::span<const double> given,
                                   std::span<const double> rows, std::vector<Vec6>& bodies,
                                   std::vector<double>& nodes, std::vector<double>& impulses) {
  Impl& s = *impl_;
  s.take(state);
  s.put_masses_and_rows(state);
  s.rhs.setZero();
  for (std::size_t k = 0; k < rows.size(); ++k)
    s.rhs[6 * s.system.body_count() + static_cast<Eigen::Index>(k)] = rows[k];
  if (!s.add_node_masses(state, given) || !s.factor(state)) return false;
  bodies = s.solution_by_body();
  impulses = s.solved_rows();
  nodes = node_jumps(bodies);
  return true;
}

/// @eq{switch-impulse} @eq{switch-loss}
std::optional<double> InstantSolver::jumps_onto(const State& state, std::span<const char> rows,
                                                std::vector<Vec6>& bodies,
                                                std::vector<double>& nodes,
                                                std::vector<double>& impulses) {
  Impl& s = *impl_;
  s.take(state);
  s.put_masses_and_rows(state);
  const Eigen::Index first = 6 * s.system.body_count();
  Vec given(first);
  for (int b = 0; b < s.system.body_count(); ++b) {
    const BodyMotion m = s.system.motion(state, b);
    given.segment<6>(6 * b) << m.v, m.omega();
  }
  s.rhs.setZero();
  auto wanted = s.rhs.tail(s.system.rows());
  s.rows_times(given, wanted);
  s.subtract_rates(state, TimeSide::kAfter, wanted);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    double& row = wanted[static_cast<Eigen::Index>(k)];
    row = rows[k] != 0 ? -row : 0.0;
  }
  const Vec jumps = wanted;
  if (!s.add_node_masses(state) || !s.factor(state)) return std::nullopt;
  if (!s.solve_factored().solved) return std::nullopt;
  bodies.assign(static_cast<std::size_t>(s.system.body_count()), Vec6::Zero());
  for (int b = 0; b < s.system.body_count(); ++b) bodies[b] = s.x.segment<6>(6 * b);
  impulses = s.solved_rows();
  double energy = 0.0;
  for (std::size_t k = 0; k < rows.size(); ++k)
    energy += 0.5 * impulses[k] * jumps[static_cast<Eigen::Index>(k)];
  nodes = node_jumps(bodies);
  return energy;
}

std::vector<double> InstantSolver::node_jumps(std::span<const Vec6> bodies) {
  Impl& s = *impl_;
  if (!s.nodes) return {};
  for (std::size_t b = 0; b < bodies.size(); ++b)
    s.x.segment<6>(6 * static_cast<Eigen::Index>(b)) = bodies[b];
  return s.nodes->accelerations(s.x.data());
}

void add_jumps(const System& system, std::span<const Vec6> bodies, std::span<const double> nodes,
               State& state) {
  for (std::size_t k = 0; k < nodes.size(); ++k) state.node_v[k] += nodes[k];
  for (int b = 0; b < system.body_count(); ++b) {
    const int slot = system.slot(b), lane = slot % kLanes;
    const Vec6& jump = bodies[static_cast<std::size_t>(b)];
    const Vec3 dW = system.motion(state, b).q.conjugate() * jump.tail<3>();
    BodyBlock& block = state.blocks[static_cast<std::size_t>(slot / kLanes)];
    for (int c = 0; c < 3; ++c) {  // positions keep their compensated rounding
      block.v[c][lane] += jump[c];
      block.W[c][lane] += dW[c];
    }
  }
}

}  // namespace polhode
