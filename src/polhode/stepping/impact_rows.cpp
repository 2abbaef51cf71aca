// SPDX-License-Identifier: Apache-2.0
#include <map>

#include <polhode/stepping/impact_rows.hpp>

namespace polhode {

/// Calls use for bodies and connected components of solids loaded by a row, numbered as in `ties_`.
template <class Use>
void ImpactResolver::for_bodies(int row, Use&& use) const {
  if (const SurfaceImpact* hit = surface(row)) {
    for (const auto& [node, rate] : hit->nodes) {
      const int body = system_->nodes()[node].body, piece = system_->nodes().piece(node);
      if (body >= 0) use(body);
      if (body == kFreeNode && piece >= 0) use(system_->body_count() + piece);
    }
    return;
  }
  const auto [a, b] = rows_[row].bodies;
  if (a != kGround) use(a);
  if (b != kGround) use(b);
}

std::vector<ImpactResolver::Island> ImpactResolver::islands() const {
  DisjointSets sets = ties_;
  const int bodies = system_->body_count(), rows = static_cast<int>(rows_.size());
  const auto first = [&](int row) {
    int one = -1;
    for_bodies(row, [&](int body) { one = one < 0 ? body : one; });
    return one;
  };
  for (int k = 0; k < rows; ++k)
    for_bodies(k, [&, one = first(k)](int body) { sets.join(one, body); });
  std::map<int, Island> by_root;
  for (int k = 0; k < rows; ++k) {
    if (first(k) < 0) continue;
    Island& island = by_root[sets.first_of(first(k))];
    island.rows.push_back(k);
    for_bodies(k, [&](int body) {
      if (body < bodies) island.bodies.push_back(body);
      island.tied = island.tied || body >= bodies || tied_[body];
    });
    if (const SurfaceImpact* hit = surface(k))
      for (const auto& [node, rate] : hit->nodes)
        if (system_->nodes()[node].body == kFreeNode) island.nodes.push_back(node);
  }
  const auto sort = [](std::vector<int>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  };
  std::vector<Island> list;
  for (auto& [top, island] : by_root) {
    if (island.tied) {
      island.bodies.clear();
      for (int body = 0; body < bodies; ++body)
        if (sets.first_of(body) == top) island.bodies.push_back(body);
    } else {
      sort(island.bodies);
    }
    sort(island.nodes);
    list.push_back(std::move(island));
  }
  return list;
}

namespace {

/// Axes of the turning rows of a contact: its normal n for torsion, two tangents for rolling.
std::vector<Vec3> turning_axes(const StepRow& row, const Vec3& n) {
  std::vector<Vec3> axes;
  if (row.turning.torsion > 0.0) axes.push_back(n);
  if (row.turning.rolling > 0.0) {
    axes.push_back(n.unitOrthogonal());
    axes.push_back(n.cross(axes.back()));
  }
  return axes;
}

}  // namespace

std::vector<ImpactResolver::Row> ImpactResolver::start_rows(const State& state,
                                                            const Island& island) {
  std::vector<Row> rows;
  const int bodies = static_cast<int>(island.bodies.size());
  std::vector<Vec6> impulses;
  if (island.tied) impulses.assign(static_cast<std::size_t>(system_->body_count()), Vec6::Zero());
  std::vector<double> on_nodes;
  if (!island.nodes.empty()) on_nodes.assign(state.node_v.size(), 0.0);
  const auto add_tied = [&](Row& row) {
    for (const auto& [place, J] : row.on) {
      if (place < bodies)
        impulses[island.bodies[static_cast<std::size_t>(place)]] = J;
      else
        at_node(on_nodes, island.nodes[static_cast<std::size_t>(place - bodies)]) = J.head<3>();
    }
    if (!on_nodes.empty()) solver_->press_nodes(on_nodes);
    const std::vector<Vec6> jumps = solver_->jumps(impulses);
    for (std::size_t i = 0; i < island.bodies.size(); ++i)
      row.answer.emplace_back(static_cast<int>(i), jumps[island.bodies[i]]);
    if (!on_nodes.empty()) {
      const std::vector<double> dv = solver_->node_jumps(jumps);
      for (std::size_t i = 0; i < island.nodes.size(); ++i) {
        Vec6 x = Vec6::Zero();
        x.head<3>() = at_node(dv, island.nodes[i]);
        row.answer.emplace_back(bodies + static_cast<int>(i), x);
      }
    }
    for (const auto& [place, J] : row.on) {
      if (place < bodies)
        impulses[island.bodies[static_cast<std::size_t>(place)]].setZero();
      else
        at_node(on_nodes, island.nodes[static_cast<std::size_t>(place - bodies)]).setZero();
    }
  };
  const auto add = [&](int impact, std::vector<std::pair<int, Vec6>> on, bool has_friction) {
    Row& row = rows.emplace_back();
    row.impact = impact;
    row.on = std::move(on);
    row.has_friction = has_friction;
    if (!on_nodes.empty()) {
      add_tied(row);
      return;
    }
    for (const auto& [place, J] : row.on) {
      const int body = island.bodies[static_cast<std::size_t>(place)];
      if (tied_[body]) continue;
      const BodyData& data = system_->bodies()[body];
      const Mat3 Lambda = system_->motion(state, body).Lambda();
      Vec6 x;
      x << J.head<3>() / data.mass,
          Lambda * data.inertia.ldlt().solve(Lambda.transpose() * J.tail<3>());
      row.answer.emplace_back(place, x);
    }
  };
  const auto of_pair = [&](int k, const Vec6& on_a, const Vec6& on_b) {
    const auto& [a, b] = rows_[k].bodies;
    std::vector<std::pair<int, Vec6>> on;
    if (a != kGround) on.emplace_back(place_[a], on_a);
    if (b != kGround) on.emplace_back(place_[b], on_b);
    return on;
  };
  const auto of_surface = [&](const SurfaceImpact& hit, const Vec3& t) {
    std::vector<std::pair<int, Vec6>> on;
    const auto push = [&](int place, const Vec6& J) {
      for (auto& [known, sum] : on)
        if (known == place) {
          sum += J;
          return;
        }
      on.emplace_back(place, J);
    };
    for (const auto& [node, rate] : hit.nodes) {
      const NodeData& data = system_->nodes()[node];
      Vec6 J = Vec6::Zero();
      J.head<3>() = rate.transpose() * t;
      if (data.body == kFreeNode) {
        const auto at = std::lower_bound(island.nodes.begin(), island.nodes.end(), node);
        push(bodies + static_cast<int>(at - island.nodes.begin()), J);
      } else if (data.body != kGround) {
        const Vec3 arm = system_->motion(state, data.body).q * data.Z;
        J.tail<3>() = arm.cross(J.head<3>());
        push(place_[data.body], J);
      }
    }
    return on;
  };
  for (int k : island.rows) {
    const Impact& impact = rows_[k].impact;
    const SurfaceImpact* hit = surface(k);
    add(k, hit ? of_surface(*hit, hit->normal) : of_pair(k, impact.on_a, impact.on_b), false);
    if (impact.mu != 0.0)
      for (const Vec3* t : {&impact.along, &impact.across}) {
        Vec6 on_a, on_b;
        on_a << *t, impact.arm_a.cross(*t);
        on_b << -*t, -impact.arm_b.cross(*t);
        add(k, hit ? of_surface(*hit, *t) : of_pair(k, on_a, on_b), t == &impact.along);
      }
    if (rows_[k].row)
      for (const Vec3& axis : turning_axes(*rows_[k].row, impact.on_a.head<3>())) {
        Vec6 on_a = Vec6::Zero();
        on_a.tail<3>() = axis;
        add(k, of_pair(k, on_a, -on_a), false);
        rows.back().turns = true;
      }
  }
  if (!on_nodes.empty()) solver_->press_nodes({});
  return rows;
}

/// Adds the responses of tied bodies. Bodies that nothing ties do not affect each other: one
/// solution of the whole system answers a row of each connected component.
void ImpactResolver::add_responses(std::span<const Island> islands,
                                   std::vector<std::vector<Row>>& rows) {
  struct Component {
    std::size_t island = 0;
    std::vector<int> places;  ///< Of its bodies, in the island.
    std::vector<Row*> rows;   ///< That load it.
  };
  std::map<int, Component> components;
  const auto component_of = [&](const Island& island, int place) -> Component* {
    if (static_cast<std::size_t>(place) >= island.bodies.size()) return nullptr;
    const int body = island.bodies[static_cast<std::size_t>(place)];
    return tied_[body] ? &components[ties_.first_of(body)] : nullptr;
  };
  std::size_t rounds = 0;
  for (std::size_t i = 0; i < islands.size(); ++i) {
    if (!islands[i].tied || !islands[i].nodes.empty()) continue;
    for (int place = 0; place < static_cast<int>(islands[i].bodies.size()); ++place)
      if (Component* const c = component_of(islands[i], place)) {
        c->island = i;
        c->places.push_back(place);
      }
    for (Row& row : rows[i])
      for (const auto& [place, J] : row.on)
        if (Component* const c = component_of(islands[i], place)) {
          if (c->rows.empty() || c->rows.back() != &row) c->rows.push_back(&row);
          rounds = std::max(rounds, c->rows.size());
        }
  }
  std::vector<Vec6> impulses;
  for (std::size_t round = 0; round < rounds; ++round) {
    impulses.assign(static_cast<std::size_t>(system_->body_count()), Vec6::Zero());
    for (auto& [root, c] : components) {
      if (round >= c.rows.size()) continue;
      const Island& island = islands[c.island];
      for (const auto& [place, J] : c.rows[round]->on)
        if (component_of(island, place) == &c)
          impulses[island.bodies[static_cast<std::size_t>(place)]] = J;
    }
    const std::vector<Vec6> jumps = solver_->jumps(impulses);
    for (auto& [root, c] : components) {
      if (round >= c.rows.size()) continue;
      for (const int place : c.places)
        c.rows[round]->answer.emplace_back(
            place, jumps[islands[c.island].bodies[static_cast<std::size_t>(place)]]);
    }
  }
}

std::vector<std::vector<ImpactResolver::Row>> ImpactResolver::rows_of(
    const State& state, std::span<const Island> islands) {
  std::vector<std::vector<Row>> rows;
  for (const Island& island : islands) rows.push_back(start_rows(state, island));
  add_responses(islands, rows);
  for (std::vector<Row>& of_island : rows)
    for (Row& row : of_island) row.mobility = row.speed_by(row);
  return rows;
}

std::vector<double> ImpactResolver::on_nodes(const Island& island, const std::vector<Row>& rows,
                                             double part) const {
  std::vector<double> sum(system_->nodes().no_displacement().size(), 0.0);
  const int bodies = static_cast<int>(island.bodies.size());
  for (const Row& row : rows)
    for (const auto& [place, J] : row.on)
      if (place >= bodies)
        at_node(sum, island.nodes[static_cast<std::size_t>(place - bodies)]) +=
            part * row.impulse * J.head<3>();
  return sum;
}

}  // namespace polhode
