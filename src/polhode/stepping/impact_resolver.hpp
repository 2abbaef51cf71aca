// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include <polhode/core/disjoint_sets.hpp>
#include <polhode/equations/trial.hpp>
#include <polhode/stepping/instant.hpp>
#include <polhode/system/surface_impacts.hpp>

namespace polhode {

/// Velocity jumps by impacts at the end of a step: of contacts, of surfaces and of joint stops.
/// Impulses act along the normals, with friction in the tangent planes, on bodies with the mass of
/// the solids attached to them, under G v = 0. They only dissipate energy. @eq{turn-law}
/// @eq{impact-friction} @eq{routh} @eq{joint-stop-exit} @eq{surface-turn}
class ImpactResolver {
 public:
  explicit ImpactResolver(const System& system);

  /// Collects the impacts of interactions and of surfaces in an accepted step; state and histories
  /// are still at t_n, but for the forces of rows that only push. Earlier ones are dropped.
  void find(const State& state, const Trial& trial);
  /// Completes those of surfaces when the state has moved to t_{n+1}. Before those of contacts.
  void find_turns(const State& state);
  /// Adds those of contacts when the state has moved to t_{n+1}.
  /// @returns the change of the energy stored by contacts, and their dissipation.
  Work find(State& state, BodyContacts& contacts);
  /// Closes and opens the rows of the step, and drops them, if no velocity changes at any of them.
  void leave_still(State& state);
  /// Whether rows of interactions that only push touched in the step.
  [[nodiscard]] bool touched() const { return !row_memories_.empty(); }
  [[nodiscard]] bool any() const;
  /// Changes the velocities of the state, which has moved to t_{n+1}.
  /// @returns the change of the energy stored by surfaces, and their dissipation.
  Work settle(State& state);
  /// Adds the impacts of the last settle() that were not solved to those of the run.
  /// @param t  Their time [s].
  void report(double t, UnsolvedImpacts& impacts) const;
  /// Largest change of a body's velocity, over the size of the model, or angular velocity by the
  /// impacts just settled [1/s].
  [[nodiscard]] double largest_jump() const { return largest_jump_; }
  /// Work of drives in the impacts just settled [J].
  [[nodiscard]] double drive_work() const { return drive_work_; }

 private:
  /// Rows that share bodies, directly or through joints and solids.
  struct Island {
    std::vector<int> rows, bodies;
    std::vector<int> nodes;  ///< Loaded free nodes, ascending.
    bool tied = false;       ///< Joints or solids couple its bodies.
    double projected = 0.0;  ///< Energy of velocities that its joints do not admit [J].
  };
  /// A point of a surface with the group of elements it belongs to and its number there.
  struct Surface {
    int number = 0;
    const SurfaceImpacts* group = nullptr;
    SurfaceImpact impact;
    bool turns = false;  ///< In this step.
    double held = 0.0;   ///< Force of others on it [N].
  };
  [[nodiscard]] std::vector<Island> islands() const;
  [[nodiscard]] Vec6 velocity(const State& state, int body) const;
  /// Velocities of an island's bodies, then of its nodes, which have no rotation.
  [[nodiscard]] std::vector<Vec6> velocities(const State& state, const Island& island) const;
  [[nodiscard]] Vec3 velocity_of_node(const State& state, int node) const;
  /// Surface impact of a row; null for other rows.
  [[nodiscard]] const SurfaceImpact* surface(int row) const;
  [[nodiscard]] Surface& of_surface(int row) {
    return surfaces_[static_cast<std::size_t>(row) - of_joints_];
  }
  [[nodiscard]] double wanted_of(const SurfaceImpact& impact, double speed) const;
  template <class Use>
  void for_bodies(int row, Use&& use) const;
  struct Row;
  /// Rows by island: one for each normal, two more for each with friction.
  [[nodiscard]] std::vector<std::vector<Row>> rows_of(const State& state,
                                                      std::span<const Island> islands);
  /// Rows of an island; responses of tied bodies are missing where no nodes take part.
  [[nodiscard]] std::vector<Row> start_rows(const State& state, const Island& island);
  void add_responses(std::span<const Island> islands, std::vector<std::vector<Row>>& rows);
  void settle(State& state, const Island& island, std::vector<Row> rows);
  /// Applies a part of the impulses of an island's rows, which change its velocities from these.
  /// @param work  Of each row's impulse along the course of the impact; null: that by mean
  /// velocities, whose sum over the rows is the same.
  void apply(State& state, const Island& island, const std::vector<Row>& rows,
             const std::vector<Vec6>& start, const std::vector<Vec6>& v, double part,
             const Vec* work = nullptr);
  /// Adds the rows of interactions that only push, as far as they touch or did.
  void find_unilateral(const State& state, const Trial& trial);
  /// Stores which of these are closed, and adds their impulses to their forces.
  void close_unilateral(State& state) const;
  /// Whether some rows of the island were rows of the step.
  [[nodiscard]] bool has_step_rows(const Island& island) const;
  void settle_step_rows(State& state, const Island& island, std::vector<Row> rows);
  /// Kinetic energy of a change of an island's velocities [J].
  [[nodiscard]] double energy_of(const State& state, const Island& island,
                                 const std::vector<Vec6>& jumps) const;
  /// Resolves the islands that contain a row from that one on.
  void settle_from(State& state, std::size_t first);
  /// Adds rows for the resting contacts of bodies that jumped, as far as they are loaded by it.
  void press_on(const State& state, const std::vector<Vec6>& before);
  [[nodiscard]] double speed(const State& state, const PairImpact& row) const;
  [[nodiscard]] double speed(const State& state, int row) const;
  void find_held(const std::vector<Row>& rows, std::vector<Vec6> v);
  void share_held(std::vector<Row>& rows, std::vector<Vec6> v) const;
  [[nodiscard]] double returnable(std::span<const Row> rows) const;
  [[nodiscard]] Work turn_surfaces(State& state) const;
  void tell_surfaces(State& state) const;
  [[nodiscard]] Eigen::Vector2d updated_friction(const Row& along, const Row& across, double normal,
                                                 const std::vector<Vec6>& v) const;
  double apply_friction(Row& along, Row& across, double normal, std::vector<Vec6>& v) const;
  /// Whether the impulses of the normals act too, or friction alone.
  enum class Acts { all, friction };
  bool sweep(std::vector<Row>& rows, Acts acts, std::vector<Vec6>& v) const;
  void solve_rows(std::vector<Row>& rows, std::vector<Vec6>& v, Acts acts);
  [[nodiscard]] std::pair<int, double> largest_miss(const std::vector<Row>& rows, Acts acts,
                                                    const std::vector<Vec6>& v) const;
  void note_error(int row, double error, double fastest);
  void follow(std::vector<Row>& rows, std::vector<Vec6>& v);
  [[nodiscard]] bool lands_flat(const Island& island, const std::vector<Row>& rows) const;
  [[nodiscard]] bool follow_flat(std::vector<Row>& rows, std::vector<Vec6>& v);
  /// Adds the impulses of rows and stops since these velocities to the sums of joints and drives.
  void record(State& state, std::span<const Vec6> bodies, std::span<const double> nodes);
  /// Work of prescribed nodes. @param before  Velocities before the impacts.
  [[nodiscard]] double work_of_nodes(const State& state, std::span<const double> before) const;
  /// @returns the energy loss of solids' nodes beyond that given by their bodies' velocities [J].
  double jump(State& state, const Island& island, const std::vector<Vec6>& jumps);
  /// Impulses of rows on free nodes, 3 each.
  [[nodiscard]] std::vector<double> on_nodes(const Island& island, const std::vector<Row>& rows,
                                             double part) const;

  const System* system_;
  std::unique_ptr<InstantSolver> solver_;  ///< From the first impact of coupled bodies on.
  /// Connected components by joints and solids: of bodies, followed by those of solids.
  DisjointSets ties_;
  std::vector<bool> tied_;  ///< By body: whether it is coupled to others or to the ground.
  std::vector<int> place_;  ///< By body: position in the present island.
  /// Groups of elements, with their numbers.
  std::vector<std::pair<int, const SurfaceImpacts*>> groups_;
  std::vector<Surface> surfaces_;  ///< In the order of their rows.
  double dt_ = 0.0;                ///< Of the step [s].
  std::vector<PairImpact> rows_;
  BodyContacts* contacts_ = nullptr;     ///< Contacts of the last rows.
  std::size_t of_joints_ = 0;            ///< Number of rows of joints, the first ones.
  std::size_t before_contacts_ = 0;      ///< Number of rows of joints and of surfaces.
  std::vector<int> jumped_;              ///< Bodies of the islands so far, ascending.
  std::vector<PairImpact> resting_;      ///< Their resting contacts.
  std::vector<ResolvedImpact> settled_;  ///< Of the rows.
  std::vector<int> stops_;               ///< Interactions of the rows of joints.
  std::vector<int> row_memories_;        ///< Entries of their records in State::history, if any.
  std::vector<Vec6> pressed_;            ///< By body: impulses of the rows.
  std::vector<double> pressed_nodes_;    ///< On free nodes, three each; empty: none.
  bool pulls_ = false;                   ///< Rows of tied bodies have been settled.
  double drive_work_ = 0.0;              ///< Of the last impacts [J].
  double largest_jump_ = 0.0;            ///< In the last impacts [1/s].
  UnsolvedImpacts unsolved_;             ///< Of the last impacts.
  std::vector<int> numbers_;  ///< Rows of contacts, in the order of the contacts' list; −1: none.
};

}  // namespace polhode
