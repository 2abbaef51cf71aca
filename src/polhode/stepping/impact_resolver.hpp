// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include <polhode/equations/trial.hpp>
#include <polhode/stepping/instant.hpp>
#include <polhode/system/surface_impacts.hpp>

namespace polhode {

/// Makes velocities jump at the end of a step in impacts, of contacts, of surfaces and of the stops
/// of joints: by impulses along their normals and friction across, from bodies that are as heavy as
/// the solids they hold make them, while G v = 0. They only take energy.
/// @eq{turn-law} @eq{impact-friction} @eq{routh} @eq{joint-stop-exit} @eq{surface-turn}
class ImpactResolver {
 public:
  explicit ImpactResolver(const System& system);

  /// Finds the impacts of interactions and of surfaces in an accepted step, the state and the
  /// histories still at t_n. Forgets those before.
  void find(const State& state, const Trial& trial);
  /// Goes on with those of surfaces, the state having moved to t_{n+1}. Before those of contacts.
  void find_turns(const State& state);
  /// Adds those of contacts, the state having moved to t_{n+1}.
  /// @returns the change of what contacts store, and what they dissipated by it.
  Work find(State& state, BodyContacts& contacts);
  [[nodiscard]] bool any() const;
  /// Changes the velocities of the state, which has moved to t_{n+1}.
  /// @returns the change of what surfaces store, and what they dissipated by it.
  Work settle(State& state);

 private:
  /// Rows that share bodies, directly or by way of joints and solids.
  struct Island {
    std::vector<int> rows, bodies;
    std::vector<int> nodes;  ///< Free ones that rows press on, ascending.
    bool tied = false;       ///< Joints or solids make its bodies answer together.
  };
  /// A point of a surface, and the group of elements that it belongs to, with its number.
  struct Surface {
    int number = 0;
    const SurfaceImpacts* group = nullptr;
    SurfaceImpact impact;
    bool turns = false;  ///< In this step.
    double held = 0.0;   ///< Force by which others press it on [N].
  };
  [[nodiscard]] std::vector<Island> islands() const;
  [[nodiscard]] Vec6 velocity(const State& state, int body) const;
  /// Of an island's bodies, then of its nodes, which do not turn.
  [[nodiscard]] std::vector<Vec6> velocities(const State& state, const Island& island) const;
  [[nodiscard]] Vec3 velocity_of_node(const State& state, int node) const;
  /// Of a row of a surface; null for others.
  [[nodiscard]] const SurfaceImpact* surface(int row) const;
  [[nodiscard]] Surface& of_surface(int row) {
    return surfaces_[static_cast<std::size_t>(row) - of_joints_];
  }
  [[nodiscard]] double wanted_of(const SurfaceImpact& impact, double speed) const;
  template <class Use>
  void for_bodies(int row, Use&& use) const;
  struct Row;
  /// Rows of an island: one for each normal, two more for each that rubs.
  [[nodiscard]] std::vector<Row> rows_of(const State& state, const Island& island);
  void settle(State& state, const Island& island);
  /// Islands that hold a row from that one on.
  void settle_from(State& state, std::size_t first);
  /// Lasting contacts of bodies that jumped, pressed on by it, become rows.
  void press_on(const State& state, const std::vector<Vec6>& before);
  [[nodiscard]] double speed(const State& state, const PairImpact& row) const;
  [[nodiscard]] double speed(const State& state, int row) const;
  void find_held(const std::vector<Row>& rows, std::vector<Vec6> v);
  void share_held(std::vector<Row>& rows, std::vector<Vec6> v) const;
  [[nodiscard]] Work turn_surfaces(State& state) const;
  void tell_surfaces(State& state) const;
  double apply_friction(Row& along, Row& across, double normal, std::vector<Vec6>& v) const;
  void sweep(std::vector<Row>& rows, double most, std::vector<Vec6>& v) const;
  void follow(std::vector<Row>& rows, std::vector<Vec6>& v) const;
  /// @returns the energy that nodes of solids lose by it beyond what their bodies' velocities
  ///          tell [J].
  double jump(State& state, const Island& island, const std::vector<Vec6>& jumps);
  /// Impulses of rows on free nodes, 3 each.
  [[nodiscard]] std::vector<double> on_nodes(const Island& island, const std::vector<Row>& rows,
                                             double part) const;

  const System* system_;
  std::unique_ptr<InstantSolver> solver_;  ///< From the first impact of tied bodies on.
  std::vector<int> tie_;    ///< By body: the first of those that joints and solids tie it to.
  std::vector<bool> tied_;  ///< By body: something ties it, be it to the ground.
  std::vector<int> place_;  ///< By body: in the island at hand.
  std::vector<std::pair<int, const SurfaceImpacts*>> groups_;  ///< Of elements, with numbers.
  std::vector<Surface> surfaces_;                              ///< In the order of their rows.
  double dt_ = 0.0;                                            ///< Of the step [s].
  std::vector<PairImpact> rows_;
  BodyContacts* contacts_ = nullptr;     ///< Whose impacts the last rows are.
  std::size_t of_joints_ = 0;            ///< Rows of joints, the first ones.
  std::size_t before_contacts_ = 0;      ///< Rows of joints and of surfaces.
  std::vector<int> jumped_;              ///< Bodies of the islands so far, ascending.
  std::vector<PairImpact> resting_;      ///< Their lasting contacts.
  std::vector<ResolvedImpact> settled_;  ///< Of the rows.
  std::vector<int>
      numbers_;  ///< Rows of contacts, in the order in which these listed them; −1: none.
};

}  // namespace polhode
