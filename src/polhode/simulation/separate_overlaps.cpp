// SPDX-License-Identifier: Apache-2.0
#include <numeric>

#include <polhode/compile/contact_sides.hpp>
#include <polhode/equations/node_motion.hpp>
#include <polhode/simulation/separate_overlaps.hpp>
#include <polhode/surface_contact/surface_law.hpp>

namespace polhode {

namespace {

constexpr int kMaxRounds = 1000;
/// Largest number of rounds with surfaces, which are checked in full each time.
constexpr int kMaxSurfaceRounds = 50;
/// Additional displacement of a pair, as a part of the depth, so that rounds end.
constexpr double kBeyond = 1e-6;

/// Rigid groups: a body, or solids with the bodies that they are bonded to. Numbers are those of
/// the System's bodies, then those of the model's solids.
class Parts {
 public:
  Parts(const System& system, const SystemMap& map) : system_(system), map_(map) {
    const int bodies = system.body_count(), solids = static_cast<int>(map.solids.size());
    part_.resize(static_cast<std::size_t>(bodies + solids));
    std::iota(part_.begin(), part_.end(), 0);
    members_.resize(part_.size());
    for (const int k : part_) members_[static_cast<std::size_t>(k)] = {k};
    mass_.assign(part_.size(), 0.0);
    held_.assign(part_.size(), false);
    for (int b = 0; b < bodies; ++b)
      mass_[static_cast<std::size_t>(b)] = system.bodies()[static_cast<std::size_t>(b)].mass;
    for (int s = 0; s < solids; ++s) add_solid(s, number_of_solid(s));
  }

  [[nodiscard]] int number_of_solid(int solid) const { return system_.body_count() + solid; }

  /// Separates two groups by a distance along the unit vector of the first one's motion, if one of
  /// them is movable.
  /// @param direction  Zero: not known.
  bool push(int a, int b, double way, const Vec3& direction, State& state) {
    const double sum = mobility(a) + mobility(b);
    if (sum == 0.0 || direction.isZero() || (a >= 0 && b >= 0 && part(a) == part(b))) return false;
    const Vec3 share = (1.0 + kBeyond) * way / sum * direction;
    move(a, mobility(a) * share, state);
    move(b, -mobility(b) * share, state);
    return true;
  }

 private:
  void add_solid(int solid, int number) {
    const SolidMap& s = map_.solids[static_cast<std::size_t>(solid)];
    mass_[static_cast<std::size_t>(number)] = s.mass;
    for (int k = 0; k < s.node_count(); ++k) {
      const int body = system_.nodes()[s.first_node + k].body;
      if (body == kGround) hold(number);
      if (body >= 0) join(body, number);
    }
    for (const PrescribedComponent& p : system_.nodes().prescribed())
      if (p.node >= s.first_node && p.node < s.first_node + s.node_count()) hold(number);
  }

  [[nodiscard]] int part(int number) const { return part_[static_cast<std::size_t>(number)]; }
  void hold(int number) { held_[static_cast<std::size_t>(part(number))] = true; }

  void join(int a, int b) {
    const int to = std::min(part(a), part(b)), from = std::max(part(a), part(b));
    if (to == from) return;
    std::vector<int>& joined = members_[static_cast<std::size_t>(from)];
    for (const int k : joined) {
      part_[static_cast<std::size_t>(k)] = to;
      members_[static_cast<std::size_t>(to)].push_back(k);
    }
    joined.clear();
    mass_[static_cast<std::size_t>(to)] += mass_[static_cast<std::size_t>(from)];
    if (held_[static_cast<std::size_t>(from)]) hold(to);
  }

  /// Inverse mass. @param number  Negative: fixed.
  [[nodiscard]] double mobility(int number) const {
    if (number < 0) return 0.0;
    const auto p = static_cast<std::size_t>(part(number));
    return held_[p] ? 0.0 : 1.0 / mass_[p];
  }

  void move(int number, const Vec3& way, State& state) const {
    if (mobility(number) == 0.0) return;
    for (const int k : members_[static_cast<std::size_t>(part(number))]) {
      if (k < system_.body_count()) {
        BodyMotion m = system_.motion(state, k);
        m.r += way;
        state.set_motion(system_.slot(k), m);
      } else {
        const SolidMap& s = map_.solids[static_cast<std::size_t>(k - system_.body_count())];
        for (int i = 0; i < s.node_count(); ++i)
          Eigen::Map<Vec3>(state.node_x.data() + 3 * (s.first_node + i)) += way;
      }
    }
  }

  const System& system_;
  const SystemMap& map_;
  std::vector<int> part_;  ///< By number: smallest number of its group.
  // By group.
  std::vector<std::vector<int>> members_;
  std::vector<double> mass_;
  std::vector<bool> held_;
};

class Separation {
 public:
  Separation(const Model& model, const System& system, const SystemMap& map, State& state)
      : model_(model), system_(system), map_(map), state_(state), parts_(system, map) {}

  void run() {
    const bool surfaces = !map_.contact.surfaces.empty();
    bool moved = false;
    for (int k = 0; k < kMaxSurfaceRounds; ++k) {
      if (map_.contacts) moved = part_shapes() || moved;
      if (!surfaces || !part_surfaces()) break;
      moved = true;
    }
    if (moved) begin_surfaces();
  }

 private:
  bool part_shapes() {
    int rounds = 0;
    for (bool moved = true; moved && rounds < kMaxRounds; rounds += moved ? 1 : 0) {
      moved = false;
      for (const auto& o : map_.contacts->deepest_overlaps(instants_of(system_, state_))) {
        const auto body = [&](int shape) {
          return map_.contacts->shapes()[static_cast<std::size_t>(shape)].body;
        };
        moved = parts_.push(body(o.a), body(o.b), o.depth, o.normal, state_) || moved;
      }
    }
    if (rounds > 0) bond_nodes(system_, state_);
    return rounds > 0;
  }

  bool part_surfaces() {
    bool moved = false;
    for (const SideOverlap& o : surface_overlaps(model_, system_, map_, state_))
      moved =
          parts_.push(number(o.own), number(o.side), o.depth + o.free_gap, o.out, state_) || moved;
    if (moved) bond_nodes(system_, state_);
    return moved;
  }

  [[nodiscard]] int number(const Side& side) const {
    if (side.is_cable()) return -1;
    if (side.is_solid()) return parts_.number_of_solid(side.index);
    return map_.body[static_cast<std::size_t>(side.index)];
  }

  void begin_surfaces() {
    const StepContext still;
    const NodeStep instant = node_instant(system_, state_, still);
    for (const ContactMap::Surface& surface : map_.contact.surfaces) {
      const Nodes& nodes = system_.nodes();
      surface.touching->begin_at(
          instant, state_.element_history.data() + nodes.first_history(surface.group));
    }
  }

  const Model& model_;
  const System& system_;
  const SystemMap& map_;
  State& state_;
  Parts parts_;
};

}  // namespace

std::vector<BodyStep> instants_of(const System& system, const State& state) {
  std::vector<BodyStep> instants(static_cast<std::size_t>(system.body_count()) + 1);
  for (int b = 0; b < system.body_count(); ++b)
    instants[static_cast<std::size_t>(b)] = system.instant(state, b);
  instants.back() = BodyStep::ground(1.0);
  return instants;
}

std::vector<std::string> overlaps_at(const System& system, contact::ContactSet& contacts,
                                     const State& state) {
  return contacts.overlaps(instants_of(system, state));
}

std::vector<StartMove> separate_overlaps(const Model& model, const System& system,
                                         const SystemMap& map, State& state) {
  const State before = state;
  Separation(model, system, map, state).run();
  std::vector<StartMove> moves;
  for (int b = 0; b < system.body_count(); ++b) {
    const double way = (system.motion(state, b).r - system.motion(before, b).r).norm();
    if (way > 0.0) moves.push_back({system.bodies()[static_cast<std::size_t>(b)].name, way});
  }
  for (std::size_t s = 0; s < map.solids.size(); ++s) {
    const int node = map.solids[s].first_node;
    const double way =
        (NodeStep::at(state.node_x.data(), node) - NodeStep::at(before.node_x.data(), node)).norm();
    if (way > 0.0) moves.push_back({model.solids[s].name, way});
  }
  return moves;
}

}  // namespace polhode
