// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <numeric>

#include <polhode/solve/settle_impacts.hpp>
#include <polhode/solve/share_impulses.hpp>

namespace polhode {

namespace {

/// An island with more impacts than this, and nothing that ties its bodies, is settled one impact
/// after the other.
constexpr std::size_t kTogether = 48;
constexpr int kSweeps = 10;

int first_of(std::vector<int>& tie, int body) {
  while (tie[body] != body) body = tie[body] = tie[tie[body]];
  return body;
}

void join(std::vector<int>& tie, int a, int b) {
  const int x = first_of(tie, a), y = first_of(tie, b);
  tie[std::max(x, y)] = std::min(x, y);
}

}  // namespace

SettleImpacts::SettleImpacts(const System& system) : system_(&system) {
  const auto n = static_cast<std::size_t>(system.body_count());
  tie_.resize(n);
  std::iota(tie_.begin(), tie_.end(), 0);
  tied_.assign(n, false);
  place_.assign(n, -1);
  const auto tie = [&](int a, int b) {
    if (a != kGround) tied_[a] = true;
    if (b != kGround) tied_[b] = true;
    if (a != kGround && b != kGround) join(tie_, a, b);
  };
  for (const InteractionRef& ref : system.interactions())
    if (ref.rows > 0 || system.group(ref.group).coupled_mass(ref.item) != 0.0) tie(ref.a, ref.b);
  const Nodes& nodes = system.nodes();
  for (int i = 0; i < nodes.count(); ++i)
    if (nodes[i].body >= 0) tied_[nodes[i].body] = true;
  for (const NodePiece& piece : nodes.pieces())
    for (int body : piece.bodies) tie(piece.bodies.front(), body);
}

void SettleImpacts::find(const State& state, const Trial& trial) {
  rows_.clear();
  contacts_ = nullptr;
  std::vector<Impact> impacts;
  for (int i : system_->barriers()) {
    const InteractionRef& ref = system_->interactions()[i];
    impacts.clear();
    const PairView view = pair_view(*system_, state, trial, ref);
    system_->group(ref.group).impacts(ref.item, view.step(), impacts);
    for (const Impact& impact : impacts) rows_.push_back({{ref.a, ref.b}, impact});
  }
  of_joints_ = rows_.size();
}

void SettleImpacts::find(State& state, MovingContacts& contacts) {
  contacts_ = &contacts;
  contacts.impacts(state, rows_);
}

std::vector<SettleImpacts::Island> SettleImpacts::islands() const {
  std::vector<int> root = tie_;
  for (const auto& [bodies, impact] : rows_)
    if (bodies.a != kGround && bodies.b != kGround) join(root, bodies.a, bodies.b);
  std::map<int, Island> by_root;
  for (int k = 0; k < static_cast<int>(rows_.size()); ++k) {
    const auto [a, b] = rows_[k].bodies;
    Island& island = by_root[first_of(root, a != kGround ? a : b)];
    island.rows.push_back(k);
    for (int body : {a, b}) {
      if (body == kGround) continue;
      island.bodies.push_back(body);
      island.tied = island.tied || tied_[body];
    }
  }
  std::vector<Island> list;
  for (auto& [first, island] : by_root) {
    if (island.tied) {
      island.bodies.clear();
      for (int body = 0; body < static_cast<int>(root.size()); ++body)
        if (first_of(root, body) == first) island.bodies.push_back(body);
    } else {
      std::sort(island.bodies.begin(), island.bodies.end());
      island.bodies.erase(std::unique(island.bodies.begin(), island.bodies.end()),
                          island.bodies.end());
    }
    list.push_back(std::move(island));
  }
  return list;
}

Vec6 SettleImpacts::velocity(const State& state, int body) const {
  const BodyMotion m = system_->motion(state, body);
  Vec6 v;
  v << m.v, m.omega();
  return v;
}

double SettleImpacts::along(const PairImpact& row, const std::vector<Vec6>& v) const {
  double sum = 0.0;
  if (row.bodies.a != kGround) sum += row.impact.on_a.dot(v[place_[row.bodies.a]]);
  if (row.bodies.b != kGround) sum += row.impact.on_b.dot(v[place_[row.bodies.b]]);
  return sum;
}

void SettleImpacts::settle(State& state) {
  impulses_.assign(rows_.size(), 0.0);
  losses_.assign(rows_.size(), 0.0);
  const std::vector<Island> all = islands();
  const bool tied = std::any_of(all.begin(), all.end(), [](const Island& i) { return i.tied; });
  std::vector<Vec6> to_admissible;
  if (tied) {
    if (!solver_) solver_ = std::make_unique<InstantSolver>(*system_);
    if (!solver_->take_impulses(state)) return;
    to_admissible = solver_->jumps_to_admissible(state);
  }
  for (const Island& island : all) {
    for (std::size_t i = 0; i < island.bodies.size(); ++i)
      place_[island.bodies[i]] = static_cast<int>(i);
    if (island.tied && system_->rows() > 0) {
      std::vector<Vec6> jumps;
      for (int body : island.bodies) jumps.push_back(to_admissible[body]);
      jump(state, island, jumps);
    }
    if (island.tied || island.rows.size() <= kTogether)
      settle_together(state, island);
    else
      settle_in_turn(state, island);
  }
  if (!contacts_) return;
  contacts_->settled(std::span(impulses_).subspan(of_joints_),
                     std::span(losses_).subspan(of_joints_));
}

std::vector<std::vector<Vec6>> SettleImpacts::answers(const State& state, const Island& island) {
  std::vector<std::vector<Vec6>> X;
  std::vector<Vec6> impulses;
  if (island.tied) impulses.assign(tie_.size(), Vec6::Zero());
  for (int k : island.rows) {
    std::vector<Vec6>& x = X.emplace_back(island.bodies.size(), Vec6::Zero());
    const auto& [a, b] = rows_[k].bodies;
    for (const auto& [body, J] : {std::pair(a, rows_[k].impact.on_a), {b, rows_[k].impact.on_b}}) {
      if (body == kGround) continue;
      if (island.tied) {
        impulses[body] = J;
        continue;
      }
      const BodyData& data = system_->bodies()[body];
      const Mat3 Lambda = system_->motion(state, body).Lambda();
      x[place_[body]] << J.head<3>() / data.mass,
          Lambda * data.inertia.ldlt().solve(Lambda.transpose() * J.tail<3>());
    }
    if (!island.tied) continue;
    const std::vector<Vec6> jumps = solver_->jumps(impulses);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = jumps[island.bodies[i]];
    if (a != kGround) impulses[a].setZero();
    if (b != kGround) impulses[b].setZero();
  }
  return X;
}

/// v += X p with X = M⁻¹ Jᵀ under G v = 0, and J X p = what is wanted.
void SettleImpacts::settle_together(State& state, const Island& island) {
  const auto n = static_cast<Eigen::Index>(island.rows.size());
  std::vector<Vec6> v;
  for (int body : island.bodies) v.push_back(velocity(state, body));
  const std::vector<std::vector<Vec6>> X = answers(state, island);
  Mat A(n, n);
  Vec before(n), wanted(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const PairImpact& row = rows_[island.rows[i]];
    before[i] = along(row, v);
    wanted[i] = row.impact.wanted;
    for (Eigen::Index k = 0; k < n; ++k) A(i, k) = along(row, X[k]);
  }
  const SharedImpulses shared = share_impulses(0.5 * (A + A.transpose()), before, wanted);
  if (shared.impulses.isZero(0.0)) return;
  std::vector<Vec6> jumps(island.bodies.size(), Vec6::Zero());
  for (Eigen::Index k = 0; k < n; ++k)
    for (std::size_t i = 0; i < jumps.size(); ++i) jumps[i] += shared.impulses[k] * X[k][i];
  const double lost = shared.energy_lost + jump(state, island, jumps);
  for (Eigen::Index k = 0; k < n; ++k) {
    impulses_[island.rows[k]] = shared.impulses[k];
    losses_[island.rows[k]] = lost / static_cast<double>(n);
  }
}

/// Each impulse takes energy, in whatever order.
void SettleImpacts::settle_in_turn(State& state, const Island& island) {
  const std::size_t n = island.bodies.size();
  std::vector<Vec6> v, start;
  std::vector<Mat3> inverse_inertia;
  for (int body : island.bodies) {
    v.push_back(velocity(state, body));
    const Mat3 Lambda = system_->motion(state, body).Lambda();
    inverse_inertia.emplace_back(Lambda * system_->bodies()[body].inertia.inverse() *
                                 Lambda.transpose());
  }
  start = v;
  const auto answer = [&](int body, const Vec6& J) {
    Vec6 x;
    x << J.head<3>() / system_->bodies()[body].mass, inverse_inertia[place_[body]] * J.tail<3>();
    return x;
  };
  std::vector<double> per_impulse;
  for (int k : island.rows) {
    const auto& [bodies, J] = rows_[k];
    double sum = 0.0;
    if (bodies.a != kGround) sum += J.on_a.dot(answer(bodies.a, J.on_a));
    if (bodies.b != kGround) sum += J.on_b.dot(answer(bodies.b, J.on_b));
    per_impulse.push_back(sum);
  }
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (std::size_t i = 0; i < island.rows.size(); ++i) {
      const int k = island.rows[i];
      const auto& [bodies, J] = rows_[k];
      const double speed = along(rows_[k], v);
      if (!(speed > J.wanted)) continue;
      const double p = (J.wanted - speed) / per_impulse[i];
      if (bodies.a != kGround) v[place_[bodies.a]] += p * answer(bodies.a, J.on_a);
      if (bodies.b != kGround) v[place_[bodies.b]] += p * answer(bodies.b, J.on_b);
      impulses_[k] += p;
      losses_[k] -= 0.5 * p * (J.wanted + speed);
    }
  for (std::size_t i = 0; i < n; ++i) v[i] -= start[i];
  jump(state, island, v);
}

double SettleImpacts::jump(State& state, const Island& island, const std::vector<Vec6>& jumps) {
  const Nodes& nodes = system_->nodes();
  double lost = 0.0;
  if (island.tied && !nodes.empty()) {
    std::vector<Vec6> by_body(tie_.size(), Vec6::Zero());
    for (std::size_t i = 0; i < jumps.size(); ++i) by_body[island.bodies[i]] = jumps[i];
    const std::vector<double> dv = solver_->node_jumps(by_body);
    const auto at = [](const std::vector<double>& x, int i) {
      return Eigen::Map<const Vec3>(x.data() + 3 * static_cast<std::ptrdiff_t>(i));
    };
    // Newmark velocities of bonded nodes are not quite those of their bodies.
    for (int i = 0; i < nodes.count(); ++i) {
      if (nodes[i].body < 0) continue;
      const BodyMotion m = system_->motion(state, nodes[i].body);
      const Vec3 lag = at(state.node_v, i) - m.v - m.omega().cross(m.q * nodes[i].Z);
      for (int b = nodes.row_start()[i]; b < nodes.row_start()[i + 1]; ++b)
        lost -= nodes.mass()[b] * lag.dot(at(dv, nodes.column()[b]));
    }
    for (std::size_t k = 0; k < dv.size(); ++k) state.node_v[k] += dv[k];
  }
  for (std::size_t i = 0; i < jumps.size(); ++i) {
    const int slot = system_->slot(island.bodies[i]), lane = slot % kLanes;
    const Vec3 dW = system_->motion(state, island.bodies[i]).q.conjugate() * jumps[i].tail<3>();
    BodyBlock& block = state.blocks[slot / kLanes];
    for (int c = 0; c < 3; ++c) {  // positions keep what rounding took from them
      block.v[c][lane] += jumps[i][c];
      block.W[c][lane] += dW[c];
    }
  }
  return lost;
}

}  // namespace polhode
