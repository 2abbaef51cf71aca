// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include <polhode/equations/node_motion.hpp>
#include <polhode/stepping/impact_rows.hpp>
#include <polhode/stepping/single_impact.hpp>

namespace polhode {

namespace {

/// Largest number of rounds in which resting contacts are added to the rows.
constexpr int kMaxCarried = 30;
/// Relative change of a target speed below which the speed is kept.
constexpr double kSameSpeed = 1e-12;
/// Part of the dissipation by friction in a step that impulses may return.
constexpr double kReturnable = 0.5;

}  // namespace

ImpactResolver::ImpactResolver(const System& system) : system_(&system) {
  const auto n = static_cast<std::size_t>(system.body_count());
  // Connected components of solids follow the bodies.
  ties_ = DisjointSets(n + system.nodes().pieces().size());
  tied_.assign(n, false);
  place_.assign(n, -1);
  const auto tie = [&](int a, int b) {
    if (a != kGround) tied_[a] = true;
    if (b != kGround) tied_[b] = true;
    if (a != kGround && b != kGround) ties_.join(a, b);
  };
  for (const InteractionRef& ref : system.interactions())
    if (ref.rows > 0 || system.traits(ref).coupled_mass != 0.0) {
      tie(ref.a, ref.b);
      if (ref.further_part)
        tie(moving_body(ref), moving_body(system.interactions()[ref.first_part]));
    }
  const Nodes& nodes = system.nodes();
  for (int i = 0; i < nodes.count(); ++i)
    if (nodes[i].body >= 0) tied_[nodes[i].body] = true;
  for (const ConnectedComponent& piece : nodes.pieces())
    for (int body : piece.bodies) tie(piece.bodies.front(), body);
  for (std::size_t p = 0; p < nodes.pieces().size(); ++p)
    if (const ConnectedComponent& piece = nodes.pieces()[p]; !piece.bodies.empty())
      ties_.join(piece.bodies.front(), static_cast<int>(n + p));
  for (int g = 0; g < nodes.group_count(); ++g)
    if (const SurfaceImpacts* group = nodes.group(g).surface_impacts())
      groups_.emplace_back(g, group);
}

void ImpactResolver::find(const State& state, const Trial& trial) {
  rows_.clear();
  stops_.clear();
  row_memories_.clear();
  surfaces_.clear();
  contacts_ = nullptr;
  dt_ = trial.context.dt;
  if (!groups_.empty()) {
    const NodeStep step = node_step(state, trial);
    std::vector<SurfaceImpact> hit;
    for (const auto& [g, group] : groups_) {
      hit.clear();
      group->impacts(step, state.element_history.data() + system_->nodes().first_history(g), hit);
      for (SurfaceImpact& impact : hit) {
        for (const auto& [node, J] : impact.nodes)
          impact.before += impact.normal.dot(J * velocity_of_node(state, node));
        surfaces_.push_back({g, group, std::move(impact)});
      }
    }
  }
  std::vector<Impact> impacts;
  for (int i : system_->barriers()) {
    const InteractionRef& ref = system_->interactions()[i];
    impacts.clear();
    const PairView view = pair_view(*system_, state, trial, ref);
    system_->group(ref.group).impacts(ref.item, view.step(), impacts);
    for (const Impact& impact : impacts) rows_.push_back({{ref.a, ref.b}, impact, {}});
    stops_.resize(rows_.size(), i);
  }
  find_unilateral(state, trial);
  of_joints_ = before_contacts_ = rows_.size();
}

Work ImpactResolver::find(State& state, BodyContacts& contacts) {
  contacts_ = &contacts;
  return contacts.impacts(state, rows_);
}

bool ImpactResolver::any() const {
  return std::any_of(rows_.begin(), rows_.end(),
                     [](const PairImpact& row) { return !std::isnan(row.impact.wanted); });
}

Vec6 ImpactResolver::velocity(const State& state, int body) const {
  const BodyMotion m = system_->motion(state, body);
  Vec6 v;
  v << m.v, m.omega();
  return v;
}

std::vector<Vec6> ImpactResolver::velocities(const State& state, const Island& island) const {
  std::vector<Vec6> v;
  for (int body : island.bodies) v.push_back(velocity(state, body));
  for (int node : island.nodes) {
    v.push_back(Vec6::Zero());
    v.back().head<3>() = at_node(state.node_v, node);
  }
  return v;
}

/// Resolves all impacts. Impulses load nearby resting contacts, which react at the same instant:
/// their rows are added, starting from the impulses so far, until no further contact is loaded.
/// @eq{impact-carried}
Work ImpactResolver::settle(State& state) {
  settled_.assign(rows_.size(), {});
  jumped_.clear();
  largest_jump_ = 0.0;
  resting_.clear();
  numbers_.resize(rows_.size() - before_contacts_);
  std::iota(numbers_.begin(), numbers_.end(), static_cast<int>(before_contacts_));
  std::vector<Vec6> before;
  for (int body = 0; body < system_->body_count(); ++body) before.push_back(velocity(state, body));
  const std::vector<double> nodes_before = state.node_v;
  pressed_.assign(before.size(), Vec6::Zero());
  pressed_nodes_.clear();
  pulls_ = false;
  unsolved_ = {};
  for (PairImpact& row : rows_)
    if (std::isnan(row.impact.wanted)) row.impact.wanted = speed(state, row);
  settle_from(state, 0);
  tell_surfaces(state);
  const Work work = turn_surfaces(state);
  if (!contacts_) {
    close_unilateral(state);
    record(state, before, nodes_before);
    return work;
  }
  for (int round = 0; round < kMaxCarried; ++round) {
    const std::size_t first = rows_.size();
    press_on(state, before);
    if (rows_.size() == first) break;
    settle_from(state, first);
  }
  std::vector<ResolvedImpact> of_contacts;
  for (int k : numbers_) of_contacts.push_back(k < 0 ? ResolvedImpact{} : settled_[k]);
  contacts_->settled(state, of_contacts);
  close_unilateral(state);
  record(state, before, nodes_before);
  return work;
}

double ImpactResolver::speed(const State& state, const PairImpact& row) const {
  double sum = 0.0;
  if (row.bodies.a != kGround) sum += row.impact.on_a.dot(velocity(state, row.bodies.a));
  if (row.bodies.b != kGround) sum += row.impact.on_b.dot(velocity(state, row.bodies.b));
  return sum;
}

void ImpactResolver::press_on(const State& state, const std::vector<Vec6>& before) {
  std::sort(jumped_.begin(), jumped_.end());
  jumped_.erase(std::unique(jumped_.begin(), jumped_.end()), jumped_.end());
  const std::size_t known = resting_.size();
  contacts_->resting(state, jumped_, resting_);
  for (std::size_t i = known; i < resting_.size(); ++i) {
    auto& [bodies, impact, course, slow, row] = resting_[i];
    impact.wanted = 0.0;
    if (bodies.a != kGround) impact.wanted += impact.on_a.dot(before[bodies.a]);
    if (bodies.b != kGround) impact.wanted += impact.on_b.dot(before[bodies.b]);
    numbers_.push_back(-1);
  }
  const std::size_t others = numbers_.size() - resting_.size();
  for (std::size_t i = 0; i < resting_.size(); ++i) {
    const PairImpact& row = resting_[i];
    int& number = numbers_[others + i];
    const double now = speed(state, row), wanted = row.impact.wanted;
    const bool pressed = now < wanted - row.slow;
    const bool thrown = row.impact.given > 0.0 && now > std::max(0.0, wanted) + row.slow;
    if (number >= 0 || !(pressed || thrown)) continue;
    number = static_cast<int>(rows_.size());
    rows_.push_back(row);
    if (thrown) rows_.back().impact.wanted = std::max(0.0, wanted);
    settled_.emplace_back();
  }
}

void ImpactResolver::settle_from(State& state, std::size_t first) {
  std::vector<Island> all = islands();
  std::erase_if(all, [&](const Island& island) {
    return static_cast<std::size_t>(island.rows.back()) < first;
  });
  const auto inert = [&](int k) {
    const Impact& impact = rows_[k].impact;
    if (impact.mu > 0.0 || rows_[k].row) return false;
    const double now = speed(state, k);
    return std::abs(impact.wanted - now) <= kSameSpeed * std::abs(now);
  };
  const auto still = std::stable_partition(all.begin(), all.end(), [&](const Island& island) {
    return !std::all_of(island.rows.begin(), island.rows.end(), inert);
  });
  std::vector<Island> pressed(std::make_move_iterator(still), std::make_move_iterator(all.end()));
  all.erase(still, all.end());
  std::erase_if(pressed, [&](const Island& island) {
    return std::none_of(island.rows.begin(), island.rows.end(), [&](int k) {
      const SurfaceImpact* hit = surface(k);
      return hit && !hit->turned;
    });
  });
  const auto is_tied = [](const Island& i) { return i.tied; };
  const bool tied = std::any_of(all.begin(), all.end(), is_tied) ||
                    std::any_of(pressed.begin(), pressed.end(), is_tied);
  std::vector<Vec6> to_admissible;
  if (tied) {
    if (!solver_) solver_ = std::make_unique<InstantSolver>(*system_);
    if (!solver_->take_impulses(state)) {
      for (const Island& island : all)
        for (const int k : island.rows)
          note_error(k, std::abs(rows_[k].impact.wanted - speed(state, k)), 0.0);
      return;
    }
    to_admissible = solver_->jumps_to_admissible(state);
    pulls_ = true;
  }
  const auto number = [&](const Island& island) {
    for (std::size_t i = 0; i < island.bodies.size(); ++i)
      place_[island.bodies[i]] = static_cast<int>(i);
  };
  for (const Island& island : pressed) number(island);
  for (const Island& island : all) number(island);
  std::vector<std::vector<Row>> held = rows_of(state, pressed), rows = rows_of(state, all);
  for (std::size_t i = 0; i < pressed.size(); ++i)
    find_held(held[i], velocities(state, pressed[i]));
  for (std::size_t i = 0; i < all.size(); ++i) {
    Island& island = all[i];
    if (island.tied && system_->rows() > 0) {
      std::vector<Vec6> jumps;
      for (int body : island.bodies) jumps.push_back(to_admissible[body]);
      if (has_step_rows(island)) island.projected = energy_of(state, island, jumps);
      jump(state, island, jumps);
    }
    settle(state, island, std::move(rows[i]));
    jumped_.insert(jumped_.end(), island.bodies.begin(), island.bodies.end());
  }
}

Vec3 impulse_by_routh(const Mat3& K, const Eigen::Vector2d& mu, const ImpactCourse& course,
                      const Vec3& before, const Vec3& now) {
  SingleImpact single;
  single.mobility = K;
  single.mu = mu[0];
  single.mu_across = mu[1];
  single.restitution = course.restitution;
  single.velocity = before;
  if (single.restitution > 0.0) {
    // A frictionless step changes the normal velocity by the stored energy and by gravity.
    const double square =
        now[0] * now[0] + course.fallen + 2.0 * K(0, 0) * (course.stored_n1 - course.stored_n);
    single.velocity[0] = std::copysign(std::sqrt(std::max(0.0, square)), before[0]);
    single.stored = course.stored_n;
    if (course.turns)
      single.kept = single.restitution * single.restitution * course.stored_n1;
    else
      single.until = course.stored_n1;
  }
  const SingleImpactEnd end = end_of(single);
  const double square = end.velocity[0] * end.velocity[0] - course.fallen;
  const double wanted = std::copysign(std::sqrt(std::max(0.0, square)), end.velocity[0]);
  const Vec3 friction(0.0, end.impulse[1], end.impulse[2]);
  return {(wanted - now[0] - K.row(0).dot(friction)) / K(0, 0), friction[1], friction[2]};
}

/// Resolves an impact that shares its bodies with no other one. @eq{routh}
void ImpactResolver::follow(std::vector<Row>& rows, std::vector<Vec6>& v) {
  const auto& [bodies, impact, course, slow, row] = rows_[rows.front().impact];
  if (friction_alone(*course)) return solve_rows(rows, v, Acts::friction);
  Mat3 K;
  Vec3 now;
  for (int i = 0; i < 3; ++i) {
    now[i] = rows[i].speed(v);
    for (int j = 0; j < 3; ++j) K(i, j) = rows[i].speed_by(rows[j]);
  }
  if (!(K(0, 0) > 0.0)) return;
  const Vec3 impulse = impulse_by_routh(K, {impact.mu, impact.mu_across}, *course,
                                        now - impact.given * K.col(0), now);
  rows[0].apply(std::max(impulse[0], -impact.given), v);
  rows[1].apply(impulse[1], v);
  rows[2].apply(impulse[2], v);
}

/// Part of the dissipation by friction of resting contacts in this step that their impulses may
/// return: with less normal force there is less friction. Half of what follows from the slip at the
/// end, which may be up to twice the mean slip of the step. None where an impact, or an earlier
/// impulse of this instant, acts as well.
double ImpactResolver::returnable(std::span<const Row> rows) const {
  double sum = 0.0;
  for (const Row& row : rows)
    if (rows_[row.impact].course || settled_[row.impact].normal != 0.0) return 0.0;
  for (std::size_t i = 0; i + 2 < rows.size(); ++i) {
    if (!rows[i + 1].has_friction || rows[i].has_friction) continue;
    const Impact& impact = rows_[rows[i].impact].impact;
    const double work = impact.friction_impulse.dot(rows[i + 1].before * impact.along +
                                                    rows[i + 2].before * impact.across);
    sum += kReturnable * std::max(0.0, -work);
  }
  return sum;
}

/// Resolves an island. Impulses that would add energy to the step are scaled back. @eq{turn-law}
void ImpactResolver::settle(State& state, const Island& island, std::vector<Row> rows) {
  if (has_step_rows(island)) return settle_step_rows(state, island, std::move(rows));
  std::vector<Vec6> v = velocities(state, island);
  const std::vector<Vec6> start = v;
  find_held(rows, v);
  double most = 0.0;
  for (Row& row : rows) {
    row.before = row.speed(v);
    most = std::max(most, row.mobility);
  }
  if (!(most > 0.0)) return;
  const bool alone =
      island.rows.size() == 1 && rows.size() == 3 && rows_[island.rows.front()].course.has_value();
  if (alone) follow(rows, v);
  if (alone || (lands_flat(island, rows) && follow_flat(rows, v))) {
    for (std::size_t i = 0; i < rows.size(); i += 3) {
      PairImpact& r = rows_[rows[i].impact];
      if (!friction_alone(*r.course)) r.impact.wanted = rows[i].speed(v);
    }
  } else {
    solve_rows(rows, v, Acts::all);
  }
  // ΔT = Σ p (J v before + J v after)/2: quadratic along the jump.
  double first = 0.0, second = 0.0;
  for (const Row& row : rows) {
    first += row.impulse * row.before;
    second += row.impulse * (row.speed(v) - row.before);
  }
  const double most_added = returnable(rows);
  double part = 1.0;
  if (first + 0.5 * second > most_added && second > 0.0)
    part = std::clamp((std::sqrt(first * first + 2.0 * second * most_added) - first) / second, 0.0,
                      1.0);
  apply(state, island, rows, start, v, part);
}

void ImpactResolver::apply(State& state, const Island& island, const std::vector<Row>& rows,
                           const std::vector<Vec6>& start, const std::vector<Vec6>& v, double part,
                           const Vec* work) {
  std::vector<Vec6> jumps(island.bodies.size());
  for (std::size_t i = 0; i < jumps.size(); ++i) jumps[i] = part * (v[i] - start[i]);
  for (const Row& row : rows)
    for (const auto& [place, J] : row.on)
      if (static_cast<std::size_t>(place) < island.bodies.size())
        pressed_[island.bodies[static_cast<std::size_t>(place)]] += part * row.impulse * J;
  if (!island.nodes.empty()) {
    const std::vector<double> now = on_nodes(island, rows, part);
    solver_->press_nodes(now);
    pressed_nodes_.resize(now.size(), 0.0);
    for (std::size_t k = 0; k < now.size(); ++k) pressed_nodes_[k] += now[k];
  }
  const double more = jump(state, island, jumps);
  if (!island.nodes.empty()) solver_->press_nodes({});
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    ResolvedImpact& s = settled_[row.impact];
    Impact& impact = rows_[row.impact].impact;
    const double p = part * row.impulse;
    const double lost = work ? -(*work)[static_cast<Eigen::Index>(i)]
                             : -p * (row.before + 0.5 * part * (row.speed(v) - row.before));
    if (row.turns) {
      s.friction_loss += lost;
    } else if (i > 0 && rows[i - 1].has_friction) {
      s.friction += p * impact.across;
      impact.friction_impulse += p * impact.across;
      s.friction_loss += lost;
    } else if (row.has_friction) {
      s.friction += p * impact.along;
      impact.friction_impulse += p * impact.along;
      s.friction_loss += lost;
    } else {
      s.normal += p;
      impact.given += p;
      s.normal_loss += lost + more / static_cast<double>(island.rows.size());
    }
  }
}

double ImpactResolver::jump(State& state, const Island& island, const std::vector<Vec6>& jumps) {
  const Nodes& nodes = system_->nodes();
  double lost = 0.0;
  if (island.tied && !nodes.empty()) {
    std::vector<Vec6> by_body(static_cast<std::size_t>(system_->body_count()), Vec6::Zero());
    for (std::size_t i = 0; i < jumps.size(); ++i) by_body[island.bodies[i]] = jumps[i];
    const std::vector<double> dv = solver_->node_jumps(by_body);
    const auto at = [](const std::vector<double>& x, int i) {
      return Eigen::Map<const Vec3>(x.data() + 3 * static_cast<std::ptrdiff_t>(i));
    };
    // Newmark velocities of bonded nodes differ slightly from those of their bodies.
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
    largest_jump_ = std::max({largest_jump_, jumps[i].head<3>().norm() / system_->length_scale(),
                              jumps[i].tail<3>().norm()});
    const int slot = system_->slot(island.bodies[i]), lane = slot % kLanes;
    const Vec3 dW = system_->motion(state, island.bodies[i]).q.conjugate() * jumps[i].tail<3>();
    BodyBlock& block = state.blocks[slot / kLanes];
    for (int c = 0; c < 3; ++c) {  // positions keep their compensated rounding
      block.v[c][lane] += jumps[i][c];
      block.W[c][lane] += dW[c];
    }
  }
  return lost;
}

}  // namespace polhode
